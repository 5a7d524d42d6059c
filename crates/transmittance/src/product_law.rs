//! The moments of a walk that multiplies independent weights: szirmay-kalos-2017 eq. 16, for every power.
//!
//! **Derivation.** Collisions are a Poisson process of rate σ_samp(s), each multiplies the estimate by an independent
//! weight W(s). In \[s, s + ds) the estimate is multiplied by W with probability σ_samp ds, else by 1, so that
//! d ln E\[T^k\] / ds = σ_samp (E\[W^k\] − 1), and with the control's transmittance T_main in front
//!
//! > E\[T^k\] = T_main^k · exp( ∫ σ_samp (E\[W^k\] − 1) ds ).
//!
//! For k = 1, E\[W\] = 1 − r gives T: the estimator is unbiased for every σ_samp and control. For k = 2 it is eq. 16.
//! Expanding W^k = (1 + (W − 1))^k in the moments about 1, with J_j = ∫ σ_samp E\[(W − 1)^j\] ds,
//!
//! > ln( E\[T^k\] / T^k ) = Σ_{j=2..k} C(k, j) J_j  =: e_k,
//!
//! since J_1 = −∫ σ_diff cancels. The J_j are what quadrature delivers; nothing here cancels for a small variance.

use crate::Theory;
use fairflight_elementary::{exp, exp_m1, ln, ln_1p};

/// The highest power whose moment is computed: the standard error of a measured variance needs the 4th, the test whether
/// that error may be used with a normal law the 6th and 8th.
pub const HIGHEST_MOMENT: usize = 8;

/// J_2 … J_8.
pub const MOMENTS: usize = HIGHEST_MOMENT - 1;

/// The law of a product over a Poisson process, from its collision integrals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProductLaw {
    integrals: [f64; MOMENTS],
}

impl ProductLaw {
    /// The law with `integrals[j − 2]` = J_j = ∫ σ_samp E\[(W − 1)^j\] ds, j = 2 … 8.
    #[must_use]
    pub fn new(integrals: [f64; MOMENTS]) -> Self {
        Self { integrals }
    }

    /// e_k = ln(E\[T^k\] / T^k), for k = 0 … 8.
    #[must_use]
    pub fn log_relative_moment(&self, k: usize) -> f64 {
        (2..=k).map(|j| binomial(k, j) * self.integrals[j - 2]).sum()
    }

    /// ln(Var / T^2) = ln(exp(J_2) − 1).
    #[must_use]
    pub fn log_relative_variance(&self) -> f64 {
        let j2 = self.integrals[0];
        if j2 > 1.0 { j2 + ln_1p(-exp(-j2)) } else { ln(exp_m1(j2)) }
    }

    /// The theory of an unbiased estimate with this law, where J_2 has an absolute `error` and as many `lookups` are
    /// expected: d Var/Var = dJ_2 exp(J_2)/(exp(J_2) − 1).
    #[must_use]
    pub fn theory(&self, error: f64, lookups: f64) -> Theory {
        Theory {
            relative_mean: 1.0,
            relative_central: self.relative_central(),
            log_relative_variance: self.log_relative_variance(),
            relative_variance_error: error / -exp_m1(-self.integrals[0]),
            ..Theory::mean_only(lookups)
        }
    }

    /// E\[(T̂ − T)^n\] / T^n for n = 2 … 8.
    #[must_use]
    pub fn relative_central(&self) -> [f64; MOMENTS] {
        std::array::from_fn(|i| self.relative_central_moment(i + 2))
    }

    /// Binomial inversion of e_k gives back J_n, so that the terms linear in the J are known exactly and only
    /// g(e_k) = exp(e_k) − 1 − e_k has to be summed with alternating signs:
    ///
    /// > μ_n / T^n = J_n + Σ_{k=2..n} C(n, k) (−1)^{n−k} g(e_k).
    ///
    /// From the 5th moment on the terms quadratic in the J cancel as well; for a small J_2 the moments are then those of
    /// the compensated Poisson sum Σ (W − 1), whose cumulants are the J, to a relative error of order J_2.
    fn relative_central_moment(&self, n: usize) -> f64 {
        const SMALL_ENOUGH_FOR_CUMULANTS: f64 = 1e-3;
        if n > 4 && self.integrals[0] < SMALL_ENOUGH_FOR_CUMULANTS {
            return self.central_moment_of_cumulants(n);
        }
        let mut moment = self.integrals[n - 2];
        for k in 2..=n {
            let sign = if (n - k).is_multiple_of(2) { 1.0 } else { -1.0 };
            moment += sign * binomial(n, k) * exp_minus_linear(self.log_relative_moment(k));
        }
        if moment.is_nan() { self.infinite_central_moment(n) } else { moment }
    }

    /// ∞ − ∞: the term with the greatest exponent dominates, and says the sign; of an even moment there is only one.
    fn infinite_central_moment(&self, n: usize) -> f64 {
        let greatest =
            (2..=n).max_by(|&a, &b| self.log_relative_moment(a).total_cmp(&self.log_relative_moment(b)));
        let dominates = greatest.unwrap_or(n);
        if n.is_multiple_of(2) || (n - dominates).is_multiple_of(2) {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
        }
    }

    /// The n-th central moment of a law with cumulants κ_j = J_j:
    /// m_n = κ_n + Σ_{j=2..n−2} C(n − 1, j − 1) κ_j m_{n−j}.
    fn central_moment_of_cumulants(&self, n: usize) -> f64 {
        match n {
            0 => 1.0,
            1 => 0.0,
            _ => (2..=n)
                .map(|j| {
                    binomial(n - 1, j - 1) * self.integrals[j - 2] * self.central_moment_of_cumulants(n - j)
                })
                .sum(),
        }
    }
}

/// exp(x) − 1 − x, without cancellation near 0.
fn exp_minus_linear(x: f64) -> f64 {
    if x.abs() > 0.1 {
        return exp_m1(x) - x;
    }
    let (mut sum, mut term) = (0.0, x);
    for n in 2..=14 {
        term *= x / f64::from(n);
        sum += term;
    }
    sum
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A law whose moments are known otherwise: 0 or 1 with probability T = exp(−tau), J_j = (−1)^j tau.
    fn bernoulli(tau: f64) -> ProductLaw {
        ProductLaw::new(std::array::from_fn(|i| if i % 2 == 0 { tau } else { -tau }))
    }

    #[test]
    fn a_zero_one_estimate_has_the_moments_of_a_coin() {
        for tau in [1e-6_f64, 1e-3, 0.3, 2.0, 6.0] {
            let t: f64 = (-tau).exp();
            let law = bernoulli(tau);
            let central = law.relative_central();
            let coin = |n: i32| (t * (1.0 - t).powi(n) + (1.0 - t) * (-t).powi(n)) / t.powi(n);
            for n in 2..=4 {
                assert_relative_eq!(central[n - 2], coin(n as i32), max_relative = 1e-9);
            }
            for n in [6, 8] {
                assert_relative_eq!(central[n - 2], coin(n as i32), max_relative = 0.02);
            }
            assert_relative_eq!(
                law.log_relative_variance(),
                coin(2).ln(),
                max_relative = 1e-10,
                epsilon = 1e-12
            );
        }
    }

    #[test]
    fn a_tiny_variance_keeps_its_digits() {
        // W = 1 ± h with equal probability, rate such that J_2 = 1e-10: nearly normal.
        let h = 1e-6;
        let law = ProductLaw::new(std::array::from_fn(|i| {
            if i % 2 == 0 { 1e-10 * f64::powi(h, i as i32) } else { 0.0 }
        }));
        let central = law.relative_central();
        assert_relative_eq!(central[0], 1e-10, max_relative = 1e-9);
        assert_relative_eq!(central[2], 3e-20 + 1e-22, max_relative = 1e-3);
        assert_relative_eq!(central[6], 105e-40, max_relative = 0.2);
    }

    #[test]
    fn an_infinite_odd_moment_has_the_sign_of_its_greatest_term() {
        // Every weight is −9: E[T^k]/T^k = exp(λ ((−9)^k − 1 + 10 k)), so that the even powers are greatest below an odd n.
        let law = ProductLaw::new(std::array::from_fn(|i| (-10.0_f64).powi(i as i32 + 2)));
        let central = law.relative_central();
        assert_eq!([central[3], central[5]], [f64::NEG_INFINITY; 2]);
        assert_eq!([central[4], central[6]], [f64::INFINITY; 2]);
        // A coin of small T: the highest power.
        assert_eq!(bernoulli(900.0).relative_central()[5], f64::INFINITY);
    }

    #[test]
    fn an_overflowing_moment_is_infinite_and_its_logarithm_is_not() {
        let law = bernoulli(800.0);
        assert_eq!(law.relative_central()[2], f64::INFINITY);
        assert_relative_eq!(law.log_relative_variance(), 800.0);
    }
}
