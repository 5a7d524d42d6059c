//! Extensions of a path tracer (antwerpen-2011 sections 4.5 to 4.7): how the next direction is chosen, and the points of lights that a vertex is
//! connected with.
//!
//! Each is a type that [`PathTracer`](crate::PathTracer) is generic over. [`Own`] and [`One`], without any, compile to nothing. [`PathReuse`] is an
//! integrator of its own, of several pixels at once.

mod candidates;
mod own;
mod resampled;
mod reuse;

pub use candidates::{LightCandidates, One, Several};
pub use own::Own;
pub use resampled::{OwnShare, Resampled, ShareOutside};
pub use reuse::{PathReuse, PixelGroups};

use crate::Heuristic;
use crate::transport::{Types, Vertex, World};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Direction in which a path goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extended {
    /// The direction, of unit length.
    pub direction: DVec3,
    /// What a path along it weighs \[1\]: the density of the vertex itself over the density that it was drawn with.
    pub weight: f64,
    /// [`Extension::pdf_solid_angle`] of it \[1/sr\].
    pub pdf_solid_angle: f64,
}

/// Choice of the direction in which a path goes on.
///
/// **Law.** At each vertex, E\[weight · g(direction)\] = ∫ g(ω) s(ω) dω for every bounded g, where s is
/// [`Vertex::pdf_solid_angle`]: BRDF · cosine or phase function.
///
/// The density told by [`pdf_solid_angle`](Self::pdf_solid_angle) stands in weights against next-event estimation alone. It may be any function of the
/// vertex and the direction, as weights may be any functions of a path that sum to one over the techniques that find it; what is far from the
/// truth costs variance, never bias. What it depends on beside those two (photons) must be drawn before, from another stream.
pub trait Extension<W: Types> {
    /// Turns to a vertex: called once for each, before anything is asked of it.
    fn prepare(&mut self, world: &World<'_, W>, vertex: &Vertex);

    /// Draws a direction.
    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended;

    /// The density that directions compare with those of light points \[1/sr\]; `scattered` is s of this direction.
    fn pdf_solid_angle(&self, vertex: &Vertex, direction: DVec3, scattered: f64) -> f64;
}

/// Samplers of a path tracer at a vertex: of directions and of light points, and the weights between the two.
#[derive(Clone, Copy, Debug, Default)]
pub struct PathSampling<E = Own, L = One> {
    /// Weights between directions and light points.
    pub heuristic: Heuristic,
    /// Choice of directions.
    pub extension: E,
    /// Candidates for the point of a light that a vertex is connected with.
    pub candidates: L,
}

impl PathSampling {
    /// Directions by BRDF · cosine or phase function, and one point of each light.
    #[must_use]
    pub fn by(heuristic: Heuristic) -> Self {
        Self { heuristic, extension: Own, candidates: One }
    }
}
