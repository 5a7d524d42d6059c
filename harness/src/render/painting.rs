//! The image of a plan, in as many channels as it has, pass by pass.

use super::canvas::{Canvas, Drawn};
use super::draw::Draw;
use super::statistics::Moments;
use crate::Failure;
use crate::plan::{Radiant, ScenePlan, Spectra};
use fairflight_scene::Spectrum;
use fairflight_sources::derive_seed;
use glam::DVec3;

/// An image that is being drawn on the threads of the current pool.
#[derive(Debug)]
pub struct Painting<'p> {
    plan: &'p ScenePlan,
    canvases: Canvases<'p>,
    samples: u32,
}

#[derive(Debug)]
enum Canvases<'p> {
    Gray(&'p Radiant<f64>, Canvas<f64>),
    Colour(&'p Radiant<DVec3>, Canvas<DVec3>),
    Separate(Box<[(&'p Radiant<f64>, Canvas<f64>); 3]>),
}

impl<'p> Painting<'p> {
    /// No sample yet.
    pub fn new(plan: &'p ScenePlan) -> Self {
        let (resolution, seed) = (plan.camera.resolution(), plan.seed);
        let groups = || plan.integrator.groups();
        let canvases = match &plan.spectra {
            Spectra::Gray(radiant) => Canvases::Gray(radiant, Canvas::new(resolution, seed, groups())),
            Spectra::Colour(radiant) => Canvases::Colour(radiant, Canvas::new(resolution, seed, groups())),
            Spectra::Separate(channels) => Canvases::Separate(Box::new([0, 1, 2].map(|k| {
                // Streams of their own, so that the noise of the channels is independent.
                (&channels[k], Canvas::new(resolution, derive_seed(seed, k as u64), groups()))
            }))),
        };
        Self { plan, canvases, samples: 0 }
    }

    /// True if all samples of the plan are drawn.
    pub fn is_complete(&self) -> bool {
        self.samples >= self.plan.samples_per_pixel
    }

    /// Adds a pass of one sample per pixel, or of one point set. `advance` is told how many samples were added.
    ///
    /// # Errors
    /// If a look-up is not lawful, or a sample not finite. The painting is then of no use.
    pub fn add_pass(&mut self, advance: &(dyn Fn(u64) + Sync)) -> Result<(), Failure> {
        self.add(self.plan.pass_samples(), (advance, &|| false))
    }

    /// Adds all samples that are missing: in one pass, unless the integrator has a batch for each, or pixels have point sets.
    ///
    /// # Errors
    /// The errors of [`add_pass`](Self::add_pass).
    pub fn complete(&mut self, advance: &(dyn Fn(u64) + Sync)) -> Result<(), Failure> {
        let by_pass = self.plan.integrator.draws_in_batches() || self.plan.points.is_some();
        while !self.is_complete() {
            let samples =
                if by_pass { self.plan.pass_samples() } else { self.plan.samples_per_pixel - self.samples };
            self.add(samples, (advance, &|| false))?;
        }
        Ok(())
    }

    /// Adds the replicas of an image that is made of them: all, or those that have begun before `ends` says that no other is to begin.
    ///
    /// # Errors
    /// The errors of [`add_pass`](Self::add_pass).
    pub fn add_replicas(
        &mut self,
        advance: &(dyn Fn(u64) + Sync),
        ends: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Failure> {
        self.add(self.plan.samples_per_pixel, (advance, ends))
    }

    fn add(&mut self, samples: u32, watch: Watch<'_>) -> Result<(), Failure> {
        let plan = self.plan;
        debug_assert!(
            samples == plan.samples_per_pixel || plan.integrator.replicas().is_none(),
            "replicas are of the whole image"
        );
        match &mut self.canvases {
            Canvases::Gray(radiant, canvas) => add(plan, radiant, canvas, samples, watch),
            Canvases::Colour(radiant, canvas) => add(plan, radiant, canvas, samples, watch),
            Canvases::Separate(channels) => channels.iter_mut().zip(["red", "green", "blue"]).try_fold(
                0,
                |_, ((radiant, canvas), name)| {
                    add(plan, radiant, canvas, samples, watch).map_err(|failure| failure.within(name))
                },
            ),
        }
        .map(|samples| self.samples = samples)
    }

    /// Statistics of the samples so far.
    pub fn moments(&self) -> Moments {
        let batches = self.plan.integrator.draws_in_batches();
        match &self.canvases {
            Canvases::Gray(_, canvas) => canvas.drawn(batches).into(),
            Canvases::Colour(_, canvas) => canvas.drawn(batches).into(),
            Canvases::Separate(channels) => {
                Drawn::of_channels([0, 1, 2].map(|k| channels[k].1.drawn(batches))).into()
            }
        }
    }
}

/// What is told how many samples were added, and what says that no other replica is to begin.
type Watch<'a> = (&'a (dyn Fn(u64) + Sync), &'a (dyn Fn() -> bool + Sync));

/// Adds a pass; gives the samples per pixel so far.
fn add<C: Spectrum>(
    plan: &ScenePlan,
    radiant: &Radiant<C>,
    canvas: &mut Canvas<C>,
    samples: u32,
    (advance, ends): Watch<'_>,
) -> Result<u32, Failure> {
    Draw { plan, radiant, seed: canvas.seed, advance, ends }.add_pass(canvas, samples)?;
    Ok(canvas.samples)
}

/// Draws the image of a plan on the threads of the current pool. `advance` is told how many samples were added.
///
/// # Errors
/// If a look-up is not lawful, or a sample not finite.
pub fn moments(plan: &ScenePlan, advance: &(dyn Fn(u64) + Sync)) -> Result<Moments, Failure> {
    let mut painting = Painting::new(plan);
    painting.complete(advance)?;
    Ok(painting.moments())
}
