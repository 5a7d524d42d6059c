//! Latin hypercube sampling: every coordinate stratified by itself, in an order of its own (mckay-1979).

use super::digits::{below, bits_53, within};
use super::{PointSet, PointSetError};
use crate::Seeded;

/// N points; coordinate d of point i is (π_d(i) + jitter)/N with a random order π_d for each coordinate.
///
/// **Law.** π_d(i) is uniform below N for a uniform order, the jitter is uniform and independent of it, and orders of different
/// coordinates are independent: each point is uniform on the cube.
///
/// **Variance.** Of a mean of f: what f has beside functions of one variate each, over N, plus terms of higher order
/// (stein-1987); never more than N/(N − 1) times that of independent points. A sum of smooth functions of one variate each has
/// Σ_d ∫ f_d′²/(12 N³) to leading order; a product of centered functions gains nothing.
///
/// **Memory.** 4 N bytes for each coordinate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LatinHypercube {
    /// π_d(i), coordinate after coordinate.
    orders: Vec<u32>,
    points: u32,
    dimensions: usize,
    seed: u64,
}

impl LatinHypercube {
    /// `points` points with this many ordered `dimensions`, for the replica `seed`.
    ///
    /// # Errors
    /// If there are no points, or 2^32 of them or more.
    pub fn new(points: u64, dimensions: usize, seed: u64) -> Result<Self, PointSetError> {
        PointSetError::check_points(u64::from(u32::MAX), points)?;
        let mut source = Seeded::for_batch(seed, u64::MAX);
        let mut orders = Vec::with_capacity(points as usize * dimensions);
        for _ in 0..dimensions {
            let start = orders.len();
            orders.extend(0..points as u32);
            // Fisher and Yates: every order with the same probability.
            for i in (1..points).rev() {
                orders.swap(start + i as usize, start + below(i + 1, &mut source) as usize);
            }
        }
        Ok(Self { orders, points: points as u32, dimensions, seed })
    }
}

impl PointSet for LatinHypercube {
    fn dimensions(&self) -> usize {
        self.dimensions
    }
    fn points(&self) -> u64 {
        u64::from(self.points)
    }
    fn seed(&self) -> u64 {
        self.seed
    }
    #[inline]
    fn coordinate(&self, index: u64, dimension: usize, filler: &mut Seeded) -> f64 {
        let stratum = self.orders[dimension * self.points as usize + index as usize];
        within(u64::from(stratum), u64::from(self.points), bits_53(filler))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_that_cannot_be_are_refused() {
        assert_eq!(LatinHypercube::new(0, 2, 1).unwrap_err(), PointSetError::NoPoints);
        let error = LatinHypercube::new(1 << 32, 0, 1).unwrap_err();
        assert!(matches!(error, PointSetError::TooManyPoints { .. }));
        assert!(error.to_string().contains("at most 4294967295"));
    }
}
