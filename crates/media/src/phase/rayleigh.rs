//! Particles much smaller than the wavelength.

use super::PhaseFunction;
use std::f64::consts::PI;

/// eval = 3/(16π) · (1 + μ²), unpolarised.
///
/// The distribution function of μ is (μ³ + 3μ + 4)/8. With z = 4u − 2 it is inverted by the root of f = μ³ + 3μ − 2|z| in \[0, 1\], to which Newton's steps go from a
/// polynomial that is right to 1 %. f is convex there: a relative error δ becomes δ² μ²/(1 + μ²) ≤ δ²/2, and is below 1e-18 after three. There is no
/// cube root and no cancellation, and the bits are the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rayleigh;

impl PhaseFunction for Rayleigh {
    #[inline(always)]
    fn eval(&self, cosine: f64) -> f64 {
        3.0 / (16.0 * PI) * (1.0 + cosine * cosine)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        const START: [f64; 3] = [0.6605, -0.0673, 0.0069];
        let z = 4.0 * u - 2.0;
        let (size, square) = (z.abs(), z * z);
        let mut mu = size * (START[0] + square * (START[1] + square * START[2]));
        for _ in 0..3 {
            let square = mu * mu;
            mu -= (mu * (square + 3.0) - 2.0 * size) / (3.0 * (square + 1.0));
        }
        if mu < 1.0 { mu } else { 1.0 }.copysign(z)
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
