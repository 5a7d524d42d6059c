//! Quadrature of a profile: the reference that estimators are judged against.
//!
//! Every closed form of a transmittance estimator is an integral over the ray of a function of s and σ_t(s), or an
//! integral nested once in another. [`RayQuadrature`] evaluates σ_t once per node, keeps it, and integrates as many such
//! functions as are asked for, refining only where one of them needs it: that is why a library of one-shot integrators
//! is not enough here. The rule is Gauss–Kronrod 10/21 per panel (Piessens et al. 1983), panels split at breakpoints;
//! each result carries an error that was measured, not hoped for.

mod cumulative;
mod panels;
mod ray;
mod rule;
mod zeros;

pub use cumulative::Cumulative;
pub use panels::{Integral, Tolerance};
pub use ray::RayQuadrature;

pub(crate) use panels::compensated_sum;

use panels::Panels;

/// ∫ of each component of `integrand` over `[0, length]`, split at `breakpoints`, refined to `tolerance`.
pub fn adaptive_integral<const K: usize>(
    length: f64,
    breakpoints: &[f64],
    tolerance: Tolerance,
    integrand: impl Fn(f64) -> [f64; K],
) -> Integral<K> {
    let mut panels = Panels::new(length, breakpoints, &integrand);
    panels.integrate(&integrand, tolerance, &|_, &values| values)
}
