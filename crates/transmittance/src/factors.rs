//! The moments of a product of few or many independent factors, from those of each.

use crate::{HIGHEST_MOMENT, MOMENTS};
use fairflight_elementary::{exp, exp_m1, ln, ln_1p};

/// The law of Π (1 + X_j) for independent X_j of mean zero: of an estimate in units of its mean, if it is a product.
///
/// With P = 1 + D the product so far, the next is 1 + D + X (1 + D), so that
///
/// > E\[D'^n\] = Σ_i C(n, i) E\[X^i\] E\[D^{n−i} (1 + D)^i\].
///
/// Nothing is subtracted from 1: a small variance keeps its digits, whatever the number of factors. The logarithm of the second moment is
/// kept beside, Σ ln(1 + E\[X_j²\]), which is finite where the variance overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorLaw {
    /// E\[D^n\], n = 0 … 8.
    central: [f64; HIGHEST_MOMENT + 1],
    log_second: f64,
}

impl FactorLaw {
    /// The empty product: 1, surely.
    pub const ONE: Self = {
        let mut central = [0.0; HIGHEST_MOMENT + 1];
        central[0] = 1.0;
        Self { central, log_second: 0.0 }
    };

    /// Multiplies by an independent factor 1 + X with `moments[n − 2]` = E\[X^n\], n = 2 … 8, and E\[X\] = 0.
    pub fn multiply(&mut self, moments: &[f64; MOMENTS]) {
        let mut factor = [0.0; HIGHEST_MOMENT + 1];
        factor[0] = 1.0;
        factor[2..].copy_from_slice(moments);
        self.central = compound(&self.central, 1.0, 1.0, &factor);
        self.log_second += ln_1p(moments[0]);
    }

    /// E\[(Π − 1)^n\], n = 2 … 8.
    #[must_use]
    pub fn relative_central(&self) -> [f64; MOMENTS] {
        // ∞ − ∞: the highest power dominates, and it is infinite.
        std::array::from_fn(
            |i| if self.central[i + 2].is_nan() { f64::INFINITY } else { self.central[i + 2] },
        )
    }

    /// ln E\[Π²\].
    #[must_use]
    pub fn log_second(&self) -> f64 {
        self.log_second
    }

    /// ln Var(Π) = ln(exp(ln E\[Π²\]) − 1).
    #[must_use]
    pub fn log_relative_variance(&self) -> f64 {
        let log = self.log_second;
        if log > 1.0 { log + ln_1p(-exp(-log)) } else { ln(exp_m1(log)) }
    }
}

/// E\[V^n\], n = 0 … 8, of V = `slope` · D + X (`base` + D) for independent D and X with these moments about zero.
///
/// > E\[V^n\] = Σ_i C(n, i) slope^{n−i} E\[X^i\] Σ_l C(i, l) base^{i−l} E\[D^{n−i+l}\].
pub(crate) fn compound(
    d: &[f64; HIGHEST_MOMENT + 1],
    slope: f64,
    base: f64,
    x: &[f64; HIGHEST_MOMENT + 1],
) -> [f64; HIGHEST_MOMENT + 1] {
    let (slopes, bases) = (powers(slope), powers(base));
    std::array::from_fn(|n| {
        let of = |i: usize| {
            let inner: f64 = (0..=i).map(|l| BINOMIALS[i][l] * bases[i - l] * d[n - i + l]).sum();
            BINOMIALS[n][i] * slopes[n - i] * x[i] * inner
        };
        (0..=n).filter(|&i| x[i] != 0.0).map(of).sum()
    })
}

/// 1, x, …, x⁸.
pub(crate) fn powers(x: f64) -> [f64; HIGHEST_MOMENT + 1] {
    let mut power = 1.0;
    std::array::from_fn(|_| {
        let current = power;
        power *= x;
        current
    })
}

/// C(n, k) for n, k ≤ 8.
pub(crate) const BINOMIALS: [[f64; HIGHEST_MOMENT + 1]; HIGHEST_MOMENT + 1] = {
    let mut table = [[0.0; HIGHEST_MOMENT + 1]; HIGHEST_MOMENT + 1];
    let mut n = 0;
    while n <= HIGHEST_MOMENT {
        table[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// E\[X^n\] of ±h with equal probability.
    fn coin(h: f64) -> [f64; MOMENTS] {
        std::array::from_fn(|i| if i % 2 == 0 { h.powi(i as i32 + 2) } else { 0.0 })
    }

    #[test]
    fn three_coins_by_hand() {
        let sides = [0.3, 0.5, 0.9];
        let mut law = FactorLaw::ONE;
        sides.iter().for_each(|&h| law.multiply(&coin(h)));
        for (i, found) in law.relative_central().into_iter().enumerate() {
            let exact: f64 = (0..8_u32)
                .map(|outcome| {
                    let factor =
                        |k: usize| if outcome >> k & 1 == 1 { 1.0 + sides[k] } else { 1.0 - sides[k] };
                    (factor(0) * factor(1) * factor(2) - 1.0).powi(i as i32 + 2) / 8.0
                })
                .sum();
            assert_relative_eq!(found, exact, max_relative = 1e-13);
        }
        assert_relative_eq!(
            law.log_relative_variance(),
            law.relative_central()[0].ln(),
            max_relative = 1e-14
        );
    }

    #[test]
    fn a_tiny_variance_keeps_its_digits() {
        let mut law = FactorLaw::ONE;
        (0..1000).for_each(|_| law.multiply(&coin(1e-9)));
        let central = law.relative_central();
        // Nearly normal with the variance 1e-15.
        assert_relative_eq!(central[0], 1e-15, max_relative = 1e-12);
        assert_relative_eq!(central[2], 3e-30, max_relative = 2e-3);
        assert_relative_eq!(central[6], 105e-60, max_relative = 2e-2);
        assert_relative_eq!(law.log_relative_variance(), 1e-15_f64.ln(), max_relative = 1e-13);
    }

    #[test]
    fn what_overflows_is_infinite_and_its_logarithm_is_not() {
        let mut law = FactorLaw::ONE;
        (0..600).for_each(|_| law.multiply(&coin(2.0)));
        assert_eq!(law.relative_central()[6], f64::INFINITY);
        // 600 additions, each rounded.
        assert_relative_eq!(law.log_relative_variance(), 600.0 * 5.0_f64.ln(), max_relative = 1e-13);
    }
}
