//! A sphere.

use super::{AreaSample, TowardsSample};
use crate::SceneError;
use fairflight_media::Line;
use glam::DVec3;

/// All points at the distance `radius` from `center`; the outer side is outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

impl Sphere {
    /// # Errors
    /// If a number is not finite, or the radius is not above 0.
    pub fn new(center: DVec3, radius: f64) -> Result<Self, SceneError> {
        let _ = (center, radius);
        todo!()
    }
    pub(super) fn intersect(&self, line: &Line, length: f64, leaves: bool) -> Option<f64> {
        let _ = (line, length, leaves);
        todo!()
    }
    pub(super) fn blocks_its_own_point(&self, line: &Line, length: f64, leaves: bool) -> bool {
        let _ = (line, length, leaves);
        todo!()
    }
    pub(super) fn normal(&self, point: DVec3) -> DVec3 {
        let _ = point;
        todo!()
    }
    pub(super) fn area(&self) -> f64 {
        todo!()
    }
    pub(super) fn sample_area(&self, u: f64, v: f64) -> AreaSample {
        let _ = (u, v);
        todo!()
    }
    pub(super) fn sample_towards(&self, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        let _ = (point, u, v);
        todo!()
    }
    pub(super) fn pdf_towards(&self, point: DVec3, direction: DVec3, distance: f64) -> f64 {
        let _ = (point, direction, distance);
        todo!()
    }
    pub(super) fn encloses(&self, point: DVec3) -> bool {
        let _ = point;
        todo!()
    }
    pub(super) fn distance_to(&self, point: DVec3) -> f64 {
        let _ = point;
        todo!()
    }
    pub(super) fn corners(&self) -> (DVec3, DVec3) {
        todo!()
    }
}
