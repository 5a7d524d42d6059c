//! The generalised Poisson estimator: a single term of the exponential series.

use crate::p_series::poisson;
use crate::{ClosedForm, ProductLaw, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_media::{Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// One term of exp(−t_c) Σ_k (t_c − τ)^k/k!, its order drawn from a Poisson law of any rate (fearnhead-2008, with a Poisson law of
/// the order; wagner-1987).
///
/// X is S σ_t at a point uniform on the profile, Y = t_c − X. With K of probability p_K = exp(−λ) λ^K/K!,
///
/// > T̂ = exp(−t_c) Y_1 … Y_K / (K! p_K) = exp(λ − t_c) Π_{i ≤ K} Y_i/λ.
///
/// **Law.** (1) E\[Y\] = t_c − τ and the points are independent: the expectation over K is exp(λ − t_c) exp(λ ((t_c − τ)/λ − 1)) =
/// exp(−τ). Unbiased for every pivot t_c and every rate λ > 0, for σ_t of any sign; negative estimates where σ_t > t_c/S.
///
/// **Moments.** (2) It is residual ratio tracking with the control (t_c − λ)/S and the sampling extinction λ/S, its points
/// unsorted: there 1 − (σ_t − σ_main)/σ_samp = (t_c/S − σ_t) S/λ = Y/λ, and exp(−∫ σ_main) = exp(λ − t_c). So all moments are those of
/// [`ProductLaw`], J_j = λ E\[(Y/λ − 1)^j\]. (3) In particular, with q = E\[Y²\],
///
/// > E\[T̂²\] = exp(−2t_c + λ + q/λ),
///
/// least for λ = √q ([`optimal_rate`](Self::optimal_rate)): exp(−2t_c + 2√q). (4) For a given λ the best pivot is the
/// one whose control is the mean: t_c = τ + λ.
///
/// **Cost.** λ look-ups, a Poisson number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralisedPoisson {
    pivot: f64,
    rate: f64,
}

/// A pivot or a rate that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GeneralisedPoissonError {
    /// The pivot is NaN or infinite.
    #[error("pivot must be finite, found {0}")]
    PivotNotFinite(f64),
    /// The rate is not above 0, or not finite.
    #[error("rate must be finite and greater than 0, found {0}")]
    RateNotPositive(f64),
}

impl GeneralisedPoisson {
    /// The estimator about the optical thickness `pivot` = t_c \[1\] with `rate` = λ look-ups.
    ///
    /// # Errors
    /// If the pivot is not finite, or the rate not finite and above 0.
    pub fn new(pivot: f64, rate: f64) -> Result<Self, GeneralisedPoissonError> {
        if !pivot.is_finite() {
            return Err(GeneralisedPoissonError::PivotNotFinite(pivot));
        }
        if !(rate > 0.0 && rate.is_finite()) {
            return Err(GeneralisedPoissonError::RateNotPositive(rate));
        }
        Ok(Self { pivot, rate })
    }

    /// The rate of least variance, √q, for the second moment q = E\[(t_c − X)²\] = (t_c − τ)² + Var X about the pivot.
    #[must_use]
    pub fn optimal_rate(q: f64) -> f64 {
        q.sqrt()
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for GeneralisedPoisson {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let length = field.length();
        let mut product = SignedProduct::ONE;
        for _ in 0..poisson(self.rate, source) {
            let x = length * field.sigma_t(length * source.next_uniform());
            product.multiply((self.pivot - x) / self.rate);
        }
        product.times_exp(self.rate - self.pivot)
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Extinction> ClosedForm<F> for GeneralisedPoisson {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let Self { pivot, rate } = *self;
        let length = quadrature.field().length();
        if length == 0.0 {
            // Every point stands for X = 0.
            let moments = std::array::from_fn(|i| rate * (pivot / rate - 1.0).powi(i as i32 + 2));
            return ProductLaw::new(moments).theory(0.0, rate);
        }
        let collisions = quadrature.integrate(tolerance, |_, sigma_t| {
            let deviation = (pivot - length * sigma_t) / rate - 1.0;
            std::array::from_fn(|i| rate / length * deviation.powi(i as i32 + 2))
        });
        ProductLaw::new(collisions.value).theory(collisions.error[0], rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Tracking;
    use crate::test_support::{agrees, mean_and_square, seed_ray, theory_of};
    use approx::assert_relative_eq;
    use fairflight_collision::{Albedo, DoubleParticle};
    use fairflight_media::{Constant, PiecewiseConstant};
    use fairflight_sources::{Scripted, Seeded};

    #[test]
    fn three_points_by_hand() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.4]).unwrap();
        let estimator = GeneralisedPoisson::new(1.0, 2.0).unwrap();
        // Steps 0.5, 0.9, 0.5 fit into 2, the next does not; then X = 1.5, −1.2, 1.5.
        let steps = [0.5_f64, 0.9, 0.5, 0.2].map(|depth| 1.0 - (-depth).exp());
        let mut source = Scripted::new(steps.into_iter().chain([0.1, 0.5, 0.2]));
        let exact = 1.0_f64.exp() * (-0.25) * 1.1 * (-0.25);
        assert_relative_eq!(estimator.estimate(&field, &mut source), exact, max_relative = 1e-12);
        assert_eq!(source.remaining(), 0);
    }

    #[test]
    fn its_theory_is_that_of_residual_ratio_tracking_and_of_its_second_moment() {
        let (pivot, rate) = (4.1, 2.3);
        let theory = theory_of(seed_ray(), &GeneralisedPoisson::new(pivot, rate).unwrap());
        let constant = |sigma: f64| Constant::new(sigma, 20.0).unwrap();
        let model = DoubleParticle { albedo: Albedo::default() };
        let tracking = Tracking::new(model, constant((pivot - rate) / 20.0), constant(rate / 20.0));
        let other = theory_of(seed_ray(), &tracking);
        for (a, b) in theory.relative_central.into_iter().zip(other.relative_central) {
            assert_relative_eq!(a, b, max_relative = 1e-9);
        }
        assert_relative_eq!(theory.lookups, other.lookups, max_relative = 1e-9);
        let (tau, square) = mean_and_square(&seed_ray());
        let q = pivot * pivot - 2.0 * pivot * tau + square;
        let second = |rate: f64| (2.0 * (tau - pivot) + rate + q / rate).exp();
        assert_relative_eq!(theory.relative_central[0], second(rate) - 1.0, max_relative = 1e-9);
        let best = GeneralisedPoisson::optimal_rate(q);
        assert!(second(best) < second(1.01 * best) && second(best) < second(0.99 * best));
    }

    #[test]
    fn it_is_unbiased_for_any_pivot_and_rate() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, -0.1, 1.0]).unwrap();
        for (seed, pivot, rate) in [(1, 2.2, 3.0), (2, 0.0, 4.0), (3, 6.0, 5.0)] {
            let estimator = GeneralisedPoisson::new(pivot, rate).unwrap();
            agrees(&field, &estimator, 200_000, &mut Seeded::new(seed));
        }
    }

    #[test]
    fn what_is_no_pivot_or_rate_is_refused() {
        use GeneralisedPoissonError::{PivotNotFinite, RateNotPositive};
        assert_eq!(GeneralisedPoisson::new(1.0, 0.0), Err(RateNotPositive(0.0)));
        assert_eq!(GeneralisedPoisson::new(f64::INFINITY, 1.0), Err(PivotNotFinite(f64::INFINITY)));
    }
}
