//! Products of very many factors and sums of such, without under- or overflow.

use fairflight_elementary::{exp, ln};

/// A product, or a sum of products, kept as mantissa · 2^(128 · scale).
///
/// A walk of a million collisions multiplies a million weights; as a plain double the product is 0 or infinite long before
/// the control's transmittance brings it back. The usual cure, sign and logarithm, costs a logarithm per collision;
/// here the exponent is split off only when the mantissa leaves \[2^-128, 2^128\], which is one comparison per collision. Every operation
/// rounds as that on plain doubles does where those neither over- nor underflow: the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedProduct {
    pub(crate) mantissa: f64,
    pub(crate) scale: i64,
}

const STEP: i32 = 128;
const LARGE: f64 = (1_u128 << 127) as f64 * 2.0;
const SMALL: f64 = 1.0 / LARGE;

impl SignedProduct {
    /// The empty product.
    pub const ONE: Self = Self { mantissa: 1.0, scale: 0 };

    /// A number as it is.
    #[inline]
    #[must_use]
    pub fn of(value: f64) -> Self {
        let mut product = Self::ONE;
        product.multiply(value);
        product
    }

    /// exp(`exponent`), also where that is no number of double precision.
    #[must_use]
    pub fn exp(exponent: f64) -> Self {
        let scale = (exponent / (f64::from(STEP) * std::f64::consts::LN_2)).round();
        let rest = exponent - scale * f64::from(STEP) * std::f64::consts::LN_2;
        Self { mantissa: exp(rest), scale: scale as i64 }
    }

    /// Quotient of this product over another, rounded once: 0 or infinite only where the quotient is. The other must not be 0.
    #[inline]
    #[must_use]
    pub fn over(&self, other: &Self) -> f64 {
        let quotient = self.mantissa / other.mantissa;
        match self.scale - other.scale {
            0 => quotient,
            // 2^±1152 is out of range, but not before it has met a quotient within 2^±257.
            scale => {
                let half = 2.0_f64.powi(STEP / 2 * scale.clamp(-12, 12) as i32);
                quotient * half * half
            }
        }
    }

    /// The number itself, rounded once: 0 or infinite only where it is beyond the range of double precision.
    #[inline]
    #[must_use]
    pub fn value(&self) -> f64 {
        self.over(&Self::ONE)
    }

    /// True of a mantissa within its range.
    #[inline(always)]
    pub(crate) fn keeps_scale(mantissa: f64) -> bool {
        (SMALL..=LARGE).contains(&mantissa.abs())
    }

    /// A word whose highest bit tells that [`keeps_scale`](Self::keeps_scale) is false, by differences of bits: those of lanes are cheaper to unite
    /// than comparisons.
    #[inline(always)]
    pub(crate) fn beyond_scale(mantissa: f64) -> u64 {
        let bits = mantissa.abs().to_bits();
        bits.wrapping_sub(SMALL.to_bits()) | LARGE.to_bits().wrapping_sub(bits)
    }

    /// Multiplies by a number.
    #[inline]
    pub fn multiply(&mut self, factor: f64) {
        let product = self.mantissa * factor;
        if Self::keeps_scale(product) {
            self.mantissa = product;
        } else {
            self.multiply_far(factor);
        }
    }

    /// The product with another one.
    #[inline]
    #[must_use]
    pub fn times(mut self, other: &Self) -> Self {
        self.scale += other.scale;
        self.multiply(other.mantissa);
        self
    }

    /// Adds another one.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        let sum = self.mantissa + other.mantissa;
        if self.scale == other.scale && (SMALL..=LARGE).contains(&sum.abs()) {
            self.mantissa = sum;
        } else {
            self.add_far(other);
        }
    }

    /// Multiplies where the mantissa leaves its range. A factor near either end of double precision is first brought to its middle, so that
    /// the product of the two can neither over- nor underflow: all but that product are shifts of the exponent.
    #[cold]
    fn multiply_far(&mut self, mut factor: f64) {
        if factor.abs() > LARGE && factor.is_finite() {
            factor *= SMALL;
            self.scale += 1;
        } else if factor != 0.0 && factor.abs() < SMALL {
            factor *= LARGE;
            self.scale -= 1;
        }
        self.mantissa *= factor;
        self.rescale();
    }

    /// Adds where the scales differ, or the sum leaves the range of a mantissa. A summand 2^1280 below the other is far below its rounding.
    #[cold]
    fn add_far(&mut self, other: &Self) {
        // A zero has no scale of its own.
        if other.mantissa == 0.0 {
            return;
        }
        if self.mantissa == 0.0 {
            *self = *other;
            return;
        }
        let (large, small) = if self.scale >= other.scale { (*self, *other) } else { (*other, *self) };
        let apart = (large.scale - small.scale).min(10) as i32;
        let shift = 2.0_f64.powi(-STEP / 2 * apart);
        *self = Self { mantissa: large.mantissa + small.mantissa * shift * shift, scale: large.scale };
        self.rescale();
    }

    fn rescale(&mut self) {
        // A zero stays zero; NaN and infinity stay what they are, for the caller to find.
        while self.mantissa != 0.0 && self.mantissa.abs() < SMALL {
            self.mantissa *= LARGE;
            self.scale -= 1;
        }
        while self.mantissa.is_finite() && self.mantissa.abs() > LARGE {
            self.mantissa *= SMALL;
            self.scale += 1;
        }
    }

    /// The product times exp(`exponent`), rounded once: 0 only where the result itself underflows.
    #[inline]
    #[must_use]
    pub fn times_exp(&self, exponent: f64) -> f64 {
        self.times_known_exp(exponent, exp(exponent))
    }

    /// The same where exp(`exponent`) is known.
    #[inline]
    pub(crate) fn times_known_exp(&self, exponent: f64, known: f64) -> f64 {
        if self.scale == 0 && exponent.abs() < 500.0 {
            return self.mantissa * known;
        }
        self.times_exp_far(exponent)
    }

    #[cold]
    #[inline(never)]
    fn times_exp_far(&self, exponent: f64) -> f64 {
        self.sign() * exp(self.ln_abs() + exponent)
    }

    /// −1, 0 or 1; NaN for NaN.
    #[must_use]
    pub fn sign(&self) -> f64 {
        if self.mantissa == 0.0 { 0.0 } else { self.mantissa.signum() }
    }

    /// The natural logarithm of the magnitude; −∞ for 0.
    #[must_use]
    pub fn ln_abs(&self) -> f64 {
        let scale = self.scale as f64 * f64::from(STEP) * std::f64::consts::LN_2;
        ln(self.mantissa.abs()) + scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_factors_keep_sign_and_logarithm() {
        // Hard case 20.
        let mut product = SignedProduct::ONE;
        for _ in 0..1_000_001 {
            product.multiply(-0.5);
        }
        assert_eq!(product.sign(), -1.0);
        let exact = -1_000_001.0 * std::f64::consts::LN_2;
        assert!((product.ln_abs() / exact - 1.0).abs() < 1e-15);
        assert!((product.times_exp(-exact) + 1.0).abs() < 1e-9);
    }

    #[test]
    fn growth_and_decay_cancel() {
        let mut product = SignedProduct::ONE;
        for _ in 0..5000 {
            product.multiply(3.0);
        }
        let back = product.times_exp(-5000.0 * 3.0_f64.ln());
        assert!((back - 1.0).abs() < 1e-11);
        // By exponents of any size, also where only the product is beyond the range of numbers.
        for (product, exponent) in [(600.0, -300.0), (-900.0, 450.0), (2.0, 3.0), (30.0, 600.0)] {
            let found = SignedProduct::exp(product).times_exp(exponent);
            assert!(
                (found / f64::exp(product + exponent) - 1.0).abs() < 1e-12,
                "{product} {exponent}: {found}"
            );
        }
    }

    #[test]
    fn exponentials_and_quotients_beyond_the_range_of_numbers() {
        for exponent in [-5000.0, -700.0, -44.4, 0.0, 1e-3, 300.0, 9000.0] {
            let product = SignedProduct::exp(exponent);
            assert!(
                (product.ln_abs() - exponent).abs() <= 4.0 * f64::EPSILON * (1.0 + exponent.abs()),
                "{exponent}"
            );
            assert_eq!(product.over(&product), 1.0);
            let more = SignedProduct::exp(exponent + 100.0).over(&product);
            assert!((more / 100.0_f64.exp() - 1.0).abs() < 1e-11, "{exponent}: {more}");
        }
        let large = SignedProduct::exp(5000.0);
        assert_eq!((large.over(&SignedProduct::ONE), SignedProduct::ONE.over(&large)), (f64::INFINITY, 0.0));
    }

    #[test]
    fn any_number_is_a_factor() {
        let ends = [f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e200, -1e-200, -3.0, 0.7];
        for a in ends {
            assert_eq!(SignedProduct::of(a).value(), a);
            for b in ends {
                // Back to where it was, though a b is no number.
                let mut product = SignedProduct::of(a);
                product.multiply(b);
                assert_eq!(product.sign(), (a * b.signum()).signum());
                let [ln_a, ln_b] = [a, b].map(|x| x.abs().ln());
                let rounding = 4.0 * f64::EPSILON * (1.0 + ln_a.abs() + ln_b.abs());
                assert!((product.ln_abs() - ln_a - ln_b).abs() <= rounding, "{a:e} {b:e}");
                let both = SignedProduct::of(a).times(&SignedProduct::of(b));
                assert!((both.over(&product) - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn sums_of_products_beyond_the_range_of_numbers() {
        let (huge, tiny) = (SignedProduct::exp(5000.0), SignedProduct::exp(-5000.0));
        let mut sum = huge;
        sum.add(&tiny);
        assert_eq!(sum, huge);
        let mut sum = tiny;
        sum.add(&huge);
        assert_eq!(sum, huge);
        // e^5000 twice, twice taken off, and what is added to nothing.
        let mut sum = huge;
        for factor in [1.0, -1.0, -1.0, 2.0_f64.powi(-40)] {
            let mut term = huge;
            term.multiply(factor);
            sum.add(&term);
        }
        assert_eq!(sum.over(&huge), 2.0_f64.powi(-40));
        // As plain numbers where those suffice.
        let terms = [1e-30, 3.0, -2.9999, 1e20, 7.0, -1e20, 0.0];
        let mut sum = SignedProduct::of(0.0);
        terms.iter().for_each(|&term| sum.add(&SignedProduct::of(term)));
        assert_eq!(sum.value(), terms.iter().sum::<f64>());
        sum.add(&SignedProduct::of(f64::NAN));
        assert!(sum.value().is_nan());
    }

    #[test]
    fn two_ways_to_see_the_range_of_a_mantissa() {
        let edges = [SMALL, SMALL.next_down(), LARGE, LARGE.next_up(), 0.0, 1.0, f64::NAN, f64::INFINITY];
        for mantissa in edges.into_iter().flat_map(|edge| [edge, -edge]) {
            let beyond = SignedProduct::beyond_scale(mantissa) >> 63 == 1;
            assert_eq!(beyond, !SignedProduct::keeps_scale(mantissa), "{mantissa:e}");
        }
    }

    #[test]
    fn zero_stays_zero_and_nan_is_not_hidden() {
        let mut product = SignedProduct::ONE;
        product.multiply(0.0);
        product.multiply(5.0);
        assert_eq!(product.times_exp(700.0), 0.0);
        product.multiply(f64::NAN);
        assert!(product.times_exp(0.0).is_nan());
    }
}
