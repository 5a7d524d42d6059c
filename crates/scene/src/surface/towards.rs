//! Directions from a point towards a shape: how a light of some extent is sampled.

use super::{Rectangle, Sphere, TowardsSample};
use crate::directions::{about, on_sphere};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

impl Rectangle {
    /// A point uniform by area, seen from `point`. `None` if that is in the plane.
    pub(super) fn sample_towards(&self, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        let offset = self.sample_area(u, v).position - point;
        let distance = offset.length();
        let direction = offset / distance;
        let pdf_solid_angle = self.pdf_towards(direction, distance);
        (distance > 0.0 && pdf_solid_angle > 0.0).then_some(TowardsSample {
            direction,
            distance,
            pdf_solid_angle,
        })
    }

    /// distance²/(area · |cosine|), with the angle to the normal; 0 in the plane, from where nothing is seen.
    #[inline]
    pub(super) fn pdf_towards(&self, direction: DVec3, distance: f64) -> f64 {
        let pdf = distance * distance / (self.area * self.normal.dot(direction).abs());
        if pdf.is_finite() { pdf } else { 0.0 }
    }
}

impl Sphere {
    /// Draws, from outside, uniformly in the cone of directions that meet the sphere, to the nearer crossing: its density is the greatest
    /// that is constant. From inside uniform in all directions: by area, the few directions that leave over a near part of the sphere
    /// would have weights without bound as the point comes near it. `None` on the sphere itself, at the distance `radius` to
    /// rounding, and where the cone is too narrow for its density to be a number (radius/distance below 1e-154).
    pub(super) fn sample_towards(&self, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        let to_center = self.center - point;
        let to_center_length = to_center.length();
        let pdf_solid_angle = self.pdf_at(to_center_length);
        if pdf_solid_angle == 0.0 {
            return None;
        }
        // The product of the distances of both crossings, by which the one follows from the other without cancellation.
        let power = (to_center_length - self.radius) * (to_center_length + self.radius);
        if power < 0.0 {
            let direction = on_sphere(u, v);
            let along = to_center.dot(direction);
            let half = (along * along - power).sqrt();
            let distance = if along > 0.0 { along + half } else { -power / (half - along) };
            return Some(TowardsSample { direction, distance, pdf_solid_angle });
        }
        // With m = 1 − cos of the cone's half angle and x = 1 − cos of the angle drawn, sin² is x (2 − x), and half of the chord is
        // √(radius² − d² sin²) = d √((m − x) (2 − m − x)).
        let most = self.one_minus_cosine(to_center_length);
        let x = u * most;
        let direction = about(to_center / to_center_length, ((x * (2.0 - x)).max(0.0).sqrt(), 1.0 - x), v);
        let half = to_center_length * ((most * (1.0 - u)) * (2.0 - most - x)).sqrt();
        let distance = power / (to_center_length * (1.0 - x) + half);
        Some(TowardsSample { direction, distance, pdf_solid_angle })
    }

    /// 1/(2π (1 − cos)) outside, 1/(4π) inside, 0 on the sphere. The direction has no part in it: it meets the sphere.
    #[inline]
    pub(super) fn pdf_towards(&self, point: DVec3) -> f64 {
        self.pdf_at((self.center - point).length())
    }

    fn pdf_at(&self, to_center: f64) -> f64 {
        if to_center > self.radius {
            let pdf = 1.0 / (TAU * self.one_minus_cosine(to_center));
            if pdf.is_finite() { pdf } else { 0.0 }
        } else if to_center < self.radius {
            1.0 / (4.0 * PI)
        } else {
            0.0
        }
    }

    /// 1 − cos of the half angle under which the sphere is seen from outside: sin²/(1 + cos), and cos² as a product; neither
    /// cancels, far away or near.
    fn one_minus_cosine(&self, to_center: f64) -> f64 {
        let sine = self.radius / to_center;
        let cosine = (((to_center - self.radius) / to_center) * (1.0 + sine)).sqrt();
        sine * sine / (1.0 + cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use crate::variates::{Variates, mean_and_error};
    use fairflight_media::Line;
    use glam::dvec3;

    /// Checks every sample against the intersection and the density, and returns the mean of `g`/pdf and its error.
    fn integral(shape: Shape, point: DVec3, g: impl Fn(DVec3) -> f64) -> (f64, f64) {
        let mut next = Variates::new(31);
        mean_and_error(100_000, || {
            let sample = shape.sample_towards(point, next.draw(), next.draw()).unwrap();
            assert!((sample.direction.length() - 1.0).abs() < 1e-15);
            let told = shape.pdf_towards(point, sample.direction, sample.distance);
            assert_eq!(sample.pdf_solid_angle, told);
            let line = Line { origin: point, direction: sample.direction };
            // At the rim, rounding decides whether a direction meets the shape.
            if let Some(met) = shape.intersect(&line, f64::INFINITY, false) {
                let cosine = shape.normal(line.at(met)).dot(sample.direction).abs();
                assert!(
                    (met - sample.distance).abs() * cosine < 1e-14 * (1.0 + met),
                    "{met} {}",
                    sample.distance
                );
            }
            g(sample.direction) / sample.pdf_solid_angle
        })
    }

    /// Five standard errors (false alarm 6e-7), and rounding where nothing is left to chance.
    fn agree((mean, error): (f64, f64), expected: f64) {
        let tolerance = 5.0 * error + 1e-10 * expected.abs();
        assert!((mean - expected).abs() < tolerance, "{mean} ± {error}, expected {expected}");
    }

    #[test]
    fn a_rectangle_seen_from_before_its_middle() {
        let (a, b) = (1.0, 0.5);
        let shape = Shape::Rectangle(
            Rectangle::new(dvec3(-a, -b, 0.0), 2.0 * a * DVec3::X, 2.0 * b * DVec3::Y).unwrap(),
        );
        for d in [0.2, 1.0, 30.0] {
            let exact = 4.0 * (a * b / (d * f64::sqrt(a * a + b * b + d * d))).atan();
            for z in [d, -d] {
                agree(integral(shape, dvec3(0.0, 0.0, z), |_| 1.0), exact);
            }
            // The form factor of a rectangle to a parallel patch below its middle, times π.
            let (x, y) = (f64::hypot(a, d), f64::hypot(b, d));
            let form = 2.0 * (a / x * (b / x).atan() + b / y * (a / y).atan());
            agree(integral(shape, dvec3(0.0, 0.0, d), |w| -w.z), form);
        }
        assert!(shape.sample_towards(dvec3(3.0, 0.2, 0.0), 0.4, 0.7).is_none());
        assert!(shape.sample_towards(dvec3(0.0, 0.0, 0.0), 0.5, 0.5).is_none());
        assert_eq!(shape.pdf_towards(dvec3(3.0, 0.2, 0.0), DVec3::NEG_X, 2.5), 0.0);
    }

    #[test]
    fn a_sphere_seen_from_outside() {
        let center = dvec3(0.3, -0.2, 0.5);
        let shape = Shape::Sphere(Sphere::new(center, 0.7).unwrap());
        let axis = dvec3(0.48, 0.6, 0.64);
        for d in [0.7 + 1e-9, 0.75, 2.0, 1e4, 1e8] {
            let point = center - d * axis;
            let sin2: f64 = (0.7 / d) * (0.7 / d);
            let angle =
                if d < 1e3 { TAU * (1.0 - (1.0 - sin2).sqrt()) } else { PI * sin2 * (1.0 + sin2 / 4.0) };
            agree_relative(integral(shape, point, |_| 1.0).0, angle);
            agree(integral(shape, point, |w| w.dot(axis)), PI * sin2);
            // Nothing is preferred about the axis.
            let across = dvec3(0.6, -0.48, 0.0).normalize();
            let (mean, error) = integral(shape, point, |w| w.dot(across - across.dot(axis) * axis));
            assert!(mean.abs() < 5.0 * error, "{mean} {error}");
        }
    }

    /// 1 − √(1 − s) of the expected value loses digits near, d − radius itself does, too.
    fn agree_relative(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }

    #[test]
    fn a_sphere_seen_from_inside_is_everywhere() {
        let shape = Shape::Sphere(Sphere::new(DVec3::ONE, 2.0).unwrap());
        for off in [0.0, 1.0, 2.0 - 1e-9] {
            let point = DVec3::ONE + off * DVec3::Y;
            agree(integral(shape, point, |_| 1.0), 4.0 * PI);
            agree(integral(shape, point, |w| w.y * w.y), 4.0 * PI / 3.0);
            let (mean, error) = integral(shape, point, |w| w.y);
            assert!(mean.abs() < 5.0 * error);
        }
    }

    #[test]
    fn what_cannot_be_seen_has_no_sample_and_no_density() {
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
        assert!(sphere.sample_towards(2.0 * DVec3::X, 0.5, 0.5).is_none());
        assert_eq!(sphere.pdf_towards(2.0 * DVec3::X, DVec3::X, 1.0), 0.0);
        let speck = Shape::Sphere(Sphere::new(DVec3::ZERO, 1e-150).unwrap());
        let point = 1e10 * DVec3::X;
        assert!(speck.sample_towards(point, 0.5, 0.5).is_none());
        assert_eq!(speck.pdf_towards(point, DVec3::NEG_X, 1e10), 0.0);
    }

    #[test]
    fn the_rim_and_the_middle_of_the_cone() {
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 3.0).unwrap());
        let point = dvec3(0.0, 0.0, 5.0);
        let middle = sphere.sample_towards(point, 0.0, 0.3).unwrap();
        assert_eq!((middle.direction, middle.distance), (DVec3::NEG_Z, 2.0));
        let rim = sphere.sample_towards(point, 1.0, 0.3).unwrap();
        assert!((rim.direction.z + 0.8).abs() < 1e-15 && (rim.distance - 4.0).abs() < 1e-14);
    }

    #[test]
    fn distances_to_a_near_sphere_keep_their_digits() {
        // Straight onto it from both sides; the difference of two near numbers is exact.
        for radius in [0.3, 0.7, 1.1, 1.9] {
            let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, radius).unwrap());
            for z in [1e-6, 1e-11, -1e-11, -1e-6].map(|h| radius + h) {
                let point = dvec3(0.0, 0.0, z);
                let found = sphere.sample_towards(point, 0.0, 0.3).unwrap().distance;
                assert!((found / (z - radius).abs() - 1.0).abs() < 2e-15, "{radius} {z} {found}");
                // Slanted: the quadratic equation of the crossing, t² − 2 t along + z² − radius² = 0.
                for u in [0.1, 0.2, 0.3] {
                    let sample = sphere.sample_towards(point, u, 0.3).unwrap();
                    let (t, along) = (sample.distance, -z * sample.direction.z);
                    let last = (z - radius) * (z + radius);
                    assert!((t * (t - 2.0 * along) + last).abs() < 4e-15 * last.abs(), "{radius} {z} {u}");
                }
            }
        }
    }
}
