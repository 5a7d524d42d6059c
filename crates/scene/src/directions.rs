//! Directions drawn by closed forms, and frames about them.

use fairflight_elementary::sin_cos;
use glam::{DVec3, dvec3};
use std::f64::consts::TAU;

/// Uniform on the unit sphere.
pub(crate) fn on_sphere(u: f64, v: f64) -> DVec3 {
    let z = 1.0 - 2.0 * u;
    let (sin, cos) = sin_cos(TAU * v);
    let horizontal = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    dvec3(horizontal * cos, horizontal * sin, z)
}

/// Two unit vectors across a unit vector and each other.
pub(crate) fn across(axis: DVec3) -> (DVec3, DVec3) {
    let x = axis.any_orthonormal_vector();
    (x, axis.cross(x))
}

/// The direction at an angle from `axis`, given as its sine and cosine, and at the azimuth τ·v about it.
#[inline]
pub(crate) fn about(axis: DVec3, (sin, cos): (f64, f64), v: f64) -> DVec3 {
    let (x, y) = across(axis);
    let (up, right) = sin_cos(TAU * v);
    sin * right * x + sin * up * y + cos * axis
}

/// A direction on the side of `normal` (of unit length) with the density cosine/π per solid angle, for u, v in \[0, 1).
///
/// The cosine is √(1 − u) and therefore never 0; the sine is √u, so that the result has unit length to rounding.
#[inline]
#[must_use]
pub fn cosine_hemisphere(normal: DVec3, u: f64, v: f64) -> DVec3 {
    debug_assert!((normal.length_squared() - 1.0).abs() < 1e-9, "not of unit length: {normal}");
    about(normal, (u.sqrt(), (1.0 - u).sqrt()), v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variates::{Variates, mean_and_error};

    #[test]
    fn directions_about_a_normal_have_unit_length_and_are_on_its_side() {
        let mut next = Variates::new(1);
        for _ in 0..10_000 {
            let normal = on_sphere(next.draw(), next.draw());
            let direction = cosine_hemisphere(normal, next.draw(), next.draw());
            assert!((direction.length() - 1.0).abs() < 4.0 * f64::EPSILON);
            assert!(direction.dot(normal) > 0.0);
            let grazing = cosine_hemisphere(normal, 1.0 - f64::EPSILON / 2.0, next.draw());
            assert!(grazing.dot(normal) > 0.0);
        }
        assert_eq!(cosine_hemisphere(DVec3::NEG_Z, 0.0, 0.3), DVec3::NEG_Z);
    }

    #[test]
    fn the_density_is_that_of_the_cosine() {
        // Under cosine/π the mean of the cosine is 2/3, that of its square 1/2, and the components across it have the
        // mean square 1/4 each. Five standard errors: false alarm below 1e-6 per comparison.
        let normal = dvec3(0.36, -0.48, 0.8);
        let (x, y) = across(normal);
        let moments = |c: f64, a: f64, b: f64| [c, c * c, a * a, b * b, a * b, a, b];
        for (index, expected) in [2.0 / 3.0, 0.5, 0.25, 0.25, 0.0, 0.0, 0.0].into_iter().enumerate() {
            let mut next = Variates::new(2);
            let (mean, error) = mean_and_error(100_000, || {
                let d = cosine_hemisphere(normal, next.draw(), next.draw());
                moments(d.dot(normal), d.dot(x), d.dot(y))[index]
            });
            assert!((mean - expected).abs() < 5.0 * error, "{mean} {expected}");
        }
    }
}
