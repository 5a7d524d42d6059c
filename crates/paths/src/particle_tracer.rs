//! Particle tracing from the camera: importons (szirmay-kalos-2017 section 4.1).

use crate::{End, Integrator, Ratio, RayTransmittance, SamplingExtinction, ScatteringEvent, Walk, arriving};
use fairflight_media::{Line, Medium, PhaseFunction, Ray};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;

/// Multiple scattering by importons: one walk per ray.
///
/// It meets the background where it leaves; every other light is connected with at each scattering event, through an unbiased
/// estimate of transmittance by the same sampling extinction. [`trace`](Self::trace) follows importons of many streams in lanes.
///
/// **Law.** E\[radiance\] solves the equation of transfer (raab-2008 eq. 2) in a medium without emission.
///
/// **Variance.** Finite while the walk is subcritical ([`Walk`]), without point lights in the medium. The connection with a point
/// light d away weighs 1/d²: its second moment diverges where collisions can lie next to the light (raab-2008 section 4.1).
#[derive(Debug)]
pub struct ParticleTracer<'s, M, P, C, R> {
    pub(crate) volume: &'s Volume<M, P, C>,
    pub(crate) lights: &'s Lights<C>,
    pub(crate) walk: Walk<R>,
    pub(crate) truncated: u64,
}

impl<'s, M, P, C, R> ParticleTracer<'s, M, P, C, R> {
    /// Traces importons through `volume`, lit by `lights`.
    pub fn new(volume: &'s Volume<M, P, C>, lights: &'s Lights<C>, walk: Walk<R>) -> Self {
        Self { volume, lights, walk, truncated: 0 }
    }

    /// The number of walks that were cut at their greatest number of collisions so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> ParticleTracer<'_, M, P, C, R> {
    /// Adds the light of all sources that is scattered at an event towards where its importon came from.
    #[inline]
    pub(crate) fn connect(
        &self,
        event: &ScatteringEvent<C>,
        radiance: &mut C,
        source: &mut impl UniformSource,
    ) {
        for light in &self.lights.sources {
            let Some(connection) = light.connect(event.point) else { continue };
            let shadow = &mut Ratio(self.walk.sampling());
            let arriving = arriving(self.volume, event.point, &connection, shadow, source);
            let phase = self.volume.phase.eval(event.incident.dot(connection.towards));
            *radiance += event.energy * arriving * phase;
        }
    }

    /// Adds all that one importon meets from the start of `ray` on.
    #[inline]
    pub(crate) fn follow(&mut self, ray: Ray<&M>, radiance: &mut C, source: &mut impl UniformSource) {
        let end = self
            .walk
            .simulate(self.volume, ray, source, |event, source| self.connect(&event, radiance, source));
        match end {
            End::Escaped { direction, energy } => {
                *radiance += energy * self.lights.background.radiance(direction);
            }
            End::Absorbed => {}
            End::Truncated => self.truncated += 1,
        }
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> Integrator<C>
    for ParticleTracer<'_, M, P, C, R>
{
    #[inline]
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let Some(ray) = self.volume.enter(line, None) else {
            return self.lights.background.radiance(line.direction);
        };
        let mut radiance = C::ZERO;
        self.follow(ray, &mut radiance, source);
        radiance
    }
}

/// Transmittance of the ray to the background, and no scattering at all (section 4.2).
#[derive(Debug)]
pub struct Attenuation<'s, M, P, C, T> {
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    estimator: T,
}

impl<'s, M, P, C, T> Attenuation<'s, M, P, C, T> {
    /// The background of `lights` seen through `volume`.
    pub fn new(volume: &'s Volume<M, P, C>, lights: &'s Lights<C>, estimator: T) -> Self {
        Self { volume, lights, estimator }
    }
}

impl<M: Medium, P, C: Spectrum, T: RayTransmittance<M>> Integrator<C> for Attenuation<'_, M, P, C, T> {
    #[inline]
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let background = self.lights.background.radiance(line.direction);
        match self.volume.enter(line, None) {
            Some(ray) => background * self.estimator.estimate(&ray, source),
            None => background,
        }
    }
}
