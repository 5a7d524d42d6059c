//! Particle tracing from the lights: photons (szirmay-kalos-2017 section 4.1).

use crate::{End, Ratio, RayTransmittance, SamplingExtinction, ScatteringEvent, Walk};
use fairflight_media::Line;
use fairflight_media::{Medium, PhaseFunction};
use fairflight_scene::{Camera, Connection, Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;

/// Multiple scattering by photons: each scattering event is connected with the camera.
///
/// A photon of power Φ/n scatters the energy E at a point; towards the camera that is E ρ(cos) per solid angle, which the
/// pixel it appears in sees as E ρ · T · [`importance`](fairflight_scene::Projection::importance).
///
/// **Law.** The expected sum of all contributions to a pixel, per photon, is its radiance without the light that reaches the camera
/// unscattered ([`crate::Attenuation`] adds that of the background). It is the adjoint of [`crate::ParticleTracer`]: the same
/// expectation, another variance.
///
/// **Variance.** As the importons' subcriticality; where the camera stands in the medium, 1/distance² of a connection has
/// no second moment.
#[derive(Debug)]
pub struct PhotonTracer<'s, M, P, C, R> {
    camera: &'s Camera,
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    walk: Walk<R>,
    truncated: u64,
}

impl<'s, M: Medium, P: PhaseFunction, C: Spectrum, R: SamplingExtinction> PhotonTracer<'s, M, P, C, R> {
    /// Traces photons of `lights` through `volume` towards `camera`.
    pub fn new(
        camera: &'s Camera,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        walk: Walk<R>,
    ) -> Self {
        Self { camera, volume, lights, walk, truncated: 0 }
    }

    /// The number of walks that were cut at their greatest number of collisions so far: each is a bias.
    pub fn truncated(&self) -> u64 {
        self.truncated
    }

    /// Emits one photon and follows it. `splat` sees each contribution with its pixel (column, row).
    pub fn trace(&mut self, source: &mut impl UniformSource, mut splat: impl FnMut([u32; 2], C)) {
        let Self { camera, volume, lights, walk, truncated } = self;
        let emitters = lights.emitters();
        if emitters == 0 {
            return;
        }
        let index = ((source.next_uniform() * emitters as f64) as usize).min(emitters - 1);
        let u = std::array::from_fn(|_| source.next_uniform());
        let Some(photon) = lights.emit(index, volume.bounds.enclosing_ball(), u) else { return };
        let line = Line { origin: photon.origin, direction: photon.direction };
        let Some(ray) = volume.enter(&line, None) else { return };
        let power = photon.power * emitters as f64;
        let shadow = walk.sampling();
        let end = walk.simulate(volume, ray, source, |event: ScatteringEvent<C>, source| {
            let Some(seen) = camera.project(event.point) else { return };
            let connection =
                Connection { towards: seen.towards_camera, distance: Some(seen.distance), irradiance: power };
            let transmittance = Ratio(shadow).estimate(&volume.towards(event.point, &connection), source);
            let phase = volume.phase.eval(event.incident.dot(seen.towards_camera));
            splat(seen.pixel, power * event.energy * (phase * transmittance * seen.importance));
        });
        if end == End::Truncated {
            *truncated += 1;
        }
    }
}
