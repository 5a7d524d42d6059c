//! Woodcock tracking as an estimator of transmittance: 1 if the flight escapes, else 0 (raab-2008 algorithm 1).

use crate::{ClosedForm, ProductLaw, Theory, TransmittanceEstimator};
use fairflight_elementary::exp;
use fairflight_media::{Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Draws one flight through the majorant and scores whether it escapes.
///
/// **Law.** P(escape) = exp(−∫ σ_t) for 0 ≤ σ_t ≤ majorant everywhere. Above the majorant the escape probability is too
/// high: a bias, not only variance.
///
/// **Moments.** A coin: E\[T^k\] = T, Var = T (1 − T) whatever the majorant; equal to the terminating single particle model
/// with σ_samp at or above σ_t (szirmay-kalos-2017 eq. 19).
///
/// **Cost.** majorant · ∫ T(0, s) ds look-ups: the flight ends at the first collision with matter.
///
/// The printed algorithm takes −log(rand()), infinite at 0, and accepts at `ratio ≥ rand()`, which can collide in empty
/// space; here −ln(1 − u), and a collision only where `u < ratio`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Woodcock;

impl<F: Majorant> TransmittanceEstimator<F> for Woodcock {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        match collides(field, source.next_exponential(), source) {
            Some(_) => 0.0,
            None => 1.0,
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        (0.0..=field.majorant()).contains(&sigma_t)
    }
}

/// Follows a flight, the first step of which has the optical length `first` in the majorant: where it collides with matter,
/// and σ_t there; `None` if it leaves the profile.
#[inline]
pub(crate) fn collides<F: Majorant>(
    field: &F,
    first: f64,
    source: &mut impl UniformSource,
) -> Option<(f64, f64)> {
    let majorant = field.majorant();
    let mean_free_path = 1.0 / majorant;
    let mut depth = first;
    let mut s = 0.0;
    loop {
        // majorant = 0: the step is infinite, or NaN where depth = 0; neither is inside the profile.
        s += depth * mean_free_path;
        let inside = s < field.length();
        if !inside {
            return None;
        }
        let sigma_t = field.sigma_t(s);
        if source.next_uniform() * majorant < sigma_t {
            return Some((s, sigma_t));
        }
        depth = source.next_exponential();
    }
}

impl<F: Majorant> ClosedForm<F> for Woodcock {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        // E[(W − 1)^j] = (−1)^j r, so that J_j = (−1)^j tau.
        let law = ProductLaw::new(std::array::from_fn(|i| if i % 2 == 0 { tau } else { -tau }));
        Theory {
            relative_central: law.relative_central(),
            log_relative_variance: law.log_relative_variance(),
            relative_variance_error: 0.0,
            ..Theory::mean_only(expected_lookups(quadrature, tolerance))
        }
    }
}

/// majorant · ∫ T(0, s) ds.
pub(crate) fn expected_lookups<F: Majorant>(quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> f64 {
    let majorant = quadrature.field().majorant();
    if majorant == 0.0 {
        return 0.0;
    }
    let free =
        quadrature.integrate_nested(tolerance, |_, sigma_t| [sigma_t], |_, _, [tau]| [majorant * exp(-tau)]);
    free.value[0]
}
