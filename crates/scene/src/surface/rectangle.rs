//! A parallelogram with right angles, or any other.

use super::AreaSample;
use crate::SceneError;
use fairflight_media::Line;
use glam::DVec3;

/// corner + u · edge_u + v · edge_v for u, v in \[0, 1\]. The outer side is that of edge_u × edge_v. Edges need not be at right
/// angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    pub(super) corner: DVec3,
    pub(super) edge_u: DVec3,
    pub(super) edge_v: DVec3,
    /// Normal of the outer side, of unit length.
    pub(super) normal: DVec3,
    pub(super) area: f64,
    /// Vector in the plane, with dual_u · edge_u = 1 and dual_u · edge_v = 0: the coordinate u of a point is dual_u · (point − corner).
    dual_u: DVec3,
    dual_v: DVec3,
}

impl Rectangle {
    /// # Errors
    /// If a number is not finite, or the edges span no area: one of them is zero, or the sine of the angle between them is
    /// below 1e-12, where coordinates have lost most of their digits.
    pub fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Result<Self, SceneError> {
        SceneError::check_finite("corner", corner.is_finite())?;
        SceneError::check_finite("edge_u", edge_u.is_finite())?;
        SceneError::check_finite("edge_v", edge_v.is_finite())?;
        let across = edge_u.cross(edge_v);
        let area = across.length();
        SceneError::check_finite("the area of the rectangle", area.is_finite())?;
        SceneError::check_finite("the far corner", (corner + edge_u + edge_v).is_finite())?;
        if edge_u.length() == 0.0 {
            return Err(SceneError::Degenerate { what: "edge_u", because: "a vector of length 0" });
        }
        if edge_v.length() == 0.0 {
            return Err(SceneError::Degenerate { what: "edge_v", because: "a vector of length 0" });
        }
        if !(area > 0.0 && area >= 1e-12 * edge_u.length() * edge_v.length()) {
            return Err(SceneError::Degenerate { what: "edge_v", because: "parallel to edge_u" });
        }
        let normal = across / area;
        let (dual_u, dual_v) = (edge_v.cross(normal) / area, normal.cross(edge_u) / area);
        let numbers_fit = normal.is_finite() && dual_u.is_finite() && dual_v.is_finite();
        SceneError::check_finite("the inverse of the area of the rectangle", numbers_fit)?;
        Ok(Self { corner, edge_u, edge_v, normal, area, dual_u, dual_v })
    }

    /// A line in the plane, or one that has left the rectangle, does not meet it.
    #[inline]
    pub(super) fn intersect(&self, line: &Line, length: f64, leaves: bool) -> Option<f64> {
        if leaves {
            return None;
        }
        let to_corner = self.corner - line.origin;
        // Parallel to the plane this is infinite, or 0/0 within it: neither lies between the ends.
        let distance = to_corner.dot(self.normal) / line.direction.dot(self.normal);
        if !(distance > 0.0 && distance < length) {
            return None;
        }
        // Edges belong to the rectangle, so that nothing passes between two that share one.
        let at = distance * line.direction - to_corner;
        let within = |coordinate: f64| (0.0..=1.0).contains(&coordinate);
        (within(at.dot(self.dual_u)) && within(at.dot(self.dual_v))).then_some(distance)
    }

    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }

    pub(super) fn area(&self) -> f64 {
        self.area
    }

    pub(super) fn sample_area(&self, u: f64, v: f64) -> AreaSample {
        AreaSample { position: self.corner + u * self.edge_u + v * self.edge_v, normal: self.normal }
    }

    /// Distance of `point` from the nearest point of the rectangle \[length\]: in the interior, or on one of the edges.
    pub(super) fn distance_to(&self, point: DVec3) -> f64 {
        let offset = point - self.corner;
        let (u, v) = (offset.dot(self.dual_u), offset.dot(self.dual_v));
        if (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v) {
            return offset.dot(self.normal).abs();
        }
        let to_edge = |start: DVec3, edge: DVec3| {
            let nearest = ((offset - start).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            (offset - start - nearest * edge).length()
        };
        to_edge(DVec3::ZERO, self.edge_u)
            .min(to_edge(self.edge_v, self.edge_u))
            .min(to_edge(DVec3::ZERO, self.edge_v))
            .min(to_edge(self.edge_u, self.edge_v))
    }

    pub(super) fn corners(&self) -> (DVec3, DVec3) {
        let (u, v) = (self.corner + self.edge_u, self.corner + self.edge_v);
        let far = u + self.edge_v;
        (self.corner.min(u).min(v).min(far), self.corner.max(u).max(v).max(far))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variates::Variates;
    use glam::{DMat3, dvec3};

    fn square() -> Rectangle {
        Rectangle::new(dvec3(-1.0, -1.0, 2.0), 2.0 * DVec3::X, 2.0 * DVec3::Y).unwrap()
    }

    fn meet(rectangle: &Rectangle, origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let line = Line { origin: origin.into(), direction: DVec3::from(direction).normalize() };
        rectangle.intersect(&line, f64::INFINITY, false)
    }

    #[test]
    fn along_the_axes_distances_are_exact_and_edges_belong_to_it() {
        for zero in [0.0, -0.0] {
            assert_eq!(meet(&square(), [0.5, 0.25, -1.0], [zero, zero, 1.0]), Some(3.0));
            assert_eq!(meet(&square(), [0.5, 0.25, 5.0], [zero, zero, -1.0]), Some(3.0));
            assert_eq!(meet(&square(), [1.0, -1.0, 0.0], [zero, zero, 1.0]), Some(2.0));
            assert_eq!(meet(&square(), [1.0 + 2.0 * f64::EPSILON, 0.0, 0.0], [zero, zero, 1.0]), None);
            // Away, in the plane, beside it, and starting in it without leaving it.
            assert_eq!(meet(&square(), [0.5, 0.25, -1.0], [zero, zero, -1.0]), None);
            assert_eq!(meet(&square(), [-3.0, 0.0, 2.0], [1.0, zero, zero]), None);
            assert_eq!(meet(&square(), [-3.0, 0.0, 1.0], [1.0, zero, zero]), None);
            assert_eq!(meet(&square(), [0.0, 0.0, 2.0], [zero, zero, 1.0]), None);
        }
        assert_eq!(meet(&square(), [0.5, 0.25, -1e6], [0.0, 0.0, 1.0]), Some(1e6 + 2.0));
        assert_eq!(meet(&square(), [0.0, 0.0, 1.0], [1.0, 0.0, 1e-300]), None);
    }

    #[test]
    fn the_ends_of_the_segment_do_not_belong_to_it() {
        let line = Line { origin: DVec3::ZERO, direction: DVec3::Z };
        assert_eq!(square().intersect(&line, 2.0, false), None);
        assert_eq!(square().intersect(&line, 2.0 + 4e-16, false), Some(2.0));
        assert_eq!(square().intersect(&line, f64::INFINITY, true), None);
    }

    #[test]
    fn any_ray_agrees_with_the_inverse_of_its_matrix() {
        // corner + u·U + v·V = o + t·d, solved by a matrix; from near, and from a million edge lengths away.
        let mut next = Variates::new(11);
        let mut met = 0;
        for i in 0..20_000 {
            let far = if i % 2 == 0 { 1.0 } else { 1e6 };
            let (corner, u, v) = (next.vector(), next.vector(), next.vector());
            let Ok(shape) = Rectangle::new(corner, u, v) else { panic!("{u} {v}") };
            let target = corner + (2.0 * next.draw() - 0.5) * u + (2.0 * next.draw() - 0.5) * v;
            let origin = target + far * next.vector();
            let direction = (target - origin).normalize();
            if direction.dot(shape.normal).abs() < 1e-3 || shape.area < 1e-2 {
                continue;
            }
            let solved = DMat3::from_cols(u, v, -direction).inverse() * (origin - corner);
            let margin = (solved.x.min(1.0 - solved.x)).min(solved.y.min(1.0 - solved.y));
            if margin.abs() < 1e-9 * far {
                continue;
            }
            let found = shape.intersect(&Line { origin, direction }, f64::INFINITY, false);
            assert_eq!(found.is_some(), margin > 0.0, "{solved}");
            if let Some(distance) = found {
                assert!((distance - solved.z).abs() < 1e-9 * far);
                met += 1;
            }
        }
        assert!(met > 2000, "{met}");
    }

    #[test]
    fn samples_boxes_and_distances() {
        let shape =
            Rectangle::new(dvec3(1.0, 0.0, 0.0), dvec3(2.0, 1.0, 0.0), dvec3(-1.0, 1.0, 1.0)).unwrap();
        let (least, greatest) = shape.corners();
        assert_eq!((least, greatest), (DVec3::ZERO, dvec3(3.0, 2.0, 1.0)));
        let mut next = Variates::new(12);
        for _ in 0..300 {
            let point = 3.0 * next.vector();
            let mut nearest = f64::INFINITY;
            for i in 0..=100 {
                for j in 0..=100 {
                    let at = shape.sample_area(f64::from(i) / 100.0, f64::from(j) / 100.0);
                    nearest = nearest.min(at.position.distance(point));
                }
            }
            // The lattice is 0.023 wide at most, so that the nearest of its points is at most its half diagonal farther.
            let found = shape.distance_to(point);
            assert!(found <= nearest + 1e-12 && nearest < found + 0.03, "{found} {nearest}");
        }
        assert_eq!(square().distance_to(dvec3(0.0, 0.0, 5.0)), 3.0);
        assert_eq!(square().distance_to(dvec3(4.0, 5.0, 2.0)), 5.0);
        assert_eq!(square().area(), 4.0);
        assert_eq!(square().sample_area(0.5, 0.25).position, dvec3(0.0, -0.5, 2.0));
    }

    #[test]
    fn what_spans_no_area_is_refused() {
        let refused = |corner, u, v| Rectangle::new(corner, u, v).unwrap_err();
        let (zero, x, y) = (DVec3::ZERO, DVec3::X, DVec3::Y);
        assert_eq!(refused(DVec3::NAN, x, y), SceneError::NotFinite { what: "corner" });
        assert_eq!(refused(zero, DVec3::INFINITY, y), SceneError::NotFinite { what: "edge_u" });
        assert_eq!(refused(zero, x, DVec3::NAN), SceneError::NotFinite { what: "edge_v" });
        assert!(matches!(refused(zero, zero, y), SceneError::Degenerate { what: "edge_u", .. }));
        assert!(matches!(refused(zero, x, -zero), SceneError::Degenerate { what: "edge_v", .. }));
        assert!(matches!(refused(zero, x, -3.0 * x), SceneError::Degenerate { what: "edge_v", .. }));
        assert!(matches!(refused(zero, x, x + 1e-13 * y), SceneError::Degenerate { what: "edge_v", .. }));
        assert!(matches!(refused(zero, 1e300 * x, 1e300 * y), SceneError::NotFinite { .. }));
        assert!(matches!(refused(zero, 1e-170 * x, 1e-170 * y), SceneError::Degenerate { .. }));
        assert!(Rectangle::new(zero, 1e-6 * x, 1e3 * y).is_ok());
    }
}
