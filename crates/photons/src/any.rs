//! Any choice of directions as one type.

use crate::Guided;
use fairflight_paths::extend::{Extended, Extension, Own, Resampled};
use fairflight_paths::transport::{Types, Vertex, World};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Any choice of directions: one path tracer is compiled for all of them, which branches a few times per vertex. Who wants none at all, and pays for
/// none, takes [`PathTracer`](fairflight_paths::PathTracer) as it is.
#[derive(Clone, Debug)]
pub enum AnyExtension<'m, C> {
    /// Directions that a vertex chooses itself.
    Own,
    /// Directions from where photons came.
    Guided(Guided<'m, C>),
    /// Directions of which one is kept for what it would meet.
    Resampled(Resampled),
}

impl<W: Types> Extension<W> for AnyExtension<'_, W::Spectrum> {
    fn prepare(&mut self, world: &World<'_, W>, vertex: &Vertex) {
        match self {
            Self::Guided(guided) => guided.prepare(world, vertex),
            // Neither of them learns anything of a vertex.
            Self::Own | Self::Resampled(_) => {}
        }
    }

    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        match self {
            Self::Own => Own.sample(world, vertex, source),
            Self::Guided(guided) => guided.sample(world, vertex, source),
            Self::Resampled(resampled) => resampled.sample(world, vertex, source),
        }
    }

    fn pdf_solid_angle(&self, vertex: &Vertex, direction: DVec3, scattered: f64) -> f64 {
        match self {
            Self::Own => Extension::<W>::pdf_solid_angle(&Own, vertex, direction, scattered),
            Self::Guided(guided) => Extension::<W>::pdf_solid_angle(guided, vertex, direction, scattered),
            Self::Resampled(resampled) => {
                Extension::<W>::pdf_solid_angle(resampled, vertex, direction, scattered)
            }
        }
    }
}
