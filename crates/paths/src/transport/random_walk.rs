//! One random walk from vertex to vertex, from a camera or from a light.

use super::{Event, Passage, Types, Vertex, World};
use crate::{Roulette, Walk};
use fairflight_media::Line;
use fairflight_scene::{Geometry, Hit, Segment, Spectrum};
use fairflight_sources::{PathEnd, Row, UniformSource};
use glam::DVec3;
use std::ops::ControlFlow;

/// Quantity that a walk carries, which says what a change of the index of refraction does to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// Radiance, from the camera: L/n² is what stays the same along a ray.
    Radiance,
    /// Power, from a light: refraction does not change it.
    Power,
}

/// Vertex at which a walk is scattered, or smooth surface that it passes.
#[derive(Clone, Copy, Debug)]
pub enum Met<'h, C> {
    /// A collision, or a diffuse surface.
    Vertex {
        /// The vertex.
        vertex: Vertex,
        /// Share of what arrives that is scattered: the energy behind a collision, a reflectance.
        factor: C,
        /// The surface; none in the medium.
        hit: Option<Hit<'h, C>>,
    },
    /// A smooth surface.
    Smooth {
        /// The surface.
        hit: Hit<'h, C>,
        /// Way behind it.
        passage: Passage,
    },
}

/// End of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WalkEnd<C> {
    /// It left the scene in this direction with what it carried.
    Escaped(DVec3, C),
    /// It was absorbed, lost at roulette, or stopped by who saw it.
    Ended,
    /// It had more vertices or collisions than it was allowed: a bias.
    Cut,
}

impl<W: Types> World<'_, W> {
    /// Walks from the start of `segment`:
    ///
    /// ```text
    /// repeat, at most `max_vertices` times
    ///     fly to a collision or a surface                      (raab-2008 algorithm 1, or any other sampling extinction)
    ///     show `met` where that is, and what arrives there; end if it says so
    ///     at a smooth surface: go on behind it
    ///     else: roulette with the share that is scattered, unless the walk never plays it
    ///     choose a direction by BRDF · cosine or phase function
    /// ```
    ///
    /// **Law.** What arrives, weighted with any bounded function of the vertices so far and summed over walks, has the expectation
    /// of its integral against the product of all that light meets up to there: [`follow`](Self::follow), step by step. Roulette
    /// looks at the vertex alone.
    #[inline]
    pub fn random_walk<S: UniformSource>(
        &self,
        (walk, max_vertices): (&Walk<W::Sampling>, u32),
        (mut segment, mut carried): (Segment, W::Spectrum),
        kind: Carried,
        source: &mut S,
        mut met: impl FnMut(Met<'_, W::Spectrum>, DVec3, W::Spectrum, &mut S) -> ControlFlow<()>,
    ) -> WalkEnd<W::Spectrum> {
        let collisions = self.collisions(walk);
        let end = match kind {
            Carried::Radiance => PathEnd::Camera,
            Carried::Power => PathEnd::Light,
        };
        for before in 0..max_vertices {
            let number = before.saturating_add(1);
            let hit = self.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let incident = segment.line.direction;
            source.row(Row::flight(end, number));
            let (vertex, factor, hit) = match self.follow(walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => (vertex, energy, None),
                Event::Passed { weight } => {
                    carried = carried * weight;
                    let Some(hit) = hit else { return WalkEnd::Escaped(incident, carried) };
                    source.row(Row::direction(end, number));
                    if let Some(passage) = self.pass(&hit, incident, source) {
                        if met(Met::Smooth { hit, passage }, incident, carried, source).is_break() {
                            return WalkEnd::Ended;
                        }
                        if kind == Carried::Radiance {
                            carried = carried * passage.radiance_scale;
                        }
                        let line = Line { origin: hit.position, direction: passage.direction };
                        segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                        continue;
                    }
                    let (vertex, reflectance) =
                        self.diffuse_vertex(&hit).expect("what is not smooth is diffuse");
                    (vertex, reflectance, Some(hit))
                }
                Event::Absorbed => return WalkEnd::Ended,
                Event::Truncated => return WalkEnd::Cut,
            };
            if met(Met::Vertex { vertex, factor, hit }, incident, carried, source).is_break() {
                return WalkEnd::Ended;
            }
            source.row(Row::direction(end, number));
            let scattered = factor.magnitude().min(1.0);
            let survival = match walk.roulette() {
                _ if scattered == 0.0 => return WalkEnd::Ended,
                Roulette::Scattered if source.next_uniform() >= scattered => return WalkEnd::Ended,
                Roulette::Scattered => scattered,
                Roulette::Never => 1.0,
            };
            carried = carried * factor * (1.0 / survival);
            let (u, v) = (source.next_uniform(), source.next_uniform());
            segment = vertex.leave(vertex.sample(&self.volume.phase, u, v), f64::INFINITY);
        }
        WalkEnd::Cut
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{ball, diffuse, ray, square, vacuum};
    use super::*;
    use crate::Uniform;
    use fairflight_collision::Version;
    use fairflight_scene::Material;
    use fairflight_sources::Scripted;
    use glam::dvec3;

    /// What arrives at each vertex, and the end, of the walk that these variates make.
    fn walked(
        surfaces: Vec<fairflight_scene::Surface<f64>>,
        (from, kind, most): (Segment, Carried, u32),
        script: &[f64],
    ) -> (Vec<f64>, WalkEnd<f64>) {
        let scene = vacuum(surfaces, vec![]);
        let walk = Walk::new(Version::Terminating, Uniform::new(0.5).unwrap());
        let mut source = Scripted::new(script.iter().copied());
        let mut arriving = Vec::new();
        let end =
            scene.world().random_walk((&walk, most), (from, 2.0), kind, &mut source, |_, _, carried, _| {
                arriving.push(carried);
                ControlFlow::Continue(())
            });
        assert_eq!(source.remaining(), 0);
        (arriving, end)
    }

    #[test]
    fn refraction_changes_radiance_and_not_power() {
        let through = ray(dvec3(0.0, 0.0, -2.0), DVec3::Z);
        for (kind, inside) in [(Carried::Radiance, 2.0 / 2.25), (Carried::Power, 2.0)] {
            let glass = || ball(DVec3::ZERO, 0.5, Material::Dielectric { ior: 1.5 }, 0.0);
            let (arriving, end) = walked(vec![glass()], (through, kind, 9), &[0.5, 0.5]);
            assert!((arriving[1] - inside).abs() < 1e-15 && arriving[0] == 2.0);
            let WalkEnd::Escaped(direction, carried) = end else { panic!("{end:?}") };
            assert!((carried - 2.0).abs() < 1e-15 && (direction - DVec3::Z).length() < 1e-15);
            assert_eq!(walked(vec![glass()], (through, kind, 1), &[0.5]), (vec![2.0], WalkEnd::Cut));
        }
    }

    #[test]
    fn roulette_keeps_what_survives_and_black_ends_without_it() {
        let up = ray(DVec3::ZERO, DVec3::Z);
        let gray = || vec![square(1.0, 9.0, diffuse(0.25), 0.0), square(-1.0, 9.0, diffuse(0.0), 0.0)];
        let (arriving, end) = walked(gray(), (up, Carried::Power, 9), &[0.249, 0.0, 0.0]);
        assert_eq!((arriving, end), (vec![2.0, 2.0], WalkEnd::Ended));
        assert_eq!(walked(gray(), (up, Carried::Power, 9), &[0.25]), (vec![2.0], WalkEnd::Ended));
    }

    #[test]
    fn who_sees_a_walk_may_stop_it() {
        let scene = vacuum(vec![square(1.0, 9.0, Material::Mirror, 0.0)], vec![]);
        let walk = Walk::new(Version::Terminating, Uniform::new(0.5).unwrap());
        let start = (ray(DVec3::ZERO, DVec3::Z), 1.0);
        let mut seen = 0;
        let mut none = Scripted::new([]);
        let end = scene.world().random_walk((&walk, 9), start, Carried::Power, &mut none, |met, _, _, _| {
            assert!(matches!(met, Met::Smooth { .. }));
            seen += 1;
            ControlFlow::Break(())
        });
        assert_eq!((seen, end), (1, WalkEnd::Ended));
    }
}
