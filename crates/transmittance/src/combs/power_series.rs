//! The power series of one segment about each of its own draws (kettunen-2021), as numbers of any size.

use super::Roulette;
use super::symmetric_means::SymmetricMeans;
use fairflight_elementary::{exp, exp2, ln, log2};

/// 1/(N + 1) Σ_j exp(D_j) Σ_{k ≤ N} w_k m_k({D_i − D_j}_{i ≠ j}) of the deviations D_i = X_0 − X_i of N + 1 draws: s and t of s exp(t), t = 0
/// where that is no way beyond the range of numbers.
#[inline]
pub(crate) fn of_draws(roulette: Roulette, deviations: &[f64]) -> (f64, f64) {
    let order = deviations.len() as u32 - 1;
    // exp(X_0 − X_j) in units of the greatest, and differences in units of U, so that no product of them leaves the range.
    let greatest = deviations.iter().copied().fold(0.0, f64::max);
    let least = deviations.iter().copied().fold(0.0, f64::min);
    let unit = differences_in(greatest - least, order);
    let top = if greatest > MOST_EXPONENT { greatest } else { 0.0 };
    let mut means = SymmetricMeans::new();
    let mut sum = 0.0;
    for (pivot, &own) in deviations.iter().enumerate() {
        means.clear();
        let (before, others) = deviations.split_at(pivot);
        means.extend(before.iter().chain(&others[1..]).map(|&other| (other - own) / unit));
        sum += exp(own - top) * polynomial(roulette, &means.means()[1..], unit);
    }
    let exponent = if unit == 1.0 { top } else { top + f64::from(order) * ln(0.5 * unit) };
    (sum / f64::from(order + 1), exponent)
}

/// exp of this, times what the polynomials may be, is far from the range of numbers.
const MOST_EXPONENT: f64 = 300.0;

/// The power of two that differences up to `spread` are taken in: 1 unless their powers up to `order` pass 2^450.
#[inline]
fn differences_in(spread: f64, order: u32) -> f64 {
    // 10000^33 < 2^450.
    let few = spread < 1e4 && order <= 33;
    if few || log2(spread) * f64::from(order) < 450.0 { 1.0 } else { exp2(log2(spread).ceil()) }
}

/// Σ_k w_k U^k m_k over (U/2)^N, of m_1 … m_N in units of U; 1 stands for no unit and no divisor.
#[inline]
fn polynomial(roulette: Roulette, means: &[f64], unit: f64) -> f64 {
    // w_k = 2^{1−k}/P.
    let mut weight = roulette.weight(1);
    if unit == 1.0 {
        let mut series = 1.0;
        for &mean in means {
            series += weight * mean;
            weight *= 0.5;
        }
        return series;
    }
    // From the highest power down, (2/P) (U/2)^{k−N} and (U/2)^{−N} at last: what underflows is nothing beside the first.
    let (half, mut series) = (0.5 * unit, 0.0);
    weight *= 2.0;
    let mut power = 1.0;
    for &mean in means.iter().rev() {
        series += weight * power * mean;
        power /= half;
    }
    series + power
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_polynomial_is_the_same_in_any_unit() {
        let means = [0.3, -1.2, 2.5, 0.7, -0.4, 1.0];
        let plain = polynomial(Roulette::KETTUNEN, &means, 1.0);
        for unit in [0.5_f64, 4.0, 1024.0] {
            let mut power = 1.0;
            let scaled = means.map(|mean| {
                power *= unit;
                mean / power
            });
            let found = polynomial(Roulette::KETTUNEN, &scaled, unit) * (0.5 * unit).powi(6);
            assert_relative_eq!(found, plain, max_relative = 1e-13);
        }
        assert_eq!(
            [differences_in(9e3, 33), differences_in(1e4, 40), differences_in(0.0, 1)],
            [1.0, 16384.0, 1.0]
        );
    }

    #[test]
    fn draws_that_are_far_apart_are_what_logarithms_say() {
        // Two values of X, and orders whose powers pass the range of numbers: 70 draws of one, one of the other, 1e5 above.
        let far = 1e5;
        let mut deviations = vec![0.0; 71];
        deviations[70] = far;
        let (sum, exponent) = of_draws(Roulette::KETTUNEN, &deviations);
        // All differences from the far one are −1e5, so that m_k = (−1e5)^k; exp(1e5) times that rules. The last two powers show:
        // w_k m_k with the ratio −2/1e5 of the one below.
        let leading = 70.0 * (0.5_f64 * far).ln() + (2.0_f64 / 0.1).ln();
        assert!(sum > 0.0);
        let found = sum.ln() + exponent;
        let exact = far + leading + (1.0_f64 / (1.0 + 2.0 / far)).ln() - 71.0_f64.ln();
        assert_relative_eq!(found, exact, max_relative = 1e-12);
    }
}
