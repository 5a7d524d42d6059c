//! One random path.

use super::{Event, Scattered, World};
use crate::{Heuristic, RayTransmittance, SamplingExtinction, Walk};
use fairflight_media::{Line, Medium, PhaseFunction};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;

/// A path's radiance, and whether it was cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traced<C> {
    /// What was found.
    pub radiance: C,
    /// Whether the path had more vertices or collisions than it was allowed: the rest is missing, a bias.
    pub is_cut: bool,
}

impl<G, M, P, C> World<'_, G, M, P, C>
where
    C: Spectrum,
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
{
    /// The radiance that arrives along a ray, by one path: the loop of [`PathTracer`](crate::PathTracer).
    pub fn trace<R, T, S>(
        &self,
        walk: &Walk<R>,
        (heuristic, max_vertices): (Heuristic, u32),
        mut segment: Segment,
        shadow: &mut T,
        source: &mut S,
    ) -> Traced<C>
    where
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let collisions = self.collisions(walk);
        let phase = &self.volume.phase;
        let mut radiance = C::ZERO;
        let mut throughput = C::splat(1.0);
        let mut from: Option<Scattered> = None;
        for _ in 0..max_vertices {
            let hit = self.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let (vertex, factor) = match self.follow(walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => (vertex, energy),
                Event::Passed { weight } => {
                    throughput = throughput * weight;
                    let Some(hit) = hit else {
                        radiance +=
                            throughput * self.background(heuristic, from.as_ref(), segment.line.direction);
                        return Traced { radiance, is_cut: false };
                    };
                    radiance +=
                        throughput * self.emission(heuristic, from.as_ref(), segment.line.direction, &hit);
                    if let Some(passage) = self.pass(&hit, segment.line.direction, source) {
                        throughput = throughput * passage.radiance_scale;
                        let line = Line { origin: hit.position, direction: passage.direction };
                        segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                        from = None;
                        continue;
                    }
                    self.diffuse_vertex(&hit).expect("what is not smooth is diffuse")
                }
                Event::Absorbed => return Traced { radiance, is_cut: false },
                Event::Truncated => return Traced { radiance, is_cut: true },
            };
            let factor: C = factor;
            let lit = self.emitters_at(heuristic, &vertex, shadow, source);
            radiance += throughput * factor * lit;
            let survival = factor.magnitude().min(1.0);
            if source.next_uniform() >= survival {
                return Traced { radiance, is_cut: false };
            }
            throughput = throughput * factor * (1.0 / survival);
            let direction = vertex.sample(phase, source.next_uniform(), source.next_uniform());
            from = Some(Scattered { vertex, pdf_solid_angle: vertex.pdf_solid_angle(phase, direction) });
            segment = vertex.leave(direction, f64::INFINITY);
        }
        Traced { radiance, is_cut: true }
    }
}
