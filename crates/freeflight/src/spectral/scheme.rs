//! How spectral tracking chooses between a collision and none, one decision for all wavelengths (kutz-2017).

use super::flight::magnitude;

/// What a collision and a null collision are chosen in proportion to.
///
/// A scheme changes the variance alone: for any probabilities that are positive where a weight is, the weights divide them
/// out.
pub trait Scheme {
    /// The sizes of "collides" and "does not", from the weights of the path and the ratios r_l = σ_l/σ_samp here.
    ///
    /// Both are at least 0; that of an event is 0 only if no wavelength with a weight takes part in it.
    fn sizes<const N: usize>(&self, weights: &[f64; N], ratios: &[f64; N]) -> [f64; 2];
}

/// max_l |r_l| and max_l |1 − r_l|, whatever the path has gone through.
///
/// One event multiplies the weight of any wavelength by at most their sum, 1 + r_max − r_min for ratios within \[0, 1\]. The
/// bound is one of each event: over many of them weights grow without one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaxScheme;

impl Scheme for MaxScheme {
    #[inline]
    fn sizes<const N: usize>(&self, _weights: &[f64; N], ratios: &[f64; N]) -> [f64; 2] {
        ratios.iter().fold([0.0, 0.0], |[collides, passes], r| {
            [f64::max(collides, r.abs()), f64::max(passes, (1.0 - r).abs())]
        })
    }
}

/// Σ_l |w_l r_l| and Σ_l |w_l (1 − r_l)|: the history-aware average.
///
/// For ratios within \[0, 1\] and weights of one sign both add up to Σ_l |w_l|, and the weights after the event,
/// w_l e_l Σ|w|/Σ|w e|, have the same sum as before: Σ_l w_l = N for ever, and no weight exceeds N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AverageScheme;

impl Scheme for AverageScheme {
    #[inline]
    fn sizes<const N: usize>(&self, weights: &[f64; N], ratios: &[f64; N]) -> [f64; 2] {
        let collides: [f64; N] = std::array::from_fn(|l| weights[l] * ratios[l]);
        let passes: [f64; N] = std::array::from_fn(|l| weights[l] * (1.0 - ratios[l]));
        [magnitude(&collides), magnitude(&passes)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_by_hand() {
        let ratios = [0.25, 1.5, 0.0];
        assert_eq!(MaxScheme.sizes(&[1.0, 9.0, 1.0], &ratios), [1.5, 1.0]);
        assert_eq!(AverageScheme.sizes(&[1.0, -2.0, 0.5], &ratios), [3.25, 2.25]);
    }
}
