//! The single-term estimator.

use super::p_series::countable;
use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Number, Positive};
use crate::{Failure, kind};
use fairflight_transmittance::GeneralisedPoisson;

kind! {
    /// One term of the power series, of Poisson order (fearnhead-2008).
    GeneralisedPoissonSpec = "generalised_poisson" {
        /// The optical thickness about which the series is.
        pivot: f64 as Number,
        /// The mean order.
        rate: f64 as Positive,
    }
}

impl GeneralisedPoissonSpec {
    fn estimator(&self, key: &str) -> Result<GeneralisedPoisson, Failure> {
        let rate = countable(self.rate, &format!("{key}.rate"))?;
        GeneralisedPoisson::new(self.pivot, rate).map_err(|error| refuse(key, error))
    }
}

impl EstimatorKind for GeneralisedPoissonSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.erased_trial(self.estimator("estimator")?);
        Ok(Prepared::new("generalised_poisson", trial, "variance: closed form, integrated over the ray"))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(Shadow::erased)
    }

    fn work(&self, _ray: RayKnown) -> Work {
        Work::of("estimator.rate", Expected::Exactly(self.rate))
    }
}
