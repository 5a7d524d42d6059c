//! A grid of bounds of a medium, and the cells that a line passes in it.

use crate::interval_bounds::widened;
use crate::medium_bounds::Boxes;
use crate::{BoundCell, Bounds, BoxBounds, FieldError, Line};
use glam::DVec3;

/// Minorant and majorant of a medium in equal boxes of a larger one, in the medium's own coordinates (szirmay-kalos-2011; the walk from
/// box to box is that of amanatides-1987, but for what it adds up).
///
/// Building costs the medium's bounds in every box: for voxels one look-up per voxel. It holds two numbers per box
/// ([`bytes`](Self::bytes)). Finer boxes have tighter bounds and more crossings: eight voxels a side are a start.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundGrid {
    boxes: Boxes,
    bounds: Vec<(f64, f64)>,
    outside: (f64, f64),
    lookups: u64,
}

/// Look-ups that building a grid may take: a minute, of a volume of 1290 voxels a side.
const MOST_LOOKUPS: u64 = 1 << 31;

impl BoundGrid {
    /// The bounds of `medium` in the box between two corners, in `resolution` boxes along each axis. Outside those of the whole medium
    /// are used, infinite where it knows none; see [`with_outside`](Self::with_outside).
    ///
    /// # Errors
    /// If a corner is not finite, the box is flat, a resolution is 0, their product beyond 2³⁰, or it takes more than 2³¹ look-ups.
    pub fn build<M: BoxBounds>(
        medium: &M,
        (min, max): (DVec3, DVec3),
        resolution: [usize; 3],
    ) -> Result<Self, FieldError> {
        Self::of(medium, Boxes::checked((min, max), resolution)?)
    }

    /// The bounds of `medium` in boxes around `bounds`: `longest` along the longest edge, along the others as many as make them no longer
    /// than there. A ray that is clipped to `bounds` does not leave it but by rounding; the bounds of all boxes hold beyond.
    ///
    /// # Errors
    /// If the bounds are a point, `longest` is 0, there are more than 2³⁰ boxes, or it takes more than 2³¹ look-ups.
    pub fn around<M: BoxBounds>(medium: &M, bounds: &Bounds, longest: usize) -> Result<Self, FieldError> {
        let grid = Self::of(medium, Boxes::around(medium, bounds, longest)?)?;
        let (minorant, majorant) = grid.hull();
        Ok(grid.with_outside(minorant, majorant))
    }

    fn of<M: BoxBounds>(medium: &M, boxes: Boxes) -> Result<Self, FieldError> {
        let lookups = medium.lookups_in_all(&boxes);
        if lookups > MOST_LOOKUPS {
            let (most, found) = (MOST_LOOKUPS as usize, lookups as usize);
            return Err(FieldError::TooMany { what: "the values of a grid", most, found });
        }
        let outside = match (medium.lower_bound(), medium.upper_bound()) {
            // Of values that are interpolated, hence off by a rounding where they are all the same.
            (Some(low), Some(high)) => widened(low, high),
            (low, high) => (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY)),
        };
        Ok(Self { bounds: medium.bounds_in_all(&boxes), boxes, outside, lookups })
    }

    /// The grid with other bounds outside of the box: 0 and the background, for voxels of which the box holds all that differ from it.
    #[must_use]
    pub fn with_outside(self, minorant: f64, majorant: f64) -> Self {
        Self { outside: (minorant, majorant), ..self }
    }

    /// Number of boxes along each axis.
    #[must_use]
    pub fn resolution(&self) -> [usize; 3] {
        self.boxes.resolution()
    }

    /// The least minorant and the greatest majorant of a box \[1/length\].
    #[must_use]
    pub fn hull(&self) -> (f64, f64) {
        let whole = (f64::INFINITY, f64::NEG_INFINITY);
        self.bounds.iter().fold(whole, |(low, high), bounds| (low.min(bounds.0), high.max(bounds.1)))
    }

    /// Values of the medium that were looked up for it; none where its bounds come from a formula.
    #[must_use]
    pub fn lookups(&self) -> u64 {
        self.lookups
    }

    /// The memory of the bounds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        std::mem::size_of_val(self.bounds.as_slice())
    }

    /// The cells of the stretch from 0 to `length` on a line in the medium's own coordinates: in place of what `cells` holds, without an
    /// allocation once it is large enough. Neighbours with the same bounds are one cell.
    ///
    /// **Law.** The cells are those of [`crate::BoundedInCells`]: in order, none of width 0, the last one ends at `length`. Every look-up of
    /// a line that starts in or near the box (a clipped ray) is within its cell's bounds, also on a line that runs in a plane
    /// between boxes, along an edge, or through corners: the bounds of a box hold on its surface, and a little beyond.
    ///
    /// The distance at which the line leaves each box is computed from the plane itself: nothing is added up, and nothing divided by a
    /// direction of 0.
    pub fn cells_along(&self, local: &Line, length: f64, cells: &mut Vec<BoundCell>) {
        cells.clear();
        if length <= 0.0 {
            return;
        }
        let Some((enters, leaves)) = self.inside(local, length) else {
            push(cells, length, self.outside);
            return;
        };
        if enters > 0.0 {
            push(cells, enters, self.outside);
        }
        let mut axes = [0, 1, 2].map(|axis| Axis::new(&self.boxes, axis, local, enters));
        let [_, ny, nz] = self.resolution();
        loop {
            let [x, y, z] = axes.each_ref().map(|axis| axis.crossing);
            let next = x.min(y).min(z);
            let bounds = self.bounds[(axes[0].index * ny + axes[1].index) * nz + axes[2].index];
            if next >= leaves {
                push(cells, leaves, bounds);
                break;
            }
            push(cells, next, bounds);
            // Through an edge or a corner two or three planes are crossed at once; what rounding keeps apart makes a cell of its own.
            axes.iter_mut().filter(|axis| axis.crossing <= next).for_each(Axis::cross);
        }
        if leaves < length {
            push(cells, length, self.outside);
        }
    }

    /// Distances at which the line enters and leaves the box, both on the stretch \[length\]; `None` where it meets none of the inside.
    /// A line beside a face by rounding counts as inside.
    fn inside(&self, local: &Line, length: f64) -> Option<(f64, f64)> {
        let slack = self.boxes.slack();
        let (mut enters, mut leaves) = (0.0_f64, length);
        for axis in 0..3 {
            let (o, d) = (local.origin[axis], local.direction[axis]);
            let last = self.resolution()[axis];
            let (low, high) = (self.boxes.plane(axis, 0) - slack, self.boxes.plane(axis, last) + slack);
            if d == 0.0 {
                // Parallel to the faces, negative zero included.
                if !(low..=high).contains(&o) {
                    return None;
                }
                continue;
            }
            let (near, far) = if d > 0.0 { (low, high) } else { (high, low) };
            enters = enters.max((near - o) / d);
            leaves = leaves.min((far - o) / d);
        }
        (enters < leaves).then_some((enters, leaves))
    }
}

/// Appends a cell up to `to`; one of width 0 is none, and one with the bounds of its predecessor is more of it.
#[inline]
fn push(cells: &mut Vec<BoundCell>, to: f64, (minorant, majorant): (f64, f64)) {
    match cells.last_mut() {
        Some(last) if to <= last.to => {}
        Some(last) if (last.minorant, last.majorant) == (minorant, majorant) => last.to = to,
        None if to <= 0.0 => {}
        _ => cells.push(BoundCell { to, minorant, majorant }),
    }
}

/// Place of a line along one axis of the grid.
struct Axis<'a> {
    boxes: &'a Boxes,
    axis: usize,
    origin: f64,
    direction: f64,
    /// The box that the line is in.
    index: usize,
    /// Distance at which it leaves that box through a plane between two \[length\]; infinite where there is none ahead.
    crossing: f64,
}

impl<'a> Axis<'a> {
    /// The place at the distance `s`, in the box.
    fn new(boxes: &'a Boxes, axis: usize, local: &Line, s: f64) -> Self {
        let (origin, direction) = (local.origin[axis], local.direction[axis]);
        let n = boxes.resolution()[axis];
        let (first, last) = (boxes.plane(axis, 0), boxes.plane(axis, n));
        let guess = (origin + s * direction - first) / (last - first) * n as f64;
        // The cast saturates.
        let index = (guess as usize).min(n - 1);
        let mut at = Self { boxes, axis, origin, direction, index, crossing: f64::INFINITY };
        at.settle(s, n);
        at.aim();
        at
    }

    /// Distance at which the line meets the `i`-th plane \[length\].
    #[inline]
    fn at(&self, i: usize) -> f64 {
        (self.boxes.plane(self.axis, i) - self.origin) / self.direction
    }

    /// Moves from the box that was guessed to the one that the line is in at `s`, judged by the crossings themselves.
    fn settle(&mut self, s: f64, n: usize) {
        if self.direction == 0.0 {
            let above = |i: usize| self.boxes.plane(self.axis, i) > self.origin;
            while self.index > 0 && above(self.index) {
                self.index -= 1;
            }
            while self.index + 1 < n && !above(self.index + 1) {
                self.index += 1;
            }
            return;
        }
        // Back while the plane behind is still to come, on while the one ahead is behind.
        if self.direction > 0.0 {
            while self.index > 0 && self.at(self.index) > s {
                self.index -= 1;
            }
            while self.index + 1 < n && self.at(self.index + 1) <= s {
                self.index += 1;
            }
        } else {
            while self.index + 1 < n && self.at(self.index + 1) > s {
                self.index += 1;
            }
            while self.index > 0 && self.at(self.index) <= s {
                self.index -= 1;
            }
        }
    }

    /// Finds the next crossing.
    #[inline]
    fn aim(&mut self) {
        let n = self.boxes.resolution()[self.axis];
        self.crossing = if self.direction > 0.0 && self.index + 1 < n {
            self.at(self.index + 1)
        } else if self.direction < 0.0 && self.index > 0 {
            self.at(self.index)
        } else {
            f64::INFINITY
        };
    }

    /// Crosses the plane ahead.
    #[inline]
    fn cross(&mut self) {
        if self.direction > 0.0 {
            self.index += 1;
        } else {
            self.index -= 1;
        }
        self.aim();
    }
}

#[cfg(test)]
#[path = "bound_grid_tests.rs"]
mod tests;
