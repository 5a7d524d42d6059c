//! Particles much smaller than the wavelength.

use super::PhaseFunction;
use std::f64::consts::PI;

/// eval = 3/(16π) · (1 + μ²), unpolarised.
///
/// The distribution function of μ is (μ³ + 3μ + 4)/8; solving μ³ + 3μ = 2z with z = 4u − 2 by Cardano's formula gives
/// μ = A − 1/A, A = ∛(z + √(z² + 1)), written for |z| so that nothing cancels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rayleigh;

impl PhaseFunction for Rayleigh {
    #[inline]
    fn eval(&self, cosine: f64) -> f64 {
        3.0 / (16.0 * PI) * (1.0 + cosine * cosine)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        let z = 4.0 * u - 2.0;
        let a = (z.abs() + (z * z + 1.0).sqrt()).cbrt();
        (a - 1.0 / a).min(1.0).copysign(z)
    }
    fn mean_cosine(&self) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inversion_solves_the_cubic() {
        for i in 0..=1000 {
            let u = f64::from(i) / 1000.0;
            let mu = Rayleigh.sample_cosine(u);
            let distribution = (mu * mu * mu + 3.0 * mu + 4.0) / 8.0;
            assert!((distribution - u).abs() < 4e-16 && mu.abs() <= 1.0, "u = {u}: {distribution}");
        }
        assert_eq!(Rayleigh.sample_cosine(0.0), -1.0);
    }

    #[test]
    fn values_by_hand() {
        for (cosine, value) in [(0.0, 3.0), (0.5, 3.75), (-1.0, 6.0)] {
            assert!((Rayleigh.eval(cosine) * 16.0 * PI - value).abs() < 1e-14);
        }
    }
}
