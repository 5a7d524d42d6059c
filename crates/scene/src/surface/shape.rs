//! A primitive of either kind.

use super::{Rectangle, Sphere};
use fairflight_media::Line;
use glam::DVec3;

/// Shape and place of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Flat.
    Rectangle(Rectangle),
    /// Round.
    Sphere(Sphere),
}

/// A point of a surface, uniform by area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    /// The point.
    pub position: DVec3,
    /// The normal of the outer side there, of unit length.
    pub normal: DVec3,
}

/// A direction from a point towards a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TowardsSample {
    /// Direction of unit length.
    pub direction: DVec3,
    /// Distance to the surface along it \[length\].
    pub distance: f64,
    /// The density of the direction \[1/sr\], positive.
    pub pdf_solid_angle: f64,
}

impl Shape {
    /// The distance at which a line first meets the shape within `(0, length)`; `None` if nowhere.
    ///
    /// `leaves` says that the line starts on this very shape: the crossing at its origin is then left out by algebra, not by a
    /// distance that is taken for zero. A flat shape is not met again; a sphere at the other end of the chord.
    #[inline]
    #[must_use]
    pub fn intersect(&self, line: &Line, length: f64, leaves: bool) -> Option<f64> {
        match self {
            Self::Rectangle(rectangle) => rectangle.intersect(line, length, leaves),
            Self::Sphere(sphere) => sphere.intersect(line, length, leaves),
        }
    }

    /// True if the shape blocks a segment of a line that ends, at `length`, on this very shape; `leaves` as in
    /// [`intersect`](Self::intersect).
    #[inline]
    #[must_use]
    pub fn blocks_its_own_point(&self, line: &Line, length: f64, leaves: bool) -> bool {
        match self {
            Self::Rectangle(_) => false,
            Self::Sphere(sphere) => sphere.blocks_its_own_point(line, length, leaves),
        }
    }

    /// The normal of the outer side at a point of the shape, of unit length.
    #[inline]
    #[must_use]
    pub fn normal(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Rectangle(rectangle) => rectangle.normal(),
            Self::Sphere(sphere) => sphere.normal(point),
        }
    }

    /// \[length²\], of one side.
    #[must_use]
    pub fn area(&self) -> f64 {
        match self {
            Self::Rectangle(rectangle) => rectangle.area(),
            Self::Sphere(sphere) => sphere.area(),
        }
    }

    /// A point uniform by area.
    #[must_use]
    pub fn sample_area(&self, u: f64, v: f64) -> AreaSample {
        match self {
            Self::Rectangle(rectangle) => rectangle.sample_area(u, v),
            Self::Sphere(sphere) => sphere.sample_area(u, v),
        }
    }

    /// A direction from `point` towards the part of the shape that is seen from there; `None` where nothing is seen (a set of
    /// measure zero: in the plane of a rectangle, on a sphere).
    ///
    /// Towards a rectangle by a point uniform by area; towards a sphere from outside uniform in the cone of directions that meet
    /// it, from inside uniform in all directions.
    ///
    /// A point that was found on this very shape must not ask: rounding says on which side of a sphere it lies. What a shape sees
    /// of itself (a sphere its inside) is left to directions drawn otherwise, with a density of 0 for this way.
    #[inline]
    #[must_use]
    pub fn sample_towards(&self, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        match self {
            Self::Rectangle(rectangle) => rectangle.sample_towards(point, u, v),
            Self::Sphere(sphere) => sphere.sample_towards(point, u, v),
        }
    }

    /// The density of [`sample_towards`](Self::sample_towards) for a direction of unit length that first meets the shape at
    /// `distance` \[1/sr\], to the last bit the one that the sample tells; 0 where there is no sample.
    #[inline]
    #[must_use]
    pub fn pdf_towards(&self, point: DVec3, direction: DVec3, distance: f64) -> f64 {
        match self {
            Self::Rectangle(rectangle) => rectangle.pdf_towards(direction, distance),
            Self::Sphere(sphere) => sphere.pdf_towards(point),
        }
    }

    /// True if the shape has an inside.
    #[inline]
    #[must_use]
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Sphere(_))
    }

    /// True if a point lies inside; nothing lies inside a rectangle.
    #[must_use]
    pub fn encloses(&self, point: DVec3) -> bool {
        match self {
            Self::Rectangle(_) => false,
            Self::Sphere(sphere) => sphere.encloses(point),
        }
    }

    /// True if the shape comes within `radius` of `center`.
    #[must_use]
    pub fn reaches(&self, center: DVec3, radius: f64) -> bool {
        match self {
            Self::Rectangle(rectangle) => rectangle.distance_to(center) <= radius,
            Self::Sphere(sphere) => sphere.distance_to(center) <= radius,
        }
    }

    /// The corners of a box along the axes around the shape: least and greatest coordinates.
    #[must_use]
    pub fn corners(&self) -> (DVec3, DVec3) {
        match self {
            Self::Rectangle(rectangle) => rectangle.corners(),
            Self::Sphere(sphere) => sphere.corners(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_has_an_inside_and_a_rectangle_none() {
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
        let rectangle =
            Shape::Rectangle(Rectangle::new(-DVec3::ONE, 2.0 * DVec3::X, 2.0 * DVec3::Y).unwrap());
        assert_eq!([sphere, rectangle].map(|shape| shape.is_closed()), [true, false]);
        assert_eq!([sphere, rectangle].map(|shape| shape.encloses(DVec3::ZERO)), [true, false]);
    }
}
