//! Light paths, whose vertices are virtual point lights (engelhardt-2013 section 3.2, raab-2008 section 4.2).

use crate::{Emitters, Vpl};
use fairflight_media::{Line, Medium, PhaseFunction};
use fairflight_paths::transport::{Event, World};
use fairflight_paths::{SamplingExtinction, Walk};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Light paths through surfaces and medium.
///
/// ```text
/// start on an emitter, with its power
/// repeat
///     fly to a collision or a surface                      (raab-2008 algorithm 1, or any other sampling extinction)
///     at a smooth surface: go on behind it
///     else: leave a virtual point light with the power that is scattered
///     roulette with the share that is scattered
///     choose a direction by BRDF · cosine or phase function
/// ```
///
/// **Law.** With N paths, each light of power Φ/N, the sum over all virtual point lights of power · f(x) · g(x) has the expectation
/// ∫ L_s(x → ·) g(x) dx: they are samples of the light that is scattered at x, whatever g. In particular the power that they absorb and
/// the power that escapes are those of the emitters ([`Ledger`]).
///
/// **Variance.** A sampling extinction below the extinction gives powers of either sign; subcriticality is that of the
/// [`Walk`].
#[derive(Debug)]
pub struct LightPaths<'s, G, M, P, C, R> {
    world: World<'s, G, M, P, C>,
    emitters: &'s Emitters<C>,
    walk: Walk<R>,
    keep_near: Option<KeepNear>,
    max_vertices: u32,
}

/// Keeps what is near to somebody, and of the rest as much as counts (engelhardt-2013 section 7).
///
/// The paper keeps the virtual point lights that are close to the camera, a bias. Here one at the distance r is kept with probability
/// min(1, (radius/r)²) and weighs as much more: as their number falls with 1/r², so does what one of them could add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepNear {
    /// Near to where.
    pub point: DVec3,
    /// Within this distance all are kept \[length\], positive.
    pub radius: f64,
}

impl KeepNear {
    /// The probability to keep what lies at `position`.
    #[must_use]
    pub fn probability(&self, position: DVec3) -> f64 {
        (self.radius * self.radius / (position - self.point).length_squared()).min(1.0)
    }
}

/// Where the power of light paths went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ledger<C> {
    /// Light paths.
    pub paths: u64,
    /// What they started with.
    pub emitted: C,
    /// What left the scene.
    pub escaped: C,
    /// What virtual point lights scatter, before any of them is dropped for being far.
    pub scattered: C,
    /// What vertices absorbed, as far as it is scored there and not by chance: (1/ρ − 1) of what is scattered.
    pub absorbed: C,
    /// Paths that were cut at the greatest number of vertices: each is a bias.
    pub truncated: u64,
}

impl<C: Spectrum> Ledger<C> {
    /// Of no paths.
    #[must_use]
    pub fn empty() -> Self {
        let zero = C::ZERO;
        Self { paths: 0, emitted: zero, escaped: zero, scattered: zero, absorbed: zero, truncated: 0 }
    }

    /// Of these and other paths.
    #[must_use]
    pub fn and(self, other: &Self) -> Self {
        Self {
            paths: self.paths + other.paths,
            emitted: self.emitted + other.emitted,
            escaped: self.escaped + other.escaped,
            scattered: self.scattered + other.scattered,
            absorbed: self.absorbed + other.absorbed,
            truncated: self.truncated + other.truncated,
        }
    }
}

/// Longer paths are cut, and counted: only a scene without absorption has them.
const MOST_VERTICES: u32 = 10_000;

impl<'s, G, M, P, C, R> LightPaths<'s, G, M, P, C, R>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
{
    /// Light paths from `emitters` through `world` that fly by `walk`.
    pub fn new(world: World<'s, G, M, P, C>, emitters: &'s Emitters<C>, walk: Walk<R>) -> Self {
        Self { world, emitters, walk, keep_near: None, max_vertices: MOST_VERTICES }
    }

    /// The same, thinned far away from a point.
    #[must_use]
    pub fn keeping_near(self, keep_near: Option<KeepNear>) -> Self {
        Self { keep_near, ..self }
    }

    /// The same with at most `max_vertices` vertices on a path.
    #[must_use]
    pub fn with_max_vertices(self, max_vertices: u32) -> Self {
        Self { max_vertices, ..self }
    }

    /// Traces one path that carries `share` of all power (1/N for N paths); `deposit` takes its virtual point lights.
    pub fn trace<S: UniformSource + ?Sized>(
        &self,
        share: f64,
        ledger: &mut Ledger<C>,
        source: &mut S,
        mut deposit: impl FnMut(Vpl<C>),
    ) {
        let world = &self.world;
        ledger.paths += 1;
        let Some(start) = self.emitters.sample(world.lights, world.surfaces, source) else { return };
        let collisions = world.collisions(&self.walk);
        let mut power = start.power * share;
        let mut segment = start.segment;
        let mut bounce = 0;
        ledger.emitted += power;
        for _ in 0..self.max_vertices {
            let hit = world.surfaces.intersect(&segment);
            segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
            let incident = segment.line.direction;
            let (vertex, factor) = match world.follow(&self.walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => {
                    ledger.absorbed += share_absorbed(power * energy, world.volume.albedo);
                    (vertex, energy)
                }
                Event::Passed { weight } => {
                    power = power * weight;
                    let Some(hit) = hit else {
                        ledger.escaped += power;
                        return;
                    };
                    if let Some(passage) = world.pass(&hit, incident, source) {
                        let line = Line { origin: hit.position, direction: passage.direction };
                        segment = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                        continue;
                    }
                    let (vertex, reflectance) =
                        world.diffuse_vertex(&hit).expect("what is not smooth is diffuse");
                    ledger.absorbed += power * (C::splat(1.0) + reflectance * -1.0);
                    (vertex, reflectance)
                }
                Event::Absorbed => return,
                Event::Truncated => {
                    ledger.truncated += 1;
                    return;
                }
            };
            bounce += 1;
            let scattered = power * factor;
            ledger.scattered += scattered;
            let survival = factor.magnitude().min(1.0);
            if survival == 0.0 {
                return;
            }
            let kept = self.keep_near.map_or(1.0, |near| near.probability(vertex.position));
            if kept >= 1.0 || source.next_uniform() < kept {
                deposit(Vpl { vertex, incident, power: scattered * (1.0 / kept), bounce });
            }
            if source.next_uniform() >= survival {
                return;
            }
            power = scattered * (1.0 / survival);
            let (u, v) = (source.next_uniform(), source.next_uniform());
            segment = vertex.leave(vertex.sample(&world.volume.phase, u, v), f64::INFINITY);
        }
        ledger.truncated += 1;
    }
}

/// What was absorbed where `scattered` was not, per channel: (1 − a)/a of it.
fn share_absorbed<C: Spectrum>(scattered: C, albedo: C) -> C {
    let ratio = albedo.map(|a| if a > 0.0 { (1.0 - a) / a } else { 0.0 });
    scattered * ratio
}
