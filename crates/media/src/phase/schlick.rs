//! Henyey and Greenstein's lobe without the root.

use super::{PhaseError, PhaseFunction};
use fairflight_elementary::ln_1p;
use std::f64::consts::PI;

/// eval = (1 − k²)/(4π (1 − kμ)²), −1 < k < 1, forward for k > 0 (blasi-1993; lafortune-1996 uses it).
///
/// As in [`HenyeyGreenstein`](super::HenyeyGreenstein), sums of terms of one sign: 1 − kμ = ((1 − k)(1 + μ) +
/// (1 + k)(1 − μ))/2. The distribution function is (1 − k)(1 + μ)/(2(1 − kμ)), a quotient of linear functions, so that with
/// d = 1 − k + 2ku = (1 − k)(1 − u) + (1 + k)u, μ = (2u + k − 1)/d is 1 + μ = 2u(1 + k)/d and 1 − μ = 2(1 − u)(1 − k)/d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    k: f64,
}

impl Schlick {
    /// The phase function of anisotropy `k` \[1\]; the mean cosine of a small k is 2k/3.
    ///
    /// # Errors
    /// If `k` is not strictly between −1 and 1: at the ends all directions are one.
    pub fn new(k: f64) -> Result<Self, PhaseError> {
        PhaseError::check_anisotropy("k", k)?;
        Ok(Self { k })
    }
}

/// Size of the parameter k from which on the mean cosine is computed by its closed form, and below by its series.
const LARGE: f64 = 0.5;

impl PhaseFunction for Schlick {
    #[inline(always)]
    fn eval(&self, cosine: f64) -> f64 {
        let cosine = cosine.clamp(-1.0, 1.0);
        let (back, front) = (1.0 - self.k, 1.0 + self.k);
        let root = 0.5 * (back * (1.0 + cosine) + front * (1.0 - cosine));
        back * front / (4.0 * PI * root * root)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        let (back, front) = ((1.0 - self.k) * (1.0 - u), (1.0 + self.k) * u);
        let d = back + front;
        let one_minus = 2.0 * (back / d);
        if one_minus < 1.0 { 1.0 - one_minus } else { 2.0 * (front / d) - 1.0 }
    }
    /// 1/k − (1 − k²) artanh(k)/k².
    ///
    /// The two terms cancel at small k. Expanding artanh k = Σ k^{2n+1}/(2n + 1) cancels 1/k symbolically and leaves
    /// Σ_{n ≥ 1} 2 k^{2n−1}/(4n² − 1) = 2k/3 + 2k³/15 + …, of one sign. Up to |k| = 1/2 it takes 25 terms; above, the
    /// closed form subtracts at most 1.65 from 2, which costs less than three bits.
    fn mean_cosine(&self) -> f64 {
        let k = self.k.abs();
        if k > LARGE {
            let artanh = 0.5 * ln_1p(2.0 * k / (1.0 - k));
            return (1.0 / k - (1.0 - k) * (1.0 + k) * artanh / (k * k)).copysign(self.k);
        }
        // Smallest terms first; the first one left out is 4^-26 of the sum.
        let sum = (1..=26).rev().fold(0.0, |sum, n| {
            let n = f64::from(n);
            sum * k * k + 2.0 / (4.0 * n * n - 1.0)
        });
        sum * self.k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGEST_VARIATE: f64 = 1.0 - f64::EPSILON / 2.0;

    // k and the mean cosine: mpmath with 60 digits, of the closed form.
    const MEANS: [(f64, f64); 10] = [
        (1e-300, 6.666666666666667e-301),
        (1e-07, 6.66666666666668e-08),
        (0.0001, 6.666666680000001e-05),
        (0.1, 0.06680057462351752),
        (0.5, 0.35208156699783544),
        (0.5000001, 0.3520816458876694),
        (0.7, 0.5258708793388426),
        (0.95, 0.8547383598351022),
        (0.999999, 0.9999864913219981),
        (0.9999999999, 0.9999999977281),
    ];

    #[test]
    fn the_mean_cosine_keeps_its_digits() {
        for (k, expected) in MEANS {
            let found = Schlick::new(k).unwrap().mean_cosine();
            assert!((found / expected - 1.0).abs() < 2e-15, "k = {k}: {found} for {expected}");
            assert_eq!(Schlick::new(-k).unwrap().mean_cosine(), -found);
        }
        assert_eq!(Schlick::new(0.0).unwrap().mean_cosine(), 0.0);
    }

    #[test]
    fn inversion_solves_the_distribution() {
        for k in [0.0, 1e-7, -1e-7, 1e-4, 0.5, -0.9, 0.999_999, -0.999_999] {
            let phase = Schlick::new(k).unwrap();
            for i in 0..1000 {
                let u = f64::from(i) / 1000.0;
                let mu = phase.sample_cosine(u);
                let distribution = (1.0 - k) * (1.0 + mu) / ((1.0 - k) * (1.0 + mu) + (1.0 + k) * (1.0 - mu));
                // The rounding of the cosine, seen through the density of the peak.
                let granted = 4.0 * f64::EPSILON * (1.0 + 2.0 * PI * phase.eval(mu));
                assert!((distribution - u).abs() <= granted, "k = {k}, u = {u}: {distribution}");
            }
            assert_eq!(phase.sample_cosine(0.0), -1.0);
            assert!((-1.0..=1.0).contains(&phase.sample_cosine(LARGEST_VARIATE)));
        }
    }

    #[test]
    fn values_by_hand() {
        let phase = Schlick::new(0.5).unwrap();
        assert!((phase.eval(1.0) * 4.0 * PI - 3.0).abs() < 1e-15);
        assert!((phase.eval(-1.0) * 4.0 * PI - 1.0 / 3.0).abs() < 1e-15);
        let narrow = Schlick::new(0.999_999).unwrap();
        let peak = (1.0 + 0.999_999) / (1.0 - 0.999_999) / (4.0 * PI);
        assert!((narrow.eval(1.0) / peak - 1.0).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_anisotropy_is_refused() {
        assert!(matches!(Schlick::new(1.0), Err(PhaseError::NotBelowOne { what: "k", .. })));
        assert!(matches!(Schlick::new(-1.5), Err(PhaseError::NotAboveMinusOne { .. })));
        assert!(matches!(Schlick::new(f64::NAN), Err(PhaseError::NotAboveMinusOne { .. })));
    }
}
