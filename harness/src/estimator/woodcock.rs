//! Track length: a coin.

use super::erased::ByMajorant;
use super::range::below_zero;
use super::ray::RayKind;
use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::NonNegative;
use crate::{Failure, kind};
use fairflight_laws::scores;
use fairflight_transmittance::Woodcock;

kind! {
    /// Track length: 1 if a flight escapes, else 0 (raab-2008 algorithm 1).
    WoodcockSpec = "woodcock" {
        /// An upper bound of σ_t \[1/length\].
        majorant: f64 as NonNegative,
    }
}

impl WoodcockSpec {
    fn estimator(&self, key: &str) -> Result<ByMajorant<Woodcock>, Failure> {
        ByMajorant::new(Woodcock, self.majorant).map_err(|error| refuse(&format!("{key}.majorant"), error))
    }
}

impl EstimatorKind for WoodcockSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.trial_in_lanes(self.estimator("estimator")?);
        Ok(Prepared::new("woodcock", trial, "variance: closed form T(1 - T)")
            .scoring(scores::woodcock)
            .objecting(below_zero)
            .claiming(self.majorant))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(RayKind::Woodcock).map(Shadow::of)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("estimator.majorant", Expected::Between(0.0, ray.depth(self.majorant)))
    }
}
