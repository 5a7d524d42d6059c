//! Ratio tracking that adapts its sampling extinction.

use super::erased::ByMajorant;
use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{NonNegative, Positive};
use crate::{Failure, kind};
use fairflight_transmittance::AdaptiveRatio;

kind! {
    /// Ratio tracking that takes longer steps as its weight falls (misso-2023).
    AdaptiveRatioSpec = "adaptive_ratio" {
        /// An upper bound of σ_t \[1/length\].
        majorant: f64 as NonNegative,
        /// The least sampling extinction over the majorant.
        floor: f64 as Positive,
    }
}

impl AdaptiveRatioSpec {
    fn estimator(&self, key: &str) -> Result<ByMajorant<AdaptiveRatio>, Failure> {
        let at = |what: &str| format!("{key}.{what}");
        // The claim first, as it stands first.
        let claim = ByMajorant::new((), self.majorant).map_err(|error| refuse(&at("majorant"), error))?;
        let estimator = AdaptiveRatio::new(self.floor).map_err(|error| refuse(&at("floor"), error))?;
        Ok(claim.with(estimator))
    }
}

impl EstimatorKind for AdaptiveRatioSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.erased_trial(self.estimator("estimator")?);
        let range = profile.field().knowledge().of_null_collisions(self.majorant);
        Ok(Prepared::new("adaptive_ratio", trial, "variance: by an integral equation along the ray")
            .claiming(self.majorant)
            .within(range))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(Shadow::erased)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("estimator.majorant", Expected::Between(0.0, ray.depth(self.majorant)))
    }
}
