//! The background seen through the medium; no scattering.

use super::{IntegratorKind, SamplerSpec};
use crate::estimator::{EstimatorSpec, ForAllRays};
use crate::kind;
use crate::reader::kind::Among;

kind! {
    /// The background seen through the medium; no scattering.
    TransmittanceSpec = "transmittance" {
        /// The estimator of the transmittance.
        estimator: EstimatorSpec as ForAllRays,
        /// Variates of the samples of a pixel.
        points: SamplerSpec as Among,
    }
    check |spec, object| spec.points.check(object)
}

impl IntegratorKind for TransmittanceSpec {
    fn sampler(&self) -> Option<&SamplerSpec> {
        Some(&self.points)
    }
    fn bias(&self) -> Option<&'static str> {
        super::of_a_baseline(self.estimator.is_biased_baseline())
    }
}
