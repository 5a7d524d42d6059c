//! Two combs: a biased baseline.

use super::{EstimatorKind, Expected, InScene, MOST, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::Whole;
use crate::{Failure, kind};
use fairflight_transmittance::{Comb, CombShape, Jackknife};

kind! {
    /// Two combs (peters-2025): biased.
    JackknifeSpec = "jackknife" {
        /// Look-ups per comb.
        teeth: u32 as Whole<1, MOST>,
    }
}

impl JackknifeSpec {
    fn estimator(&self, key: &str) -> Result<Jackknife, Failure> {
        let comb = Comb::new(self.teeth, CombShape::Uniform);
        comb.map(Jackknife::new).map_err(|error| refuse(&format!("{key}.teeth"), error))
    }
}

impl EstimatorKind for JackknifeSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.erased_trial_in_lanes(self.estimator("estimator")?);
        Ok(Prepared::new("jackknife", trial, "variance: quadrature over both offsets (a biased baseline)"))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(Shadow::erased)
    }

    fn work(&self, _ray: RayKnown) -> Work {
        Work::of("estimator.teeth", Expected::Exactly(2.0 * f64::from(self.teeth)))
    }

    fn is_biased_baseline(&self) -> bool {
        true
    }
}
