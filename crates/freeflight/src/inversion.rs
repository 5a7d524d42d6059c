//! Inversion of the optical thickness in closed form (szirmay-kalos-2017 eq. 3 and 4).

use crate::theory::{HIGHEST_MOMENT, Moments};
use crate::{ClosedForm, Flight, FreeFlight};
use fairflight_media::{Extinction, InvertOpticalThickness, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// The distance at which the optical thickness reaches −ln(1 − u).
///
/// **Law.** P(distance > s) = P(−ln(1 − u) > τ(s)) = exp(−τ(s)): the density σ_t T itself, every weight is 1.
///
/// **Moments.** E\[weight^k; collided\] = 1 − T, E\[weight^k; escaped\] = T.
///
/// **Cost.** No look-up and one variate: what is needed is known of the field.
///
/// **Domain.** σ_t ≥ 0: a flight ends once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inversion;

impl<F: InvertOpticalThickness> FreeFlight<F> for Inversion {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        Flight::unweighted(field.invert(0.0, source.next_exponential()))
    }

    #[inline]
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t >= 0.0
    }
}

impl<F: Extinction> ClosedForm<F> for Inversion {
    fn lookups(&self, _quadrature: &mut RayQuadrature<F>, _tolerance: Tolerance) -> Option<Moments> {
        Some([0.0; HIGHEST_MOMENT])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::Constant;
    use fairflight_sources::Scripted;

    #[test]
    fn one_variate_decides_and_nothing_is_looked_up() {
        let field = Constant::new(2.0, 1.0).unwrap();
        let sample = |u: f64| Inversion.sample(&field, &mut Scripted::new([u]));
        assert_eq!(sample(0.0), Flight::Collided { distance: 0.0, weight: 1.0 });
        // exp(−2 · 0.5) = 0.368 of all flights pass the middle.
        let middle = sample(-(-1.0_f64).exp_m1()).distance().unwrap();
        assert!((middle - 0.5).abs() < 1e-15);
        assert_eq!(sample(0.87), Flight::Escaped { weight: 1.0 });
    }
}
