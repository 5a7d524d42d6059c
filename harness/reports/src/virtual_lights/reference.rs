//! The path-traced image that all others are judged by.

use super::scenes::path_tracer;
use crate::measured::Measured;
use crate::replicas::{Replicas, Subject};
use crate::run::Run;
use fairflight_harness::Failure;

/// Independent images of the reference: their scatter is its error.
const REPLICAS: u32 = 4;

/// Paths per pixel of the room with smoke.
pub(super) const ROOM_PATHS: u32 = 4096;

/// A path-traced image with its error.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) pixels: Vec<f64>,
    /// Of a pixel, on average.
    pub(super) squared_error: f64,
    /// Of the image, and its standard error.
    pub(super) mean: (f64, f64),
    pub(super) shown: Replicas,
}

impl Reference {
    /// Renders `subject` with so many paths per pixel in all.
    pub(super) fn of(run: &Run<'_>, subject: &Subject, paths: u32, seed: u64) -> Result<Self, Failure> {
        let subject = subject.with("integrator", path_tracer());
        let shown = subject.measure(run.samples(paths / REPLICAS), (seed, REPLICAS), &run.media)?;
        run.advance();
        let (pixels, squared_error) = shown.mean();
        let n = pixels.len() as f64;
        let mean = pixels.iter().sum::<f64>() / n;
        Ok(Self { mean: (mean, (squared_error / n).sqrt()), pixels, squared_error, shown })
    }

    /// The root of the mean squared error of images against this one, whose own error is taken off.
    pub(super) fn rmse(&self, images: &Replicas) -> Measured {
        images.squared_difference(&self.pixels, self.squared_error).map(f64::sqrt)
    }

    /// The mean radiance of independent images less that of this one, in standard errors of both; images of one set of lights share
    /// their error, so that only their means tell it.
    pub(super) fn z_of(&self, images: &Replicas) -> f64 {
        let (mean, error) = images.mean_of_images();
        (mean - self.mean.0) / error.hypot(self.mean.1)
    }
}
