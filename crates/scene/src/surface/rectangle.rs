//! A parallelogram with right angles, or any other.

use super::{AreaSample, TowardsSample};
use crate::SceneError;
use fairflight_media::Line;
use glam::DVec3;

/// corner + u · edge_u + v · edge_v for u, v in \[0, 1\]. The outer side is that of edge_u × edge_v. Edges need not be at right
/// angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    corner: DVec3,
    edge_u: DVec3,
    edge_v: DVec3,
    normal: DVec3,
    area: f64,
}

impl Rectangle {
    /// # Errors
    /// If a number is not finite, or the edges span no area.
    pub fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Result<Self, SceneError> {
        let _ = (corner, edge_u, edge_v);
        todo!()
    }
    pub(super) fn intersect(&self, line: &Line, length: f64, leaves: bool) -> Option<f64> {
        let _ = (line, length, leaves);
        todo!()
    }
    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }
    pub(super) fn area(&self) -> f64 {
        self.area
    }
    pub(super) fn sample_area(&self, u: f64, v: f64) -> AreaSample {
        let _ = (u, v);
        todo!()
    }
    pub(super) fn sample_towards(&self, point: DVec3, u: f64, v: f64) -> Option<TowardsSample> {
        let _ = (point, u, v);
        todo!()
    }
    pub(super) fn pdf_towards(&self, direction: DVec3, distance: f64) -> f64 {
        let _ = (direction, distance);
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
