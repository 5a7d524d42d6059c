//! Path tracing from the camera through surfaces and medium (raab-2008 section 4.1).

use crate::extend::{Extension, LightCandidates, One, Own, PathSampling, Several};
use crate::transport::{Types, World};
use crate::{Heuristic, Integrator, Walk};
use fairflight_media::Line;
use fairflight_scene::Segment;
use fairflight_sources::UniformSource;
use std::num::NonZeroU32;

/// Volumetric path tracing with next-event estimation: the reference for everything that knows surfaces.
///
/// ```text
/// repeat
///     fly along the ray: to a collision, a surface, or out                      (raab-2008 algorithm 1)
///     at an emitter or outside: add what it emits                               (weight against next-event estimation)
///     at a smooth surface: go on behind it
///     add what emitters send here and is scattered back along the path          (weight against the direction chosen next)
///     roulette with the share that is scattered here
///     choose a direction by BRDF · cosine or phase function
/// ```
///
/// **Law.** E\[radiance\] solves the three point form (raab-2008 eq. 5) with all its orders, for light that is reached: light of a point or
/// of a direction is not seen behind smooth surfaces, since no direction meets it by chance and no connection passes them.
///
/// **Variance.** Of emitters with some size, see [`World::emitters_at`]. Point lights in a medium leave no second moment: raab-2008
/// section 4.1 suggests to bound the geometric term and to compensate; but compensation cannot hit a point either.
///
/// **Extensions** choose directions otherwise, or the points of lights among several ([`extend`](crate::extend)): the expectation stays, the variance
/// changes. Without them they cost nothing.
///
/// **Roulette** looks at the vertex alone (reflectance, or what the collision left of the energy), not at the path before: bidirectional
/// weights will rely on that.
///
/// ```
/// use fairflight_collision::Version;
/// use fairflight_media::{Bounds, EmptySpace, Line, phase::Isotropic};
/// use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk, transport::World};
/// use fairflight_scene::surface::Rectangle;
/// use fairflight_scene::{Background, Lights, Material, Shape, Source, Surface, Surfaces, Volume};
/// use fairflight_sources::Seeded;
/// use fairflight_transmittance::Regular;
/// use glam::{DVec3, dvec3};
/// use std::f64::consts::PI;
///
/// // A floor of reflectance 1/2, a point light of power 8π² two above it, and nothing else that could send light back.
/// let floor = Rectangle::new(dvec3(-1.0, -1.0, 0.0), 2.0 * DVec3::X, 2.0 * DVec3::Y).unwrap();
/// let floor = Surface::new(Shape::Rectangle(floor), Material::Diffuse { reflectance: 0.5 }, 0.0).unwrap();
/// let light = Source::point(dvec3(0.0, 0.0, 2.0), 8.0 * PI * PI).unwrap();
/// let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
/// let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
/// let (surfaces, lights) = (Surfaces::new(vec![floor]), Lights { background: Background::dark(), sources: vec![light] });
///
/// let world = World::new(&volume, &surfaces, &lights);
/// let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
/// let mut tracer = PathTracer::new(world, walk, Regular, Heuristic::Balance);
/// let radiance = tracer.radiance(&Line { origin: DVec3::Z, direction: -DVec3::Z }, &mut Seeded::new(1));
/// // reflectance/π · power/(4π distance²)
/// assert!((radiance - 0.25).abs() < 1e-15);
/// ```
#[derive(Debug)]
pub struct PathTracer<'s, W: Types, E = Own, L = One> {
    world: World<'s, W>,
    walk: Walk<W::Sampling>,
    shadow: W::Shadow,
    sampling: PathSampling<E, L>,
    max_vertices: u32,
    truncated: u64,
}

impl<'s, W: Types> PathTracer<'s, W> {
    /// Paths through `world` that fly by `walk`, connected with lights through `shadow`.
    pub fn new(
        world: World<'s, W>,
        walk: Walk<W::Sampling>,
        shadow: W::Shadow,
        heuristic: Heuristic,
    ) -> Self {
        let sampling = PathSampling::by(heuristic);
        Self { world, walk, shadow, sampling, max_vertices: u32::MAX, truncated: 0 }
    }
}

impl<'s, W: Types, E, L> PathTracer<'s, W, E, L> {
    /// The same with another choice of directions.
    #[must_use]
    pub fn with_extension<F: Extension<W>>(self, extension: F) -> PathTracer<'s, W, F, L> {
        let Self { world, walk, shadow, max_vertices, truncated, .. } = self;
        let PathSampling { heuristic, candidates, .. } = self.sampling;
        let sampling = PathSampling { heuristic, extension, candidates };
        PathTracer { world, walk, shadow, sampling, max_vertices, truncated }
    }

    /// The same with `candidates` points of each light of some extent, of which one is kept.
    #[must_use]
    pub fn with_light_candidates(self, candidates: NonZeroU32) -> PathTracer<'s, W, E, Several> {
        let Self { world, walk, shadow, max_vertices, truncated, .. } = self;
        let PathSampling { heuristic, extension, .. } = self.sampling;
        let sampling = PathSampling { heuristic, extension, candidates: Several(candidates) };
        PathTracer { world, walk, shadow, sampling, max_vertices, truncated }
    }

    /// The same with at most `max_vertices` vertices on surfaces and in the medium: a bias where a path has more.
    #[must_use]
    pub fn with_max_vertices(self, max_vertices: u32) -> Self {
        Self { max_vertices, ..self }
    }

    /// The number of paths that were cut so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }
}

impl<W: Types, E: Extension<W>, L: LightCandidates> Integrator<W::Spectrum> for PathTracer<'_, W, E, L> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> W::Spectrum {
        let Self { world, walk, shadow, sampling, max_vertices, truncated } = self;
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        let traced = world.trace(walk, (sampling, *max_vertices), (segment, None), shadow, source);
        *truncated += u64::from(traced.is_cut);
        traced.radiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Uniform;
    use crate::transport::fixtures::{ball, diffuse, hazy, vacuum};
    use fairflight_collision::Version;
    use fairflight_sources::{Scripted, Seeded};
    use fairflight_transmittance::Regular;
    use glam::DVec3;

    fn walk() -> Walk<Uniform> {
        Walk::new(Version::Terminating, Uniform::new(0.5).unwrap())
    }

    fn up() -> Line {
        Line { origin: DVec3::ZERO, direction: DVec3::Z }
    }

    #[test]
    fn cut_paths_are_counted() {
        let scene = vacuum(vec![ball(DVec3::ZERO, 1.0, diffuse(0.5), 3.0)], vec![]);
        let mut tracer =
            PathTracer::new(scene.world(), walk(), Regular, Heuristic::Power).with_max_vertices(2);
        // Emission, roulette and a direction, twice: a throughput of 0.5 that survives with 0.5 stays 1.
        let mut both = Scripted::new([0.4, 0.3, 0.6, 0.4, 0.3, 0.6]);
        assert_eq!(tracer.radiance(&up(), &mut both), 6.0);
        assert_eq!((tracer.truncated(), both.remaining()), (1, 0));
        assert_eq!(tracer.radiance(&up(), &mut Scripted::new([0.5])), 3.0);
        assert_eq!(tracer.truncated(), 1);
        assert_eq!(tracer.radiance(&up(), &mut Scripted::new([0.4, 0.3, 0.6, 0.7])), 6.0);
        assert_eq!(tracer.truncated(), 1);
    }

    #[test]
    fn a_furnace_is_equally_bright_by_every_heuristic() {
        // A glowing ball that reflects half, with a haze inside that absorbs nothing: emission/(1 − reflectance) = 1.
        let mut scene = hazy(0.5, vec![ball(DVec3::ZERO, 1.0, diffuse(0.5), 0.5)], vec![]);
        scene.volume.albedo = 1.0;
        for heuristic in [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum] {
            let mut tracer = PathTracer::new(scene.world(), walk(), Regular, heuristic);
            let mut source = Seeded::new(3);
            let found: Vec<f64> = (0..20_000).map(|_| tracer.radiance(&up(), &mut source)).collect();
            let n = found.len() as f64;
            let mean = found.iter().sum::<f64>() / n;
            let variance = found.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
            // Five standard errors: false alarm 6e-7.
            assert!((mean - 1.0).abs() < 5.0 * (variance / n).sqrt(), "{heuristic:?}: {mean}");
            assert_eq!(tracer.truncated(), 0);
        }
    }
}
