//! Bounds of a medium in boxes: what grids of bounds are built from.

use crate::interval_bounds::{range_of, widened};
use crate::{AnalyticCosine, Bounds, EmptySpace, FieldError, Homogeneous, Lattice, Line, Medium, Voxels};
use fairflight_elementary::cos;
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A medium that knows its range in boxes.
///
/// **Law.** σ_t of every point of the closed box lies within the bounds. They need not be tight. Where they are equal σ_t has that value
/// in the box, to rounding.
///
/// Formulas find them by interval arithmetic; where one has no bounds, or may have no value, they are infinite. Noise is none: the octaves beyond
/// the first have all of their range in any box that is not far finer than their lattice, which is most of the range of the whole.
pub trait BoxBounds: Medium {
    /// Lower and upper bound of σ_t in the box between two corners in the medium's own coordinates
    /// \[1/length\].
    fn bounds_in(&self, min: DVec3, max: DVec3) -> (f64, f64);

    /// The bounds in all `boxes`, in their order, valid for points beside them by [`Boxes::slack`] as well. A medium that can find them
    /// in one pass does.
    fn bounds_in_all(&self, boxes: &Boxes) -> Vec<(f64, f64)> {
        let [nx, ny, nz] = boxes.resolution();
        let mut bounds = Vec::with_capacity(nx * ny * nz);
        let slack = DVec3::splat(boxes.slack());
        for x in 0..nx {
            for y in 0..ny {
                for z in 0..nz {
                    let corner =
                        |x, y, z| DVec3::new(boxes.plane(0, x), boxes.plane(1, y), boxes.plane(2, z));
                    let (min, max) = (corner(x, y, z), corner(x + 1, y + 1, z + 1));
                    bounds.push(self.bounds_in(min - slack, max + slack));
                }
            }
        }
        bounds
    }

    /// Values that [`bounds_in_all`](Self::bounds_in_all) looks up; none where they come from a formula.
    fn lookups_in_all(&self, _boxes: &Boxes) -> u64 {
        0
    }
}

/// A box cut into equal boxes by planes across its axes, z fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxes {
    min: DVec3,
    max: DVec3,
    resolution: [usize; 3],
    slack: f64,
}

/// Boxes of a grid at most: 16 GiB.
const MOST_BOXES: usize = 1 << 30;
/// Roundings by which a point on a line may be off, over its greatest coordinate.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

impl Boxes {
    /// The boxes between two corners, of which the second is greater in each coordinate; `resolution` boxes along each axis.
    pub(crate) fn new(min: DVec3, max: DVec3, resolution: [usize; 3]) -> Self {
        debug_assert!(min.cmplt(max).all() && resolution.iter().all(|&n| n > 0), "no boxes");
        let slack = ROUNDINGS * min.abs().max(max.abs()).max_element();
        Self { min, max, resolution, slack }
    }

    /// Around bounds in world space, as the medium sees them: `longest` boxes along the longest edge, along the others as many as make
    /// them no longer than there. The slack is that of the world's coordinates as well; a flat edge is as thick as the slack.
    pub(crate) fn around<M: Medium>(medium: &M, bounds: &Bounds, longest: usize) -> Result<Self, FieldError> {
        let local = |origin, direction| medium.local(Line { origin, direction });
        let (low, high) = bounds.corners();
        let corner = |bits: u8| {
            let is_high = DVec3::from_array([0, 1, 2].map(|axis| f64::from(bits >> axis & 1)));
            local(low + is_high * (high - low), DVec3::X).origin
        };
        let (mut min, mut max) = (0..8)
            .map(corner)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), at| (min.min(at), max.max(at)));
        let stretch: f64 = DVec3::AXES.map(|axis| local(low, axis).direction.length()).iter().sum();
        let world = low.abs().max(high.abs()).max_element();
        let slack = ROUNDINGS * (stretch * world).max(min.abs().max(max.abs()).max_element());
        let flat = max.cmple(min);
        min = DVec3::select(flat, min - slack, min);
        max = DVec3::select(flat, max + slack, max);
        let sides = max - min;
        // An edge that is longer by roundings needs no box more.
        let along = |side: f64| {
            let count = longest as f64 * (side / sides.max_element());
            ((count * (1.0 - 1e-12)).ceil() as usize).max(1)
        };
        let boxes = Self::checked((min, max), sides.to_array().map(along))?;
        Ok(Self { slack, ..boxes })
    }

    /// The boxes between two corners.
    ///
    /// # Errors
    /// If a corner is not finite, the box is flat, a resolution is 0, or their product beyond 2³⁰.
    pub(crate) fn checked((min, max): (DVec3, DVec3), resolution: [usize; 3]) -> Result<Self, FieldError> {
        FieldError::check_all_finite("min", &min.to_array())?;
        FieldError::check_all_finite("max", &max.to_array())?;
        if !(min.cmplt(max).all() && (max - min).is_finite()) {
            return Err(FieldError::Degenerate { what: "the box of a grid" });
        }
        if let Some(&found) = resolution.iter().find(|&&n| n == 0) {
            return Err(FieldError::TooFew { what: "resolution", least: 1, found });
        }
        let count = resolution.iter().try_fold(1_usize, |product, &n| product.checked_mul(n));
        let found = count.unwrap_or(usize::MAX);
        if found > MOST_BOXES {
            return Err(FieldError::TooMany { what: "a grid", most: MOST_BOXES, found });
        }
        Ok(Self::new(min, max, resolution))
    }

    /// Number of boxes along each axis.
    #[must_use]
    pub fn resolution(&self) -> [usize; 3] {
        self.resolution
    }

    /// Coordinate of the `i`-th plane across an axis, `0 ≤ i ≤ resolution`. The first and the last are the faces of the whole, exactly.
    #[inline]
    #[must_use]
    pub fn plane(&self, axis: usize, i: usize) -> f64 {
        let n = self.resolution[axis];
        if i == n {
            return self.max[axis];
        }
        self.min[axis] + (self.max[axis] - self.min[axis]) * (i as f64 / n as f64)
    }

    /// The distance by which a point on a line through the whole may be off by rounding: some roundings of the greatest coordinate.
    #[inline]
    #[must_use]
    pub fn slack(&self) -> f64 {
        self.slack
    }
}

impl BoxBounds for Homogeneous {
    fn bounds_in(&self, min: DVec3, _max: DVec3) -> (f64, f64) {
        let value = self.sigma_t_local(min);
        (value, value)
    }
}

impl BoxBounds for EmptySpace {
    fn bounds_in(&self, _min: DVec3, _max: DVec3) -> (f64, f64) {
        (0.0, 0.0)
    }
}

/// The product of the exact ranges of both factors over the box: valid, and not tight where both vary.
impl BoxBounds for AnalyticCosine {
    fn bounds_in(&self, min: DVec3, max: DVec3) -> (f64, f64) {
        let (lowest, highest) = (self.lower_bound().unwrap_or(0.0), self.upper_bound().unwrap_or(0.0));
        let diagonal = cosine_range(1.5 * min.element_sum(), 1.5 * max.element_sum());
        // sin(z/2) = cos(z/2 − π/2)
        let axial = cosine_range(0.5 * (min.z - PI), 0.5 * (max.z - PI));
        let factor = |cos: f64, sin: f64| (0.5 * cos + 0.5).powi(5) * (sin + 2.0) / 3.0;
        let ends =
            [factor(diagonal.0, axial.0), factor(diagonal.1, axial.1)].map(|end| end * (lowest + highest));
        // A value is off by some roundings of the greatest.
        let rounding = 32.0 * f64::EPSILON * highest.max(-lowest);
        let (low, high) = range_of(ends.into_iter());
        ((low - rounding).max(lowest), (high + rounding).min(highest))
    }
}

/// The range of the cosine between two phases, to the rounding of the phases.
fn cosine_range(from: f64, to: f64) -> (f64, f64) {
    let rounding = 8.0 * f64::EPSILON * from.abs().max(to.abs()).max(PI);
    let (from, to) = (from - rounding, to + rounding);
    let (at_from, at_to) = (cos(from), cos(to));
    // Whether an even, or an odd, multiple of π is inside.
    let holds = |offset: f64| ((to - offset) / TAU).floor() >= ((from - offset) / TAU).ceil();
    let low = if holds(PI) { -1.0 } else { at_from.min(at_to) };
    let high = if holds(0.0) { 1.0 } else { at_from.max(at_to) };
    (low, high)
}

/// The range of the values at the integer coordinates around the box: exact for a box with integer corners.
impl<L: Lattice> BoxBounds for Voxels<L> {
    fn bounds_in(&self, min: DVec3, max: DVec3) -> (f64, f64) {
        let (low, high) = (min.floor(), max.ceil());
        let (least, greatest) = (self.lattice().minimum(), self.lattice().maximum());
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let axis = |i: usize| Integers { next: low[i], last: high[i] };
        for x in axis(0) {
            for y in axis(1) {
                for z in axis(2) {
                    let value = self.lattice().trilinear(x, y, z);
                    range = (range.0.min(value), range.1.max(value));
                }
                if range == (least, greatest) {
                    return self.scaled(widened(range.0, range.1));
                }
            }
        }
        self.scaled(widened(range.0, range.1))
    }

    /// One look-up for each integer point of the whole, and a comparison for each box that it belongs to (eight at most in boxes of one
    /// voxel, hardly more than one in large ones).
    fn bounds_in_all(&self, boxes: &Boxes) -> Vec<(f64, f64)> {
        let [nx, ny, nz] = boxes.resolution();
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); nx * ny * nz];
        let axes = [0, 1, 2].map(|axis| Shares::of(boxes, axis));
        for (x, in_x) in axes[0].points() {
            for (y, in_y) in axes[1].points() {
                for (z, in_z) in axes[2].points() {
                    let value = self.lattice().trilinear(x, y, z);
                    for i in in_x.0..in_x.1 {
                        for j in in_y.0..in_y.1 {
                            let row = (i * ny + j) * nz;
                            for range in &mut ranges[row + in_z.0..row + in_z.1] {
                                *range = (range.0.min(value), range.1.max(value));
                            }
                        }
                    }
                }
            }
        }
        // A point beside its box by the slack has a value beside the range by the slack times the slope, which along each of three axes
        // is at most the difference of two values. A value of the other sign than all of them it has not.
        let (least, greatest) = (self.lattice().minimum(), self.lattice().maximum());
        let beside = 3.0 * boxes.slack() * (greatest - least);
        for range in &mut ranges {
            let (low, high) = widened(range.0, range.1);
            if low < high {
                let floor = if least >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
                let ceiling = if greatest <= 0.0 { 0.0 } else { f64::INFINITY };
                *range = ((low - beside).max(floor), (high + beside).min(ceiling));
            }
            *range = self.scaled(*range);
        }
        ranges
    }

    fn lookups_in_all(&self, boxes: &Boxes) -> u64 {
        let along = |axis: usize| {
            let n = boxes.resolution()[axis];
            boxes.plane(axis, n).ceil() - boxes.plane(axis, 0).floor() + 1.0
        };
        // Saturates.
        (along(0) * along(1) * along(2)) as u64
    }
}

/// Integers from `next` to `last` as numbers.
struct Integers {
    next: f64,
    last: f64,
}

impl Iterator for Integers {
    type Item = f64;

    #[inline]
    fn next(&mut self) -> Option<f64> {
        let current = self.next;
        self.next += 1.0;
        (current <= self.last).then_some(current)
    }
}

/// The integers met along an axis, each with the boxes whose interpolated values it has a share in.
struct Shares {
    first: f64,
    boxes: Vec<(usize, usize)>,
}

impl Shares {
    fn of(boxes: &Boxes, axis: usize) -> Self {
        let n = boxes.resolution()[axis];
        let first = boxes.plane(axis, 0).floor();
        let count = (boxes.plane(axis, n).ceil() - first) as usize + 1;
        let mut shares = vec![(usize::MAX, 0); count];
        for i in 0..n {
            let from = (boxes.plane(axis, i).floor() - first) as usize;
            let to = (boxes.plane(axis, i + 1).ceil() - first) as usize;
            for share in &mut shares[from..=to] {
                *share = (share.0.min(i), i + 1);
            }
        }
        Self { first, boxes: shares }
    }

    fn points(&self) -> impl Iterator<Item = (f64, (usize, usize))> + '_ {
        self.boxes.iter().enumerate().map(|(i, &boxes)| (self.first + i as f64, boxes))
    }
}

/// A medium behind a pointer is the medium.
macro_rules! behind_a_pointer {
    ($($pointer:ty),*) => {$(
        impl<M: BoxBounds + ?Sized> BoxBounds for $pointer {
            fn bounds_in(&self, min: DVec3, max: DVec3) -> (f64, f64) {
                (**self).bounds_in(min, max)
            }
            fn bounds_in_all(&self, boxes: &Boxes) -> Vec<(f64, f64)> {
                (**self).bounds_in_all(boxes)
            }
            fn lookups_in_all(&self, boxes: &Boxes) -> u64 {
                (**self).lookups_in_all(boxes)
            }
        }
    )*};
}

behind_a_pointer!(&M, Arc<M>);
