//! Sobol's sequence, scrambled as Owen does, and shifted (sobol-1967, owen-1995, burley-2020, joe-2008).

use super::digits::bits_53;
use super::{PointSet, PointSetError};
use crate::Seeded;
use sobol_burley::NUM_DIMENSIONS;
use sobol_burley::parts::{owen_scramble_rev, sobol_rev};

/// Points that the direction numbers of the library reach: it uses the 16 low bits of an index.
const POINTS: u64 = 1 << 16;

/// Coordinate d of point i is Sobol's in 32 bits, its tree of digits permuted by a hash (nested uniform scrambling by
/// burley-2020, with the improved hash of `sobol_burley`), followed by 21 bits of the point's own, all combined with one
/// random 53-bit number of the coordinate by exclusive or.
///
/// **Law.** The hash has one of 2^32 keys and is a good imitation of Owen's scrambling, no proof of uniformity. The digital shift is:
/// whatever the number was, its exclusive or with 53 independent random bits is uniform on the lattice, and shifts
/// of different coordinates are independent.
///
/// **Order.** Both operations permute strata of 2^-k among themselves for every k ≤ 32: of any 2^k points that follow each other from a multiple of
/// 2^k on, one lies in each of 2^k strata of each coordinate; pairs and more form the digital nets of joe-2008.
///
/// **Variance.** Nested scrambling leaves the places within strata nearly independent: a mean of a smooth function of one variate
/// over n = 2^k points varies by ∫ f′²/(12 n³) (owen-1997). Of square-integrable functions of several variates by no more than a constant times
/// that of independent points.
///
/// Beyond 2^16 points and 256 dimensions, the limits of the library, variates are independent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sobol {
    /// The key of the hash and the shift of each coordinate.
    coordinates: Vec<(u32, u64)>,
    seed: u64,
}

impl Sobol {
    /// The sequence with this many ordered `dimensions`, for the replica `seed`.
    ///
    /// # Errors
    /// If there are more than 256 dimensions.
    pub fn new(dimensions: usize, seed: u64) -> Result<Self, PointSetError> {
        PointSetError::check_dimensions(NUM_DIMENSIONS as usize, dimensions)?;
        let mut source = Seeded::for_batch(seed, u64::MAX);
        let key = |source: &mut Seeded| (bits_53(source) >> 21) as u32;
        let coordinates = (0..dimensions).map(|_| (key(&mut source), bits_53(&mut source))).collect();
        Ok(Self { coordinates, seed })
    }
}

impl PointSet for Sobol {
    fn dimensions(&self) -> usize {
        self.coordinates.len()
    }
    fn points(&self) -> u64 {
        POINTS
    }
    fn seed(&self) -> u64 {
        self.seed
    }
    #[inline]
    fn coordinate(&self, index: u64, dimension: usize, filler: &mut Seeded) -> f64 {
        debug_assert!(index < POINTS, "the library repeats its points there");
        let (key, shift) = self.coordinates[dimension];
        // The library keeps its bits reversed, the first one behind the point last.
        let digits = sobol_rev((index as u32).reverse_bits(), dimension as u32);
        let scrambled = owen_scramble_rev(digits, key).reverse_bits();
        let number = (u64::from(scrambled) << 21) | (bits_53(filler) >> 32);
        (number ^ shift) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::UniformSource;

    /// One of 2^k points lies in each of the 2^k rectangles of every shape: the first two coordinates are a (0, k, 2)-net.
    #[test]
    fn the_first_two_coordinates_are_a_net() {
        const K: u32 = 6;
        for seed in 0..10 {
            let set = Sobol::new(2, seed).unwrap();
            for start in [0, 64, 640] {
                for wide in 0..=K {
                    let mut met = [0; 1 << K];
                    for index in start..start + (1 << K) {
                        let mut source = set.source(index);
                        let x = (source.next_uniform() * f64::from(1 << wide)) as usize;
                        let y = (source.next_uniform() * f64::from(1 << (K - wide))) as usize;
                        met[x << (K - wide) | y] += 1;
                    }
                    assert_eq!(met, [1; 1 << K], "seed {seed}, 2^{wide} columns");
                }
            }
        }
    }

    #[test]
    fn the_limits_of_the_library_are_ours() {
        assert!(Sobol::new(256, 1).is_ok());
        assert!(matches!(
            Sobol::new(257, 1),
            Err(PointSetError::TooManyDimensions { most: 256, found: 257 })
        ));
        // The last point is ordered, the next is not.
        let set = Sobol::new(1, 1).unwrap();
        let mut filler = set.filler(1 << 16);
        assert_eq!(set.source(1 << 16).next_uniform(), filler.next_uniform());
        assert_ne!(set.source((1 << 16) - 1).next_uniform(), set.filler((1 << 16) - 1).next_uniform());
    }
}
