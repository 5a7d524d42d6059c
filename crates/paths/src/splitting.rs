//! Splitting along the primary ray: several first collisions for one camera ray (raab-2008 section 3.1).

use crate::{End, Integrator, Ratio, SamplingExtinction, ScatteringEvent, Walk, arriving};
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
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    walk: Walk<R>,
    line: LineIntegral,
    starts: Starts,
    majorant: f64,
    truncated: u64,
}

impl<'s, M, P, C, R> LineSplitting<'s, M, P, C, R> {
    /// The integrator by one set of flights through `majorant` \[1/length\] per camera ray, each continued by `walk`.
    pub fn new(
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        walk: Walk<R>,
        (line, starts, majorant): (LineIntegral, Starts, f64),
    ) -> Self {
        Self { volume, lights, walk, line, starts, majorant, truncated: 0 }
    }

    /// The number of walks that were cut at their greatest number of collisions so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> LineSplitting<'_, M, P, C, R> {
    /// ∫ ρ L over the sphere at a point: the radiance that is scattered there towards −`incident`, per σ_s.
    fn in_scattered<S: UniformSource>(&mut self, point: DVec3, incident: DVec3, source: &mut S) -> C {
        let Self { volume, lights, walk, truncated, .. } = self;
        let mut radiance = C::ZERO;
        let mut connect = |event: ScatteringEvent<C>, source: &mut S| {
            for light in &lights.sources {
                let Some(connection) = light.connect(event.point) else { continue };
                let shadow = &mut Ratio(walk.sampling());
                let arriving = arriving(volume, event.point, &connection, shadow, source);
                let phase = volume.phase.eval(event.incident.dot(connection.towards));
                radiance += event.energy * arriving * phase;
            }
        };
        connect(ScatteringEvent { point, incident, energy: C::splat(1.0) }, source);
        let (u, v) = (source.next_uniform(), source.next_uniform());
        let direction = volume.phase.sample(incident, u, v).direction;
        let ray = volume.inside(Line { origin: point, direction });
        match walk.simulate(volume, ray, source, connect) {
            End::Escaped { direction, energy } => radiance += energy * lights.background.radiance(direction),
            End::Absorbed => {}
            End::Truncated => *truncated += 1,
        }
        radiance
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> Integrator<C>
    for LineSplitting<'_, M, P, C, R>
{
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let background = self.lights.background.radiance(line.direction);
        let Some(ray) = self.volume.enter(line, None) else { return background };
        let bounded = Bounded::new(&ray, self.majorant).expect("a majorant is checked to be a number");
        let (integral, starts, albedo) = (self.line, self.starts, self.volume.albedo);
        integral.integrate(&bounded, starts, source, background, |s, _sigma_t, source| {
            albedo * self.in_scattered(ray.world_point(s), line.direction, source)
        })
    }
}
