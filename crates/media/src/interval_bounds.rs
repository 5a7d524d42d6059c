//! Bounds of a profile between two distances, and with them bounds in equal cells.

use crate::{BoundCell, BoxBounds, Constant, Extinction, PiecewiseConstant, PiecewiseLinear, Ray, Vacuum};

/// A profile that knows its range on every stretch.
///
/// **Law.** σ_t(s) lies within `bounds_between(from, to)` for `from ≤ s < to`, and at `to` as well where `to` is the length. Where the
/// two bounds are equal σ_t has that value on the stretch, to rounding.
pub trait IntervalBounds: Extinction {
    /// Lower and upper bound of σ_t on a stretch within the profile, `from < to` \[1/length\].
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64);

    /// The profile in `count` cells of the same width (in one for a count of 0), each with its bounds; none for a profile of length 0.
    fn equal_cells(&self, count: usize) -> Vec<BoundCell> {
        let (length, count) = (self.length(), count.max(1));
        let mut cells = Vec::with_capacity(count);
        let mut from = 0.0;
        for i in 1..=count {
            let to = if i == count { length } else { length * (i as f64 / count as f64) };
            // A width below the rounding of the distance is no cell of its own.
            if to > from {
                let (minorant, majorant) = self.bounds_between(from, to);
                cells.push(BoundCell { to, minorant, majorant });
                from = to;
            }
        }
        cells
    }
}

impl IntervalBounds for Constant {
    fn bounds_between(&self, from: f64, _to: f64) -> (f64, f64) {
        let value = self.sigma_t(from);
        (value, value)
    }
}

impl IntervalBounds for Vacuum {
    fn bounds_between(&self, _from: f64, _to: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
}

/// Exact.
impl IntervalBounds for PiecewiseConstant {
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64) {
        range_of(self.values_between(from, to).iter().copied())
    }
}

/// Exact where a node is the extreme, else to the rounding of an interpolated value.
impl IntervalBounds for PiecewiseLinear {
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64) {
        self.bounds_in_pieces(from, to).fold((f64::INFINITY, f64::NEG_INFINITY), |hull, bounds| {
            (hull.0.min(bounds.0), hull.1.max(bounds.1))
        })
    }
}

/// Bounds in the box around the stretch: not tight for a ray across the axes, and never wrong.
impl<M: BoxBounds> IntervalBounds for Ray<M> {
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64) {
        /// A point on the line is off by a few roundings of its coordinates, and of the way to it.
        const ROUNDINGS: f64 = 8.0 * f64::EPSILON;
        let line = self.local_line();
        let (start, end) = (line.at(from), line.at(to));
        let slack = ROUNDINGS * (start.abs().max(end.abs()) + line.origin.abs());
        self.medium().bounds_in(start.min(end) - slack, start.max(end) + slack)
    }
}

impl<F: IntervalBounds + ?Sized> IntervalBounds for &F {
    fn bounds_between(&self, from: f64, to: f64) -> (f64, f64) {
        (**self).bounds_between(from, to)
    }
}

/// The least and the greatest of some values.
pub(crate) fn range_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Bounds of what is interpolated between values with these: a mean of values of one sign is off by some roundings of itself, of values
/// of both signs by as many of the greater. Bounds that agree are left as they are: there is one value, and nothing to look up.
pub(crate) fn widened(low: f64, high: f64) -> (f64, f64) {
    const ROUNDINGS: f64 = 8.0 * f64::EPSILON;
    if low == high {
        return (low, high);
    }
    let greatest = low.abs().max(high.abs());
    let below = if low >= 0.0 { low } else { greatest };
    let above = if high <= 0.0 { -high } else { greatest };
    (low - ROUNDINGS * below, high + ROUNDINGS * above)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AnalyticCosine, InCells};
    use glam::DVec3;
    use proptest::prelude::*;

    #[test]
    fn steps_are_bounded_exactly() {
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 3.0, 4.0], vec![2.0, 0.0, 0.5]).unwrap();
        assert_eq!(steps.bounds_between(0.0, 1.0), (2.0, 2.0));
        assert_eq!(steps.bounds_between(0.5, 1.5), (0.0, 2.0));
        assert_eq!(steps.bounds_between(1.0, 3.0), (0.0, 0.0));
        assert_eq!(steps.bounds_between(3.0, 4.0), (0.5, 0.5));
        let cells = steps.equal_cells(4);
        assert_eq!(cells.iter().map(|cell| cell.to).collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0]);
        assert!(cells.iter().all(|cell| cell.range() == 0.0));
    }

    #[test]
    fn a_tent_is_bounded_at_its_ends_and_its_node() {
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        let (low, high) = tent.bounds_between(0.5, 2.0);
        assert!((low - 1.0).abs() < 1e-14 && (high - 2.0).abs() < 1e-14 && low <= 1.0 && high >= 2.0);
        // Not below 0: an estimate would exceed 1.
        assert_eq!(tent.bounds_between(2.0, 3.0).0, 0.0);
        let flat = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 0.1, 0.0]).unwrap();
        assert_eq!(flat.bounds_between(0.0, 1.0), (0.1, 0.1));
    }

    #[test]
    fn no_length_no_cells() {
        assert_eq!(Constant::new(1.0, 0.0).unwrap().equal_cells(3), []);
        assert_eq!(Constant::new(1.0, 2.0).unwrap().equal_cells(0).len(), 1);
        assert_eq!(Vacuum::new(2.0).equal_cells(2).len(), 2);
    }

    #[test]
    fn a_ray_is_within_the_bounds_of_its_cells() {
        let medium = AnalyticCosine::new(1.0).unwrap();
        for direction in [DVec3::Z, DVec3::new(0.3, -0.2, 1.0), DVec3::new(-1.0, 0.4, 0.1)] {
            let clip = AnalyticCosine::default_bounds().clip(DVec3::new(0.5, 0.0, 9.0), direction, None);
            let ray = Ray::new(&medium, &clip.unwrap().unwrap());
            let mut from = 0.0;
            for cell in ray.equal_cells(30) {
                for i in 0..=50 {
                    assert!(cell.admits(ray.sigma_t(from + f64::from(i) / 50.0 * (cell.to - from))));
                }
                from = cell.to;
            }
        }
    }

    proptest! {
        #[test]
        fn every_value_is_within_its_cell(
            widths in prop::collection::vec(0.01..1.0_f64, 5),
            values in prop::collection::vec(-1.0..2.0_f64, 6),
            count in 1..40_usize,
            at in prop::collection::vec(0.0..1.0_f64, 20),
        ) {
            let mut edges = vec![0.0];
            widths.iter().for_each(|width| edges.push(edges[edges.len() - 1] + width));
            let steps = PiecewiseConstant::new(edges.clone(), values[..5].to_vec()).unwrap();
            let lines = PiecewiseLinear::new(edges, values).unwrap();
            fn check<F: IntervalBounds>(field: &F, count: usize, at: &[f64]) -> bool {
                use crate::BoundedInCells;
                let cells = InCells::new(field, field.equal_cells(count)).unwrap();
                // Also the ends of the cells, where an estimator may look as well.
                let ends = cells.bound_cells().iter().flat_map(|cell| [cell.to, cell.to.next_down()]);
                let inside = at.iter().map(|t| t * field.length());
                inside.chain(ends).all(|s| cells.cells_admit(s, field.sigma_t(s)))
            }
            prop_assert!(check(&steps, count, &at));
            prop_assert!(check(&lines, count, &at));
        }
    }
}
