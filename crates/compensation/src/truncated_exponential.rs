//! Distances within the bounding region in a medium that is taken for homogeneous (engelhardt-2013 eq. 4 and 5).

use fairflight_elementary::{exp, exp_m1, ln_1p};

/// The exponential distribution cut off at a length.
///
/// ```text
/// p(t)        = σ exp(−σt)/(1 − exp(−σR))                       (eq. 4)
/// t           = −ln(1 − ξ(1 − exp(−σR)))/σ                      (eq. 5)
/// P(t ≥ s)    = (exp(−σs) − exp(−σR))/(1 − exp(−σR))
/// ```
///
/// As printed they are 0/0 for σR → 0, where the limit is uniform: t = ξR, p = 1/R, P = 1 − s/R. Here they are written with
/// expm1 and ln_1p, which lose no digit on the way there; the limit is taken where σR is next to nothing. R may be infinite if σ > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedExponential {
    rate: f64,
    length: f64,
    /// 1 − exp(−σR).
    mass: f64,
}

/// Product of rate and length below which the law is uniform to the last digit, and products with variates (of 2⁻⁵³ and more) would
/// lose theirs.
const UNIFORM_BELOW: f64 = 1e-280;

impl TruncatedExponential {
    /// The law of `rate` ≥ 0 \[1/length\] within `length` > 0; one of them may make the product 0 or infinite, but not undefined.
    #[inline]
    #[must_use]
    pub fn new(rate: f64, length: f64) -> Self {
        debug_assert!(rate >= 0.0 && rate.is_finite() && length > 0.0, "rate {rate}, length {length}");
        debug_assert!(rate > 0.0 || length.is_finite(), "nothing ends an endless flight through nothing");
        Self { rate, length, mass: -exp_m1(-rate * length) }
    }

    /// The distance below which a share `u` of the mass lies, u in \[0, 1) \[length\].
    #[inline]
    #[must_use]
    pub fn sample(&self, u: f64) -> f64 {
        if self.mass < UNIFORM_BELOW {
            return u * self.length;
        }
        (-ln_1p(-u * self.mass) / self.rate).min(self.length)
    }

    /// The density of [`sample`](Self::sample) at a distance within the length \[1/length\].
    #[inline]
    #[must_use]
    pub fn pdf_distance(&self, distance: f64) -> f64 {
        if self.mass < UNIFORM_BELOW {
            return 1.0 / self.length;
        }
        self.rate * exp(-self.rate * distance) / self.mass
    }

    /// The probability of a distance of at least `distance` ≥ 0 \[1\].
    #[inline]
    #[must_use]
    pub fn probability_beyond(&self, distance: f64) -> f64 {
        if distance >= self.length {
            return 0.0;
        }
        if self.mass < UNIFORM_BELOW {
            return 1.0 - distance / self.length;
        }
        // exp(−σs)(1 − exp(−σ(R − s)))/(1 − exp(−σR)): nothing cancels.
        let rest = -exp_m1(-self.rate * (self.length - distance));
        exp(-self.rate * distance) * rest / self.mass
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_of_thin_and_thick_media() {
        // Hard case 17.
        for (rate, length) in [(0.0, 2.0), (1e-18, 1.0), (5e-324, 1.0), (1e-300, 1e-20), (0.5e-18, 2.0)] {
            let thin = TruncatedExponential::new(rate, length);
            for u in [0.0, 0.25, 0.5, 1.0 - 0.5 * f64::EPSILON] {
                assert!((thin.sample(u) - u * length).abs() <= 2e-16 * length, "{rate} {length} {u}");
            }
            assert!((thin.pdf_distance(0.3 * length) * length - 1.0).abs() < 1e-15);
            assert!((thin.probability_beyond(0.25 * length) - 0.75).abs() < 1e-15);
        }
        let thick = TruncatedExponential::new(1e3, 1.0);
        assert!((thick.sample(0.5) - 2f64.ln() / 1e3).abs() < 1e-18);
        assert_eq!(thick.probability_beyond(1.0), 0.0);
        assert!(thick.sample(1.0 - 0.5 * f64::EPSILON) < 0.04);
        let endless = TruncatedExponential::new(2.0, f64::INFINITY);
        assert!((endless.sample(0.5) - 0.5 * 2f64.ln()).abs() < 1e-16);
        assert!((endless.probability_beyond(1.0) - (-2f64).exp()).abs() < 1e-16);
        assert!((endless.pdf_distance(1.0) - 2.0 * (-2f64).exp()).abs() < 1e-16);
    }

    #[test]
    fn density_and_probability_belong_to_the_samples() {
        let law = TruncatedExponential::new(1.7, 0.9);
        let h = 1e-6;
        for i in 1..100 {
            let u = f64::from(i) / 100.0;
            let t = law.sample(u);
            assert!((law.probability_beyond(t) - (1.0 - u)).abs() < 1e-14, "{u}");
            let slope = (law.sample(u + h) - law.sample(u - h)) / (2.0 * h);
            assert!((slope * law.pdf_distance(t) - 1.0).abs() < 1e-8, "{u}");
        }
        assert_eq!(law.probability_beyond(0.0), 1.0);
    }
}
