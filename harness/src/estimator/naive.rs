//! The exponential of one comb: a biased baseline.

use super::{EstimatorKind, Expected, InScene, MOST, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::Whole;
use crate::{Failure, kind};
use fairflight_transmittance::{Offset, RayMarching};

kind! {
    /// The exponential of one comb: biased.
    NaiveSpec = "naive" {
        /// Look-ups.
        teeth: u32 as Whole<1, MOST>,
    }
}

impl NaiveSpec {
    fn estimator(&self, key: &str) -> Result<RayMarching, Failure> {
        RayMarching::new(self.teeth, Offset::Jittered).map_err(|error| refuse(&format!("{key}.teeth"), error))
    }
}

impl EstimatorKind for NaiveSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.erased_trial_in_lanes(self.estimator("estimator")?);
        Ok(Prepared::new("naive", trial, "variance: quadrature over the offset (a biased baseline)"))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(Shadow::erased)
    }

    fn work(&self, _ray: RayKnown) -> Work {
        Work::of("estimator.teeth", Expected::Exactly(f64::from(self.teeth)))
    }

    fn is_biased_baseline(&self) -> bool {
        true
    }
}
