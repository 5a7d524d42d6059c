//! The law of a free flight that counts for several wavelengths.

use crate::Flight;
use fairflight_media::SpectralExtinction;
use fairflight_sources::UniformSource;

/// Where a flight of N wavelengths ended: all at one place, each with a weight of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectralFlight<const N: usize> {
    /// At a collision with matter inside the profile.
    Collided {
        /// The distance from the start of the profile \[length\].
        distance: f64,
        /// What the flight counts for each wavelength.
        weights: [f64; N],
    },
    /// At the end of the profile.
    Escaped {
        /// What the flight counts for each wavelength.
        weights: [f64; N],
    },
}

impl<const N: usize> SpectralFlight<N> {
    /// The weights, wherever the flight ended.
    #[inline]
    #[must_use]
    pub fn weights(&self) -> [f64; N] {
        match *self {
            Self::Collided { weights, .. } | Self::Escaped { weights } => weights,
        }
    }

    /// What the flight is for one of its wavelengths.
    #[inline]
    #[must_use]
    pub fn of(&self, wavelength: usize) -> Flight {
        match *self {
            Self::Collided { distance, weights } => {
                Flight::Collided { distance, weight: weights[wavelength] }
            }
            Self::Escaped { weights } => Flight::Escaped { weight: weights[wavelength] },
        }
    }
}

/// A sampler of one distance for N wavelengths.
///
/// **Law.** For every field whose values [`admits`](Self::admits) accepts, for each wavelength l with
/// T_l(s) = exp(−∫_0^s σ_l), and for every bounded test function g,
///
/// > E\[1{collided} · weight_l · g(distance)\] = ∫_0^length σ_l(s) T_l(s) g(s) ds,   E\[1{escaped} · weight_l\] = T_l(length).
///
/// It is the law of [`crate::FreeFlight`] for each wavelength by itself. Weights of one flight depend on each other.
pub trait SpectralFreeFlight<F: SpectralExtinction<N>, const N: usize> {
    /// Draws one flight of a path that came with the weights `past`, not all 0; they multiply the law. A sampler that
    /// decides by the whole path (the average scheme, the hero wavelength) decides by them, so that its bound is one of the
    /// path and not one per flight.
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N>;

    /// Draws one flight from the start of the profile, of a path that begins here.
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> SpectralFlight<N> {
        self.sample_from(field, [1.0; N], source)
    }

    /// Whether the sampler is defined where σ_t has these values at the distance `s`.
    fn admits(&self, field: &F, s: f64, sigma_t: &[f64; N]) -> bool;
}

impl<F: SpectralExtinction<N>, E: SpectralFreeFlight<F, N>, const N: usize> SpectralFreeFlight<F, N> for &E {
    #[inline]
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        (**self).sample_from(field, past, source)
    }
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: &[f64; N]) -> bool {
        (**self).admits(field, s, sigma_t)
    }
}

/// Σ_l |w_l|.
#[inline]
pub(super) fn magnitude<const N: usize>(weights: &[f64; N]) -> f64 {
    weights.iter().map(|weight| weight.abs()).sum()
}

/// Weights as a sampler reckons with them, and the unit that they are in: 1, but for a path whose weights are near either end of the
/// range, where their products with probabilities would under- or overflow and shares of a sum be 0/0.
#[inline]
pub(super) fn centred<const N: usize>(weights: [f64; N]) -> ([f64; N], f64) {
    const FAR: f64 = {
        let step = (1_u128 << 127) as f64;
        step * step * step * step
    };
    let size = magnitude(&weights);
    // A power of two, 2^±508: exact, also back, but for what is denormal.
    let unit = match size {
        _ if size > FAR => FAR,
        _ if size > 0.0 && size * FAR < 1.0 => 1.0 / FAR,
        _ => return (weights, 1.0),
    };
    (weights.map(|weight| weight / unit), unit)
}

/// The index l with probability |w_l|/Σ|w|, from one variate.
#[inline]
pub(super) fn pick<const N: usize>(weights: &[f64; N], source: &mut impl UniformSource) -> usize {
    let mut left = source.next_uniform() * magnitude(weights);
    let mut last = 0;
    for (l, weight) in weights.iter().enumerate() {
        // A weight of 0 is never picked, also not by what rounding leaves at the end.
        if *weight != 0.0 {
            last = l;
            left -= weight.abs();
            if left < 0.0 {
                break;
            }
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::{LARGEST_VARIATE, Scripted};

    #[test]
    fn picks_are_proportional_and_never_nothing() {
        let picked = |weights: [f64; 3], u: f64| pick(&weights, &mut Scripted::new([u]));
        assert_eq!([0.0, 0.33, 0.34, 0.67, LARGEST_VARIATE].map(|u| picked([1.0; 3], u)), [0, 0, 1, 2, 2]);
        assert_eq!([0.0, 0.9, LARGEST_VARIATE].map(|u| picked([0.0, -3.0, 0.0], u)), [1; 3]);
        assert_eq!(picked([0.1, 0.2, 0.0], LARGEST_VARIATE), 1);
    }

    /// u lies in [0, 1/4) for the first of 1 and 3: the border belongs to the second.
    #[test]
    fn the_border_belongs_to_the_next() {
        let picked = |u: f64| pick(&[1.0, 3.0], &mut Scripted::new([u]));
        assert_eq!([0.25 - 2f64.powi(-53), 0.25].map(picked), [0, 1]);
    }
}
