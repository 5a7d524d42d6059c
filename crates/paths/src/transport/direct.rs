//! Light that comes straight from an emitter, by two techniques whose weights sum to one.

use super::{Light, Types, Vertex, World};
use crate::Heuristic;
use crate::extend::{Extension, LightCandidates, One, PathSampling};
use fairflight_scene::{Geometry, Hit, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Last scattering of a path that comes to an emitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The vertex that chose the direction.
    pub vertex: Vertex,
    /// Density of that direction \[1/sr\], per candidate for a point of a light where there are several.
    pub pdf_solid_angle: f64,
}

/// A point of an emitter, drawn for a vertex to be lit by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterSample<C> {
    /// The emitter.
    pub light: Light,
    /// From the vertex to that point; endless for a direction.
    pub segment: Segment,
    /// Light that arrives along the segment if nothing takes of it: radiance, or irradiance of a light without extent.
    pub arriving: C,
    /// The density of the direction \[1/sr\]; none for a light without extent.
    pub pdf_solid_angle: Option<f64>,
    /// The density with which the vertex scatters into this direction \[1/sr\], positive.
    pub scattered: f64,
}

impl<W: Types> World<'_, W> {
    /// Next-event estimation: the light of all emitters that `vertex` scatters towards where its path came from, per reflectance or
    /// albedo, weighted against [`emission`](Self::emission) and [`background`](Self::background).
    ///
    /// Every light takes its turn: point and directional ones count whole, since no direction meets them by chance; surfaces and
    /// environment maps are chosen by solid angle, and weighted by `heuristic` against the directions that the vertex chooses itself. The
    /// constant background is left to those.
    ///
    /// **Weights** compare densities of the direction alone. That both techniques also meet the transmittance of the same ray, one as an
    /// estimate and one as a chance, changes no expectation: for each direction the weights are numbers that sum to 1.
    ///
    /// **Variance.** A point light at the distance r counts 1/r²; in a medium around it there is no second moment, and no second technique
    /// to help (raab-2008 section 4.1). For emitters of some size the weak singularity is gone: weight/density ≤ 1/density of the
    /// other technique, so that a contribution is at most L_e.
    #[inline]
    pub fn emitters_at(
        &self,
        heuristic: Heuristic,
        vertex: &Vertex,
        shadow: &mut W::Shadow,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        self.emitters_by(&PathSampling::by(heuristic), vertex, shadow, source)
    }

    /// The same for any choice of directions, which has turned to this vertex, and any number of candidates for the point of a light.
    ///
    /// Of n candidates one is kept for what it would add were nothing between; it stands for their mean. The weights take their density
    /// n-fold: heuristics know quotients alone, so that the density of the direction is divided by n instead, on both sides.
    #[inline(never)]
    pub fn emitters_by<E: Extension<W>, L: LightCandidates>(
        &self,
        sampling: &PathSampling<E, L>,
        vertex: &Vertex,
        shadow: &mut W::Shadow,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let PathSampling { heuristic, extension, candidates } = sampling;
        let mut radiance = W::Spectrum::ZERO;
        let share = |sampled: &EmitterSample<W::Spectrum>| {
            let scattered = sampled.scattered;
            let Some(pdf) = sampled.pdf_solid_angle else { return scattered };
            let direction = sampled.segment.line.direction;
            let other = extension.pdf_solid_angle(vertex, direction, scattered) / candidates.count();
            heuristic.mis_weight(pdf, other) * scattered / pdf
        };
        let phase = &self.volume.phase;
        self.kept_emitters(
            (vertex, |direction| vertex.pdf_solid_angle(phase, direction)),
            (*candidates, |sampled: &EmitterSample<_>| (sampled.arriving * share(sampled)).magnitude()),
            source,
            |sampled, scale, source| {
                let visibility = self.attenuated_visibility(&sampled.segment, shadow, source);
                radiance += sampled.arriving * (share(&sampled) * visibility * scale);
            },
        );
        radiance
    }

    /// Draws a point of each emitter that `vertex` may be lit by, and hands it to `seen` unless nothing of it is scattered back: the sampling of
    /// [`emitters_at`](Self::emitters_at), without visibility and weights.
    ///
    /// **Law.** The sum of arriving · scattered/density over what `seen` is given has the expectation of the light of all emitters, but
    /// for the constant background and for what a surface sees of itself, scattered per reflectance or albedo, as if nothing were between.
    #[inline]
    pub fn sample_emitters<S: UniformSource>(
        &self,
        vertex: &Vertex,
        source: &mut S,
        mut seen: impl FnMut(EmitterSample<W::Spectrum>, &mut S),
    ) {
        let phase = &self.volume.phase;
        self.kept_emitters(
            (vertex, |direction| vertex.pdf_solid_angle(phase, direction)),
            (One, |_: &EmitterSample<_>| 1.0),
            source,
            |sampled, _, source| seen(sampled, source),
        );
    }

    /// The same with several candidates for the point of each light of some extent, of which one is kept, and a density of its own for what is
    /// scattered into a direction: `seen` learns by what its contribution is to be multiplied.
    #[inline]
    pub(crate) fn kept_emitters<S: UniformSource, L: LightCandidates>(
        &self,
        (vertex, scattered): (&Vertex, impl Fn(DVec3) -> f64),
        (candidates, weigh): (L, impl Fn(&EmitterSample<W::Spectrum>) -> f64),
        source: &mut S,
        mut seen: impl FnMut(EmitterSample<W::Spectrum>, f64, &mut S),
    ) {
        for (index, light) in self.lights.sources.iter().enumerate() {
            let Some(connection) = light.connect(vertex.position) else { continue };
            let scattered = scattered(connection.towards);
            if scattered > 0.0 {
                let segment = vertex.leave(connection.towards, connection.distance.unwrap_or(f64::INFINITY));
                let (light, arriving) = (Light::Source(index), connection.irradiance);
                let sampled = EmitterSample { light, segment, arriving, pdf_solid_angle: None, scattered };
                seen(sampled, 1.0, source);
            }
        }
        for (index, map) in self.lights.background.maps.iter().enumerate() {
            let draw = |source: &mut S| {
                let [choice, u, v] = std::array::from_fn(|_| source.next_uniform());
                let (towards, arriving) = map.sample(choice, u, v)?;
                let scattered = scattered(towards);
                (scattered > 0.0).then(|| EmitterSample {
                    light: Light::Map(index),
                    segment: vertex.leave(towards, f64::INFINITY),
                    arriving,
                    pdf_solid_angle: Some(map.pdf_solid_angle(towards)),
                    scattered,
                })
            };
            if let Some((sampled, scale)) = candidates.keep(source, draw, &weigh) {
                seen(sampled, scale, source);
            }
        }
        for &index in self.surfaces.emitters() {
            // What an emitter sees of itself is left to the directions that the vertex chooses.
            if vertex.surface() == Some(index) {
                continue;
            }
            let draw = |source: &mut S| {
                let (u, v) = (source.next_uniform(), source.next_uniform());
                let sample = self.surfaces.sample_towards(index, vertex.position, u, v)?;
                let scattered = scattered(sample.direction);
                (scattered > 0.0).then(|| {
                    let towards = vertex.leave(sample.direction, sample.distance);
                    EmitterSample {
                        light: Light::Surface(index),
                        segment: Segment { to: Some(index), ..towards },
                        arriving: self.surfaces.surfaces()[index].emission,
                        pdf_solid_angle: Some(sample.pdf_solid_angle),
                        scattered,
                    }
                })
            };
            if let Some((sampled, scale)) = candidates.keep(source, draw, &weigh) {
                seen(sampled, scale, source);
            }
        }
    }

    /// The radiance that a surface emits towards a path that met it along `direction`: whole for one from the camera or a smooth surface, weighted against
    /// [`emitters_at`](Self::emitters_at) for one that a vertex sent there.
    #[inline]
    pub fn emission(
        &self,
        heuristic: Heuristic,
        from: Option<&Scattered>,
        direction: DVec3,
        hit: &Hit<'_, W::Spectrum>,
    ) -> W::Spectrum {
        let emission = hit.surface.emission;
        match from {
            Some(Scattered { vertex, pdf_solid_angle }) if emission != W::Spectrum::ZERO => {
                let shape = &hit.surface.shape;
                let is_own = vertex.surface() == Some(hit.index);
                let pdf =
                    if is_own { 0.0 } else { shape.pdf_towards(vertex.position, direction, hit.distance) };
                emission * heuristic.mis_weight(*pdf_solid_angle, pdf)
            }
            _ => emission,
        }
    }

    /// The same for the background, where a path leaves everything.
    #[inline]
    pub fn background(&self, heuristic: Heuristic, from: Option<&Scattered>, towards: DVec3) -> W::Spectrum {
        let background = &self.lights.background;
        let Some(Scattered { pdf_solid_angle, .. }) = from else { return background.radiance(towards) };
        let mut radiance = background.constant;
        for map in &background.maps {
            radiance +=
                map.radiance(towards) * heuristic.mis_weight(*pdf_solid_angle, map.pdf_solid_angle(towards));
        }
        radiance
    }
}

#[cfg(test)]
mod tests {
    use super::super::Lobe;
    use super::super::fixtures::{Scene, ball, diffuse, hazy, square, vacuum};
    use super::*;
    use fairflight_media::{EmptySpace, PhaseFunction};
    use fairflight_scene::{EnvironmentMap, Source};
    use fairflight_sources::Scripted;
    use fairflight_transmittance::Regular;
    use glam::dvec3;
    use std::f64::consts::{FRAC_1_PI, PI};

    const ALL: [Heuristic; 3] = [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum];

    /// A vertex of the floor at the origin, facing up.
    fn on_floor() -> Vertex {
        Vertex { position: DVec3::ZERO, lobe: Lobe::Diffuse { normal: DVec3::Z, surface: 0 } }
    }

    fn in_medium() -> Vertex {
        Vertex { position: DVec3::ZERO, lobe: Lobe::Phase { incident: dvec3(0.6, 0.0, 0.8) } }
    }

    #[test]
    fn point_and_parallel_light_by_hand() {
        let sources = vec![
            Source::point(dvec3(0.0, 3.0, 4.0), 100.0).unwrap(),
            Source::directional(DVec3::NEG_Z, 2.0).unwrap(),
        ];
        let scene = hazy(0.1, vec![square(0.0, 9.0, diffuse(0.5), 0.0)], sources);
        let lit = |vertex| {
            scene.world().emitters_at(Heuristic::Balance, &vertex, &mut Regular, &mut Scripted::new([]))
        };
        // The haze reaches up to 10.
        let (point, parallel) = (100.0 / (4.0 * PI * 25.0) * (-0.5f64).exp(), 2.0 * (-1.0f64).exp());
        assert!((lit(on_floor()) - FRAC_1_PI * (0.8 * point + parallel)).abs() < 1e-15);
        let phase = |direction: DVec3| scene.volume.phase.eval(dvec3(0.6, 0.0, 0.8).dot(direction));
        // The floor goes through the point, but lies behind no light.
        let expected = phase(dvec3(0.0, 0.6, 0.8)) * point + phase(DVec3::Z) * parallel;
        assert!((lit(in_medium()) - expected).abs() < 1e-15);
        let below =
            Vertex { position: DVec3::ZERO, lobe: Lobe::Diffuse { normal: DVec3::NEG_Z, surface: 0 } };
        assert_eq!(lit(below), 0.0);
    }

    #[test]
    fn a_sphere_casts_a_shadow() {
        let light = Source::point(dvec3(0.0, 0.0, 4.0), 100.0).unwrap();
        let lit = |center| {
            let scene = vacuum(
                vec![square(0.0, 9.0, diffuse(0.5), 0.0), ball(center, 1.0, diffuse(0.5), 0.0)],
                vec![light],
            );
            scene.world().emitters_at(Heuristic::Balance, &on_floor(), &mut Regular, &mut Scripted::new([]))
        };
        assert_eq!(lit(dvec3(0.5, 0.0, 2.0)), 0.0);
        assert!((lit(dvec3(1.5, 0.0, 2.0)) - 100.0 / (64.0 * PI * PI)).abs() < 1e-15);
        // Behind the light it is in nobody's way.
        assert!(lit(dvec3(0.0, 0.0, 6.0)) > 0.0);
    }

    /// Estimates of both techniques in one direction, each as its share of the whole emission.
    fn shares(
        scene: &Scene<EmptySpace>,
        vertex: &Vertex,
        heuristic: Heuristic,
        script: &[f64],
    ) -> (f64, f64) {
        let world = scene.world();
        let mut source = Scripted::new(script.iter().copied());
        let sampled = world.emitters_at(heuristic, vertex, &mut Regular, &mut source);
        assert_eq!(source.remaining(), 0);
        let lamp = &scene.surfaces.surfaces()[1];
        let towards = lamp.shape.sample_towards(vertex.position, script[0], script[1]).unwrap();
        let scattered = vertex.pdf_solid_angle(&scene.volume.phase, towards.direction);
        let from = Scattered { vertex: *vertex, pdf_solid_angle: scattered };
        let hit = scene.surfaces.intersect(&vertex.leave(towards.direction, f64::INFINITY)).unwrap();
        let met = world.emission(heuristic, Some(&from), towards.direction, &hit);
        // A sample counts emission · scattered/density: without that quotient the weight is left.
        (sampled * towards.pdf_solid_angle / scattered / lamp.emission, met / lamp.emission)
    }

    #[test]
    fn the_weights_of_both_techniques_sum_to_one() {
        let floor = square(0.0, 9.0, diffuse(0.5), 0.0);
        let lamps = [square(2.0, 1.0, diffuse(0.0), 3.0), ball(dvec3(0.5, 0.0, 3.0), 1.0, diffuse(0.0), 3.0)];
        for lamp in lamps {
            let scene = vacuum(vec![floor, lamp], vec![]);
            for vertex in [on_floor(), in_medium()] {
                for heuristic in ALL {
                    for script in [[0.75, 0.5], [0.1, 0.3], [0.6, 0.9]] {
                        let (sampled, met) = shares(&scene, &vertex, heuristic, &script);
                        assert!((sampled + met - 1.0).abs() < 1e-14, "{heuristic:?}: {sampled} + {met}");
                        assert!(heuristic == Heuristic::Maximum || (sampled > 0.0 && met > 0.0));
                    }
                }
            }
        }
    }

    #[test]
    fn one_sample_of_a_lamp_by_hand() {
        // Straight up to a lamp of the area 4 at the distance 2: density 4/(4 · 1) = 1 against 1/π.
        let scene =
            vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0), square(2.0, 1.0, diffuse(0.0), 3.0)], vec![]);
        let lit = |heuristic| {
            scene.world().emitters_at(heuristic, &on_floor(), &mut Regular, &mut Scripted::new([0.5, 0.5]))
        };
        assert!((lit(Heuristic::Balance) - 3.0 * FRAC_1_PI / (1.0 + FRAC_1_PI)).abs() < 1e-15);
        assert!((lit(Heuristic::Power) - 3.0 * FRAC_1_PI / (1.0 + FRAC_1_PI * FRAC_1_PI)).abs() < 1e-15);
        assert!((lit(Heuristic::Maximum) - 3.0 * FRAC_1_PI).abs() < 1e-15);
    }

    #[test]
    fn an_environment_map_is_shared_and_the_constant_is_not() {
        let mut scene = vacuum(vec![square(0.0, 9.0, diffuse(0.5), 0.0)], vec![]);
        let map = EnvironmentMap::new(2, 2, vec![1.0, 2.0, 0.5, 0.25]).unwrap();
        scene.lights.background.maps.push(map);
        scene.lights.background.constant = 0.5;
        let map = &scene.lights.background.maps[0];
        let (towards, arriving) = map.sample(0.1, 0.2, 0.3).unwrap();
        assert!(towards.z > 0.0, "a script that looks up");
        for heuristic in ALL {
            let mut source = Scripted::new([0.1, 0.2, 0.3]);
            let sampled = scene.world().emitters_at(heuristic, &on_floor(), &mut Regular, &mut source);
            let (pdf, scattered) = (map.pdf_solid_angle(towards), towards.z * FRAC_1_PI);
            let from = Scattered { vertex: on_floor(), pdf_solid_angle: scattered };
            let met = scene.world().background(heuristic, Some(&from), towards);
            let whole = scene.world().background(heuristic, None, towards);
            assert!((whole - 0.5 - arriving).abs() < 1e-15);
            assert!((sampled * pdf / scattered + met - whole).abs() < 1e-14, "{heuristic:?}");
        }
    }

    #[test]
    fn what_an_emitter_sees_of_itself_is_left_to_directions() {
        let scene = vacuum(vec![ball(DVec3::ZERO, 2.0, diffuse(0.5), 3.0)], vec![]);
        let normal = DVec3::X;
        let vertex = Vertex { position: dvec3(-2.0, 0.0, 0.0), lobe: Lobe::Diffuse { normal, surface: 0 } };
        let world = scene.world();
        let lit = world.emitters_at(Heuristic::Balance, &vertex, &mut Regular, &mut Scripted::new([]));
        assert_eq!(lit, 0.0);
        let hit = scene.surfaces.intersect(&vertex.leave(normal, f64::INFINITY)).unwrap();
        let from = Scattered { vertex, pdf_solid_angle: FRAC_1_PI };
        for heuristic in ALL {
            assert_eq!(world.emission(heuristic, Some(&from), normal, &hit), 3.0);
        }
    }
}
