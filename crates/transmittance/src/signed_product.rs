//! A product of very many factors, without under- or overflow.

/// A product kept as mantissa · 2^(128 · scale).
///
/// A walk of a million collisions multiplies a million weights; as a plain double the product is 0 or infinite long before
/// the control's transmittance brings it back. The usual cure, sign and logarithm, costs a logarithm per collision;
/// here the exponent is split off only when the mantissa leaves \[2^-128, 2^128\], which is one comparison per collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedProduct {
    mantissa: f64,
    scale: i64,
}

const STEP: i32 = 128;
const LARGE: f64 = (1_u128 << 127) as f64 * 2.0;
const SMALL: f64 = 1.0 / LARGE;

impl SignedProduct {
    /// The empty product.
    pub const ONE: Self = Self { mantissa: 1.0, scale: 0 };

    /// exp(`exponent`), also where that is no number of double precision.
    #[must_use]
    pub fn exp(exponent: f64) -> Self {
        let scale = (exponent / (f64::from(STEP) * std::f64::consts::LN_2)).round();
        let rest = exponent - scale * f64::from(STEP) * std::f64::consts::LN_2;
        Self { mantissa: rest.exp(), scale: scale as i64 }
    }

    /// This product over another, rounded once: 0 or infinite only where the quotient is. The other must not be 0.
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

    /// Multiplies by a factor of magnitude below 2^895.
    #[inline]
    pub fn multiply(&mut self, factor: f64) {
        self.mantissa *= factor;
        let magnitude = self.mantissa.abs();
        if !(SMALL..=LARGE).contains(&magnitude) {
            self.rescale();
        }
    }

    #[cold]
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
        if self.scale == 0 && exponent.abs() < 500.0 {
            return self.mantissa * exponent.exp();
        }
        self.sign() * (self.ln_abs() + exponent).exp()
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
        self.mantissa.abs().ln() + scale
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
    fn zero_stays_zero_and_nan_is_not_hidden() {
        let mut product = SignedProduct::ONE;
        product.multiply(0.0);
        product.multiply(5.0);
        assert_eq!(product.times_exp(700.0), 0.0);
        product.multiply(f64::NAN);
        assert!(product.times_exp(0.0).is_nan());
    }
}
