//! Points in the place of independent variates.

use super::ScenePlan;
use crate::Failure;
use crate::spec::{Sampler, SceneSpec};
use fairflight_scene::Spectrum;
use fairflight_sources::{Halton, PointSet, Sobol, UniformSource};

/// Point sets of each pixel, of as many points each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelPoints {
    is_sobol: bool,
    /// Points of a set.
    pub each: u32,
}

/// Coordinates that a set orders: the place in the pixel, and what few and smooth variates a ray draws. Those beyond are independent.
const DIMENSIONS: usize = 16;

impl PixelPoints {
    /// The point sets of a scene, if it asks for some.
    ///
    /// # Errors
    /// If they cannot share the samples evenly.
    pub(super) fn of(spec: &SceneSpec) -> Result<Option<Self>, Failure> {
        let Some(asked) = spec.integrator.kind().sampler() else { return Ok(None) };
        let (Some(sets), samples) = (asked.point_sets(), spec.samples_per_pixel) else { return Ok(None) };
        if samples % sets != 0 {
            return Err(Failure::refused(format!(
                "integrator.replicas: {sets} point sets share the samples of a pixel evenly, found samples_per_pixel {samples}"
            )));
        }
        Ok(Some(Self { is_sobol: asked.sampler == Sampler::Sobol, each: samples / sets }))
    }

    /// The mean of `estimate` over the points of the set with this seed, told the number of each.
    ///
    /// # Errors
    /// The first of the estimates.
    pub fn mean<C: Spectrum>(
        &self,
        seed: u64,
        estimate: impl FnMut(u32, &mut dyn UniformSource) -> Result<C, Failure>,
    ) -> Result<C, Failure> {
        const FEW: &str = "these are few coordinates";
        if self.is_sobol {
            self.mean_over(&Sobol::new(DIMENSIONS, seed).expect(FEW), estimate)
        } else {
            self.mean_over(&Halton::new(DIMENSIONS, seed).expect(FEW), estimate)
        }
    }

    fn mean_over<C: Spectrum>(
        self,
        set: &impl PointSet,
        mut estimate: impl FnMut(u32, &mut dyn UniformSource) -> Result<C, Failure>,
    ) -> Result<C, Failure> {
        let mut sum = C::ZERO;
        for index in 0..self.each {
            sum += estimate(index, &mut set.source(index.into()))?;
        }
        Ok(sum * f64::from(self.each).recip())
    }
}

impl ScenePlan {
    /// Samples per pixel of a pass: those of a point set, or one.
    #[must_use]
    pub fn pass_samples(&self) -> u32 {
        self.points.map_or(1, |points| points.each)
    }
}
