//! Ratio tracking that learns its majorant from estimate to estimate.

use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::Positive;
use crate::{Failure, kind};
use fairflight_media::{Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{ClosedForm, ProgressiveMajorant, Theory, TransmittanceEstimator};
use std::sync::{Mutex, PoisonError};

kind! {
    /// Ratio tracking that learns its majorant (misso-2023): biased, consistent.
    ProgressiveMajorantSpec = "progressive_majorant" {
        /// The first guess of the majorant \[1/length\].
        start: f64 as Positive,
    }
}

/// The learner, behind a lock: estimates are drawn one after another.
#[derive(Debug)]
struct Learning(Mutex<ProgressiveMajorant>);

impl<F: Extinction> TransmittanceEstimator<F> for Learning {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).estimate(field, source)
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Extinction> ClosedForm<F> for Learning {
    /// Biased as long as it learns; how much depends on what it has learned.
    fn theory(&self, _nodes: &mut RayQuadrature<F>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory::mean_only(f64::NAN)
    }
}

impl EstimatorKind for ProgressiveMajorantSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let learner =
            ProgressiveMajorant::new(self.start).map_err(|error| refuse("estimator.start", error))?;
        let trial = profile.erased_trial(Learning(Mutex::new(learner)));
        let variance = "variance: no closed form (biased as long as it learns)";
        let prepared = Prepared::new("progressive_majorant", trial, variance);
        Ok(Prepared { is_sequential: true, ..prepared.within(profile.field().knowledge().of_clamped_walk()) })
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        Err(refuse(&format!("{key}.kind"), "progressive_majorant learns along one ray, but a scene has many"))
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        Some(("kind", "progressive_majorant learns along one ray, but a scene has many".to_owned()))
    }

    fn work(&self, ray: RayKnown) -> Work {
        let greatest = self.start.max(ray.upper_bound.unwrap_or(0.0));
        Work::of("estimator.start", Expected::Between(0.0, ray.depth(greatest)))
    }

    fn is_biased_baseline(&self) -> bool {
        true
    }
}
