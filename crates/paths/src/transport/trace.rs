//! One random path.

use super::{Event, Scattered, Types, World};
use crate::Walk;
use crate::extend::{Extension, LightCandidates, PathSampling};
use fairflight_media::Line;
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::{PathEnd, Row, UniformSource};

/// A path's radiance, and whether it was cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traced<C> {
    /// Radiance along the ray, by this path.
    pub radiance: C,
    /// True if the path had more vertices or collisions than it was allowed: the rest is missing, a bias.
    pub is_cut: bool,
}

impl<W: Types> World<'_, W> {
    /// The radiance that arrives along a ray, by one path: the loop of [`PathTracer`](crate::PathTracer). `from` is the vertex that chose the
    /// ray; none for one from the camera or a smooth surface.
    #[inline(never)]
    pub fn trace<E: Extension<W>, L: LightCandidates>(
        &self,
        walk: &Walk<W::Sampling>,
        (sampling, max_vertices): (&mut PathSampling<E, L>, u32),
        (mut segment, mut from): (Segment, Option<Scattered>),
        shadow: &mut W::Shadow,
        source: &mut impl UniformSource,
    ) -> Traced<W::Spectrum> {
        let collisions = self.collisions(walk);
        let heuristic = sampling.heuristic;
        let mut radiance = W::Spectrum::ZERO;
        let mut throughput = W::Spectrum::splat(1.0);
        for before in 0..max_vertices {
            let number = before.saturating_add(1);
            let hit = self.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            source.row(Row::flight(PathEnd::Camera, number));
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
                    source.row(Row::direction(PathEnd::Camera, number));
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
            let factor: W::Spectrum = factor;
            sampling.extension.prepare(self, &vertex);
            source.row(Row::connection(PathEnd::Camera, number));
            let lit = self.emitters_by(sampling, &vertex, shadow, source);
            radiance += throughput * factor * lit;
            source.row(Row::direction(PathEnd::Camera, number));
            let survival = factor.magnitude().min(1.0);
            if source.next_uniform() >= survival {
                return Traced { radiance, is_cut: false };
            }
            let extended = sampling.extension.sample(self, &vertex, source);
            throughput = throughput * factor * (extended.weight / survival);
            let pdf_solid_angle = extended.pdf_solid_angle / sampling.candidates.count();
            from = Some(Scattered { vertex, pdf_solid_angle });
            segment = vertex.leave(extended.direction, f64::INFINITY);
        }
        Traced { radiance, is_cut: true }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Scene, ball, diffuse, hazy, ray, square, vacuum};
    use super::*;
    use crate::{Heuristic, Uniform};
    use fairflight_collision::Version;
    use fairflight_media::LineThickness;
    use fairflight_scene::{Material, Source};
    use fairflight_sources::Scripted;
    use fairflight_transmittance::Regular;
    use glam::{DVec3, dvec3};
    use std::f64::consts::{FRAC_1_PI, PI};

    /// The path that these variates make, all of which it must use.
    fn trace<M: LineThickness>(
        scene: &Scene<M>,
        segment: Segment,
        max_vertices: u32,
        script: &[f64],
    ) -> Traced<f64> {
        let walk = Walk::new(Version::Terminating, Uniform::new(0.5).unwrap());
        let mut source = Scripted::new(script.iter().copied());
        let how = (&mut PathSampling::by(Heuristic::Balance), max_vertices);
        let traced = scene.world().trace(&walk, how, (segment, None), &mut Regular, &mut source);
        assert_eq!(source.remaining(), 0);
        traced
    }

    fn up() -> Segment {
        ray(DVec3::ZERO, DVec3::Z)
    }

    #[test]
    fn a_lamp_seen_directly_counts_once() {
        let lamp = || square(1.0, 1.0, diffuse(0.0), 3.0);
        // It lights nothing that it sees: the one variate is that of roulette, which nothing survives.
        let scene = vacuum(vec![lamp()], vec![]);
        assert_eq!(trace(&scene, up(), 9, &[0.0]), Traced { radiance: 3.0, is_cut: false });
        // In a mirror, where no other technique finds it.
        let scene = vacuum(vec![lamp(), square(-1.0, 1.0, Material::Mirror, 0.0)], vec![]);
        let down = ray(DVec3::ZERO, DVec3::NEG_Z);
        assert_eq!(trace(&scene, down, 9, &[0.0]), Traced { radiance: 3.0, is_cut: false });
        // Through a ball of glass, in at one side and out at the other: what n² takes away it gives back.
        let scene =
            vacuum(vec![lamp(), ball(DVec3::ZERO, 0.5, Material::Dielectric { ior: 1.5 }, 0.0)], vec![]);
        let through = ray(dvec3(0.0, 0.0, -2.0), DVec3::Z);
        let traced = trace(&scene, through, 9, &[0.5, 0.5, 0.0]);
        assert!((traced.radiance - 3.0).abs() < 1e-15 && !traced.is_cut);
    }

    #[test]
    fn the_background_is_seen_where_everything_is_left() {
        let mut scene = vacuum(vec![square(1.0, 1.0, diffuse(0.5), 0.0)], vec![]);
        scene.lights.background.constant = 0.25;
        let down = ray(DVec3::ZERO, DVec3::NEG_Z);
        assert_eq!(trace(&scene, down, 9, &[]), Traced { radiance: 0.25, is_cut: false });
        // Scattered at the ceiling, back to the background: roulette keeps 0.5 as 1.
        let traced = trace(&scene, up(), 9, &[0.49, 0.3, 0.7]);
        assert_eq!(traced, Traced { radiance: 0.25, is_cut: false });
        assert_eq!(trace(&scene, up(), 9, &[0.5]), Traced { radiance: 0.0, is_cut: false });
    }

    #[test]
    fn two_techniques_meet_a_lamp_on_one_path() {
        // From above on a floor of reflectance 1/2, which a lamp at the height 2 lights: density 1 of a point straight above.
        let scene =
            vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0), square(2.0, 1.0, diffuse(0.0), 3.0)], vec![]);
        let down = ray(DVec3::Z, DVec3::NEG_Z);
        let lit = 0.5 * 3.0 * FRAC_1_PI / (1.0 + FRAC_1_PI);
        // Lamp (u, v), roulette, straight up, roulette at the lamp.
        let traced = trace(&scene, down, 9, &[0.5, 0.5, 0.49, 0.0, 0.0, 0.0]);
        let met = 3.0 * FRAC_1_PI / (1.0 + FRAC_1_PI);
        assert!((traced.radiance - lit - met).abs() < 1e-15 && !traced.is_cut);
        // No more vertices than allowed: the lamp as a vertex is one, the floor another.
        assert_eq!(trace(&scene, down, 2, &[0.5, 0.5, 0.49, 0.0, 0.0, 0.0]), traced);
        let cut = trace(&scene, down, 1, &[0.5, 0.5, 0.49, 0.0, 0.0]);
        assert!((cut.radiance - lit).abs() < 1e-15 && cut.is_cut);
        assert_eq!(trace(&scene, down, 0, &[]), Traced { radiance: 0.0, is_cut: true });
    }

    #[test]
    fn a_collision_is_lit_through_the_medium() {
        let scene = hazy(0.5, vec![], vec![Source::point(dvec3(0.0, 3.0, 0.0), 10.0).unwrap()]);
        // Half of what flies collides within 2 ln 2; the albedo is 1/2, decided by the second variate; roulette keeps all.
        let start = ray(dvec3(0.0, 0.0, -2.0 * std::f64::consts::LN_2), DVec3::Z);
        let traced = trace(&scene, start, 1, &[0.5, 0.2, 0.999, 0.1, 0.1]);
        let irradiance = 10.0 / (36.0 * PI) * (-1.5f64).exp();
        let phase = fairflight_media::PhaseFunction::eval(&scene.volume.phase, 0.0);
        assert!((traced.radiance - irradiance * phase).abs() < 1e-15 && traced.is_cut);
        assert_eq!(trace(&scene, start, 1, &[0.5, 0.7]), Traced { radiance: 0.0, is_cut: false });
    }
}
