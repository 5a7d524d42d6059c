//! Rays that start inside the bounds: those of a walk after its first collision.

use crate::lanes::vector;
use crate::{Bounds, Clip, Line};
use fairflight_elementary::lanes::{LANES, Lanes};
use glam::DVec3;

impl Bounds {
    /// The distance from `point`, in the bounds or beside them by rounding, to where a particle that travels along the unit
    /// vector `direction` leaves them \[length\]; 0 where it does at once.
    #[inline]
    #[must_use]
    pub fn exit_distance(&self, point: DVec3, direction: DVec3) -> f64 {
        match *self {
            Self::Sphere { center, radius } => exit_of_sphere((center, radius), point, direction),
            Self::Box { min, max } => exit_of_box((min, max), point, direction),
        }
    }

    /// The same in all lanes, of the coordinates of points and directions.
    #[inline(always)]
    #[must_use]
    pub fn exit_distance_lanes(&self, points: &[Lanes; 3], directions: &[Lanes; 3]) -> Lanes {
        let mut exits = [0.0; LANES];
        match *self {
            Self::Sphere { center, radius } => {
                for (i, exit) in exits.iter_mut().enumerate() {
                    *exit = exit_of_sphere((center, radius), vector(points, i), vector(directions, i));
                }
            }
            Self::Box { min, max } => {
                for (i, exit) in exits.iter_mut().enumerate() {
                    *exit = exit_of_box((min, max), vector(points, i), vector(directions, i));
                }
            }
        }
        exits
    }

    /// The rest of a ray that starts inside, as a clip of its own.
    #[inline]
    #[must_use]
    pub fn clip_inside(&self, line: Line) -> Clip {
        Clip { line, entry_distance: 0.0, length: self.exit_distance(line.origin, line.direction) }
    }

    /// True if the line through `origin` along the unit vector `direction` certainly misses the bounds: a quick look before
    /// [`clip`](Self::clip), which most rays of a camera need not go through. `false` says nothing.
    #[inline]
    #[must_use]
    pub fn certainly_misses(&self, origin: DVec3, direction: DVec3) -> bool {
        line_misses(self.enclosing_ball(), origin, direction)
    }

    /// True if a point lies in the bounds, their surface included.
    #[inline]
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        match *self {
            Self::Sphere { center, radius } => point.distance_squared(center) <= radius * radius,
            Self::Box { min, max } => point.cmpge(min).all() && point.cmple(max).all(),
        }
    }

    /// [`contains`](Self::contains) in all lanes.
    #[inline(always)]
    #[must_use]
    pub fn contains_lanes(&self, points: &[Lanes; 3]) -> [bool; LANES] {
        let mut contains = [false; LANES];
        match *self {
            Self::Sphere { center, radius } => {
                for (i, contains) in contains.iter_mut().enumerate() {
                    *contains = vector(points, i).distance_squared(center) <= radius * radius;
                }
            }
            Self::Box { min, max } => {
                for (i, contains) in contains.iter_mut().enumerate() {
                    let [x, y, z] = vector(points, i).to_array();
                    *contains = (x >= min.x)
                        & (y >= min.y)
                        & (z >= min.z)
                        & (x <= max.x)
                        & (y <= max.y)
                        & (z <= max.z);
                }
            }
        }
        contains
    }

    /// The corners of the box along the axes around the bounds: least and greatest coordinates \[length\].
    #[must_use]
    pub fn corners(&self) -> (DVec3, DVec3) {
        match *self {
            Self::Sphere { center, radius } => (center - radius, center + radius),
            Self::Box { min, max } => (min, max),
        }
    }

    /// A ball that holds the bounds: its center and its radius \[length\].
    #[must_use]
    pub fn enclosing_ball(&self) -> (DVec3, f64) {
        match *self {
            Self::Sphere { center, radius } => (center, radius),
            Self::Box { min, max } => (0.5 * (min + max), 0.5 * (max - min).length()),
        }
    }
}

/// True if a line certainly misses a ball.
#[inline(always)]
pub(crate) fn line_misses((center, radius): (DVec3, f64), origin: DVec3, direction: DVec3) -> bool {
    let offset = origin - center;
    let along = offset.dot(direction);
    let far = offset.length_squared();
    // Each square is rounded at the size of the largest, by a few ε = 2e-16: a margin a thousand times that.
    far - along * along - radius * radius > 1e-12 * (far + radius * radius)
}

#[inline(always)]
fn exit_of_sphere((center, radius): (DVec3, f64), point: DVec3, direction: DVec3) -> f64 {
    let offset = point - center;
    let along = offset.dot(direction);
    let inside = radius * radius - offset.length_squared();
    let half = at_least_0(along * along + inside).sqrt();
    // −along + half, written for along > 0 so that it does not cancel near the surface.
    let exit = if along > 0.0 { inside / (along + half) } else { half - along };
    at_least_0(exit)
}

#[inline(always)]
fn exit_of_box((min, max): (DVec3, DVec3), point: DVec3, direction: DVec3) -> f64 {
    let mut exit = f64::INFINITY;
    for axis in 0..3 {
        let d = direction[axis];
        let face = if d > 0.0 { max[axis] } else { min[axis] };
        let distance = (face - point[axis]) / d;
        // No face across an axis along which it does not travel.
        exit = if (d != 0.0) & (distance < exit) { distance } else { exit };
    }
    at_least_0(exit)
}

/// A comparison, which `f64::max` is more than: nothing here is no number.
#[inline(always)]
fn at_least_0(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn the_exit_is_that_of_the_clip() {
        let ball = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 10.0).unwrap();
        let cube = Bounds::aligned_box(DVec3::ZERO, DVec3::ONE).unwrap();
        for i in 0..300 {
            let t = f64::from(i);
            let direction = dvec3(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()).normalize();
            let unit = dvec3((2.1 * t).sin(), (1.9 * t).sin(), (0.3 * t).cos());
            for (bounds, point) in [(ball, dvec3(0.0, 0.0, 10.0) + 5.7 * unit), (cube, 0.5 + 0.5 * unit)] {
                assert!(bounds.contains(point));
                let clip = bounds.clip(point, direction, None).unwrap().unwrap();
                assert!((bounds.exit_distance(point, direction) - clip.length).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn the_exit_of_lanes_is_that_of_one() {
        let ball = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 10.0).unwrap();
        let cube = Bounds::aligned_box(DVec3::ZERO, DVec3::ONE).unwrap();
        for (bounds, start) in [(ball, dvec3(0.0, 0.0, 10.0)), (cube, DVec3::splat(0.5))] {
            for k in 0..40 {
                let t: Lanes = std::array::from_fn(|i| (LANES * k + i) as f64);
                let points = [0.31, -0.27, 0.07].map(|step| t.map(|t| (step * t).sin()));
                let points: [Lanes; 3] =
                    std::array::from_fn(|axis| points[axis].map(|offset| start[axis] + 0.6 * offset));
                // Some along an axis.
                let directions = [0.91, 1.7, 2.3].map(|step| t.map(|t| ((step * t).sin() * 4.0).trunc()));
                let found = bounds.exit_distance_lanes(&points, &directions);
                for (i, found) in found.iter().enumerate() {
                    let expected = bounds.exit_distance(vector(&points, i), vector(&directions, i));
                    assert_eq!(found.to_bits(), expected.to_bits());
                }
            }
        }
    }

    #[test]
    fn what_certainly_misses_does_not_meet() {
        let ball = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 10.0).unwrap();
        let cube = Bounds::aligned_box(DVec3::ZERO, DVec3::ONE).unwrap();
        let (mut missed, mut met) = (0, 0);
        for i in 0..2000 {
            let t = f64::from(i);
            let offset = 100.0 * dvec3(t.sin(), (1.3 * t).cos(), (0.7 * t).sin());
            let aside = 2.0 * dvec3((0.3 * t).cos(), (0.9 * t).sin(), (0.11 * t).sin());
            for (bounds, size) in [(ball, 10.0), (cube, 0.7)] {
                let (center, _) = bounds.enclosing_ball();
                let (origin, direction) = (center + offset, (size * aside - offset).normalize());
                let meets = bounds.clip(origin, direction, None).unwrap().is_some();
                let misses = bounds.certainly_misses(origin, direction);
                assert!(!(meets && misses), "{origin} {direction}");
                missed += i32::from(misses);
                met += i32::from(meets);
            }
        }
        assert!(missed > 500 && met > 500, "{missed} {met}");
        assert!(!ball.certainly_misses(dvec3(1e6, 10.0, 10.0), -DVec3::X));
    }

    #[test]
    fn on_the_surface_it_leaves_at_once_or_crosses() {
        let ball = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
        assert_eq!(ball.exit_distance(DVec3::Z, DVec3::Z), 0.0);
        assert_eq!(ball.exit_distance(DVec3::Z, -DVec3::Z), 2.0);
        assert_eq!(ball.exit_distance(DVec3::Z * (1.0 + 1e-15), DVec3::Z), 0.0);
        let cube = Bounds::aligned_box(DVec3::ZERO, DVec3::ONE).unwrap();
        assert_eq!(cube.exit_distance(dvec3(1.0, 0.5, 0.5), DVec3::X), 0.0);
        assert_eq!(cube.exit_distance(dvec3(1.0, 0.5, 0.5), dvec3(-1.0, 0.0, -0.0)), 1.0);
        assert!(!cube.contains(dvec3(1.0 + 1e-15, 0.5, 0.5)));
        assert_eq!(cube.enclosing_ball(), (DVec3::splat(0.5), 0.5 * 3f64.sqrt()));
    }
}
