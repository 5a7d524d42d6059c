//! SimulateParticle (szirmay-kalos-2017 section 4.1): one light particle until it leaves the medium or ends.

use crate::SamplingExtinction;
use fairflight_collision::{Albedo, Outcome, SingleOutcome, SingleParticle, Version};
use fairflight_media::{Extinction, Line, Medium, PhaseFunction, Ray};
use fairflight_scene::{Spectrum, Volume};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// Random walk of particles: photons and importons alike.
///
/// ```text
/// while the particle is inside and has energy
///     s += free flight of sigma_samp                                     (eq. 4)
///     r = sigma_t / sigma_samp
///     scattered, transmitted or absorbed, with energies of eq. 9
///     if scattered: a new direction by the phase function
/// ```
///
/// **Law.** The expected energy that is scattered per volume, and that leaves, is that of the medium, for every σ_samp that is
/// positive where the extinction is. Above r = 2/(1 + a) the absolute energy grows at each collision: in a medium where that
/// happens often enough there is no second moment, later no first one ([`second_moment_growth`](crate::second_moment_growth)).
///
/// **Colour.** The decisions are made by the greatest albedo; each channel carries the ratio of its own to that one, at most 1.
///
/// **Roulette.** SimulateParticle never ends a non-terminating particle in an endless medium. Here one whose energy has fallen
/// below [`ROULETTE_BELOW`] survives with probability |E|/ROULETTE_BELOW, with that energy: no bias, and what it adds to the
/// second moment of a score X is at most ROULETTE_BELOW · E\[|X|\] of the walks that got there.
#[derive(Clone, Copy, Debug)]
pub struct Walk<R> {
    version: Version,
    sampling: R,
    max_collisions: u64,
    roulette: Roulette,
}

/// Chance of a path to go on from a vertex ([`World::random_walk`](crate::transport::World::random_walk)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Roulette {
    /// The share that is scattered there: what goes on has the weight of one that was scattered whole.
    #[default]
    Scattered,
    /// Certainty: what goes on weighs as much as was scattered. For walks whose number of vertices is chosen before.
    Never,
}

/// The energy, relative to where the particle started, below which roulette is played.
pub const ROULETTE_BELOW: f64 = 1.0 / 256.0;

/// End of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End<C> {
    /// The particle left the medium.
    Escaped {
        /// Direction of travel, of unit length.
        direction: DVec3,
        /// Energy relative to that at the start.
        energy: C,
    },
    /// The particle was absorbed, or lost at roulette.
    Absorbed,
    /// The particle met the greatest number of collisions that it was allowed: what it had left is missing, a bias.
    Truncated,
}

/// A particle that was just scattered, before its new direction is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScatteringEvent<C> {
    /// Point of the medium at which it was scattered.
    pub point: DVec3,
    /// The direction of travel before.
    pub incident: DVec3,
    /// Energy behind the collision, relative to that at the start.
    pub energy: C,
}

/// End of a flight along one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Leg {
    /// The particle was scattered.
    Scattered {
        /// The distance from the start of the ray \[length\].
        s: f64,
        /// The energy behind the collision, by the greatest albedo.
        weight: f64,
    },
    /// The particle met the end of the ray.
    Passed {
        /// The energy left.
        weight: f64,
    },
    /// The particle was absorbed, or lost at roulette.
    Absorbed,
    /// The particle met as many collisions as it was allowed.
    Truncated,
}

impl<R: SamplingExtinction> Walk<R> {
    /// Walks with the collisions of `version`, at the rate of `sampling`.
    pub fn new(version: Version, sampling: R) -> Self {
        Self { version, sampling, max_collisions: u64::MAX, roulette: Roulette::Scattered }
    }

    /// The same, but no more than `max_collisions` collisions each: a bias where it happens.
    #[must_use]
    pub fn with_max_collisions(self, max_collisions: u64) -> Self {
        Self { max_collisions, ..self }
    }

    /// The same with another chance to go on from a vertex.
    #[must_use]
    pub fn with_roulette(self, roulette: Roulette) -> Self {
        Self { roulette, ..self }
    }

    /// Chance to go on from a vertex.
    pub fn roulette(&self) -> Roulette {
        self.roulette
    }

    /// The sampling extinction.
    pub fn sampling(&self) -> &R {
        &self.sampling
    }

    /// The greatest number of collisions of a walk.
    pub fn max_collisions(&self) -> u64 {
        self.max_collisions
    }

    /// The version.
    pub fn version(&self) -> Version {
        self.version
    }

    /// The collisions of the walk in a volume: by its greatest albedo, and the ratio of each channel's to that.
    pub fn collisions<M, P, C: Spectrum>(&self, volume: &Volume<M, P, C>) -> (SingleParticle, C) {
        let greatest = volume.albedo.max_channel();
        // A gain is left to the energies: probabilities are those of an albedo of 1.
        let albedo =
            Albedo::new(greatest.min(1.0)).expect("an albedo is checked to be a number of at least 0");
        let ratio = if albedo.get() > 0.0 { volume.albedo * (1.0 / albedo.get()) } else { C::ZERO };
        (SingleParticle { version: self.version, albedo }, ratio)
    }

    /// Flies along one ray: to the first scattering, or to the end of the ray.
    ///
    /// `weight` is the energy that the particle starts with, `left` the number of collisions that it may still meet. `model` is that
    /// of [`collisions`](Self::collisions).
    #[inline]
    pub(crate) fn fly<M: Medium>(
        &self,
        model: &SingleParticle,
        ray: &Ray<&M>,
        mut weight: f64,
        left: &mut u64,
        source: &mut impl UniformSource,
    ) -> Leg {
        let length = ray.length();
        let mut s = 0.0;
        loop {
            let depth = source.next_exponential();
            let Some((next, sigma_samp)) = self.sampling.fly(ray.world_line(), s, length, depth) else {
                return Leg::Passed { weight };
            };
            if *left == 0 {
                return Leg::Truncated;
            }
            *left -= 1;
            s = next;
            let (energy, scatters) = match model.collide(ray.sigma_t(s) / sigma_samp, source) {
                Outcome::Transmitted(energy) => (energy, false),
                Outcome::Scattered(energy) => (energy, true),
                Outcome::Absorbed => return Leg::Absorbed,
            };
            weight *= energy;
            if weight.abs() < ROULETTE_BELOW {
                if source.next_uniform() * ROULETTE_BELOW >= weight.abs() {
                    return Leg::Absorbed;
                }
                weight = ROULETTE_BELOW.copysign(weight);
            }
            if scatters {
                return Leg::Scattered { s, weight };
            }
        }
    }

    /// Follows a particle of energy 1 from the start of `ray`. `scattered` sees each scattering event.
    #[inline]
    pub fn simulate<'v, M: Medium, P: PhaseFunction, C: Spectrum, S: UniformSource>(
        &self,
        volume: &'v Volume<M, P, C>,
        mut ray: Ray<&'v M>,
        source: &mut S,
        mut scattered: impl FnMut(ScatteringEvent<C>, &mut S),
    ) -> End<C> {
        let (model, ratio) = self.collisions(volume);
        let (mut weight, mut colour) = (1.0_f64, C::splat(1.0));
        let mut left = self.max_collisions;
        loop {
            let s = match self.fly(&model, &ray, weight, &mut left, source) {
                Leg::Scattered { s, weight: energy } => {
                    weight = energy;
                    s
                }
                Leg::Passed { weight } => {
                    return End::Escaped { direction: ray.world_line().direction, energy: colour * weight };
                }
                Leg::Absorbed => return End::Absorbed,
                Leg::Truncated => return End::Truncated,
            };
            let Line { direction: incident, .. } = *ray.world_line();
            let point = ray.world_point(s);
            colour = colour * ratio;
            scattered(ScatteringEvent { point, incident, energy: colour * weight }, source);
            let (u, v) = (source.next_uniform(), source.next_uniform());
            let direction = volume.phase.sample(incident, u, v).direction;
            ray = volume.inside(Line { origin: point, direction });
        }
    }
}
