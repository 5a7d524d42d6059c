//! One number between backward and forward.

use super::{PhaseError, PhaseFunction};
use std::f64::consts::PI;

/// eval = (1 − g²)/(4π (1 + g² − 2gμ)^{3/2}), −1 < g < 1, forward for g > 0 (henyey-1941 eq. 2). The mean cosine is g.
///
/// Every formula below is a sum of terms of one sign, for either sign of g, so that nothing cancels at g = 0, at |g| near
/// 1 or at the poles, and none divides by g:
///
/// * 1 + g² − 2gμ = ((1 − g)²(1 + μ) + (1 + g)²(1 − μ))/2.
/// * The usual inversion μ = (1 + g² − ((1 − g²)/d)²)/(2g), d = 1 − g + 2gu, leaves a rounding error of the order of ε/g:
///   in single precision the cosine is wrong by 0.1 at g = 1e-6, in double precision at 1e-15. Adding 1 completes a
///   difference of squares, (1 + g)² − ((1 − g²)/d)², whose factors contain 2g:
///   1 + μ = 2u (1 + g)² (1 − g + gu)/d². The reflection g → −g, u → 1 − u gives 1 − μ = 2(1 − u)(1 − g)² (1 + gu)/d².
/// * d = (1 − g)(1 − u) + (1 + g)u, 1 − g + gu = (1 − g)(1 − u) + u and 1 + gu = (1 − u) + (1 + g)u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    g: f64,
}

impl HenyeyGreenstein {
    /// The phase function with the mean cosine `g` \[1\].
    ///
    /// # Errors
    /// If `g` is not strictly between −1 and 1: at the ends all directions are one.
    pub fn new(g: f64) -> Result<Self, PhaseError> {
        PhaseError::check_anisotropy("g", g)?;
        Ok(Self { g })
    }
}

impl PhaseFunction for HenyeyGreenstein {
    #[inline(always)]
    fn eval(&self, cosine: f64) -> f64 {
        // A scalar product of unit vectors may be 1 + 1e-16, which the peak of |g| near 1 would notice.
        let cosine = cosine.clamp(-1.0, 1.0);
        let (back, front) = (1.0 - self.g, 1.0 + self.g);
        let square = 0.5 * (back * back * (1.0 + cosine) + front * front * (1.0 - cosine));
        back * front / (4.0 * PI * square * square.sqrt())
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        let (back, front, rest) = (1.0 - self.g, 1.0 + self.g, 1.0 - u);
        let d = back * rest + front * u;
        let one_minus = 2.0 * rest * (back / d) * (back / d) * (rest + front * u);
        if one_minus < 1.0 {
            return 1.0 - one_minus;
        }
        2.0 * u * (front / d) * (front / d) * (back * rest + u) - 1.0
    }
    fn mean_cosine(&self) -> f64 {
        self.g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGEST_VARIATE: f64 = 1.0 - f64::EPSILON / 2.0;

    // g, u and the cosine: mpmath with 60 digits, of the usual formula.
    const COSINES: [(f64, f64, f64); 12] = [
        (0.0, 0.3, -0.4),
        (1e-07, 0.3, -0.3999998739999933),
        (1e-07, 0.8, 0.6000000959999924),
        (-1e-07, 0.3, -0.4000001259999933),
        (0.0001, 0.1, -0.799945994239604),
        (0.0001, 0.9, 0.800053994240396),
        (-0.0001, 0.9, 0.799945994239604),
        (0.999999, 1e-06, 0.7777774814731094),
        (0.999999, 0.5, 0.9999999999985),
        (0.999999, 0.999, 0.999999999999999),
        (-0.999999, 0.5, -0.9999999999985),
        (-0.999999, 0.999999, -0.7777774814816296),
    ];
    // g, cosine and the phase function, likewise.
    const VALUES: [(f64, f64, f64); 8] = [
        (0.0, 0.3, 0.07957747154594767),
        (1e-07, -1.0, 0.07957744767271019),
        (0.5, 0.25, 0.05968310365946075),
        (0.999999, 1.0, 159154863505.27057),
        (0.999999, 0.999999999999, 30630075980.934223),
        (0.999999, -1.0, 1.98943877814418e-08),
        (-0.999999, -1.0, 159154863505.27057),
        (-0.999999, -0.9999999, 1779.3947939163845),
    ];

    #[test]
    fn cosines_of_every_anisotropy() {
        for (g, u, expected) in COSINES {
            let found = HenyeyGreenstein::new(g).unwrap().sample_cosine(u);
            // Relative to the nearer pole, since that is what the peak resolves.
            let granted = f64::EPSILON * (1.0 + 8.0 * (1.0 - expected).min(1.0));
            assert!((found - expected).abs() <= granted, "g {g}, u {u}: {found} for {expected}");
        }
    }

    #[test]
    fn values_of_every_anisotropy() {
        for (g, cosine, expected) in VALUES {
            let found = HenyeyGreenstein::new(g).unwrap().eval(cosine);
            assert!(
                (found / expected - 1.0).abs() < 2e-15,
                "g {g}, cosine {cosine}: {found:e} for {expected:e}"
            );
        }
    }

    #[test]
    fn both_ends_of_the_variates_are_poles() {
        for g in
            [0.0, 1e-300, 1e-7, -1e-7, 0.5, -0.5, 0.999_999, -0.999_999, LARGEST_VARIATE, -LARGEST_VARIATE]
        {
            let phase = HenyeyGreenstein::new(g).unwrap();
            assert_eq!(phase.sample_cosine(0.0), -1.0);
            for u in [f64::MIN_POSITIVE, 0.5 * f64::EPSILON, 0.25, 0.5, 0.75, LARGEST_VARIATE] {
                let cosine = phase.sample_cosine(u);
                assert!((-1.0..=1.0).contains(&cosine), "g {g}, u {u}: {cosine}");
                assert_eq!(HenyeyGreenstein::new(-g).unwrap().eval(-cosine), phase.eval(cosine));
            }
        }
    }

    #[test]
    fn cosines_increase_with_the_variate() {
        for g in [-0.999_999, -0.3, 0.0, 1e-7, 0.8, 0.999_999] {
            let phase = HenyeyGreenstein::new(g).unwrap();
            let cosines: Vec<f64> = (0..2000).map(|i| phase.sample_cosine(f64::from(i) / 2000.0)).collect();
            assert!(cosines.windows(2).all(|pair| pair[0] <= pair[1]), "g = {g}");
        }
    }

    #[test]
    fn what_is_no_anisotropy_is_refused() {
        assert!(matches!(HenyeyGreenstein::new(1.0), Err(PhaseError::NotBelowOne { .. })));
        assert!(matches!(HenyeyGreenstein::new(f64::INFINITY), Err(PhaseError::NotBelowOne { .. })));
        assert!(matches!(HenyeyGreenstein::new(-1.0), Err(PhaseError::NotAboveMinusOne { .. })));
        assert!(matches!(HenyeyGreenstein::new(f64::NAN), Err(PhaseError::NotAboveMinusOne { .. })));
        assert_eq!(HenyeyGreenstein::new(2.0).unwrap_err().to_string(), "g must be below 1, found 2");
    }
}
