//! Halton's sequence: the radical inverses of the index in prime bases, randomly scrambled (halton-1960, matousek-1998).

use super::digits::{below, bits_53, within};
use super::{PointSet, PointSetError};
use crate::Seeded;

/// The most coordinates: of bases beyond the 64th prime too many points are wanted for any order to show.
pub(super) const DIMENSIONS: usize = 64;

/// The first 64 primes.
const PRIMES: [u32; DIMENSIONS] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103,
    107, 109, 113, 127, 131, 137, 139, 149, 151, 157, 163, 167, 173, 179, 181, 191, 193, 197, 199, 211, 223,
    227, 229, 233, 239, 241, 251, 257, 263, 269, 271, 277, 281, 283, 293, 307, 311,
];

/// Points that are told apart; b^K below is at least that for every base.
const POINTS: u64 = 1 << 32;

/// Coordinate d of point i has the digits of i in the base of the d-th prime b, the least significant first behind the point, each
/// replaced by (m d + a) mod b with m ≠ 0 and a random for each position: a random linear digit scrambling.
///
/// ```text
/// i = Σ_k d_k b^k,   u = Σ_{k<K} ((m_k d_k + a_k) mod b) b^(−k − 1) + jitter b^(−K),   b^K ≥ 2^32
/// ```
///
/// **Law.** a_k is uniform below b and independent of all else, hence every scrambled digit is uniform and independent of the others,
/// the first K digits are a uniform integer below b^K, and with the point's own jitter u is uniform on the lattice, exactly.
/// Coordinates have numbers m, a of their own: independent.
///
/// **Order.** m_k is no multiple of the prime b, so that a position is permuted: of any b^k points that follow each other from a multiple
/// of b^k on, one lies in each of b^k strata. The multipliers break up the lines on which the unscrambled points of two large
/// bases lie. Multipliers of the first base are all 1.
///
/// **Variance.** The scrambling is one for all points: those of b^k points have, up to jitter below 2^-32, one common offset
/// within their strata. A mean of f over them varies by (f(1) − f(0))²/(12 n²), not by n^-3 as with nested scrambling.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Halton {
    bases: Vec<Base>,
    seed: u64,
}

/// One coordinate.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Base {
    base: u32,
    /// b^K.
    strata: u64,
    /// (m_k, a_k), k < K.
    positions: Vec<(u32, u32)>,
}

impl Base {
    fn new(base: u32, source: &mut Seeded) -> Self {
        let (mut strata, mut positions) = (1, Vec::new());
        while strata < POINTS {
            strata *= u64::from(base);
            let multiplier = 1 + below(u64::from(base) - 1, source) as u32;
            positions.push((multiplier, below(u64::from(base), source) as u32));
        }
        Self { base, strata, positions }
    }

    #[inline]
    fn coordinate(&self, index: u64, inside: u64) -> f64 {
        // An index of 2^32 and more never gets here: what is left of it after K digits is 0.
        let (mut left, mut inverse) = (index, 0_u64);
        let base = u64::from(self.base);
        for &(multiplier, addend) in &self.positions {
            let digit = (u64::from(multiplier) * (left % base) + u64::from(addend)) % base;
            left /= base;
            inverse = inverse * base + digit;
        }
        within(inverse, self.strata, inside)
    }
}

impl Halton {
    /// The sequence with this many ordered `dimensions`, for the replica `seed`.
    ///
    /// # Errors
    /// If there are more than 64 dimensions.
    pub fn new(dimensions: usize, seed: u64) -> Result<Self, PointSetError> {
        PointSetError::check_dimensions(DIMENSIONS, dimensions)?;
        let mut source = Seeded::for_batch(seed, u64::MAX);
        let bases = PRIMES[..dimensions].iter().map(|&base| Base::new(base, &mut source)).collect();
        Ok(Self { bases, seed })
    }
}

impl PointSet for Halton {
    fn dimensions(&self) -> usize {
        self.bases.len()
    }
    fn points(&self) -> u64 {
        POINTS
    }
    fn seed(&self) -> u64 {
        self.seed
    }
    #[inline]
    fn coordinate(&self, index: u64, dimension: usize, filler: &mut Seeded) -> f64 {
        self.bases[dimension].coordinate(index, bits_53(filler))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_scrambling_it_is_the_radical_inverse() {
        let plain = |base: u32| Base {
            positions: vec![(1, 0); Base::new(base, &mut Seeded::new(1)).positions.len()],
            ..Base::new(base, &mut Seeded::new(1))
        };
        let of = |base: u32| [0, 1, 2, 3, 4].map(|i| plain(base).coordinate(i, 0));
        assert_eq!(of(2), [0.0, 0.5, 0.25, 0.75, 0.125]);
        for (found, exact) in of(3).into_iter().zip([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0 / 9.0, 4.0 / 9.0]) {
            assert!((found - exact).abs() < 1e-15, "{found} for {exact}");
        }
    }

    #[test]
    fn bases_are_the_first_primes() {
        let is_prime = |n: u32| (2..n).all(|d| !n.is_multiple_of(d));
        let primes: Vec<u32> = (2..=311).filter(|&n| is_prime(n)).collect();
        assert_eq!(PRIMES.to_vec(), primes);
        assert!(matches!(Halton::new(65, 1), Err(PointSetError::TooManyDimensions { most: 64, found: 65 })));
    }
}
