//! Hammersley's points: Halton's, with the index itself as the first coordinate (hammersley-1960).

use super::digits::{below, bits_53, within};
use super::halton::{self, Halton};
use super::{PointSet, PointSetError};
use crate::Seeded;

/// N points: coordinate 0 of point i is (((i + c) mod N) + jitter)/N with one random c, the others are those of [`Halton`].
///
/// **Law.** c is uniform below N, so that the stratum of a given point is; with its jitter the coordinate is uniform, and independent
/// of the others, which know nothing of c. Without c point 0 would always come first: a bias of each estimate by itself.
///
/// **Order.** Coordinate 0 has one point in each of N strata; the others are ordered as Halton's. Where the cyclic c
/// passes from the last stratum to the first, the order of the pairs (coordinate 0, another) is that of two sets of points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hammersley {
    halton: Halton,
    points: u64,
    dimensions: usize,
    start: u64,
}

impl Hammersley {
    /// `points` points with this many ordered `dimensions`, the first among them, for the replica `seed`.
    ///
    /// # Errors
    /// If there are no points, more than 2^32, or more than 65 dimensions.
    pub fn new(points: u64, dimensions: usize, seed: u64) -> Result<Self, PointSetError> {
        PointSetError::check_points(1 << 32, points)?;
        PointSetError::check_dimensions(halton::DIMENSIONS + 1, dimensions)?;
        let halton = Halton::new(dimensions.saturating_sub(1), seed)?;
        // A stream that no point has: their indices lie below 2^32, and Halton's own takes the last.
        let start = below(points, &mut Seeded::for_batch(seed, u64::MAX - 1));
        Ok(Self { halton, points, dimensions, start })
    }
}

impl PointSet for Hammersley {
    fn dimensions(&self) -> usize {
        self.dimensions
    }
    fn points(&self) -> u64 {
        self.points
    }
    fn seed(&self) -> u64 {
        self.halton.seed()
    }
    #[inline]
    fn coordinate(&self, index: u64, dimension: usize, filler: &mut Seeded) -> f64 {
        match dimension {
            0 => within((index + self.start) % self.points, self.points, bits_53(filler)),
            _ => self.halton.coordinate(index, dimension - 1, filler),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_start_is_any_of_the_points() {
        let mut met: Vec<u64> = (0..200).map(|seed| Hammersley::new(8, 2, seed).unwrap().start).collect();
        met.sort_unstable();
        met.dedup();
        assert_eq!(met, (0..8).collect::<Vec<_>>());
        assert_eq!(Hammersley::new(0, 2, 1).unwrap_err(), PointSetError::NoPoints);
        assert!(matches!(Hammersley::new(8, 66, 1), Err(PointSetError::TooManyDimensions { .. })));
    }
}
