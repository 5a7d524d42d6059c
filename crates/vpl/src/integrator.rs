//! Radiance from virtual point lights (instant radiosity, raab-2008 section 4.2, engelhardt-2013 section 3.3).

use crate::{Connected, Correction, Gather};
use fairflight_media::{Line, Medium, PhaseFunction};
use fairflight_paths::transport::{Event, Vertex};
use fairflight_paths::{Integrator, RayTransmittance, SamplingExtinction};
use fairflight_scene::{Geometry, Segment, Spectrum};
use fairflight_sources::UniformSource;

/// Which virtual point lights each point on the eye ray is connected with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairing {
    /// All.
    Every,
    /// One, which counts for all; those of the points of one ray are stratified over the set.
    One,
}

/// Which part of the light is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Component {
    /// All of it.
    #[default]
    All,
    /// Connections alone. With [`Term::Excess`](crate::Term::Excess) that is the energy that bounding takes away, seen by the
    /// virtual point lights themselves: without a second moment in a medium.
    Connections,
    /// The correction alone: the same energy, recovered.
    Correction,
}

/// All light: emitters seen directly and lit by them, and virtual point lights for what was scattered before.
///
/// ```text
/// L = emitter or background behind the medium
///   + mean over S flights of   albedo or reflectance at the vertex y where the flight ends
///       · ( light of emitters scattered at y + Σ_k connection(y, k) + correction(y) )
/// ```
///
/// engelhardt-2013 section 3.3, with points y sampled by transmittance; its sum runs over S points and M lights (the printed bounds run
/// one too far). With [`Pairing::One`] the sum over k is M times one term.
///
/// **Law.** Over sets of light paths E\[radiance\] solves the three point form (raab-2008 eq. 5), if nothing is bounded or the correction is
/// unbiased. Given one set it does not: pixels of an image share their error, and only independent sets tell it.
///
/// Smooth surfaces are followed: no virtual point light lies on them and no connection passes them.
#[derive(Debug)]
pub struct VplIntegrator<'s, G, M, P, C, R, T, K> {
    gather: Gather<'s, G, M, P, C, R, T>,
    eye_samples: u32,
    pairing: Pairing,
    correction: K,
    component: Component,
    truncated: u64,
}

/// Smooth surfaces on one path from the camera; longer ones are cut, and counted.
const MOST_SMOOTH: u32 = 1000;

impl<'s, G, M, P, C, R, T, K> VplIntegrator<'s, G, M, P, C, R, T, K> {
    /// `eye_samples` ≥ 1 flights by `walk` along each camera ray.
    pub fn new(
        gather: Gather<'s, G, M, P, C, R, T>,
        (eye_samples, pairing): (u32, Pairing),
        correction: K,
    ) -> Self {
        Self {
            gather,
            eye_samples: eye_samples.max(1),
            pairing,
            correction,
            component: Component::All,
            truncated: 0,
        }
    }

    /// The same, one part of the light only.
    #[must_use]
    pub fn component(self, component: Component) -> Self {
        Self { component, ..self }
    }

    /// The number of flights and chains of smooth surfaces that were cut so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// The correction, with what it counted.
    pub fn correction(&self) -> &K {
        &self.correction
    }
}

impl<G, M, P, C, R, T, K> VplIntegrator<'_, G, M, P, C, R, T, K>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
    K: Correction<C>,
{
    /// What is scattered at `y`, per albedo or reflectance, as the `j`-th of `of` points of a ray.
    fn shade<S: UniformSource + ?Sized>(&mut self, y: &Vertex, (j, of): (u32, u32), source: &mut S) -> C {
        let Self { gather, correction, component, .. } = self;
        let count = gather.vpls.len();
        let (which, scale) = match self.pairing {
            // Without virtual point lights there is no one to choose; the correction still has emitters to see.
            _ if count == 0 => (Connected::All, 1.0),
            Pairing::Every => (Connected::All, 1.0),
            Pairing::One => {
                let place = (f64::from(j) + source.next_uniform()) / f64::from(of);
                (Connected::One(((place * count as f64) as usize).min(count - 1)), count as f64)
            }
        };
        let mut radiance = C::ZERO;
        if *component != Component::Correction {
            radiance += gather.connected(y, which, source) * scale;
        }
        if *component != Component::Connections {
            radiance += correction.recover(gather, y, which, source) * scale;
        }
        if *component == Component::All {
            radiance += gather.emitters(y, source);
        }
        radiance
    }

    /// The radiance that arrives along a ray; `smooth` surfaces were met before.
    fn arriving<S: UniformSource + ?Sized>(
        &mut self,
        mut segment: Segment,
        smooth: u32,
        source: &mut S,
    ) -> C {
        let world = self.gather.world;
        let hit = world.surfaces.intersect(&segment);
        segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
        let heuristic = self.gather.heuristic;
        let mut behind = C::ZERO;
        if self.component == Component::All {
            let direction = segment.line.direction;
            behind += match &hit {
                Some(hit) => world.emission(heuristic, None, direction, hit),
                None => world.background(heuristic, None, direction),
            };
        }
        if let Some(hit) = hit
            && let Some(passage) = world.pass(&hit, segment.line.direction, source)
        {
            if smooth < MOST_SMOOTH {
                let line = Line { origin: hit.position, direction: passage.direction };
                let next = Segment { line, length: f64::INFINITY, from: Some(hit.index), to: None };
                behind += self.arriving(next, smooth + 1, source) * passage.radiance_scale;
            } else {
                self.truncated += 1;
            }
        }
        let mut radiance = C::ZERO;
        if behind != C::ZERO {
            radiance += behind * world.transmittance(&segment, &mut self.gather.shadow, source);
        }

        let surface = hit.as_ref().and_then(|hit| world.diffuse_vertex(hit));
        let collisions = world.collisions(&self.gather.walk);
        // Where nothing scatters on the way all flights end alike.
        let scatters = world.meets_medium(&segment);
        let flights = if scatters || self.pairing == Pairing::One { self.eye_samples } else { 1 };
        if !scatters && surface.is_none() {
            return radiance;
        }
        let mut scattered = C::ZERO;
        for j in 0..flights {
            let (vertex, factor) = match world.follow(&self.gather.walk, &collisions, &segment, source) {
                Event::Scattered { vertex, energy } => (vertex, energy),
                Event::Passed { weight } => match surface {
                    Some((vertex, reflectance)) => (vertex, reflectance * weight),
                    None => continue,
                },
                Event::Absorbed => continue,
                Event::Truncated => {
                    self.truncated += 1;
                    continue;
                }
            };
            scattered += factor * self.shade(&vertex, (j, flights), source);
        }
        radiance + scattered * (1.0 / f64::from(flights))
    }
}

impl<G, M, P, C, R, T, K> Integrator<C> for VplIntegrator<'_, G, M, P, C, R, T, K>
where
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
    C: Spectrum,
    R: SamplingExtinction,
    T: RayTransmittance<M>,
    K: Correction<C>,
{
    fn radiance<S: UniformSource + ?Sized>(&mut self, line: &Line, source: &mut S) -> C {
        let segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        self.arriving(segment, 0, source)
    }
}
