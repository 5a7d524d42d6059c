//! Density of the second vertex of a path, drawn from the first vertex of any path of a group.

use crate::transport::{Types, Vertex, World};
use fairflight_elementary::exp;
use fairflight_media::{Extinction, LineThickness, OpticalThickness};
use fairflight_scene::{Geometry, Hit, Segment};
use glam::DVec3;

/// First vertex of a pixel's path.
#[derive(Clone, Copy)]
pub(super) struct Origin<C> {
    pub(super) vertex: Vertex,
    /// The probability that roulette lets a path go on.
    pub(super) survival: f64,
    /// Throughput of the paths that do.
    pub(super) carried: C,
}

/// Second vertex of a path.
pub(super) enum Second<'h, C> {
    /// With the share that is scattered there; and the surface.
    Vertex(Vertex, C, Option<Hit<'h, C>>),
    /// A direction that leaves everything.
    Escaped(DVec3),
}

/// Factors of the density P of a second vertex, without σ_t.
#[derive(Clone, Copy)]
pub(super) struct Factors {
    /// Survival of roulette at the first vertex.
    pub(super) survival: f64,
    /// Density of the direction \[1/sr\].
    pub(super) scattered: f64,
    /// Cosine at the second vertex over the squared distance \[1/length²\].
    pub(super) geometric: f64,
    pub(super) transmittance: f64,
}

impl Factors {
    pub(super) fn density(self) -> f64 {
        self.survival * self.scattered * self.geometric * self.transmittance
    }
}

/// The factors for a second vertex drawn from a first one; `None` where it cannot have been. Nothing is between it and its own one.
pub(super) fn factors<W: Types<Medium: LineThickness>>(
    world: &World<'_, W>,
    origin: &Origin<W::Spectrum>,
    second: &Second<'_, W::Spectrum>,
    is_own: bool,
) -> Option<Factors> {
    let first = &origin.vertex;
    let (segment, geometric) = match second {
        Second::Escaped(direction) => (first.leave(*direction, f64::INFINITY), 1.0),
        Second::Vertex(vertex, ..) => {
            let (direction, distance) = between(first, vertex);
            let surface = vertex.surface();
            // Points of one plane do not see each other.
            let is_flat = |index: usize| !world.surfaces.surfaces()[index].shape.is_closed();
            if surface.is_some_and(|index| first.surface() == Some(index) && is_flat(index)) {
                return None;
            }
            let segment = Segment { to: surface, ..first.leave(direction, distance) };
            (segment, vertex.cosine(-direction) / (distance * distance))
        }
    };
    let scattered = first.pdf_solid_angle(&world.volume.phase, segment.line.direction);
    // Not a number where both vertices are one.
    let is_seen = scattered * geometric > 0.0 && (is_own || !world.surfaces.is_occluded(&segment));
    is_seen.then(|| {
        let length = segment.length.is_finite().then_some(segment.length);
        let ray = world.volume.enter(&segment.line, length);
        let thickness = ray.map_or(0.0, |ray| ray.optical_thickness(0.0, ray.length()));
        Factors { survival: origin.survival, scattered, geometric, transmittance: exp(-thickness) }
    })
}

/// Direction and distance from the first vertex to the second.
pub(super) fn between(first: &Vertex, second: &Vertex) -> (DVec3, f64) {
    let offset = second.position - first.position;
    let distance = offset.length();
    (offset / distance, distance)
}
