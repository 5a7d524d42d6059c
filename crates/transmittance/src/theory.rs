//! The law of an estimator in closed form, before a sample is drawn.

use crate::HIGHEST_MOMENT;
use fairflight_media::{Breakpoints, Extinction, OpticalThickness, RayQuadrature, Tolerance};
use std::fmt;

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
    /// The lowest moment that has a closed form and would have taken too many look-ups.
    pub unreached: Option<Unreached>,
}

/// A moment in closed form whose quadratures take more look-ups than they may spend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unreached {
    /// Its order: 1 for the mean, 2 for the variance.
    pub moment: u32,
    /// Look-ups that were made before it was given up; an integrand at a node whose look-ups are kept counts as one.
    pub lookups: f64,
}

impl fmt::Display for Unreached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moment = match self.moment {
            1 => "mean",
            2 => "variance",
            _ => "third moment",
        };
        write!(f, "the {moment} in closed form was not reached with {:.1e} look-ups", self.lookups)
    }
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
            unreached: None,
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
            unreached: None,
        }
    }

    /// An estimate of which nothing is known from a moment on; the mean of one that is not unbiased is NaN.
    pub(crate) fn without(unreached: Unreached, lookups: f64) -> Self {
        let relative_mean = if unreached.moment == 1 { f64::NAN } else { 1.0 };
        Self { relative_mean, unreached: Some(unreached), ..Self::mean_only(lookups) }
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
