//! A pass over an image in parallel, the same one whatever the number of threads.

use super::batch::Batch;
use super::canvas::{Canvas, Spent};
use super::light_image::LightImage;
use super::tile::{Added, Tile};
use crate::field::{AnyMedium, OnlyLookUps};
use crate::plan::{
    Counts, IntegratorPlan, Radiant, ScenePlan, SceneVolume, Seen, Splatted, Stage, TileIntegrator,
};
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::{EmptySpace, LineThickness, Medium, Observed};
use fairflight_paths::transport::{Emitters, World};
use fairflight_scene::{Spectrum, Surfaces, Volume};
use rayon::prelude::*;
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Parts of a scene that are drawn: shared by all workers.
#[derive(Clone, Copy)]
pub(super) struct Draw<'a, C> {
    pub plan: &'a ScenePlan,
    pub radiant: &'a Radiant<C>,
    pub seed: u64,
    /// Callback that is told how many samples were added.
    pub advance: &'a (dyn Fn(u64) + Sync),
    /// True once no further replica is to begin.
    pub ends: &'a (dyn Fn() -> bool + Sync),
}

/// Work with the integrator of one tile.
pub(super) type Work<'a, C> = dyn FnMut(&mut dyn TileIntegrator<C>) -> Result<Added<C>, Failure> + 'a;

/// A scene compiled for its medium.
///
/// An integrator whose pixels share what is prepared for a pass (virtual point lights, say), or light each other, says so in
/// [`IntegratorPlan::draws_in_batches`](crate::plan::IntegratorPlan::draws_in_batches): its passes then are of one sample per pixel, and
/// the variance of the image's mean comes from the means of the passes.
pub(super) trait Scene<C>: Sync {
    /// Prepares what all tiles of pass number `pass`, from 0, share, on the threads of the current pool: all its variates are those of the
    /// seed and `pass`.
    ///
    /// # Errors
    /// If a look-up is not lawful.
    fn prepare(&self, pass: usize) -> Result<(Batch<C>, Spent), Failure>;

    /// Does the work of one tile with the integrator of the scene; what it met is judged afterwards. Gives what came of it, and the cost.
    ///
    /// # Errors
    /// If the integrator does not fit the scene, a look-up is not lawful, or the work fails.
    fn integrate(&self, batch: &Batch<C>, work: &mut Work<'_, C>) -> TileResult<C>;
}

/// A scene whose medium has the type M.
struct In<'a, M, C> {
    draw: Draw<'a, C>,
    medium: M,
    emitters: Emitters<C>,
}

impl<M: LineThickness + Copy + Sync, C: Spectrum> Scene<C> for In<'_, M, C> {
    fn prepare(&self, pass: usize) -> Result<(Batch<C>, Spent), Failure> {
        let Self { draw, medium, emitters } = self;
        let integrator = &draw.plan.integrator;
        let count = integrator.replicas().map_or(0, |count| count.min(draw.plan.samples_per_pixel));
        match integrator {
            IntegratorPlan::Vpl(plan) => draw.virtual_lights(*medium, plan, (emitters, pass)),
            // In empty space nothing is scattered towards the camera.
            IntegratorPlan::PhotonTracer(walk) if !M::IS_EMPTY => draw.photons(*medium, walk, count),
            IntegratorPlan::Metropolis(plan) => draw.chains(*medium, plan, (emitters, count)),
            _ => integrator.photons().map_or(Ok((Batch::none(), Spent::default())), |how| {
                draw.map(*medium, how, (emitters, pass))
            }),
        }
    }

    fn integrate(&self, batch: &Batch<C>, work: &mut Work<'_, C>) -> TileResult<C> {
        let Self { draw, medium, emitters } = self;
        let clock = ThreadTime::now();
        let volume = draw.volume(*medium);
        let unlawful = Cell::new(None);
        let Radiant { lights, surfaces, .. } = draw.radiant;
        let (camera, Batch { vpls, map, bound, mean, .. }) = (&draw.plan.camera, batch);
        let (mean, bound, unlawful_at) = (*mean, *bound, &unlawful);
        let stage =
            Stage { lights, surfaces, camera, emitters, mean, map, vpls, bound, unlawful: unlawful_at };
        let integrator = draw.plan.integrator.on(&volume, stage);
        let added = integrator.and_then(|mut integrator| work(&mut *integrator));
        // Before the samples: a look-up that is not finite explains a sample that is not.
        draw.judge(&volume.medium)?;
        if let Some(unlawful) = unlawful.get() {
            return Err(draw.plan.integrator.explain(unlawful));
        }
        let added = added?;
        if added.counts.unlawful > 0 {
            return Err(Failure::refused(format!(
                "integrator.sigma_samp: reuse needs sigma_samp >= sigma_t, but {} flights met more",
                added.counts.unlawful
            )));
        }
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let Counts { truncated, compensation_tried, compensation_inside, .. } = added.counts;
        let Splatted { light_paths, unseen_power, .. } = added.splatted;
        let lookups = volume.medium.lookups();
        let spent = Spent {
            lookups,
            cpu_seconds,
            truncated,
            compensation_tried,
            compensation_inside,
            light_paths,
            unseen_power,
            ..Spent::default()
        };
        Ok((added, spent))
    }
}

/// Draws a tile: what came of it, and the cost.
type DrawTile<'a, C> = dyn Fn(&mut Tile<C>) -> TileResult<C> + Sync + 'a;

/// Sums that a tile adds, and the work that they took.
type TileResult<C> = Result<(Added<C>, Spent), Failure>;

/// The volume of a tile, observed.
pub(super) type ObservedVolume<'a, M, C> = SceneVolume<'a, Observed<M>, C>;

impl<'a, C: Spectrum> Draw<'a, C> {
    /// Adds a pass of `samples` samples per pixel to a canvas.
    ///
    /// Passes continue the streams of the pixels and their moments: one of n samples gives the same bits as n of one sample, for
    /// integrators that carry nothing from ray to ray.
    ///
    /// # Errors
    /// If a look-up is not lawful, or a sample not finite: that of the first tile where it happens. The canvas is then of no use.
    pub(super) fn add_pass(self, canvas: &mut Canvas<C>, samples: u32) -> Result<(), Failure> {
        self.add(&*self.compiled(), canvas, samples)
    }

    /// The scene compiled for its medium.
    fn compiled(self) -> Box<dyn Scene<C> + 'a> {
        match &self.plan.medium {
            AnyMedium::Empty => self.within(EmptySpace),
            AnyMedium::Homogeneous(medium) => self.within(**medium),
            AnyMedium::AnalyticCosine(medium) => self.within(**medium),
            AnyMedium::Perlin(medium) => self.within(OnlyLookUps(&**medium)),
            AnyMedium::Expression(medium) => self.within(OnlyLookUps(&**medium)),
            AnyMedium::Voxels(medium) => self.within(&**medium),
        }
    }

    fn within<M: LineThickness + Copy + Sync + 'a>(self, medium: M) -> Box<dyn Scene<C> + 'a> {
        let Radiant { lights, surfaces, .. } = self.radiant;
        let volume = self.volume(medium);
        let world = World::<Seen<'_, _, _, Surfaces<C>>>::new(&volume, surfaces, lights);
        let emitters = Emitters::new(lights, surfaces, world.enclosing_ball(), self.plan.camera.origin());
        Box::new(In { draw: self, medium, emitters })
    }

    fn add(self, scene: &dyn Scene<C>, canvas: &mut Canvas<C>, samples: u32) -> Result<(), Failure> {
        let integrator = &self.plan.integrator;
        debug_assert!(
            samples == self.plan.pass_samples() || !integrator.draws_in_batches(),
            "a batch is for one sample per pixel, or one point set"
        );
        let number = canvas.pass_means.len();
        if number == 0 {
            // Whether they fit together is known before anything is drawn.
            scene.integrate(&Batch::none(), &mut |_| Ok(Added::none()))?;
            canvas.warning = self.check_growth()?;
        }
        let kept = canvas.batch.take().filter(|_| integrator.keeps_its_batch());
        let (mut batch, spent) = match kept {
            Some(batch) => (batch, Spent::default()),
            None => scene.prepare(number)?,
        };
        batch.mean = canvas.mean;
        canvas.cost = canvas.cost.and(spent);
        // As many pixel by pixel as the replicas have, which may have ended early.
        let samples = batch.replicas.as_ref().map_or(samples, |layer| layer.samples);
        let (range, camera) = ((canvas.samples, samples, canvas.seed), &self.plan.camera);
        let mut light = integrator.splats().then(|| LightImage::new(camera.resolution()));
        let (splats, groups) = (light.is_some(), integrator.groups());
        let draw_tile = |tile: &mut Tile<C>| {
            scene.integrate(&batch, &mut |integrator| match (&self.plan.points, &groups) {
                (Some(points), _) => tile.add_replica(integrator, camera, range, points),
                (_, Some(groups)) => tile.share_samples(integrator, camera, range, groups),
                _ if splats => tile.hold_samples(integrator, camera, range),
                _ => tile.add_samples(integrator, camera, range),
            })
        };
        let mut sum = 0.0;
        for tiles in canvas.tiles.chunks_mut(if splats { LightImage::<C>::TILES } else { usize::MAX }) {
            let added = self.tiles(tiles, samples, &draw_tile)?;
            for (tile, (added, spent)) in tiles.iter_mut().zip(added) {
                let Splatted { splats, tally, .. } = added.splatted;
                sum += added.sum + light.as_mut().map_or(0.0, |light| light.add(&splats));
                tile.tell(&tally);
                canvas.cost = canvas.cost.and(spent);
            }
        }
        if let Some(light) = light {
            canvas.tiles.par_iter_mut().for_each(|tile| tile.complete(&light));
        }
        let [columns, rows] = camera.resolution().map(f64::from);
        canvas.push_pass(sum / (columns * rows * f64::from(samples)), samples);
        canvas.batch = Some(batch);
        Ok(())
    }

    pub(super) fn volume<M: Medium>(&self, medium: M) -> ObservedVolume<'a, M, C> {
        Volume {
            medium: Observed::new(medium),
            bounds: self.plan.bounds,
            albedo: self.radiant.albedo,
            phase: &self.plan.phase,
        }
    }

    /// Checks that the walks of the integrator have a second moment. Its look-ups are not part of the cost: it is a diagnosis.
    fn check_growth(&self) -> Result<Option<String>, Failure> {
        let is_empty = matches!(self.plan.medium, AnyMedium::Empty);
        let Some(walk) = self.plan.integrator.walk().filter(|_| !is_empty) else { return Ok(None) };
        let volume = self.volume(&self.plan.medium);
        let growth = walk.check_growth(&volume, self.seed);
        // Where walks are not defined they do not grow either.
        self.judge(&volume.medium)?;
        growth
    }

    /// Checks that all look-ups so far were lawful.
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

    /// All tiles; what comes of them in their order. One copy for all integrators: a call per tile costs nothing.
    fn tiles(
        &self,
        tiles: &mut [Tile<C>],
        samples: u32,
        tile: &DrawTile<'_, C>,
    ) -> Result<Vec<(Added<C>, Spent)>, Failure> {
        // A tile behind the first failure is not drawn; one before it is, since it might fail too.
        let first_failure = AtomicUsize::new(usize::MAX);
        let done: Vec<Option<TileResult<C>>> = tiles
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
    use fairflight_media::Line;
    use fairflight_sources::{Seeded, UniformSource};

    /// Sees the number of the batch, and one variate of the pixel.
    struct Shows(f64);

    impl TileIntegrator<f64> for Shows {
        fn radiance(&mut self, _line: &Line, source: &mut Seeded) -> f64 {
            self.0 + 1e-3 * (source.next_uniform() - 0.5)
        }
        fn counts(&self) -> Counts {
            Counts { truncated: 2, ..Counts::default() }
        }
    }

    /// A batch is one number, in the place of the bound.
    struct Numbers;

    impl Scene<f64> for Numbers {
        fn prepare(&self, pass: usize) -> Result<(Batch<f64>, Spent), Failure> {
            let number = Seeded::for_batch(5, pass as u64).next_uniform();
            Ok((Batch { bound: number, ..Batch::none() }, Spent { lookups: 7, ..Spent::default() }))
        }

        fn integrate(&self, batch: &Batch<f64>, work: &mut Work<'_, f64>) -> TileResult<f64> {
            let added = work(&mut Shows(batch.bound))?;
            let truncated = added.counts.truncated;
            Ok((added, Spent { truncated, ..Spent::default() }))
        }
    }

    #[test]
    fn a_batch_is_prepared_for_each_pass_and_shared() {
        let scene = include_str!("../../scenes/eq21-environment.json");
        let spec = SceneSpec::parse(scene, SceneOverrides::default()).unwrap();
        let plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
        let Spectra::Gray(radiant) = &plan.spectra else { panic!("it is gray") };
        let mut canvas = Canvas::new(plan.camera.resolution(), 5, None);
        for _ in 0..3 {
            let draw = Draw { plan: &plan, radiant, seed: 5, advance: &|_| (), ends: &|| false };
            draw.add(&Numbers, &mut canvas, 1).unwrap();
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

    /// An integrator that draws one pixel after the other.
    struct Apart<'a>(&'a mut dyn TileIntegrator<f64>);

    impl TileIntegrator<f64> for Apart<'_> {
        fn radiance(&mut self, line: &Line, source: &mut Seeded) -> f64 {
            self.0.radiance(line, source)
        }
        fn counts(&self) -> Counts {
            self.0.counts()
        }
    }

    /// A scene whose pixels are drawn one after the other.
    struct OneByOne<'a>(Box<dyn Scene<f64> + 'a>);

    impl Scene<f64> for OneByOne<'_> {
        fn prepare(&self, pass: usize) -> Result<(Batch<f64>, Spent), Failure> {
            self.0.prepare(pass)
        }
        fn integrate(&self, batch: &Batch<f64>, work: &mut Work<'_, f64>) -> TileResult<f64> {
            self.0.integrate(batch, &mut |integrator| work(&mut Apart(integrator)))
        }
    }

    #[test]
    fn neither_lanes_nor_threads_change_a_bit() {
        let scene = include_str!("../../scenes/eq21-environment.json").replace("128, 128", "40, 30");
        let forward = scene.replace("\"rayleigh\"", "\"henyey_greenstein\", \"g\": 0.7");
        let cut = scene.replace("0.8 }", "0.8, \"max_collisions\": 9 }");
        let point = "{ \"kind\": \"point\", \"position\": [0, 0, 10], \"power\": 600.0 }";
        let lit = scene.replace("1.0 } ]", &format!("1.0 }}, {point} ]"));
        for scene in [scene, forward, cut, lit] {
            let spec = SceneSpec::parse(&scene, SceneOverrides::default()).unwrap();
            let plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
            let Spectra::Gray(radiant) = &plan.spectra else { panic!("it is gray") };
            let told = |threads: usize, one_by_one: bool| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let mut canvas = Canvas::new(plan.camera.resolution(), 5, None);
                let draw = Draw { plan: &plan, radiant, seed: 5, advance: &|_| (), ends: &|| false };
                pool.install(|| {
                    let scene: Box<dyn Scene<f64>> =
                        if one_by_one { Box::new(OneByOne(draw.compiled())) } else { draw.compiled() };
                    for samples in [3, 1] {
                        draw.add(&*scene, &mut canvas, samples).unwrap();
                    }
                });
                let drawn = canvas.drawn(false);
                (drawn.pixels, canvas.pass_means, drawn.cost.lookups, drawn.cost.truncated)
            };
            let expected = told(1, true);
            assert!(told(1, false) == expected && told(2, false) == expected, "{scene}");
        }
    }
}
