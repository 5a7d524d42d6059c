//! Directions that a vertex chooses itself.

use super::{Extended, Extension};
use crate::transport::{Types, Vertex, World};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Directions by BRDF · cosine or phase function, which are sampled exactly: every weight is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Own;

impl<W: Types> Extension<W> for Own {
    #[inline]
    fn prepare(&mut self, _world: &World<'_, W>, _vertex: &Vertex) {}

    #[inline]
    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        let phase = &world.volume.phase;
        let direction = vertex.sample(phase, source.next_uniform(), source.next_uniform());
        Extended { direction, weight: 1.0, pdf_solid_angle: vertex.pdf_solid_angle(phase, direction) }
    }

    #[inline]
    fn pdf_solid_angle(&self, _vertex: &Vertex, _direction: DVec3, scattered: f64) -> f64 {
        scattered
    }
}
