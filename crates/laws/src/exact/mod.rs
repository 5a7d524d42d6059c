//! Laws without chance: what a decision, a density or a closed form must be, to rounding.
//!
//! A sample sees a bias down to its standard error; these see any that is larger than a rounding, on every seed, and cost next to
//! nothing. Each takes one part of an estimate by itself.
//!
//! * [`decisions`]: the expectation over the variate of a decision, found from where the decision changes.
//! * [`densities`]: the density of a direction or point that is drawn is the reciprocal of the Jacobian of the map that draws it.
//! * [`thickness`]: a closed-form optical thickness is the integral of its look-ups, and an inverted one has the depth asked for.
//! * [`renewal`]: the variance of next-flight estimators by another equation than their closed form.
//! * [`orders`]: an estimate by combs averaged over everything that it draws.

pub mod decisions;
pub mod densities;
pub mod orders;
pub mod renewal;
pub mod thickness;

use crate::CheckResult;

/// The outcome of a comparison whose greatest relative deviation is `worst`, of which `granted` is rounding or quadrature.
#[must_use]
pub fn agree(worst: f64, granted: f64) -> CheckResult {
    CheckResult {
        detectable_relative_bias: Some(granted),
        // No number agrees with none.
        ..CheckResult::exact(worst <= granted, format!("off by {worst:.1e} of {granted:.0e} granted"))
    }
}

/// The greatest of some deviations; NaN if one is.
#[must_use]
pub fn greatest(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, |worst: f64, next| if next.is_nan() { next } else { worst.max(next) })
}
