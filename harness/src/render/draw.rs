//! A pass over an image in parallel, the same one whatever the number of threads.

use super::canvas::{Canvas, Spent};
use super::tile::{AddSamples, Tile};
use super::virtual_lights::Batch;
use crate::estimator::Unlawful;
use crate::field::MediumJob;
use crate::plan::{AnyPhase, IntegratorJob, IntegratorPlan, Radiant, ScenePlan, Stage, TileIntegrator};
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::{LineThickness, Medium, Observed};
use fairflight_scene::{Spectrum, Volume};
use rayon::prelude::*;
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is drawn: shared by all workers.
pub(super) struct Draw<'a, C> {
    pub plan: &'a ScenePlan,
    pub radiant: &'a Radiant<C>,
    pub seed: u64,
    /// Is told how many samples were added.
    pub advance: &'a (dyn Fn(u64) + Sync),
}

/// Adds a pass of `samples` samples per pixel to a canvas.
///
/// Passes continue the streams of the pixels and their moments: one of n samples gives the same bits as n of one sample, for
/// integrators that carry nothing from ray to ray.
pub(super) struct AddPass<'a, C> {
    pub draw: Draw<'a, C>,
    pub canvas: &'a mut Canvas<C>,
    pub samples: u32,
}

/// How the integrator of a tile comes about, in one pass over a medium.
///
/// An integrator whose pixels share what is prepared for a pass (virtual point lights, say) says so in
/// [`IntegratorPlan::draws_in_batches`]: its passes then are of one sample per pixel, and the variance of the image's mean comes from
/// the means of the passes.
pub(super) trait Pass<M: Medium, C: Spectrum>: Sync {
    /// What all tiles of a pass share.
    type Batch: Sync;

    /// Prepares pass number `pass`, from 0, on the threads of the current pool: all its variates are those of (`draw.seed`, `pass`).
    ///
    /// # Errors
    /// If a look-up is not lawful.
    fn prepare(&self, draw: &Draw<'_, C>, medium: &M, pass: usize) -> Result<(Self::Batch, Spent), Failure>;

    /// Does a job with an integrator of one tile.
    ///
    /// # Errors
    /// If the integrator does not fit medium or lights.
    fn integrate<'s, J: IntegratorJob<C>>(
        &'s self,
        batch: &'s Self::Batch,
        volume: &'s ObservedVolume<'_, M, C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure>;
}

/// Integrators that need nothing but look-ups.
struct ByLookUps<'a, C>(&'a IntegratorPlan, &'a Radiant<C>);

/// The same on a medium whose optical thickness has a closed form.
struct ByClosedForm<'a, C>(&'a IntegratorPlan, &'a Radiant<C>);

/// What is prepared for a pass of any integrator.
fn prepare<M: Medium + Sync, C: Spectrum>(
    draw: &Draw<'_, C>,
    medium: &M,
    pass: usize,
) -> Result<(Batch<C>, Spent), Failure> {
    match &draw.plan.integrator {
        IntegratorPlan::Vpl(plan) => draw.virtual_lights(medium, plan, pass),
        _ => Ok((Batch::none(), Spent::default())),
    }
}

impl<C> Batch<C> {
    fn stage<'s>(&'s self, radiant: &'s Radiant<C>) -> Stage<'s, C> {
        let Radiant { lights, surfaces, .. } = radiant;
        Stage { lights, surfaces, vpls: &self.vpls, bound: self.bound }
    }
}

impl<M: Medium + Sync, C: Spectrum> Pass<M, C> for ByLookUps<'_, C> {
    type Batch = Batch<C>;

    fn prepare(&self, draw: &Draw<'_, C>, medium: &M, pass: usize) -> Result<(Batch<C>, Spent), Failure> {
        prepare(draw, medium, pass)
    }

    fn integrate<'s, J: IntegratorJob<C>>(
        &'s self,
        batch: &'s Batch<C>,
        volume: &'s ObservedVolume<'_, M, C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        self.0.by_look_ups(volume, batch.stage(self.1), unlawful, job)
    }
}

impl<M: LineThickness + Sync, C: Spectrum> Pass<M, C> for ByClosedForm<'_, C> {
    type Batch = Batch<C>;

    fn prepare(&self, draw: &Draw<'_, C>, medium: &M, pass: usize) -> Result<(Batch<C>, Spent), Failure> {
        prepare(draw, medium, pass)
    }

    fn integrate<'s, J: IntegratorJob<C>>(
        &'s self,
        batch: &'s Batch<C>,
        volume: &'s ObservedVolume<'_, M, C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        self.0.by_closed_form(volume, batch.stage(self.1), unlawful, job)
    }
}

impl<C: Spectrum> MediumJob for AddPass<'_, C> {
    type Output = Result<(), Failure>;

    fn by_look_ups<M: Medium + Sync>(self, medium: &M) -> Self::Output {
        let pass = ByLookUps(&self.draw.plan.integrator, self.draw.radiant);
        self.add(medium, &pass)
    }

    fn by_closed_form<M: LineThickness + Sync>(self, medium: &M) -> Self::Output {
        let pass = ByClosedForm(&self.draw.plan.integrator, self.draw.radiant);
        self.add(medium, &pass)
    }
}

/// An integrator that could be built.
struct Fits;

impl<C> IntegratorJob<C> for Fits {
    type Output = ();
    fn run<I: TileIntegrator<C>>(self, _integrator: I) {}
}

/// What draws a tile: the sum of its samples, and what they cost.
type DrawTile<'a, C> = dyn Fn(&mut Tile<C>) -> Result<(f64, Spent), Failure> + Sync + 'a;

/// The volume of a tile, observed.
pub(super) type ObservedVolume<'a, M, C> = Volume<Observed<&'a M>, &'a AnyPhase, C>;

impl<C: Spectrum> AddPass<'_, C> {
    /// # Errors
    /// If a look-up is not lawful, or a sample not finite: that of the first tile where it happens. The canvas is then of no use.
    fn add<M: Medium + Sync>(self, medium: &M, pass: &impl Pass<M, C>) -> Result<(), Failure> {
        let Self { draw, canvas, samples } = self;
        let integrator = &draw.plan.integrator;
        debug_assert!(samples == 1 || !integrator.draws_in_batches(), "a batch is for one sample per pixel");
        let number = canvas.pass_means.len();
        let (batch, spent) = pass.prepare(&draw, medium, number)?;
        canvas.cost = canvas.cost.and(spent);
        if number == 0 {
            // Whether they fit together is known before the first tile.
            pass.integrate(&batch, &draw.volume(medium), &Cell::new(None), Fits)?;
            canvas.warning = draw.check_growth(medium)?;
        }
        let (seed, drawn) = (canvas.seed, canvas.samples);
        let added = draw.tiles(&mut canvas.tiles, samples, &|tile| {
            let job = AddSamples { camera: &draw.plan.camera, tile, drawn, samples, seed };
            draw.tile(medium, |volume, unlawful| pass.integrate(&batch, volume, unlawful, job)?)
        })?;
        let mut sum = 0.0;
        for (of_tile, spent) in added {
            sum += of_tile;
            canvas.cost = canvas.cost.and(spent);
        }
        let [columns, rows] = draw.plan.camera.resolution().map(f64::from);
        canvas.pass_means.push(sum / (columns * rows * f64::from(samples)));
        canvas.samples += samples;
        // In empty space nothing is scattered towards the camera.
        if !M::IS_EMPTY
            && let IntegratorPlan::PhotonTracer(walk) = integrator
        {
            canvas.photons = Some(draw.photons(medium, walk)?);
        }
        Ok(())
    }
}

impl<C: Spectrum> Draw<'_, C> {
    pub(super) fn volume<'a, M: Medium>(&'a self, medium: &'a M) -> ObservedVolume<'a, M, C> {
        Volume {
            medium: Observed::new(medium),
            bounds: self.plan.bounds,
            albedo: self.radiant.albedo,
            phase: &self.plan.phase,
        }
    }

    /// Whether the walks of the integrator have a second moment. Its look-ups are not part of the cost: it is a diagnosis.
    fn check_growth<M: Medium>(&self, medium: &M) -> Result<Option<String>, Failure> {
        let Some(walk) = self.plan.integrator.walk().filter(|_| !M::IS_EMPTY) else { return Ok(None) };
        let volume = self.volume(medium);
        let growth = walk.check_growth(&volume, self.seed);
        // Where walks are not defined they do not grow either.
        self.judge(&volume.medium)?;
        growth
    }

    /// Whether all look-ups so far were lawful.
    pub(super) fn judge<M: Medium>(&self, observed: &Observed<M>) -> Result<(), Failure> {
        if !observed.is_finite() {
            return Err(Failure::refused("medium: sigma_t is not finite somewhere"));
        }
        let (lowest, highest) = observed.range();
        if let Some(bound) = observed.upper_bound()
            && highest > bound
        {
            return Err(Failure::refused(format!(
                "medium: sigma_t = {highest} exceeds the declared majorant {bound}"
            )));
        }
        if observed.lookups() > 0 {
            self.plan.integrator.admits((lowest, highest), self.radiant.albedo.max_channel())?;
        }
        Ok(())
    }

    /// One tile on an observed medium; what was met is judged afterwards. Gives the sum of the samples, and the cost.
    fn tile<M: Medium>(
        &self,
        medium: &M,
        draw: impl FnOnce(
            &ObservedVolume<'_, M, C>,
            &Cell<Option<Unlawful>>,
        ) -> Result<super::tile::Added, Failure>,
    ) -> Result<(f64, Spent), Failure> {
        let clock = ThreadTime::now();
        let volume = self.volume(medium);
        let unlawful = Cell::new(None);
        let added = draw(&volume, &unlawful);
        // Before the samples: a look-up that is not finite explains a sample that is not.
        self.judge(&volume.medium)?;
        if let Some(unlawful) = unlawful.get() {
            return Err(self.plan.integrator.explain(unlawful));
        }
        let added = added?;
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let (compensation_tried, compensation_inside) = added.compensation;
        let spent = Spent {
            lookups: volume.medium.lookups(),
            cpu_seconds,
            truncated: added.truncated,
            compensation_tried,
            compensation_inside,
            ..Spent::default()
        };
        Ok((added.sum, spent))
    }

    /// All tiles; what comes of them in their order. One copy for all integrators: a call per tile costs nothing.
    fn tiles(
        &self,
        tiles: &mut [Tile<C>],
        samples: u32,
        tile: &DrawTile<'_, C>,
    ) -> Result<Vec<(f64, Spent)>, Failure> {
        // A tile behind the first failure is not drawn; one before it is, since it might fail too.
        let first_failure = AtomicUsize::new(usize::MAX);
        let done: Vec<Option<Result<(f64, Spent), Failure>>> = tiles
            .par_iter_mut()
            .enumerate()
            .with_max_len(1)
            .map(|(i, drawn)| {
                if i > first_failure.load(Ordering::Relaxed) {
                    return None;
                }
                let area = drawn.area;
                let done = interrupt::check()
                    .and_then(|()| tile(drawn))
                    .map_err(|failure| failure.within(area.name()));
                if done.is_err() {
                    first_failure.fetch_min(i, Ordering::Relaxed);
                }
                (self.advance)(area.pixels() * u64::from(samples));
                Some(done)
            })
            .collect();
        // Up to the first failure there is no gap.
        done.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::MediumLibrary;
    use crate::plan::Spectra;
    use crate::render::canvas::MeanVariance;
    use crate::spec::{SceneOverrides, SceneSpec};
    use fairflight_media::{EmptySpace, Line};
    use fairflight_paths::Integrator;
    use fairflight_sources::{Seeded, UniformSource};

    /// Sees the number of the batch, and one variate of the pixel.
    struct Shows(f64);

    impl Integrator<f64> for Shows {
        fn radiance(&mut self, _line: &Line, source: &mut impl UniformSource) -> f64 {
            self.0 + 1e-3 * (source.next_uniform() - 0.5)
        }
    }

    impl TileIntegrator<f64> for Shows {
        fn truncated(&self) -> u64 {
            2
        }
    }

    /// A batch is one number.
    struct Numbers;

    impl<M: Medium> Pass<M, f64> for Numbers {
        type Batch = f64;

        fn prepare(&self, draw: &Draw<'_, f64>, _: &M, pass: usize) -> Result<(f64, Spent), Failure> {
            let number = Seeded::for_batch(draw.seed, pass as u64).next_uniform();
            Ok((number, Spent { lookups: 7, ..Spent::default() }))
        }

        fn integrate<'s, J: IntegratorJob<f64>>(
            &'s self,
            batch: &'s f64,
            _: &'s ObservedVolume<'_, M, f64>,
            _: &'s Cell<Option<Unlawful>>,
            job: J,
        ) -> Result<J::Output, Failure> {
            Ok(job.run(Shows(*batch)))
        }
    }

    #[test]
    fn a_batch_is_prepared_for_each_pass_and_shared() {
        let scene = include_str!("../../scenes/eq21-environment.json");
        let spec = SceneSpec::parse(scene, SceneOverrides::default()).unwrap();
        let plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
        let Spectra::Gray(radiant) = &plan.spectra else { panic!("it is gray") };
        let mut canvas = Canvas::new(plan.camera.resolution(), 5);
        for _ in 0..3 {
            let draw = Draw { plan: &plan, radiant, seed: 5, advance: &|_| () };
            AddPass { draw, canvas: &mut canvas, samples: 1 }.add(&EmptySpace, &Numbers).unwrap();
        }
        let batches = [0, 1, 2].map(|pass| Seeded::for_batch(5, pass).next_uniform());
        for (mean, batch) in canvas.pass_means.iter().zip(batches) {
            assert!((mean - batch).abs() < 1e-4, "{mean} of batch {batch}");
        }
        let drawn = canvas.drawn(true);
        assert_eq!((drawn.samples, drawn.cost.lookups), (3, 21));
        assert_eq!(drawn.cost.truncated, 3 * 2 * canvas.tiles.len() as u64);
        // What the pixels tell by themselves is far less: they share the batches.
        let MeanVariance::OfPasses(Some(variance)) = drawn.mean_variance else { panic!("three passes") };
        let mean = batches.iter().sum::<f64>() / 3.0;
        let expected = batches.iter().map(|batch| (batch - mean).powi(2)).sum::<f64>() / 6.0;
        assert!((variance / expected - 1.0).abs() < 1e-2, "{variance}, expected {expected}");
    }
}
