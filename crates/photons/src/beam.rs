//! The beam radiance estimate (jarosz-2008), with which engelhardt-2013 section 4 compares.

use crate::PhotonMap;
use fairflight_media::{Line, PhaseFunction};
use fairflight_paths::extend::PathSampling;
use fairflight_paths::transport::{Scattered, Types, Vertex, World};
use fairflight_paths::{Heuristic, Integrator, Walk};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;
use std::f64::consts::{FRAC_1_PI, PI};
use std::fmt;

/// Light that the first diffuse surface of a camera ray reflects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceLight {
    /// By a path from there on, without a bias.
    #[default]
    Path,
    /// By the density of the photons around, with a bias as that of the medium.
    Map,
}

/// Radiance along a whole ray from the photons beside it: **biased by design**.
///
/// ```text
/// along the camera ray up to a surface
///     for each photon of the medium nearer than r:  K T(0, s) phase(ω_photon · ω_camera) Φ        (jarosz-2008, with a fixed radius)
///     at a smooth surface: go on behind it
/// at the surface or the background: T · what it emits, and what it reflects
/// ```
///
/// s is the photon's projection onto the ray, K = 1/(π r²), and Φ the power that it scatters: albedo or reflectance are in it, and no σ_s comes on
/// top. Photons of the first order are among them, so that nothing is connected with lights beside them.
///
/// **Law.** The expectation over maps is the radiance with the scattered light smeared out across the ray over a disc of radius r: exact where that is
/// linear across, within r of the ray. The bias falls as r² inside, as r at borders of the medium and beside surfaces.
///
/// **Variance.** That of one map as 1/(N r²) of N light paths; pixels of one map are correlated. Bias and variance are told apart by replicas of
/// maps.
///
/// **Cost.** A transmittance per photon met.
pub struct BeamRadiance<'s, W: Types> {
    world: World<'s, W>,
    map: &'s PhotonMap<W::Spectrum>,
    radius: f64,
    walk: Walk<W::Sampling>,
    shadow: W::Shadow,
    heuristic: Heuristic,
    surfaces: SurfaceLight,
    max_vertices: u32,
    truncated: u64,
}

impl<W: Types> fmt::Debug for BeamRadiance<'_, W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { radius, surfaces, truncated, .. } = self;
        formatter
            .debug_struct("BeamRadiance")
            .field("radius", radius)
            .field("surfaces", surfaces)
            .field("truncated", truncated)
            .finish_non_exhaustive()
    }
}

/// A radius that is not a positive number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("radius must be a finite number above 0, found {found}")]
pub struct NotARadius {
    /// The value given.
    pub found: f64,
}

impl<'s, W: Types> BeamRadiance<'s, W> {
    /// The photons of `map` in `world`, within `radius` of a ray \[length\]; transmittance by `shadow`, paths from surfaces by `walk`.
    ///
    /// # Errors
    /// If the radius is not positive and finite.
    pub fn new(
        world: World<'s, W>,
        (map, radius): (&'s PhotonMap<W::Spectrum>, f64),
        walk: Walk<W::Sampling>,
        shadow: W::Shadow,
        heuristic: Heuristic,
    ) -> Result<Self, NotARadius> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(NotARadius { found: radius });
        }
        let (surfaces, max_vertices, truncated) = (SurfaceLight::Path, u32::MAX, 0);
        Ok(Self { world, map, radius, walk, shadow, heuristic, surfaces, max_vertices, truncated })
    }

    /// The same with another light of surfaces.
    #[must_use]
    pub fn with_surfaces(self, surfaces: SurfaceLight) -> Self {
        Self { surfaces, ..self }
    }

    /// The same with at most `max_vertices` smooth surfaces on a camera ray, and vertices on a path from a surface.
    #[must_use]
    pub fn with_max_vertices(self, max_vertices: u32) -> Self {
        Self { max_vertices, ..self }
    }

    /// The number of camera rays and paths that were cut so far: what they lack is a bias of its own.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// The radius \[length\].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Light that is scattered along a segment towards its start.
    fn scattered(&mut self, segment: &Segment, source: &mut impl UniformSource) -> W::Spectrum {
        let Self { world, map, radius, shadow, .. } = self;
        let kernel = 1.0 / (PI * *radius * *radius);
        let mut radiance = W::Spectrum::ZERO;
        map.along(&segment.line, segment.length, *radius, |photon, s| {
            let before = Segment { length: s, to: None, ..*segment };
            let transmittance = world.transmittance(&before, shadow, source);
            let phase = world.volume.phase.eval(-photon.incident.dot(segment.line.direction));
            radiance += photon.power * (kernel * phase * transmittance);
        });
        radiance
    }

    /// Light that a vertex of a surface reflects, reflectance included.
    fn reflected(
        &mut self,
        (vertex, surface): (&Vertex, usize),
        reflectance: W::Spectrum,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let Self { world, map, radius, walk, shadow, heuristic, surfaces, max_vertices, truncated } = self;
        if *surfaces == SurfaceLight::Map {
            let mut power = W::Spectrum::ZERO;
            map.on_surface((vertex.position, surface), *radius, |photon| {
                // Of this side alone.
                if vertex.cosine(-photon.incident) > 0.0 {
                    power += photon.power;
                }
            });
            return power * (FRAC_1_PI / (PI * *radius * *radius));
        }
        let mut radiance = world.emitters_at(*heuristic, vertex, shadow, source);
        let survival = reflectance.magnitude().min(1.0);
        if source.next_uniform() < survival {
            let phase = &world.volume.phase;
            let direction = vertex.sample(phase, source.next_uniform(), source.next_uniform());
            let from =
                Scattered { vertex: *vertex, pdf_solid_angle: vertex.pdf_solid_angle(phase, direction) };
            let how = (&mut PathSampling::by(*heuristic), *max_vertices);
            let start = (vertex.leave(direction, f64::INFINITY), Some(from));
            let traced = world.trace(walk, how, start, shadow, source);
            *truncated += u64::from(traced.is_cut);
            radiance += traced.radiance * (1.0 / survival);
        }
        reflectance * radiance
    }
}

impl<W: Types> Integrator<W::Spectrum> for BeamRadiance<'_, W> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> W::Spectrum {
        let world = self.world;
        let (mut radiance, mut throughput) = (W::Spectrum::ZERO, 1.0);
        let mut segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        for _ in 0..self.max_vertices {
            let hit = world.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let direction = segment.line.direction;
            radiance += self.scattered(&segment, source) * throughput;
            throughput *= world.transmittance(&segment, &mut self.shadow, source);
            let Some(hit) = hit else {
                return radiance + world.background(self.heuristic, None, direction) * throughput;
            };
            radiance += hit.surface.emission * throughput;
            if let Some(passage) = world.pass(&hit, direction, source) {
                throughput *= passage.radiance_scale;
                let line = Line { origin: hit.position, direction: passage.direction };
                segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                continue;
            }
            let (vertex, reflectance) = world.diffuse_vertex(&hit).expect("what is not smooth is diffuse");
            return radiance + self.reflected((&vertex, hit.index), reflectance, source) * throughput;
        }
        self.truncated += 1;
        radiance
    }
}
