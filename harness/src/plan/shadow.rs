//! Transmittance of shadow rays and connections, by an estimator of any kind or in closed form.

use super::{AnyMedium, RayEstimator, RayWorker, Unlawful};
use crate::Failure;
use crate::spec::{ControlSpec, EstimatorSpec, RayEstimatorSpec, SamplingSpec};
use fairflight_media::{LineThickness, Ray};
use fairflight_paths::RayTransmittance;
use fairflight_sources::UniformSource;
use fairflight_transmittance::Regular;
use std::cell::Cell;

/// What is the same for all rays.
#[derive(Debug)]
pub(super) enum Shadow {
    /// In closed form, where the medium has one.
    Regular,
    /// By an estimator.
    Sampled(RayEstimator),
}

impl Shadow {
    /// The estimator of a spec whose key is `key`.
    ///
    /// # Errors
    /// If a parameter is not lawful, or is given along one ray.
    pub(super) fn build(spec: &RayEstimatorSpec, key: &str) -> Result<Self, Failure> {
        match spec {
            RayEstimatorSpec::Regular => Ok(Self::Regular),
            RayEstimatorSpec::Sampled(estimator) => RayEstimator::build(estimator, key).map(Self::Sampled),
        }
    }

    /// The one of a spec that names none: in closed form where that costs no look-up, else ratio tracking at the greatest
    /// extinction that the medium declares.
    ///
    /// # Errors
    /// If the medium declares none.
    pub(super) fn default_for(medium: &AnyMedium, key: &str) -> Result<Self, Failure> {
        if matches!(medium, AnyMedium::Empty | AnyMedium::Homogeneous(_)) {
            return Ok(Self::Regular);
        }
        let sampling = SamplingSpec::Constant(medium.greatest_extinction(key)?);
        let ratio_tracking = EstimatorSpec::DoubleParticle { sampling, control: ControlSpec::None };
        RayEstimator::build(&ratio_tracking, key).map(Self::Sampled)
    }

    /// One worker's estimator where look-ups are all there is; `None` for the closed form.
    pub(super) fn by_look_ups<'s>(&'s self, unlawful: &'s Cell<Option<Unlawful>>) -> Option<RayWorker<'s>> {
        match self {
            Self::Regular => None,
            Self::Sampled(estimator) => Some(estimator.worker(unlawful)),
        }
    }

    /// One worker's estimator where a closed form exists.
    pub(super) fn by_closed_form<'s>(&'s self, unlawful: &'s Cell<Option<Unlawful>>) -> ShadowWorker<'s> {
        match self {
            Self::Regular => ShadowWorker::Regular(Regular),
            Self::Sampled(estimator) => ShadowWorker::Sampled(estimator.worker(unlawful)),
        }
    }
}

/// Shadow rays where a closed form exists: one branch per ray.
#[derive(Debug)]
pub(super) enum ShadowWorker<'a> {
    Regular(Regular),
    Sampled(RayWorker<'a>),
}

impl<M: LineThickness> RayTransmittance<M> for ShadowWorker<'_> {
    #[inline]
    fn estimate<S: UniformSource + ?Sized>(&mut self, ray: &Ray<&M>, source: &mut S) -> f64 {
        match self {
            Self::Regular(regular) => RayTransmittance::estimate(regular, ray, source),
            Self::Sampled(worker) => worker.estimate(ray, source),
        }
    }
}
