//! The law of an estimator in closed form, before a sample is drawn.

use crate::HIGHEST_MOMENT;
use fairflight_media::{Breakpoints, Extinction, OpticalThickness, RayQuadrature, Tolerance};

/// The law of one estimate on one profile, in units of the transmittance T, so that nothing underflows with T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// E\[estimate\] / T: 1, except for a biased baseline.
    pub relative_mean: f64,
    /// E\[(estimate − E)^k\] / T^k for k = 2 … 8 (index k − 2); NaN where no closed form is known, infinite where the
    /// moment is.
    pub relative_central: [f64; HIGHEST_MOMENT - 1],
    /// ln(Var / T^2): finite where the variance itself overflows; −∞ for zero variance.
    pub log_relative_variance: f64,
    /// The absolute error of the variance's integral, relative to the variance.
    pub relative_variance_error: f64,
    /// An upper bound of Var / T^2 where the variance has no closed form; infinite where none is known.
    pub relative_variance_bound: f64,
    /// The expected number of look-ups of one estimate.
    pub lookups: f64,
}

impl Theory {
    /// The transmittance itself, without variance or look-ups.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            relative_mean: 1.0,
            relative_central: [0.0; HIGHEST_MOMENT - 1],
            log_relative_variance: f64::NEG_INFINITY,
            relative_variance_error: 0.0,
            relative_variance_bound: f64::INFINITY,
            lookups: 0.0,
        }
    }

    /// An unbiased estimate of which no moment beyond the mean has a closed form; `lookups` is NaN where their number has none
    /// either.
    #[must_use]
    pub fn mean_only(lookups: f64) -> Self {
        Self {
            relative_mean: 1.0,
            relative_central: [f64::NAN; HIGHEST_MOMENT - 1],
            log_relative_variance: f64::NAN,
            relative_variance_error: f64::NAN,
            relative_variance_bound: f64::INFINITY,
            lookups,
        }
    }
}

/// An estimator whose law is known in closed form, up to quadrature over the ray.
pub trait ClosedForm<F: Extinction> {
    /// Moments and expected look-ups on the profile of `quadrature`, whose transmittance is exp(−`tau`).
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory;
}

impl<F: Extinction, E: ClosedForm<F>> ClosedForm<F> for &E {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        (**self).theory(quadrature, tau, tolerance)
    }
}

/// The theory of `estimator` on a field with an optical thickness in closed form, as exactly as quadrature can be; `also` are the breakpoints
/// of what the estimator knows itself.
pub fn theory_on<F: OpticalThickness + Breakpoints, E: ClosedForm<F>>(
    field: F,
    estimator: &E,
    also: &[f64],
) -> Theory {
    let tau = field.optical_thickness(0.0, field.length());
    estimator.theory(&mut RayQuadrature::new(field, also), tau, Tolerance::TIGHT)
}
