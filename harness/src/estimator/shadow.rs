//! Transmittance of rays, shadow rays and connections of a scene, by an estimator of any kind or in closed form.

use super::erased::Erased;
use super::ray::RayKind;
use super::{
    ControlSpec, DoubleParticleSpec, EstimatorKind, InScene, Preparation, RayEstimator, RayWorker, Unlawful,
};
use crate::Failure;
use crate::field::AnyMedium;
use fairflight_media::{LineThickness, Ray};
use fairflight_paths::RayTransmittance;
use fairflight_sources::UniformSource;
use fairflight_transmittance::Regular;
use std::cell::Cell;

/// The part of an estimator that is the same for all rays.
#[derive(Debug)]
pub enum Shadow {
    /// Transmittance in closed form, where the medium has one.
    Regular,
    /// Transmittance by an estimator.
    Sampled(RayEstimator),
}

impl Shadow {
    pub(super) fn of(kind: RayKind) -> Self {
        Self::Sampled(RayEstimator::new(kind))
    }

    /// An estimator that is compiled once, for a field behind a pointer.
    pub(super) fn erased(estimator: impl Erased + 'static) -> Self {
        Self::of(RayKind::Erased(Box::new(estimator)))
    }

    /// The same shadow rays with the look-ups that their preparation cost.
    pub(super) fn after(self, preparation: Preparation) -> Self {
        match self {
            Self::Regular => self,
            Self::Sampled(estimator) => Self::Sampled(estimator.after(preparation)),
        }
    }

    /// The look-ups that were made to prepare it for the scene.
    #[must_use]
    pub fn preparation(&self) -> Option<&Preparation> {
        match self {
            Self::Regular => None,
            Self::Sampled(estimator) => estimator.preparation(),
        }
    }

    /// The one of a spec that names none: in closed form where that costs no look-up, else ratio tracking at the greatest
    /// extinction that the medium declares.
    ///
    /// # Errors
    /// If the medium declares none.
    pub fn default_for(scene: &InScene<'_>, key: &str) -> Result<Self, Failure> {
        if matches!(scene.medium, AnyMedium::Empty | AnyMedium::Homogeneous(_)) {
            return Ok(Self::Regular);
        }
        let greatest = scene.medium.greatest_extinction(key)?;
        DoubleParticleSpec::at(greatest, ControlSpec::none()).for_all_rays(scene, key)
    }

    /// True for the closed form.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        matches!(self, Self::Regular)
    }

    /// One worker's estimator; the first look-up that it is not defined for is left in `unlawful`.
    #[must_use]
    pub fn worker<'s>(&'s self, unlawful: &'s Cell<Option<Unlawful>>) -> ShadowWorker<'s> {
        match self {
            Self::Regular => ShadowWorker::Regular(Regular),
            Self::Sampled(estimator) => ShadowWorker::Sampled(estimator.worker(unlawful)),
        }
    }
}

/// Transmittance of any kind: one branch per ray.
#[derive(Debug)]
pub enum ShadowWorker<'a> {
    /// Transmittance in closed form.
    Regular(Regular),
    /// Transmittance by an estimator.
    Sampled(RayWorker<'a>),
}

impl<M: LineThickness> RayTransmittance<M> for ShadowWorker<'_> {
    #[inline]
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64 {
        match self {
            Self::Regular(regular) => RayTransmittance::estimate(regular, ray, source),
            Self::Sampled(worker) => worker.estimate(ray, source),
        }
    }
    #[inline]
    fn everywhere(&self, medium: &M) -> Option<f64> {
        match self {
            Self::Regular(_) => medium.everywhere(),
            Self::Sampled(_) => None,
        }
    }
}
