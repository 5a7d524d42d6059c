//! Connections of scattering events with a light side by side: the twin of `ParticleTracer::connect`.

use super::Particle;
use super::flights::{Flights, Group};
use crate::{ParticleTracer, SamplingExtinction};
use fairflight_elementary::lanes::LANES;
use fairflight_media::{Medium, PhaseFunction};
use fairflight_scene::{Connection, Source, Spectrum};
use fairflight_transmittance::lockstep::Products;

impl<M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> ParticleTracer<'_, M, P, C, R> {
    /// Adds the light of one source that is scattered at the events of these lanes. Where a shadow ray ends, the next one takes its place.
    #[inline(always)]
    pub(super) fn connect_lanes(
        &self,
        light: &Source<C>,
        lanes: &[usize],
        (particles, flights): (&mut [Particle<C>], &mut Flights),
    ) {
        let mut waiting = lanes.iter();
        let (mut shadows, mut transmittance) = (Group::IDLE, Products::ONE);
        let mut connections: [Option<(usize, Connection<C>)>; LANES] = [None; LANES];
        loop {
            let mut some_fly = false;
            for (i, place) in connections.iter_mut().enumerate() {
                while place.is_none()
                    && let Some(&lane) = waiting.next()
                {
                    let (_, point, _) = flights.vertex(lane);
                    if let Some(connection) = light.connect(point) {
                        let ray = self.volume.towards(point, &connection);
                        shadows.start(i, &ray, &flights.stream(lane));
                        *place = Some((lane, connection));
                    }
                }
                some_fly |= place.is_some();
            }
            if !some_fly {
                return;
            }
            let mut all_collide = true;
            let mut collides = [true; LANES];
            while all_collide {
                collides = shadows.attenuate(&self.volume.medium, self.walk.sampling(), &mut transmittance);
                all_collide = collides.iter().fold(true, |all, collides| all & collides);
            }
            for (i, place) in connections.iter_mut().enumerate().filter(|(i, _)| !collides[*i]) {
                let Some((lane, connection)) = place.take() else { continue };
                flights.set_stream(lane, &shadows.end(i));
                let (line, _, weight) = flights.vertex(lane);
                let particle = &mut particles[lane];
                let arriving = connection.irradiance * transmittance.take(i).value();
                let phase = self.volume.phase.eval(line.direction.dot(connection.towards));
                particle.radiance += particle.colour * weight * arriving * phase;
            }
        }
    }
}
