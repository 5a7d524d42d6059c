//! A direction at a given angle to another.

use glam::{DVec3, dvec3};

/// The unit vector at the angle acos(`cosine`) from the unit vector `axis`, turned about it by `azimuth`.
#[inline]
pub(super) fn deflect(axis: DVec3, cosine: f64, azimuth: f64) -> DVec3 {
    // (1 − c)(1 + c) keeps the sine of a small angle, where 1 − c² would cancel.
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin_azimuth, cos_azimuth) = azimuth.sin_cos();
    // An orthonormal frame without a branch on the axis, continuous but for the sign of z (duff-2017).
    let sign = 1.0_f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    let x = dvec3(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    let y = dvec3(b, sign + axis.y * axis.y * a, -axis.y);
    let direction = sine * cos_azimuth * x + sine * sin_azimuth * y + cosine * axis;
    // One Newton step towards unit length: thousands of deflections in a row do not drift.
    direction * (1.5 - 0.5 * direction.length_squared())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_kept_in_every_direction() {
        for i in 0..200 {
            let t = f64::from(i);
            let axis = dvec3(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()).normalize();
            let cosine = (2.9 * t).sin();
            let direction = deflect(axis, cosine, 1.7 * t);
            assert!((direction.length() - 1.0).abs() < 1e-15);
            assert!((direction.dot(axis) - cosine).abs() < 1e-14, "{axis} {cosine}");
        }
        for axis in [DVec3::Z, -DVec3::Z, DVec3::X, dvec3(0.0, -1.0, -0.0)] {
            assert!((deflect(axis, 0.25, 1.0).dot(axis) - 0.25).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_do_not_drift() {
        let mut direction = DVec3::Z;
        for i in 0..1_000_000 {
            direction = deflect(direction, (f64::from(i)).sin(), f64::from(i));
        }
        assert!((direction.length() - 1.0).abs() < 1e-15);
    }

    /// Newton's step squares what the length is off by.
    #[test]
    fn a_length_that_is_off_is_mended() {
        for off in [1e-4, -1e-4] {
            let direction = deflect((1.0 + off) * DVec3::Z, 1.0, 0.3);
            assert!((direction.length() - 1.0).abs() < 1e-7, "{}", direction.length());
        }
    }
}
