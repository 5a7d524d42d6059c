//! Points and directions of lanes, which lie coordinate beside coordinate.

use fairflight_elementary::lanes::{LANES, Lanes};
use glam::DVec3;

/// The vector of a lane.
#[inline(always)]
#[must_use]
pub fn vector([x, y, z]: &[Lanes; 3], lane: usize) -> DVec3 {
    DVec3::new(x[lane], y[lane], z[lane])
}

/// Puts a vector into a lane.
#[inline(always)]
pub fn set_vector(coordinates: &mut [Lanes; 3], lane: usize, vector: DVec3) {
    for (coordinate, of_vector) in coordinates.iter_mut().zip(vector.to_array()) {
        coordinate[lane] = of_vector;
    }
}

/// The same vector in all lanes.
#[inline(always)]
#[must_use]
pub fn splat(vector: DVec3) -> [Lanes; 3] {
    vector.to_array().map(|coordinate| [coordinate; LANES])
}

/// `origin + s · direction` in each lane: the points of [`Line::at`](crate::Line::at).
#[inline(always)]
#[must_use]
pub fn points(origins: &[Lanes; 3], directions: &[Lanes; 3], s: &Lanes) -> [Lanes; 3] {
    let mut points = [[0.0; LANES]; 3];
    for axis in 0..3 {
        for i in 0..LANES {
            points[axis][i] = origins[axis][i] + s[i] * directions[axis][i];
        }
    }
    points
}
