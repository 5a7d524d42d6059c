//! A direction at a given angle to another.

use crate::lanes::{set_vector, vector};
use fairflight_elementary::lanes::{self, LANES, Lanes};
use fairflight_elementary::sin_cos;
use glam::{DVec3, dvec3};
use std::f64::consts::TAU;

/// The unit vector at the angle acos(`cosine`) from the unit vector `axis`, turned about it by `turn` of a whole turn.
#[inline]
pub(super) fn deflect(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    by_azimuth(axis, cosine, sin_cos(TAU * turn))
}

/// The same in all lanes.
#[inline(always)]
pub(super) fn deflect_lanes(axes: &[Lanes; 3], cosines: &Lanes, turns: &Lanes) -> [Lanes; 3] {
    let mut azimuths = [0.0; LANES];
    for i in 0..LANES {
        azimuths[i] = TAU * turns[i];
    }
    let (sines, cosines_of_azimuths) = lanes::sin_cos(&azimuths);
    let mut directions = [[0.0; LANES]; 3];
    for i in 0..LANES {
        let direction = by_azimuth(vector(axes, i), cosines[i], (sines[i], cosines_of_azimuths[i]));
        set_vector(&mut directions, i, direction);
    }
    directions
}

/// [`deflect`] by the sine and cosine of the azimuth.
#[inline(always)]
fn by_azimuth(axis: DVec3, cosine: f64, (sin_azimuth, cos_azimuth): (f64, f64)) -> DVec3 {
    // (1 − c)(1 + c) keeps the sine of a small angle, where 1 − c² would cancel.
    let squared = (1.0 - cosine) * (1.0 + cosine);
    let sine = if squared > 0.0 { squared } else { 0.0 }.sqrt();
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
            let direction = deflect(axis, cosine, (0.27 * t).fract());
            assert!((direction.length() - 1.0).abs() < 1e-15);
            assert!((direction.dot(axis) - cosine).abs() < 1e-14, "{axis} {cosine}");
        }
        for axis in [DVec3::Z, -DVec3::Z, DVec3::X, dvec3(0.0, -1.0, -0.0)] {
            assert!((deflect(axis, 0.25, 0.16).dot(axis) - 0.25).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_do_not_drift() {
        let mut direction = DVec3::Z;
        for i in 0..1_000_000 {
            direction = deflect(direction, (f64::from(i)).sin(), (0.159 * f64::from(i)).fract());
        }
        assert!((direction.length() - 1.0).abs() < 1e-15);
    }

    /// Newton's step squares what the length is off by.
    #[test]
    fn a_length_that_is_off_is_mended() {
        for off in [1e-4, -1e-4] {
            let direction = deflect((1.0 + off) * DVec3::Z, 1.0, 0.05);
            assert!((direction.length() - 1.0).abs() < 1e-7, "{}", direction.length());
        }
    }
}
