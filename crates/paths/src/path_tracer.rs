//! Path tracing from the camera through surfaces and medium (raab-2008 section 4.1).

use crate::transport::World;
use crate::{Heuristic, Integrator, RayTransmittance, SamplingExtinction, Walk};
use fairflight_media::{Line, Medium, PhaseFunction};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;

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
/// **Roulette** looks at the vertex alone (reflectance, or what the collision left of the energy), not at the path before: bidirectional
/// weights will rely on that.
#[derive(Debug)]
pub struct PathTracer<'s, G, M, P, C, R, T> {
    world: World<'s, G, M, P, C>,
    walk: Walk<R>,
    shadow: T,
    heuristic: Heuristic,
    max_vertices: u32,
    truncated: u64,
}

impl<'s, G, M, P, C, R, T> PathTracer<'s, G, M, P, C, R, T> {
    /// Paths through `world` that fly by `walk`, connected with lights through `shadow`.
    pub fn new(world: World<'s, G, M, P, C>, walk: Walk<R>, shadow: T, heuristic: Heuristic) -> Self {
        Self { world, walk, shadow, heuristic, max_vertices: u32::MAX, truncated: 0 }
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

impl<G, M, P, C, R, T> Integrator<C> for PathTracer<'_, G, M, P, C, R, T>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
{
    fn radiance<S: UniformSource + ?Sized>(&mut self, line: &Line, source: &mut S) -> C {
        let Self { world, walk, shadow, heuristic, max_vertices, truncated } = self;
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        let traced = world.trace(walk, (*heuristic, *max_vertices), segment, shadow, source);
        *truncated += u64::from(traced.is_cut);
        traced.radiance
    }
}
