//! A pinhole camera.

use crate::SceneError;
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_elementary::tan;
use fairflight_media::Line;
use fairflight_media::lanes::set_vector;
use glam::{DVec2, DVec3, dvec2};

/// A pinhole with a box filter: a pixel is the mean radiance over its area on the image plane.
///
/// Row 0 is on top, column 0 on the left as the camera sees it. up × view points to the left of the image: with view +z
/// and up +y the left is +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    origin: DVec3,
    /// Unit vector of the view.
    forward: DVec3,
    /// Unit vectors on the image plane: to the right, and up.
    right: DVec3,
    up: DVec3,
    /// Half of the width and height of the image plane at the distance 1.
    half_extent: DVec2,
    resolution: [u32; 2],
}

/// Image of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Distance from the pinhole \[length\].
    pub distance: f64,
    /// The direction of travel of light from the point to the pinhole, of unit length.
    pub towards_camera: DVec3,
    /// Contribution of the flux density per volume at the point to the pixel's radiance, apart from transmittance:
    /// 1/(distance² · cos³θ · pixel area on the plane at distance 1) \[1/length²\].
    ///
    /// A pixel is (1/A) ∫ L dA over its area A on that plane, dA = dω/cos³θ, and dV = distance² dω ds.
    pub importance: f64,
}

impl Camera {
    /// A camera at `origin` that looks at `look_at`, with a field of view of `vertical_fov_degrees` from the lower to the
    /// upper edge of `resolution` = (columns, rows).
    ///
    /// # Errors
    /// If a number is not finite, the view has no direction, `up` is zero or along the view, the field of view is not
    /// between 0° and 180°, or there are no pixels.
    pub fn new(
        origin: DVec3,
        look_at: DVec3,
        up: DVec3,
        vertical_fov_degrees: f64,
        resolution: [u32; 2],
    ) -> Result<Self, SceneError> {
        SceneError::check_finite("origin", origin.is_finite())?;
        SceneError::check_finite("look_at", look_at.is_finite())?;
        SceneError::check_finite("up", up.is_finite())?;
        let degenerate = |what, because| SceneError::Degenerate { what, because };
        let forward =
            (look_at - origin).try_normalize().ok_or(degenerate("look_at", "at the origin of the camera"))?;
        let up = up.try_normalize().ok_or(degenerate("up", "a vector of length 0"))?;
        // Less than this and rounding chooses the direction.
        const PARALLEL: f64 = 1e-12;
        let left = up.cross(forward);
        if left.length() < PARALLEL {
            return Err(degenerate("up", "parallel to the view"));
        }
        let left = left.normalize();
        if !(vertical_fov_degrees > 0.0 && vertical_fov_degrees < 180.0) {
            return Err(SceneError::FieldOfView { found: vertical_fov_degrees });
        }
        let [columns, rows] = resolution;
        if columns == 0 || rows == 0 {
            return Err(SceneError::NoPixels { what: "resolution" });
        }
        let half_height = tan((0.5 * vertical_fov_degrees).to_radians());
        let half_extent = dvec2(half_height * f64::from(columns) / f64::from(rows), half_height);
        Ok(Self { origin, forward, right: -left, up: forward.cross(left), half_extent, resolution })
    }

    /// The same view in so many columns and rows, of whatever shape the pixels then are.
    ///
    /// # Errors
    /// If there are no pixels.
    pub fn with_resolution(self, resolution: [u32; 2]) -> Result<Self, SceneError> {
        if resolution.contains(&0) {
            return Err(SceneError::NoPixels { what: "resolution" });
        }
        Ok(Self { resolution, ..self })
    }

    /// Columns and rows.
    #[must_use]
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// The pinhole.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The ray through a point of a pixel: (0, 0) is its upper left corner, (1, 1) its lower right one.
    #[inline]
    #[must_use]
    pub fn ray(&self, pixel: [u32; 2], within: [f64; 2]) -> Line {
        let [column, row] = pixel.map(f64::from);
        Line { origin: self.origin, direction: self.direction(column + within[0], row + within[1]) }
    }

    /// The directions of [`ray`](Self::ray) in all lanes, by columns and rows with their fractions.
    #[inline(always)]
    #[must_use]
    pub fn directions(&self, columns: &Lanes, rows: &Lanes) -> [Lanes; 3] {
        let mut directions = [[0.0; LANES]; 3];
        for i in 0..LANES {
            set_vector(&mut directions, i, self.direction(columns[i], rows[i]));
        }
        directions
    }

    #[inline(always)]
    fn direction(&self, column: f64, row: f64) -> DVec3 {
        let [columns, rows] = self.resolution.map(f64::from);
        let x = self.half_extent.x * (2.0 * column / columns - 1.0);
        let y = self.half_extent.y * (1.0 - 2.0 * row / rows);
        (self.forward + x * self.right + y * self.up).normalize()
    }

    /// Image of a point; `None` beside the picture, behind the camera, or at the pinhole itself.
    #[must_use]
    pub fn project(&self, point: DVec3) -> Option<Projection> {
        let [x, y] = self.film(point)?;
        let offset = point - self.origin;
        let distance = offset.length();
        Some(Projection {
            pixel: [x as u32, y as u32],
            distance,
            towards_camera: -offset / distance,
            importance: self.importance_at(distance, offset.dot(self.forward) / distance),
        })
    }

    /// Column and row of the image of a point, with their fractions: [`ray`](Self::ray) of pixel (0, 0) goes there. `None` as for [`project`](Self::project).
    #[must_use]
    pub fn film(&self, point: DVec3) -> Option<[f64; 2]> {
        let offset = point - self.origin;
        let depth = offset.dot(self.forward);
        if depth <= 0.0 {
            return None;
        }
        let [columns, rows] = self.resolution.map(f64::from);
        let x = 0.5 * (offset.dot(self.right) / depth / self.half_extent.x + 1.0) * columns;
        let y = 0.5 * (1.0 - offset.dot(self.up) / depth / self.half_extent.y) * rows;
        (0.0 <= x && x < columns && 0.0 <= y && y < rows).then_some([x, y])
    }

    /// The importance of a [`Projection`] of `point`, also where that would lie beside the image: for a point of a ray through a pixel, which
    /// rounding may move across its edge.
    #[inline]
    #[must_use]
    pub fn importance(&self, point: DVec3) -> f64 {
        let offset = point - self.origin;
        let distance = offset.length();
        self.importance_at(distance, offset.dot(self.forward) / distance)
    }

    #[inline]
    fn importance_at(&self, distance: f64, cosine: f64) -> f64 {
        let [columns, rows] = self.resolution.map(f64::from);
        let pixel_area = 4.0 * self.half_extent.x * self.half_extent.y / (columns * rows);
        1.0 / (distance * distance * cosine * cosine * cosine * pixel_area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_resolution_is_the_same_view() {
        let at = |x, y, z| DVec3::new(x, y, z);
        let camera =
            Camera::new(at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(0.0, 1.0, 0.0), 60.0, [90, 30]).unwrap();
        let other = camera.with_resolution([2, 3]).unwrap();
        for (pixel, same) in [([0, 0], [0, 0]), ([45, 20], [1, 2])] {
            assert_eq!(camera.ray(pixel, [0.0; 2]).direction, other.ray(same, [0.0; 2]).direction);
        }
        assert!(camera.with_resolution([4, 0]).is_err());
    }
    use glam::dvec3;

    fn camera() -> Camera {
        Camera::new(dvec3(0.0, 0.0, -20.0), dvec3(0.0, 0.0, 10.0), DVec3::Y, 60.0, [128, 64]).unwrap()
    }

    #[test]
    fn the_left_is_plus_x_and_the_first_row_is_on_top() {
        let corner = camera().ray([0, 0], [0.0, 0.0]).direction;
        let tangent = 30f64.to_radians().tan();
        assert!((corner.x / corner.z - 2.0 * tangent).abs() < 1e-15);
        assert!((corner.y / corner.z - tangent).abs() < 1e-15);
        let middle = camera().ray([63, 31], [1.0, 1.0]).direction;
        assert!((middle - DVec3::Z).length() < 1e-15);
    }

    #[test]
    fn a_point_on_a_ray_appears_where_the_ray_started() {
        let camera =
            Camera::new(dvec3(1.0, 2.0, 3.0), dvec3(-4.0, 0.5, 9.0), dvec3(0.1, 1.0, 0.3), 35.0, [40, 30])
                .unwrap();
        for pixel in [[0, 0], [39, 29], [7, 21]] {
            let ray = camera.ray(pixel, [0.3, 0.6]);
            let seen = camera.project(ray.at(17.0)).unwrap();
            assert_eq!(seen.pixel, pixel);
            let film = camera.film(ray.at(17.0)).unwrap();
            assert!((camera.ray([0, 0], film).direction - ray.direction).length() < 1e-14);
            assert!((seen.distance - 17.0).abs() < 1e-12);
            assert!((seen.towards_camera + ray.direction).length() < 1e-14);
            assert_eq!(camera.importance(ray.at(17.0)), seen.importance);
        }
        assert!(camera.project(camera.origin()).is_none());
        assert!(camera.project(camera.ray([0, 0], [0.5, 0.5]).at(-1.0)).is_none());
    }

    #[test]
    fn importance_is_one_over_the_volume_of_a_pixel_per_length() {
        // A slab of thickness dt at distance t seen by one pixel fills t² Ω dt; Ω by central differences about its middle, whose error is
        // that of their step squared, in units of the view.
        const STEP: f64 = 0.01;
        let camera = camera();
        let difference = |u: f64, v: f64| {
            let at = |sign: f64| camera.ray([3, 5], [0.5 + sign * u, 0.5 + sign * v]).direction;
            (at(1.0) - at(-1.0)) / (2.0 * STEP)
        };
        // Just beside the image it is still what the formula says.
        let beside = camera.ray([0, 5], [-1e-9, 0.5]).at(10.0);
        assert!(camera.project(beside).is_none());
        let inside = camera.importance(camera.ray([0, 5], [1e-9, 0.5]).at(10.0));
        assert!((camera.importance(beside) / inside - 1.0).abs() < 1e-9);
        let solid_angle = difference(STEP, 0.0).cross(difference(0.0, STEP)).length();
        let seen = camera.project(camera.ray([3, 5], [0.5, 0.5]).at(10.0)).unwrap();
        assert!((seen.importance * 100.0 * solid_angle - 1.0).abs() < 1e-7);
    }

    #[test]
    fn useless_cameras_are_refused() {
        let new = |look_at, up, fov, resolution| Camera::new(DVec3::ZERO, look_at, up, fov, resolution);
        assert!(matches!(
            new(DVec3::ZERO, DVec3::Y, 60.0, [1, 1]),
            Err(SceneError::Degenerate { what: "look_at", .. })
        ));
        assert!(matches!(
            new(DVec3::Z, DVec3::ZERO, 60.0, [1, 1]),
            Err(SceneError::Degenerate { what: "up", .. })
        ));
        assert!(matches!(
            new(DVec3::Z, -DVec3::Z, 60.0, [1, 1]),
            Err(SceneError::Degenerate { what: "up", .. })
        ));
        assert!(matches!(new(DVec3::Z, DVec3::Y, 180.0, [1, 1]), Err(SceneError::FieldOfView { .. })));
        assert!(matches!(new(DVec3::Z, DVec3::Y, f64::NAN, [1, 1]), Err(SceneError::FieldOfView { .. })));
        assert!(matches!(new(DVec3::Z, DVec3::Y, 60.0, [0, 1]), Err(SceneError::NoPixels { .. })));
        assert!(matches!(new(DVec3::INFINITY, DVec3::Y, 60.0, [1, 1]), Err(SceneError::NotFinite { .. })));
    }

    #[test]
    fn rays_begin_at_the_pinhole() {
        let pinhole = dvec3(1.0, 2.0, 3.0);
        let camera = Camera::new(pinhole, DVec3::ZERO, DVec3::Y, 60.0, [4, 3]).unwrap();
        assert_eq!((camera.origin(), camera.ray([1, 2], [0.3, 0.4]).origin), (pinhole, pinhole));
    }
}
