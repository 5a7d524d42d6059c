//! The background seen through the medium; no scattering.

use super::IntegratorKind;
use crate::estimator::{EstimatorSpec, ForAllRays};
use crate::kind;

kind! {
    /// The background seen through the medium; no scattering.
    TransmittanceSpec = "transmittance" {
        /// The estimator of the transmittance.
        estimator: EstimatorSpec as ForAllRays,
    }
}

impl IntegratorKind for TransmittanceSpec {
    fn bias(&self) -> Option<&'static str> {
        super::of_a_baseline(self.estimator.is_biased_baseline())
    }
}
