//! The density of what is drawn from two variates.

use super::greatest;
use glam::DVec3;

/// Step of the differences: their error is that of rounding, 1e-16/STEP, and STEP⁴ times a fifth derivative.
const STEP: f64 = 2e-4;

/// Relative error of a density by differences, for maps that vary by less than a hundred times over a tenth of their range.
pub const GRANTED: f64 = 1e-7;

/// The points in each direction at which a map is tried.
const POINTS: u32 = 12;

/// **Law.** A map x(u, v) of two uniform variates has the density 1/|∂x/∂u × ∂x/∂v| per area, or per solid angle for unit vectors:
/// the greatest relative deviation of `density(x)` from it over a grid of variates. A map that covers a part of what its density
/// says, or counts some of it twice, is off by that factor everywhere.
///
/// `None` of the map is a deviation without bounds.
pub fn deviation(map: impl Fn(f64, f64) -> Option<DVec3>, density: impl Fn(DVec3) -> f64) -> f64 {
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(POINTS);
    let at = |u: f64, v: f64| -> f64 {
        let (Some(x), Some(area)) = (map(u, v), area(&map, u, v)) else { return f64::NAN };
        (density(x) * area - 1.0).abs()
    };
    greatest(
        (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (middle(i), middle(j)))).map(|(u, v)| at(u, v)),
    )
}

/// |∂x/∂u × ∂x/∂v| by central differences of the fourth order.
fn area(map: impl Fn(f64, f64) -> Option<DVec3>, u: f64, v: f64) -> Option<f64> {
    let slope = |du: f64, dv: f64| {
        let difference = |k: f64| Some(map(u + k * du, v + k * dv)? - map(u - k * du, v - k * dv)?);
        Some((8.0 * difference(1.0)? - difference(2.0)?) / (12.0 * STEP))
    };
    Some(slope(STEP, 0.0)?.cross(slope(0.0, STEP)?).length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;
    use std::f64::consts::{FRAC_1_PI, TAU};

    /// A direction about z, with a density proportional to its cosine.
    fn cosine_hemisphere(u: f64, v: f64) -> DVec3 {
        let (sine, cosine) = ((1.0 - u).sqrt(), u.sqrt());
        dvec3(sine * (TAU * v).cos(), sine * (TAU * v).sin(), cosine)
    }

    #[test]
    fn a_cosine_is_drawn_as_it_is_told_and_a_part_of_it_is_not() {
        let told = |direction: DVec3| direction.z * FRAC_1_PI;
        let part = |u: f64, v: f64| deviation(move |x, y| Some(cosine_hemisphere(u * x, v * y)), told);
        assert!(part(1.0, 1.0) < GRANTED, "{}", part(1.0, 1.0));
        for (u, v) in [(0.999, 1.0), (1.0, 0.999)] {
            assert!((part(u, v) - 0.001).abs() < 1e-5);
        }
        assert!(deviation(|_, _| None, told).is_nan());
    }
}
