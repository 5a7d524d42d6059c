//! Regular tracking: the closed form itself.

use crate::{ClosedForm, Theory, TransmittanceEstimator};
use fairflight_elementary::exp;
use fairflight_media::{OpticalThickness, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// exp(−τ) from an optical thickness in closed form: no variance, no look-up, no variate.
///
/// **Law.** Exact. What it costs is what the closed form costs: a few sines for szirmay-kalos-2017 eq. 21, two evaluations
/// per cell for trilinear voxels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Regular;

impl<F: OpticalThickness> TransmittanceEstimator<F> for Regular {
    #[inline]
    fn estimate(&self, field: &F, _source: &mut impl UniformSource) -> f64 {
        exp(-field.optical_thickness(0.0, field.length()))
    }

    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t.is_finite()
    }
}

impl<F: OpticalThickness> ClosedForm<F> for Regular {
    fn theory(&self, _quadrature: &mut RayQuadrature<F>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory::exact()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::Constant;
    use fairflight_sources::Scripted;

    #[test]
    fn it_draws_nothing_and_is_exact() {
        let field = Constant::new(0.5, 4.0).unwrap();
        assert_eq!(Regular.estimate(&field, &mut Scripted::new([])), (-2.0_f64).exp());
    }
}
