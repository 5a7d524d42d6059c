//! The law of a sampler in closed form, before a flight is drawn.

use crate::WeightLaw;
use fairflight_elementary::{exp, ln};
use fairflight_media::{Extinction, Integral, RayQuadrature, Tolerance};

/// The highest power of a score whose moment is computed: what the tests of a mean (4) and of a variance (8) want.
pub const HIGHEST_MOMENT: usize = 8;

/// E\[X^k\] for k = 1 … 8 (index k − 1).
pub type Moments = [f64; HIGHEST_MOMENT];

/// A sampler whose weights have a law in closed form, up to quadrature over the ray.
pub trait ClosedForm<F: Extinction> {
    /// The law of the weights. By default all are 1.
    fn weights(&self) -> WeightLaw<'_, F> {
        WeightLaw::One
    }

    /// E\[N^k\] of the number N of look-ups of one flight: the first is the expected cost. `None` where no closed form is known.
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments>;
}

impl<F: Extinction, E: ClosedForm<F>> ClosedForm<F> for &E {
    fn weights(&self) -> WeightLaw<'_, F> {
        (**self).weights()
    }
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments> {
        (**self).lookups(quadrature, tolerance)
    }
}

/// E\[N^k\], k = 1 … 8, of a flight that looks up once at each point of a Poisson process. `rates` at s and σ_t: of the
/// points that end the flight, and of those that do not.
///
/// The two kinds are independent Poisson processes. A flight ends at s with the density ending(s) exp(−∫ ending), and has
/// then looked up once more than the Poisson number P of mean ν(s) = ∫_0^s of the other rate; one that leaves the profile
/// has looked up P times.
pub fn lookups_of_a_walk<F: Extinction>(
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
    rates: &dyn Fn(f64, f64) -> [f64; 2],
) -> Moments {
    lookups_of_a_race(quadrature, tolerance, &|s, sigma_t| {
        let [ending, passing] = rates(s, sigma_t);
        [0.0, ending, passing]
    })
}

/// Moments as [`lookups_of_a_walk`], with a further Poisson process whose first point ends the flight without a look-up; its rate is
/// the first of the three.
pub(crate) fn lookups_of_a_race<F: Extinction>(
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
    rates: &dyn Fn(f64, f64) -> [f64; 3],
) -> Moments {
    let ending_and_passing = |s: f64, sigma_t: f64| {
        let [unseen, ending, passing] = rates(s, sigma_t);
        [unseen + ending, passing]
    };
    let ended: Integral<HIGHEST_MOMENT> =
        quadrature.integrate_nested(tolerance, ending_and_passing, |s, sigma_t, [ended, passed]| {
            let [unseen, ending, _] = rates(s, sigma_t);
            let (as_passed, one_more) = poisson_moments(passed);
            let under_way = exp(-ended);
            std::array::from_fn(|i| ending * under_way * one_more[i] + unseen * under_way * as_passed[i])
        });
    let [all_ended, all_passed] = quadrature.integrate(tolerance, ending_and_passing).value;
    let (escaped, _) = poisson_moments(all_passed);
    std::array::from_fn(|i| ended.value[i] + exp(-all_ended) * escaped[i])
}

/// E\[P^k\] and E\[(1 + P)^k\], k = 1 … 8, of a Poisson variate P of this mean: the second by the binomial theorem, and
/// E\[P^(k+1)\] = mean · E\[(1 + P)^k\].
pub(crate) fn poisson_moments(mean: f64) -> (Moments, Moments) {
    let mut raw = [0.0; HIGHEST_MOMENT];
    let mut next = [0.0; HIGHEST_MOMENT];
    raw[0] = mean;
    for k in 1..=HIGHEST_MOMENT {
        next[k - 1] = one_more_to(k, &raw);
        if k < HIGHEST_MOMENT {
            raw[k] = mean * next[k - 1];
        }
    }
    (raw, next)
}

/// E\[(1 + X)^k\], k = 1 … 8, from E\[X^k\].
pub(crate) fn one_more(raw: &Moments) -> Moments {
    std::array::from_fn(|i| one_more_to(i + 1, raw))
}

/// E\[(1 + X)^k\], by the binomial theorem.
fn one_more_to(k: usize, raw: &Moments) -> f64 {
    let (mut sum, mut binomial) = (1.0, 1.0);
    for j in 1..=k {
        binomial *= (k - j + 1) as f64 / j as f64;
        sum += binomial * raw[j - 1];
    }
    sum
}

/// factor · exp(exponent) · score: 0 where a factor is 0, and infinite only where the product is. exp(exponent) by itself may be either.
#[inline]
pub(crate) fn times_exp(factor: f64, exponent: f64, score: f64) -> f64 {
    if exponent.abs() < 600.0 {
        return factor * exp(exponent) * score;
    }
    if factor == 0.0 || score == 0.0 {
        return 0.0;
    }
    factor.signum() * score.signum() * exp(exponent + ln(factor.abs()) + ln(score.abs()))
}

/// x, x², …, x⁸.
pub(crate) fn powers(x: f64) -> Moments {
    let mut power = 1.0;
    std::array::from_fn(|_| {
        power *= x;
        power
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_with_an_exponential_is_what_it_is() {
        let exact = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert_eq!(times_exp(3.0, -2.0, 0.5), 3.0 * (-2.0_f64).exp() * 0.5);
        assert!(exact(times_exp(1e-300, 900.0, -2.0), -2.0 * (900.0 - 300.0 * 10.0_f64.ln()).exp()));
        assert!(exact(times_exp(-1e200, -800.0, 1e100), -(300.0 * 10.0_f64.ln() - 800.0).exp()));
        // 0 · ∞ would be no number.
        assert_eq!([times_exp(0.0, 5000.0, 1.0), times_exp(2.0, 5000.0, 0.0)], [0.0, 0.0]);
        assert_eq!([times_exp(1.0, 5000.0, -1.0), times_exp(1.0, -5000.0, 1.0)], [f64::NEG_INFINITY, 0.0]);
    }

    #[test]
    fn moments_of_a_poisson_variate() {
        // Touchard polynomials: λ, λ + λ², λ + 3λ² + λ³, λ + 7λ² + 6λ³ + λ⁴.
        let (raw, one_more) = poisson_moments(2.0);
        assert_eq!(raw[..4], [2.0, 6.0, 22.0, 94.0]);
        assert_eq!(one_more[..3], [3.0, 11.0, 47.0]);
        // Bell's number B_8 for λ = 1, and B_9 = E[(1 + P)^8].
        let (raw, one_more) = poisson_moments(1.0);
        assert_eq!((raw[7], one_more[7]), (4140.0, 21147.0));
    }
}
