//! The pinhole camera of the scene spec, aimed at a medium: one ray through the middle of each pixel.

use crate::standard::Subject;
use fairflight_harness::Failure;
use fairflight_harness::field::AnyProfile;
use glam::DVec3;

/// Vertical field of view \[degrees\].
pub(super) const FIELD_OF_VIEW: f64 = 60.0;

/// A pinhole camera with square images.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    origin: DVec3,
    /// Along the view, of length 1.
    forward: DVec3,
    /// To the image's right and to its top; as long as half the image at distance 1.
    right: DVec3,
    up: DVec3,
    resolution: usize,
}

impl Camera {
    /// A camera in front of the medium, at three times the radius of the ball around it, looking along +z: for the paper's
    /// sphere the camera of the scene spec, at (0, 0, −20) towards (0, 0, 10).
    pub(super) fn before(subject: &Subject, resolution: usize) -> Self {
        let (middle, radius) = subject.bounds.enclosing_ball();
        let half = (0.5 * FIELD_OF_VIEW.to_radians()).tan();
        let (forward, up) = (DVec3::Z, DVec3::Y);
        Self {
            origin: middle - 3.0 * radius * forward,
            forward,
            // With view +z and up +y the left is +x.
            right: half * forward.cross(up),
            up: half * up,
            resolution,
        }
    }

    /// The direction through the middle of a pixel; row 0 is on top, column 0 left.
    fn direction(&self, row: usize, column: usize) -> DVec3 {
        let across = |i: usize| (2.0 * i as f64 + 1.0) / self.resolution as f64 - 1.0;
        self.forward + across(column) * self.right - across(row) * self.up
    }

    /// The profile along the ray of a pixel; `None` where it misses the medium.
    pub(super) fn profile(&self, subject: &Subject, pixel: usize) -> Result<Option<AnyProfile>, Failure> {
        let direction = self.direction(pixel / self.resolution, pixel % self.resolution);
        let clip = subject.bounds.clip(self.origin, direction, None).map_err(Failure::refused)?;
        clip.filter(|clip| clip.length > 0.0).map(|clip| AnyProfile::ray(&subject.medium, &clip)).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standard::subject;
    use fairflight_harness::field::MediumLibrary;

    #[test]
    fn the_left_is_plus_x_and_the_first_row_is_on_top() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        let camera = Camera::before(&subject, 4);
        assert_eq!(camera.origin, DVec3::new(0.0, 0.0, -20.0));
        let corner = camera.direction(0, 0);
        assert!(corner.x > 0.0 && corner.y > 0.0 && corner.z == 1.0);
        let edge = 0.75 * 30f64.to_radians().tan();
        assert!((corner.x - edge).abs() < 1e-15 && (corner.y - edge).abs() < 1e-15);
        assert!(camera.profile(&subject, 0).unwrap().is_none());
        assert!(camera.profile(&subject, 5).unwrap().is_some());
    }
}
