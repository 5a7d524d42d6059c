//! The region a medium fills, and the part of a ray inside it.

use crate::{FieldError, Line};
use glam::DVec3;

/// A closed region of space: its surface belongs to it.
///
/// The constructors check; [`Bounds::clip`] relies on what they check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// All points within `radius` of `center`.
    Sphere {
        /// The center \[length\], finite.
        center: DVec3,
        /// The radius \[length\], finite, zero or positive.
        radius: f64,
    },
    /// All points between two corners.
    Box {
        /// The corner with the least coordinates \[length\], finite.
        min: DVec3,
        /// The corner with the greatest coordinates \[length\], finite, nowhere below `min`.
        max: DVec3,
    },
}

/// The part of a ray inside bounds. Its line starts at the entry point, not at the origin of the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// The line from the entry point along the unit direction of the ray.
    pub line: Line,
    /// The distance from the origin of the ray to the entry point \[length\]: 0 if the origin is inside.
    pub entry_distance: f64,
    /// The distance from the entry point to where the ray leaves or ends \[length\].
    pub length: f64,
}

impl Clip {
    /// The clip of a ray that misses: of length 0, at its own origin. Its transmittance is 1.
    ///
    /// The `direction` may have any length; where it has none (zero or not finite) the clip points along x.
    #[must_use]
    pub fn empty(origin: DVec3, direction: DVec3) -> Self {
        let direction = unit(direction).unwrap_or(DVec3::X);
        Self { line: Line { origin, direction }, entry_distance: 0.0, length: 0.0 }
    }
}

impl Bounds {
    /// A ball; of radius 0 it is a point.
    ///
    /// # Errors
    /// If a number is not finite, or `radius < 0`.
    pub fn sphere(center: DVec3, radius: f64) -> Result<Self, FieldError> {
        FieldError::check_all_finite("center", &center.to_array())?;
        FieldError::check_at_least("radius", 0.0, radius)?;
        Ok(Self::Sphere { center, radius })
    }

    /// A box along the axes; it may be flat, or a point.
    ///
    /// # Errors
    /// If a number is not finite, or a coordinate of `max` is below that of `min`.
    pub fn aligned_box(min: DVec3, max: DVec3) -> Result<Self, FieldError> {
        FieldError::check_all_finite("min", &min.to_array())?;
        for ((what, least), found) in
            ["max[0]", "max[1]", "max[2]"].into_iter().zip(min.to_array()).zip(max.to_array())
        {
            FieldError::check_at_least(what, least, found)?;
        }
        Ok(Self::Box { min, max })
    }

    /// The part of the ray `origin + s · direction / |direction|`, `0 ≤ s ≤ length`, inside the bounds; `None` if the ray
    /// does not meet them. Without a `length` the ray has no end.
    ///
    /// A ray that only touches (a tangent, an edge, the last point before it leaves) has a clip of length 0. One in a face
    /// of a box runs inside the box. The entry point and the length are found near the bounds, not as a difference of
    /// distances from the origin, so that a far origin costs the digits that its own direction lacks and no more.
    ///
    /// # Errors
    /// If a number is not finite (also: the length inside the bounds overflows), the direction is zero, or `length < 0`.
    pub fn clip(
        &self,
        origin: DVec3,
        direction: DVec3,
        length: Option<f64>,
    ) -> Result<Option<Clip>, FieldError> {
        // Rays are many: the names of the components are made only to refuse one.
        if !(origin.is_finite() && direction.is_finite()) {
            FieldError::check_all_finite("origin", &origin.to_array())?;
            FieldError::check_all_finite("direction", &direction.to_array())?;
        }
        if let Some(length) = length {
            FieldError::check_at_least("length", 0.0, length)?;
        }
        let direction = unit(direction).ok_or(FieldError::Degenerate { what: "direction" })?;
        let endless = match *self {
            Self::Sphere { center, radius } => {
                let (clip, meets) = clip_to_sphere(center, radius, origin, direction);
                meets.then_some(clip)
            }
            Self::Box { min, max } => clip_to_box(min, max, origin, direction),
        };
        let clip = endless.and_then(|clip| {
            let rest = length.unwrap_or(f64::INFINITY) - clip.entry_distance;
            (rest >= 0.0).then(|| Clip { length: clip.length.min(rest), ..clip })
        });
        if let Some(clip) = &clip
            && !(clip.entry_distance.is_finite() && clip.length.is_finite())
        {
            FieldError::check_finite("the distance to the bounds", clip.entry_distance)?;
            FieldError::check_finite("the length inside the bounds", clip.length)?;
        }
        Ok(clip)
    }
}

/// The vector of length 1, or `None` for one that is zero or not finite. A direction along an axis is exact.
fn unit(direction: DVec3) -> Option<DVec3> {
    let unit = direction_of(direction);
    unit.is_finite().then_some(unit)
}

/// The vector of length 1; no numbers of one that is zero or not finite.
#[inline(always)]
pub(crate) fn direction_of(vector: DVec3) -> DVec3 {
    // Dividing by the largest component first keeps the square from over- and underflow.
    let scaled = vector / vector.abs().max_element();
    scaled / scaled.length()
}

/// The clip of an endless ray, and whether it meets the sphere: without a branch, for lanes.
///
/// Half a chord is √(radius² − closest²), where `closest` is the distance of the line from the center.
#[inline(always)]
pub(crate) fn clip_to_sphere(center: DVec3, radius: f64, origin: DVec3, direction: DVec3) -> (Clip, bool) {
    // A power of two that keeps the squares of a huge scene from overflow, and changes no digit of any other.
    let largest = origin.abs().max_element().max(center.abs().max_element()).max(radius);
    let [scale, unscale] = if largest > 1e150 { [2f64.powi(-520), 2f64.powi(520)] } else { [1.0; 2] };
    let to_center = center * scale - origin * scale;
    let radius = radius * scale;

    // The closest point, seen from the center. For an origin far away the first projection is rounded at the size of that
    // distance; the second one removes what is left along the line at the size of the bounds.
    let along = to_center.dot(direction);
    let offset = along * direction - to_center;
    let rest = offset.dot(direction);
    let offset = offset - rest * direction;
    let along = along - rest;

    let closest = offset.length();
    // A product does not cancel as the difference of two squares does.
    let half = ((radius - closest) * (radius + closest)).sqrt();
    let misses = (closest > radius) | (along + half < 0.0);
    let (entry, entry_distance, length) = if along > half {
        (center + (offset - half * direction) * unscale, along - half, 2.0 * half)
    } else {
        (origin, 0.0, along + half)
    };
    let line = Line { origin: entry, direction };
    (Clip { line, entry_distance: entry_distance * unscale, length: length * unscale }, !misses)
}

/// The slab method; the length is measured again from the entry point.
fn clip_to_box(min: DVec3, max: DVec3, origin: DVec3, direction: DVec3) -> Option<Clip> {
    let mut entry_distance = 0.0;
    let mut exit_distance = f64::INFINITY;
    let mut entry_face = None;
    for axis in 0..3 {
        let (o, d) = (origin[axis], direction[axis]);
        if d == 0.0 {
            // Parallel to the slab, negative zero included: no crossing to compute, and the faces belong to the box.
            if o < min[axis] || o > max[axis] {
                return None;
            }
            continue;
        }
        let (near, far) = faces(min[axis], max[axis], d);
        let enters = (near - o) / d;
        if enters > entry_distance {
            entry_distance = enters;
            entry_face = Some((axis, near));
        }
        exit_distance = exit_distance.min((far - o) / d);
    }
    if exit_distance < entry_distance {
        return None;
    }

    // The entry point, exactly on the face that is entered and within the others.
    let mut entry = origin;
    if let Some((axis, face)) = entry_face {
        entry = (origin + entry_distance * direction).clamp(min, max);
        entry[axis] = face;
    }
    let mut length = f64::INFINITY;
    for axis in 0..3 {
        if direction[axis] != 0.0 {
            let (_, far) = faces(min[axis], max[axis], direction[axis]);
            length = length.min((far - entry[axis]) / direction[axis]);
        }
    }
    let line = Line { origin: entry, direction };
    Some(Clip { line, entry_distance, length: length.max(0.0) })
}

/// The face of a slab that a line with the direction component `d ≠ 0` enters by, and the one it leaves by.
fn faces(min: f64, max: f64, d: f64) -> (f64, f64) {
    if d > 0.0 { (min, max) } else { (max, min) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::random;
    use glam::dvec3;

    fn ball() -> Bounds {
        Bounds::sphere(dvec3(0.0, 0.0, 10.0), 10.0).unwrap()
    }

    fn cube() -> Bounds {
        Bounds::aligned_box(DVec3::ZERO, DVec3::ONE).unwrap()
    }

    fn clip(bounds: Bounds, origin: [f64; 3], direction: [f64; 3]) -> Option<Clip> {
        bounds.clip(origin.into(), direction.into(), None).unwrap()
    }

    fn span(bounds: Bounds, origin: [f64; 3], direction: [f64; 3]) -> Option<(f64, f64)> {
        clip(bounds, origin, direction).map(|clip| (clip.entry_distance, clip.length))
    }

    #[test]
    fn a_sphere_from_outside_on_inside_and_beyond() {
        let along_z = |z| span(ball(), [0.0, 0.0, z], [0.0, 0.0, 3.0]);
        assert_eq!(along_z(-5.0), Some((5.0, 20.0)));
        assert_eq!(along_z(0.0), Some((0.0, 20.0)));
        assert_eq!(along_z(4.0), Some((0.0, 16.0)));
        assert_eq!(along_z(20.0), Some((0.0, 0.0)));
        assert_eq!(along_z(21.0), None);
        assert_eq!(span(ball(), [0.0, 11.0, 0.0], [0.0, 0.0, 1.0]), None);
    }

    #[test]
    fn a_box_from_outside_on_inside_and_beyond() {
        let along_x = |x| span(cube(), [x, 0.25, 0.5], [2.0, 0.0, 0.0]);
        assert_eq!(along_x(-2.0), Some((2.0, 1.0)));
        assert_eq!(along_x(0.0), Some((0.0, 1.0)));
        assert_eq!(along_x(0.75), Some((0.0, 0.25)));
        assert_eq!(along_x(1.0), Some((0.0, 0.0)));
        assert_eq!(along_x(1.5), None);
        assert_eq!(span(cube(), [0.5, 0.5, 3.0], [0.0, -0.0, -1.0]), Some((2.0, 1.0)));
    }

    #[test]
    fn the_length_of_the_ray_cuts() {
        let cut = |origin: [f64; 3], length| {
            let clip = ball().clip(origin.into(), DVec3::Z, Some(length)).unwrap();
            clip.map(|clip| (clip.entry_distance, clip.length))
        };
        assert_eq!(cut([0.0, 0.0, -5.0], 7.0), Some((5.0, 2.0)));
        assert_eq!(cut([0.0, 0.0, -5.0], 5.0), Some((5.0, 0.0)));
        assert_eq!(cut([0.0, 0.0, -5.0], 4.0), None);
        assert_eq!(cut([0.0, 0.0, 5.0], 0.0), Some((0.0, 0.0)));
        assert_eq!(cut([0.0, 0.0, 0.0], 50.0), Some((0.0, 20.0)));
    }

    #[test]
    fn grazing_is_short_and_never_nan() {
        assert_eq!(span(ball(), [-7.0, 10.0, 10.0], [1.0, 0.0, 0.0]), Some((7.0, 0.0)));
        for nudge in [1e-300, 1e-15, 1e-9, -1e-15, -1e-9] {
            let found = span(ball(), [-7.0, 10.0 + nudge, 10.0], [1.0, 1e-17, -1e-300]);
            assert!(
                found.is_none_or(|(entry, length)| entry > 6.9 && (0.0..1e-3).contains(&length)),
                "{nudge}"
            );
        }
        let point = Bounds::sphere(DVec3::ONE, 0.0).unwrap();
        assert_eq!(span(point, [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]), Some((1.0, 0.0)));
    }

    #[test]
    fn a_ray_in_a_face_an_edge_or_through_a_corner_of_a_box() {
        // In the plane of each of two faces, with both signs of zero: hard case 10.
        for zero in [0.0, -0.0] {
            assert_eq!(span(cube(), [1.0, 0.5, -1.0], [zero, zero, 1.0]), Some((1.0, 1.0)));
            assert_eq!(span(cube(), [0.0, 0.5, 2.0], [zero, zero, -1.0]), Some((1.0, 1.0)));
            assert_eq!(span(cube(), [1.0, 1.0, -1.0], [zero, zero, 1.0]), Some((1.0, 1.0)));
            assert_eq!(span(cube(), [1.0 + f64::EPSILON, 0.5, -1.0], [zero, zero, 1.0]), None);
        }
        // Through an edge into the box, and past an edge that is only touched.
        let diagonal = clip(cube(), [-1.0, -1.0, 0.5], [1.0, 1.0, 0.0]).unwrap();
        assert_eq!(diagonal.line.origin, dvec3(0.0, 0.0, 0.5));
        assert!((diagonal.length - 2f64.sqrt()).abs() < 1e-15);
        let touched = clip(cube(), [-1.0, 1.0, 0.5], [1.0, -1.0, 0.0]).unwrap();
        assert_eq!((touched.line.origin, touched.length), (dvec3(0.0, 0.0, 0.5), 0.0));
        let corner = clip(cube(), [2.0, 2.0, 2.0], [-1.0, -1.0, -1.0]).unwrap();
        assert_eq!(corner.line.origin, DVec3::ONE);
        assert!((corner.length - 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_flat_box_and_a_point() {
        let flat = Bounds::aligned_box(DVec3::ZERO, dvec3(1.0, 1.0, 0.0)).unwrap();
        assert_eq!(span(flat, [0.5, 0.5, -1.0], [0.0, 0.0, 1.0]), Some((1.0, 0.0)));
        assert_eq!(span(flat, [-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]), Some((1.0, 1.0)));
        let point = Bounds::aligned_box(DVec3::ONE, DVec3::ONE).unwrap();
        assert_eq!(span(point, [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]), Some((1.0, 0.0)));
        assert_eq!(span(point, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]), None);
    }

    #[test]
    fn a_far_origin_costs_only_the_digits_of_its_direction() {
        // Hard case 11: 1e6 away. Entry points are exact here, lengths to rounding.
        let far = clip(cube(), [-1e6, 0.1, 0.2], [1.0, 0.0, 0.0]).unwrap();
        assert_eq!((far.line.origin, far.length), (dvec3(0.0, 0.1, 0.2), 1.0));
        let far = clip(ball(), [0.0, 0.0, -1e6], [0.0, 0.0, 1.0]).unwrap();
        assert_eq!((far.line.origin, far.length), (DVec3::ZERO, 20.0));
        // Aimed at the center from an odd direction: the chord is the diameter up to the rounding of the direction.
        let direction = dvec3(0.3, -0.7, 0.64);
        let origin = dvec3(0.0, 0.0, 10.0) - 1e6 * direction;
        let far = clip(ball(), origin.to_array(), direction.to_array()).unwrap();
        assert!((far.length - 20.0).abs() < 1e-15);
        assert!(((far.line.origin - dvec3(0.0, 0.0, 10.0)).length() - 10.0).abs() < 1e-14);
    }

    #[test]
    fn both_kinds_agree_with_the_points_of_random_rays() {
        let mut uniform = random(1);
        let mut next = || 2.0 * uniform() - 1.0;
        for bounds in
            [Bounds::sphere(DVec3::ZERO, 1.0).unwrap(), Bounds::aligned_box(-DVec3::ONE, DVec3::ONE).unwrap()]
        {
            let inside = |p: DVec3| match bounds {
                Bounds::Sphere { .. } => p.length() <= 1.0,
                Bounds::Box { .. } => p.abs().max_element() <= 1.0,
            };
            for _ in 0..2000 {
                let origin = 3.0 * dvec3(next(), next(), next());
                let direction = dvec3(next(), next(), next());
                let clip = bounds.clip(origin, direction, None).unwrap();
                let ray = Line { origin, direction: direction.normalize() };
                let (start, end) =
                    clip.map_or((0.0, 0.0), |c| (c.entry_distance, c.entry_distance + c.length));
                for i in 0..60 {
                    let s = 0.15 * f64::from(i);
                    if (s - start).abs() > 1e-9 && (s - end).abs() > 1e-9 {
                        assert_eq!(inside(ray.at(s)), start < s && s < end, "{origin} {direction} {s}");
                    }
                }
                if let Some(clip) = clip {
                    assert!((clip.line.origin - ray.at(start)).length() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn extreme_numbers_do_not_overflow() {
        let huge = Bounds::sphere(DVec3::ZERO, 1e300).unwrap();
        assert!(
            (clip(huge, [0.0, 0.0, -1e301], [0.0, 0.0, 1.0]).unwrap().length / 2e300 - 1.0).abs() < 1e-15
        );
        let huge = Bounds::aligned_box(DVec3::splat(-1e300), DVec3::splat(1e300)).unwrap();
        assert_eq!(span(huge, [0.0; 3], [1e-320, 0.0, 0.0]), Some((0.0, 1e300)));
        assert_eq!(span(cube(), [-1.0, 0.5, 0.5], [1e300, 0.0, 1e-20]), Some((1.0, 1.0)));
        let largest = Bounds::aligned_box(DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX)).unwrap();
        let found = largest.clip(dvec3(-f64::MAX, 0.0, 0.0), DVec3::X, None);
        assert!(matches!(found, Err(FieldError::NotFinite { .. })));
    }

    #[test]
    fn an_empty_clip_has_a_direction() {
        let empty = Clip::empty(DVec3::ONE, dvec3(0.0, 2.0, 0.0));
        assert_eq!((empty.line.origin, empty.line.direction, empty.length), (DVec3::ONE, DVec3::Y, 0.0));
        assert_eq!(Clip::empty(DVec3::ONE, DVec3::ZERO).line.direction, DVec3::X);
    }

    #[test]
    fn bad_numbers_are_refused() {
        let refused =
            |origin: DVec3, direction: DVec3, length| cube().clip(origin, direction, length).unwrap_err();
        assert_eq!(refused(DVec3::ZERO, DVec3::ZERO, None), FieldError::Degenerate { what: "direction" });
        assert!(matches!(refused(DVec3::NAN, DVec3::X, None), FieldError::NotFinite { .. }));
        assert!(matches!(refused(DVec3::ZERO, DVec3::INFINITY, None), FieldError::NotFinite { .. }));
        assert!(matches!(refused(DVec3::ZERO, DVec3::X, Some(-1.0)), FieldError::TooSmall { .. }));
        assert!(matches!(Bounds::sphere(DVec3::ZERO, -1.0), Err(FieldError::TooSmall { .. })));
        assert!(matches!(Bounds::sphere(DVec3::NAN, 1.0), Err(FieldError::NotFinite { .. })));
        assert!(matches!(
            Bounds::aligned_box(DVec3::ONE, dvec3(1.0, 0.5, 1.0)),
            Err(FieldError::TooSmall { what: "max[1]", .. })
        ));
    }
}
