//! Adaptive ratio tracking: collisions at the rate of the null extinction found last (misso-2023).

use crate::estimator::bounded;
use crate::next_flight::of_variance;
use crate::{ClosedForm, SignedProduct, Theory, TransmittanceEstimator, adaptive_law};
use fairflight_media::{Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Ratio tracking that guesses σ_t to stay as it was where it last looked: control and rate follow it.
///
/// ```text
/// T = 1; x = 0; rate = mu
/// repeat  d = exponential free flight of rate;  stop when x + d > S
///         x += d;  T *= exp((rate − mu) d) (mu − sigma_t(x))/rate
///         rate = max(mu − sigma_t(x), floor mu)
/// T *= exp((rate − mu) (S − x))
/// ```
///
/// With the control mu − rate this is residual ratio tracking: (mu − σ_t)/rate = 1 − (σ_t − (mu − rate))/rate.
///
/// **Law.** (1) Let f(x, r) be the expectation of what is still to be multiplied at x, the rate there being r. (2) Over the
/// next flight
///
/// > f(x, r) = exp(−r(S − x)) exp((r − μ)(S − x)) + ∫_x^S r exp(−r(y − x)) · exp((r − μ)(y − x)) (μ − σ_t(y))/r · f(y, r′) dy.
///
/// (3) r cancels in the density and the weight, whatever it is: f(x) = exp(−μ(S − x)) + ∫ exp(−μ(y − x)) (μ − σ_t(y)) f(y) dy, for
/// every rule r′ too. (4) This Volterra equation has one solution, T(x, S) (differentiate it). What (3) needs is that
/// the rate by which the weight is divided is the one by which the flight was drawn: it is *predictable*, fixed before the
/// look-up at y. A rate that knows σ_t(y) is a bias.
///
/// The floor, in (0, 1\], keeps the rate positive where σ_t comes near to μ. σ_t may have any sign and exceed μ > 0 (misso-2023's
/// point is a μ that is no majorant); between 0 and μ estimates are nowhere negative.
///
/// **Variance and cost.** What a collision adds depends on where the last one was: both are solutions of integral equations along
/// the ray (`adaptive_law.rs`), solved where the ray is not thicker than some hundred mean free paths of the majorant. Higher
/// moments have no closed form here. Less than μS look-ups where 0 ≤ σ_t ≤ μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveRatio {
    floor: f64,
}

/// A floor that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FloorError {
    /// A floor that is not above 0, or NaN: the rate could vanish.
    #[error("floor must be greater than 0, found {0}")]
    NotPositive(f64),
    /// A floor above 1.
    #[error("floor must be at most 1, found {0}")]
    AboveOne(f64),
}

impl AdaptiveRatio {
    /// The estimator whose rate is at least `floor` times the majorant; misso-2023's code has 0.1.
    ///
    /// # Errors
    /// If the floor is not in (0, 1\].
    pub fn new(floor: f64) -> Result<Self, FloorError> {
        match floor {
            _ if floor > 1.0 => Err(FloorError::AboveOne(floor)),
            _ if floor > 0.0 => Ok(Self { floor }),
            _ => Err(FloorError::NotPositive(floor)),
        }
    }
}

impl<F: Majorant> TransmittanceEstimator<F> for AdaptiveRatio {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let Some((majorant, length)) = bounded(field) else { return 1.0 };
        let mut weight = SignedProduct::ONE;
        // ∫ (rate − mu) over the way so far: one exponential per estimate.
        let mut exponent = 0.0;
        let (mut x, mut rate) = (0.0, majorant);
        loop {
            let flight = source.next_exponential() / rate;
            // A value of −inf makes the rate infinite, and the walk endless.
            if x + flight >= length || rate == f64::INFINITY {
                return weight.times_exp(exponent + (rate - majorant) * (length - x));
            }
            x += flight;
            exponent += (rate - majorant) * flight;
            let null = majorant - field.sigma_t(x);
            weight.multiply(null / rate);
            rate = null.max(self.floor * majorant);
        }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        field.majorant() > 0.0 || sigma_t == 0.0
    }
}

impl<F: Majorant> ClosedForm<F> for AdaptiveRatio {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let majorant = quadrature.field().majorant();
        if majorant <= 0.0 || quadrature.field().length() == 0.0 {
            return of_variance(0.0, 0.0, 0.0, 0.0);
        }
        // Panels where σ_t and its square are smooth.
        quadrature.integrate(tolerance, |_, sigma_t| [sigma_t, sigma_t * sigma_t]);
        let borders: Vec<f64> = quadrature.borders().collect();
        match adaptive_law::solve(quadrature.field(), &borders, majorant, self.floor) {
            Some(law) => of_variance(0.0, law.variance, law.error, law.lookups),
            None => Theory::mean_only(f64::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{Broken, agrees, seed_ray, theory_of, variate};
    use approx::assert_relative_eq;
    use fairflight_media::{Bounded, Constant, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    #[test]
    fn a_walk_of_two_collisions_by_hand() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, 1.9]).unwrap();
        let field = Bounded::new(field, 2.0).unwrap();
        let estimator = AdaptiveRatio::new(0.1).unwrap();
        // At rate 2 to 0.5; at rate 1.5 to 2; then the floor, a rate of 0.2, and out.
        let mut source = Scripted::new([1.0, 2.25, 0.3].map(variate));
        let exact = 0.75 * (-0.75_f64).exp() * (0.1 / 1.5) * (-1.8_f64).exp();
        assert_relative_eq!(estimator.estimate(&field, &mut source), exact, max_relative = 1e-12);
        assert_eq!(source.remaining(), 0);
    }

    #[test]
    fn a_constant_medium_has_no_variance_behind_its_first_collision() {
        let field = Bounded::new(Constant::new(0.4, 3.0).unwrap(), 1.0).unwrap();
        let estimator = AdaptiveRatio::new(0.1).unwrap();
        let one = |later: f64| {
            estimator.estimate(&field, &mut Scripted::new([variate(0.5), variate(later), variate(9.0)]))
        };
        assert_relative_eq!(one(0.3), one(0.9), max_relative = 1e-12);
    }

    #[test]
    fn unbiased_for_every_floor_and_sign() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, 0.1, 1.0]).unwrap();
        for (seed, floor) in [(1, 0.1), (2, 0.25), (3, 1.0)] {
            agrees(&field, &AdaptiveRatio::new(floor).unwrap(), 200_000, &mut Seeded::new(seed));
        }
        let signed = PiecewiseConstant::new(vec![0.0, 0.5, 1.5], vec![1.3, -0.4]).unwrap();
        let field = Bounded::new(signed, 1.0).unwrap();
        agrees(&field, &AdaptiveRatio::new(0.5).unwrap(), 200_000, &mut Seeded::new(4));
    }

    /// A solution on a grid of 1000 cells, made elsewhere, gives 6.11 ± 0.01 and 13.90 ± 0.01 on this ray.
    #[test]
    fn the_figures_of_the_seed_ray() {
        let (field, estimator) = (seed_ray(), AdaptiveRatio::new(0.1).unwrap());
        let theory = theory_of(field, &estimator);
        assert!((theory.relative_central[0] - 6.11).abs() < 0.01, "{theory:?}");
        assert!((theory.lookups - 13.90).abs() < 0.01, "{theory:?}");
        assert!(theory.relative_variance_error < 1e-6, "{theory:?}");
        agrees(&field, &estimator, 200_000, &mut Seeded::new(41));
    }

    #[test]
    fn a_value_that_is_none_ends_the_walk_and_shows() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let field = Bounded::new(Broken(value), 1.0).unwrap();
            let script = Scripted::new([variate(0.5), variate(0.5), variate(9.0)]);
            let estimate = AdaptiveRatio::new(0.1).unwrap().estimate(&field, &mut { script });
            assert!(!estimate.is_finite(), "{value}: {estimate}");
        }
    }

    #[test]
    fn what_is_no_floor_is_refused() {
        assert_eq!(AdaptiveRatio::new(0.0), Err(FloorError::NotPositive(0.0)));
        assert_eq!(AdaptiveRatio::new(1.5), Err(FloorError::AboveOne(1.5)));
        assert!(AdaptiveRatio::new(f64::NAN).is_err());
    }
}
