//! Splitting along the primary ray: several first collisions for one camera ray (raab-2008 section 3.1).

use crate::{Integrator, ParticleTracer, SamplingExtinction, ScatteringEvent, Walk};
use fairflight_media::{Bounded, Line, Medium, PhaseFunction};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{LineIntegral, Starts};
use glam::DVec3;

/// raab-2008 algorithm 2 along the primary ray, with a walk from each collision.
///
/// **Law.** As [`crate::ParticleTracer`], for 0 ≤ σ_t ≤ majorant on the primary ray.
///
/// **Variance.** The share of the light that no flight meets is not left to chance, and first collisions are stratified as
/// far as the first step of a flight is its last: more so the more homogeneous the medium is along the ray.
#[derive(Debug)]
pub struct LineSplitting<'s, M, P, C, R> {
    /// What goes on from each collision.
    tracer: ParticleTracer<'s, M, P, C, R>,
    line: LineIntegral,
    starts: Starts,
    majorant: f64,
}

impl<'s, M, P, C, R> LineSplitting<'s, M, P, C, R> {
    /// The integrator by one set of flights through `majorant` \[1/length\] per camera ray, each continued by `walk`.
    pub fn new(
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        walk: Walk<R>,
        (line, starts, majorant): (LineIntegral, Starts, f64),
    ) -> Self {
        Self { tracer: ParticleTracer::new(volume, lights, walk), line, starts, majorant }
    }

    /// The number of walks that were cut at their greatest number of collisions so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.tracer.truncated()
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> LineSplitting<'_, M, P, C, R> {
    /// ∫ ρ L over the sphere at a point: the radiance that is scattered there towards −`incident`, per σ_s.
    fn in_scattered(&mut self, point: DVec3, incident: DVec3, source: &mut impl UniformSource) -> C {
        let mut radiance = C::ZERO;
        let event = ScatteringEvent { point, incident, energy: C::splat(1.0) };
        self.tracer.connect(&event, &mut radiance, source);
        let (u, v) = (source.next_uniform(), source.next_uniform());
        let volume = self.tracer.volume;
        let direction = volume.phase.sample(incident, u, v).direction;
        let ray = volume.inside(Line { origin: point, direction });
        self.tracer.follow(ray, &mut radiance, source);
        radiance
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> Integrator<C>
    for LineSplitting<'_, M, P, C, R>
{
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let volume = self.tracer.volume;
        let background = self.tracer.lights.background.radiance(line.direction);
        let Some(ray) = volume.enter(line, None) else { return background };
        let bounded = Bounded::new(&ray, self.majorant).expect("a majorant is checked to be a number");
        let (integral, starts, albedo) = (self.line, self.starts, volume.albedo);
        integral.integrate(&bounded, starts, source, background, |s, _sigma_t, source| {
            albedo * self.in_scattered(ray.world_point(s), line.direction, source)
        })
    }
}
