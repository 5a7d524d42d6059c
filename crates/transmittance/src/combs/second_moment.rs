//! The variance of one factor of unbiased ray marching, exactly.
//!
//! **What is summed.** D_0 … D_N are independent deviations E\[X\] − X, v = Var D, and in units of the true factor
//!
//! > R = 1/(N + 1) Σ_j A_j, A_j = e^{D_j} Σ_{k≤N} w_k m_k({D_i − D_j}_{i≠j}).
//!
//! E\[R\] = 1, so that Var R = Σ_N P(N) E\[(R − 1)² | N\], and by symmetry E\[(R − 1)² | N\] = (E\[A_0'²\] + N
//! E\[A_0' A_1'\])/(N + 1) with A' = A − 1 = (e^D − 1) + e^D Σ_{k≥1} w_k m_k. Taking the 1 off first is what keeps
//! the digits of a small variance.
//!
//! **Symmetric polynomials.** Σ_k s^k e_k({D_i − a}) = Π_i (1 + s (D_i − a)), and over one D
//!
//! > E\[(1 + s (D − a)) (1 + t (D − b))\] = 1 − s a − t b + s t (v + a b).
//!
//! Hence E\[A_0'²\] takes the coefficients of s^k t^l in (1 − (s + t) a + s t (v + a²))^N, a = D_0, and E\[A_0'
//! A_1'\] those in (1 + s (b − a)) (1 + t (a − b)) (1 − s a − t b + s t (v + a b))^{N−1}, a = D_0, b = D_1, which are
//! sums of products of
//!
//! > E\[D^p e^{2D}\], E\[D^p e^D\]:
//!
//! integrals over one variate. The orders are summed until they are negligible.

use super::Roulette;
use super::deviation::DeviationLaw;
use fairflight_elementary::{exp, exp_m1};
use fairflight_media::Breakpoints;

/// Orders tried before the sum is given up, and in how large steps: the tables grow with their cube.
const ORDERS: [usize; 3] = [12, 24, 48];

/// A share of the sum that is negligible.
const NEGLIGIBLE: f64 = 1e-13;

/// Deviations beyond which the orders that matter are more than the last of [`ORDERS`]: the share of order n is about (D²/2)^n/n!, at 48
/// still exp(200) for D = 100; and exp(2D) D^96 is a number up to here.
const MOST_DEVIATION: f64 = 100.0;

/// Var R with its error relative to itself; NaN where the orders that matter are too many, `None` where they take more look-ups than
/// there are.
pub(super) fn relative_variance<F: Breakpoints>(
    law: &mut DeviationLaw<'_, F>,
    roulette: Roulette,
) -> Option<(f64, f64)> {
    if law.unit() == 0.0 {
        return Some((0.0, 0.0));
    }
    if law.unit() > MOST_DEVIATION {
        return Some((f64::NAN, f64::NAN));
    }
    for highest in ORDERS {
        let tables = Tables::new(law, highest)?;
        let mut sum = (1.0 - roulette.going_on()) * tables.square;
        let mut negligible = 0;
        for order in 2..=highest {
            // P(N = order).
            let probability = roulette.reached(order as u32) - roulette.reached(order as u32 + 1);
            let term = probability * tables.square_at(order, roulette);
            sum += term;
            negligible = if term.abs() <= NEGLIGIBLE * sum.abs() { negligible + 1 } else { 0 };
            if negligible == 2 {
                return Some((sum, law.relative_error() + 2.0 * NEGLIGIBLE));
            }
        }
    }
    Some((f64::NAN, f64::NAN))
}

/// Moments of x = D/max |D|, from which those of D are read by weights w_k (max |D|)^k; v is the variance of x.
struct Tables {
    unit: f64,
    /// E\[(e^D − 1)²\], E\[e^D − 1\], E\[x (e^D − 1)\].
    square: f64,
    first: f64,
    slope: f64,
    /// E\[x^p e^D\].
    single: Vec<f64>,
    /// E\[x^p e^D (e^D − 1)\].
    mixed: Vec<f64>,
    /// `double[m][p]` = E\[(v + x²)^m x^p e^{2D}\].
    double: Vec<Vec<f64>>,
    /// `product[m][i][j]` = E\[(v + x_0 x_1)^m x_0^i x_1^j e^{D_0 + D_1}\].
    product: Vec<Vec<Vec<f64>>>,
    factorials: Vec<f64>,
}

impl Tables {
    fn new<F: Breakpoints>(law: &mut DeviationLaw<'_, F>, highest: usize) -> Option<Self> {
        let unit = law.unit();
        let v = law.k2() / (unit * unit);
        let [square, first, slope] = law.expect(|d, x| {
            let e = exp_m1(d);
            [e * e, e - d, x * e]
        })?;
        let single = law.moments(highest + 2, exp)?;
        let mixed = law.moments(highest, |d| exp(d) * exp_m1(d))?;

        let mut double = vec![law.moments(2 * highest, |d| exp(2.0 * d))?];
        for m in 0..highest {
            let last = &double[m];
            double.push((0..last.len().saturating_sub(2)).map(|p| v * last[p] + last[p + 2]).collect());
        }
        let size = highest + 3;
        let outer = |i: usize| (0..size).map(|j| single[i] * single[j]).collect::<Vec<_>>();
        let mut product = vec![(0..size).map(outer).collect::<Vec<_>>()];
        for m in 0..highest {
            let last = &product[m];
            let size = last.len() - 1;
            let row = |i: usize| (0..size).map(|j| v * last[i][j] + last[i + 1][j + 1]).collect::<Vec<_>>();
            product.push((0..size).map(row).collect());
        }
        let mut factorials = vec![1.0];
        for k in 1..=highest {
            factorials.push(factorials[k - 1] * k as f64);
        }
        Some(Self { unit, square, first, slope, single, mixed, double, product, factorials })
    }

    /// E\[(R − 1)² | N = `order`\].
    fn square_at(&self, order: usize, roulette: Roulette) -> f64 {
        let n = order as f64;
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let weight = |k: usize| roulette.weight(k as u32) * (sign(k) * self.unit.powi(k as i32));
        let weights: Vec<f64> = (0..=order).map(weight).collect();

        let (mut same, mut different) = (self.square, self.first * self.first);
        for (k, w) in weights.iter().enumerate().skip(1) {
            same += 2.0 * w * self.mixed[k];
            // E of e^{D_0} m_k over all but D_0 and D_1: (−a)^k + (k/N) b (−a)^{k−1}.
            let pair = self.slope * self.single[k - 1] * (k as f64 / n);
            different += 2.0 * w * (self.first * self.single[k] - pair);
        }
        for (k, wk) in weights.iter().enumerate().skip(1) {
            for (l, wl) in weights.iter().enumerate().skip(1) {
                let of_means = wk * wl / (self.binomial(order, k) * self.binomial(order, l));
                same += of_means * self.same_pivot(order, k, l);
                different += of_means * self.different_pivots(order - 1, k, l);
            }
        }
        (same + n * different) / (n + 1.0)
    }

    /// E\[e^{2a} \[s^k t^l\] (1 + (s + t) a + s t (v + a²))^n\]: the signs (−1)^{k+l} are in the weights.
    fn same_pivot(&self, n: usize, k: usize, l: usize) -> f64 {
        self.multinomials(n, k, l).map(|(m, count)| count * self.double[m][k + l - 2 * m]).sum()
    }

    /// E\[e^{a+b} \[s^k t^l\] (1 + s (a − b)) (1 + t (b − a)) (1 + s a + t b + s t (v + a b))^n\].
    fn different_pivots(&self, n: usize, k: usize, l: usize) -> f64 {
        let shifted = |k: usize, l: usize, i: usize, j: usize| -> f64 {
            self.multinomials(n, k, l).map(|(m, count)| count * self.product[m][k - m + i][l - m + j]).sum()
        };
        shifted(k, l, 0, 0)
            + (shifted(k - 1, l, 1, 0) - shifted(k - 1, l, 0, 1))
            + (shifted(k, l - 1, 0, 1) - shifted(k, l - 1, 1, 0))
            - (shifted(k - 1, l - 1, 2, 0) - 2.0 * shifted(k - 1, l - 1, 1, 1) + shifted(k - 1, l - 1, 0, 2))
    }

    /// n!/(m! (k − m)! (l − m)! (n − k − l + m)!) for every m where none of these is negative.
    fn multinomials(&self, n: usize, k: usize, l: usize) -> impl Iterator<Item = (usize, f64)> {
        let f = &self.factorials;
        ((k + l).saturating_sub(n)..=k.min(l))
            .filter(move |_| k <= n && l <= n)
            .map(move |m| (m, f[n] / (f[m] * f[k - m] * f[l - m] * f[n + m - k - l])))
    }

    fn binomial(&self, n: usize, k: usize) -> f64 {
        let f = &self.factorials;
        f[n] / (f[k] * f[n - k])
    }
}
