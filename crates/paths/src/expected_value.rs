//! Multiple scattering where transmittance has a closed form: no random decision that can be replaced by its expectation.

use crate::{Integrator, arriving};
use fairflight_freeflight::Newton;
use fairflight_media::{Extinction, Line, LineThickness, OpticalThickness, PhaseFunction};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::Regular;

/// At each vertex the background is weighed by the transmittance to it, and the next collision is forced to happen:
///
/// > L(x, ω) = T L_background(ω) + (1 − T) a E\[L(x′, ω′)\]
///
/// with x′ at the depth −ln(1 − u (1 − T)) along ω (raab-2008 eq. 12, conditioned as in algorithm 2) and ω′ from the phase
/// function. It is the double particle model (szirmay-kalos-2017 eq. 8) of a whole ray: both particles are kept, the
/// transmitted one in closed form.
///
/// **Law.** As [`crate::ParticleTracer`], for extinctions nowhere negative.
///
/// **Variance.** What is left is that of the places and directions of collisions, and of roulette, which continues a path of
/// throughput t with probability min(1, t/0.3) so that long paths stay rare. With point lights in the medium it has no second
/// moment, as the particle tracer.
///
/// **Cost.** One closed form per segment and four to eight, with a look-up each, per forced collision.
#[derive(Debug)]
pub struct ExpectedValue<'s, M, P, C> {
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
}

/// The throughput below which roulette is played. It changes variance and cost, not the expectation.
const ROULETTE_BELOW: f64 = 0.3;

impl<'s, M, P, C> ExpectedValue<'s, M, P, C> {
    /// Traces paths through `volume`, lit by `lights`.
    pub fn new(volume: &'s Volume<M, P, C>, lights: &'s Lights<C>) -> Self {
        Self { volume, lights }
    }
}

impl<M, P, C> Integrator<C> for ExpectedValue<'_, M, P, C>
where
    M: LineThickness,
    P: PhaseFunction,
    C: Spectrum,
{
    fn radiance<S: UniformSource + ?Sized>(&mut self, line: &Line, source: &mut S) -> C {
        let Self { volume, lights } = self;
        let Some(mut ray) = volume.enter(line, None) else {
            return lights.background.radiance(line.direction);
        };
        let mut radiance = C::ZERO;
        let mut throughput = C::splat(1.0);
        loop {
            let direction = ray.world_line().direction;
            let total = ray.optical_thickness(0.0, ray.length());
            radiance += throughput * lights.background.radiance(direction) * (-total).exp();
            // 1 − T without cancellation in a thin medium.
            let collides = -(-total).exp_m1();
            throughput = throughput * volume.albedo * collides;

            let survives = (throughput.max_channel() / ROULETTE_BELOW).min(1.0);
            if source.next_uniform() >= survives {
                return radiance;
            }
            throughput = throughput * (1.0 / survives);

            let depth = -(-source.next_uniform() * collides).ln_1p();
            let point = ray.world_point(Newton.invert(&ray, depth, total));
            for light in &lights.sources {
                let Some(connection) = light.connect(point) else { continue };
                let arriving = arriving(volume, point, &connection, &mut Regular, source);
                radiance += throughput * arriving * volume.phase.eval(direction.dot(connection.towards));
            }
            let (u, v) = (source.next_uniform(), source.next_uniform());
            let direction = volume.phase.sample(direction, u, v).direction;
            ray = volume.inside(Line { origin: point, direction });
        }
    }
}
