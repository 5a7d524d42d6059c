//! A sphere.

use super::AreaSample;
use crate::SceneError;
use crate::directions::on_sphere;
use fairflight_media::Line;
use glam::DVec3;
use std::f64::consts::PI;

/// All points at the distance `radius` from `center`; the outer side is outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl Sphere {
    /// # Errors
    /// If a number is not finite, or radius or area are not above 0.
    pub fn new(center: DVec3, radius: f64) -> Result<Self, SceneError> {
        SceneError::check_finite("center", center.is_finite())?;
        SceneError::check_positive("radius", radius)?;
        let sphere = Self { center, radius };
        SceneError::check_positive("the area of the sphere", sphere.area())?;
        Ok(sphere)
    }

    /// A line that only touches does not meet the sphere. One that starts on it meets it at the other end of its chord, which
    /// the reflection of the origin about the point nearest to the center gives without a root; where that end lies behind,
    /// the line goes away from the sphere.
    #[inline]
    pub(super) fn intersect(&self, line: &Line, length: f64, leaves: bool) -> Option<f64> {
        let to_center = self.center - line.origin;
        let along = to_center.dot(line.direction);
        let distance = if leaves {
            2.0 * along
        } else {
            // How near the line comes to the center, from the vector itself: rounded at the size of a far origin's distance, as the ray
            // is, and not at that of its square, as a discriminant would be.
            let closest = (along * line.direction - to_center).length();
            if closest >= self.radius {
                return None;
            }
            // A product does not cancel as the difference of two squares does.
            let half = ((self.radius - closest) * (self.radius + closest)).sqrt();
            if along > half { along - half } else { along + half }
        };
        (distance > 0.0 && distance < length).then_some(distance)
    }

    /// The line meets the sphere once more at length − 2 (target − center) · direction. Between two points of one sphere there
    /// is only its inside.
    #[inline]
    pub(super) fn blocks_its_own_point(&self, line: &Line, length: f64, leaves: bool) -> bool {
        if leaves {
            return false;
        }
        let past_center = (line.at(length) - self.center).dot(line.direction);
        let other = length - 2.0 * past_center;
        past_center > 0.0 && other > 0.0
    }

    pub(super) fn normal(&self, point: DVec3) -> DVec3 {
        (point - self.center).normalize_or(DVec3::Z)
    }

    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    pub(super) fn sample_area(&self, u: f64, v: f64) -> AreaSample {
        let normal = on_sphere(u, v);
        AreaSample { position: self.center + self.radius * normal, normal }
    }

    pub(super) fn encloses(&self, point: DVec3) -> bool {
        point.distance(self.center) < self.radius
    }

    /// Distance of `point` from the surface, not from the ball \[length\].
    pub(super) fn distance_to(&self, point: DVec3) -> f64 {
        (point.distance(self.center) - self.radius).abs()
    }

    pub(super) fn corners(&self) -> (DVec3, DVec3) {
        (self.center - self.radius, self.center + self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variates::Variates;
    use glam::dvec3;

    fn ball() -> Sphere {
        Sphere::new(dvec3(0.0, 0.0, 5.0), 2.0).unwrap()
    }

    fn line(origin: DVec3, towards: DVec3) -> Line {
        Line { origin, direction: (towards - origin).normalize() }
    }

    #[test]
    fn from_outside_inside_and_beyond() {
        let along_z = |z: f64| {
            let line = Line { origin: dvec3(-0.0, 0.0, z), direction: dvec3(0.0, -0.0, 1.0) };
            ball().intersect(&line, f64::INFINITY, false)
        };
        assert_eq!(along_z(0.0), Some(3.0));
        assert_eq!(along_z(3.5), Some(3.5));
        assert_eq!(along_z(6.0), Some(1.0));
        assert_eq!(along_z(8.0), None);
        assert_eq!(along_z(-1e6), Some(1e6 + 3.0));
        let beside = Line { origin: dvec3(2.5, 0.0, 0.0), direction: DVec3::Z };
        assert_eq!(ball().intersect(&beside, f64::INFINITY, false), None);
        let touching = Line { origin: dvec3(2.0, 0.0, 0.0), direction: DVec3::Z };
        assert_eq!(ball().intersect(&touching, f64::INFINITY, false), None);
        let middle = Line { origin: DVec3::ZERO, direction: DVec3::Z };
        assert_eq!(ball().intersect(&middle, 3.0, false), None);
        assert_eq!(ball().intersect(&middle, 3.0 + 1e-15, false), Some(3.0));
    }

    #[test]
    fn grazing_and_far_rays_end_on_the_sphere() {
        // A point aimed at, by its distance h from the rim of the disc that is seen: half the chord is √(h (4 − h)).
        for far in [1.0, 1e3, 1e6] {
            for h in [1e-3f64, 1e-6, 1e-9] {
                let origin = dvec3(2.0 - h, 0.0, 5.0 - 10.0 * far);
                let ray = Line { origin, direction: DVec3::Z };
                let found = ball().intersect(&ray, f64::INFINITY, false).unwrap();
                let half = (h * (4.0 - h)).sqrt();
                // The number 2 − h is rounded by 2e-16, which moves the half chord by 2e-16 · 2/half.
                let rounding = 4e-16 * 2.0 / half + 4e-16 * 10.0 * far;
                assert!((found - (10.0 * far - half)).abs() <= rounding, "{far} {h}");
            }
        }
        // Across the axis near the rim, where all numbers are exact, half the chord is right to the last digits.
        for h in [2f64.powi(-20), 2f64.powi(-40), 2f64.powi(-50)] {
            let ray = Line { origin: dvec3(2.0 - h, 0.0, 5.0), direction: DVec3::Z };
            let found = ball().intersect(&ray, f64::INFINITY, false).unwrap();
            assert!((found / (h * (4.0 - h)).sqrt() - 1.0).abs() < 4e-16, "{h}");
        }
        let mut next = Variates::new(21);
        for _ in 0..20_000 {
            let far = 10f64.powf(7.0 * next.draw());
            let target = ball().sample_area(next.draw(), next.draw());
            let ray = line(target.position + far * next.vector(), target.position);
            if let Some(found) = ball().intersect(&ray, f64::INFINITY, false) {
                let off = (ray.at(found).distance(ball().center) - 2.0).abs();
                assert!(off < 1e-14 + 1e-15 * far, "{far} {off}");
            } else {
                // Only a ray that grazes may miss the point that it was aimed at.
                assert!(target.normal.dot(ray.direction).abs() < 1e-3, "{far}");
            }
        }
    }

    #[test]
    fn a_ray_that_leaves_meets_the_other_end_of_its_chord_or_nothing() {
        let mut next = Variates::new(22);
        for _ in 0..20_000 {
            let [a, b] = [(); 2].map(|()| ball().sample_area(next.draw(), next.draw()));
            let chord = a.position.distance(b.position);
            let inwards = line(a.position, b.position);
            let found = ball().intersect(&inwards, f64::INFINITY, true).unwrap();
            // The ends are rounded off the sphere by up to 1e-15, which moves the end of a chord by diameter/chord as much.
            assert!((found - chord).abs() < 4e-15 * (1.0 + 4.0 / chord), "{found} {chord}");
            assert!(!ball().blocks_its_own_point(&inwards, chord, true));
            let outwards = Line { origin: a.position, direction: -inwards.direction };
            assert_eq!(ball().intersect(&outwards, f64::INFINITY, true), None);
        }
    }

    #[test]
    fn a_point_hides_behind_its_sphere_and_only_there() {
        let mut next = Variates::new(23);
        let mut counts = [0, 0, 0];
        for _ in 0..20_000 {
            let target = ball().sample_area(next.draw(), next.draw());
            let origin = dvec3(0.0, 0.0, 5.0) + 4.0 * next.vector();
            let ray = line(origin, target.position);
            let facing = target.normal.dot(ray.direction);
            if facing.abs() < 1e-6 {
                continue;
            }
            let inside = ball().encloses(origin);
            let hidden = facing > 0.0 && !inside;
            let distance = origin.distance(target.position);
            assert_eq!(ball().blocks_its_own_point(&ray, distance, false), hidden, "{origin}");
            counts[if inside { 2 } else { usize::from(hidden) }] += 1;
        }
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    #[test]
    fn samples_boxes_and_distances() {
        assert_eq!(ball().corners(), (dvec3(-2.0, -2.0, 3.0), dvec3(2.0, 2.0, 7.0)));
        assert_eq!(ball().area(), 16.0 * PI);
        assert_eq!(ball().distance_to(dvec3(0.0, 0.0, 5.5)), 1.5);
        assert_eq!(ball().distance_to(DVec3::ZERO), 3.0);
        assert!(ball().encloses(dvec3(0.0, 0.0, 6.9)) && !ball().encloses(dvec3(0.0, 0.0, 7.0)));
        let sample = ball().sample_area(0.3, 0.7);
        assert!((sample.position.distance(ball().center) - 2.0).abs() < 1e-15);
        assert!(ball().normal(sample.position).distance(sample.normal) < 1e-15);
    }

    #[test]
    fn no_radius_is_refused() {
        assert_eq!(Sphere::new(DVec3::NAN, 1.0), Err(SceneError::NotFinite { what: "center" }));
        assert_eq!(Sphere::new(DVec3::ZERO, f64::NAN), Err(SceneError::NotFinite { what: "radius" }));
        assert_eq!(
            Sphere::new(DVec3::ZERO, 0.0),
            Err(SceneError::NotPositive { what: "radius", found: 0.0 })
        );
        assert!(matches!(Sphere::new(DVec3::ZERO, -1.0), Err(SceneError::NotPositive { .. })));
        assert!(matches!(Sphere::new(DVec3::ZERO, 1e-170), Err(SceneError::NotPositive { .. })));
        assert!(matches!(Sphere::new(DVec3::ZERO, 1e170), Err(SceneError::NotFinite { .. })));
    }
}
