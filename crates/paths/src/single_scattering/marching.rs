//! Ray marching for single scattering (perlin-1989): **biased**, and labelled so.

use crate::{Integrator, arriving};
use fairflight_media::{Extinction, Line, Medium, PhaseFunction};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Offset, RayMarching};

/// A Riemann sum over equal steps of the camera ray, with Riemann sums for transmittance on it and on shadow rays:
/// the baseline that szirmay-kalos-2017 fig. 12 compares with.
///
/// **Law.** None: its expectation is that of [`super::SingleScattering`] only in the limit of many steps.
#[derive(Debug)]
pub struct Marching<'s, M, P, C> {
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    steps: u32,
    offset: Offset,
    shadow: RayMarching,
}

impl<'s, M, P, C> Marching<'s, M, P, C> {
    /// `steps` ≥ 1 equal steps with a look-up at this `offset` in each; shadow rays march by `shadow`.
    pub fn new(
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        (steps, offset): (u32, Offset),
        shadow: RayMarching,
    ) -> Self {
        Self { volume, lights, steps: steps.max(1), offset, shadow }
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum> Integrator<C> for Marching<'_, M, P, C> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let Self { volume, lights, steps, offset, shadow } = self;
        let background = lights.background.radiance(line.direction);
        let Some(ray) = volume.enter(line, None) else { return background };
        let offset = match offset {
            Offset::Fixed => 0.5,
            Offset::Jittered => source.next_uniform(),
        };
        let step = ray.length() / f64::from(*steps);
        let mut radiance = C::ZERO;
        let mut transmittance = 1.0;
        for k in 0..*steps {
            let s = (f64::from(k) + offset) * step;
            let sigma_t = ray.sigma_t(s);
            let inside = (-sigma_t * step).exp();
            let point = ray.world_point(s);
            for light in &lights.sources {
                let Some(connection) = light.connect(point) else { continue };
                let phase = volume.phase.eval(ray.world_line().direction.dot(connection.towards));
                let arriving = arriving(volume, point, &connection, shadow, source);
                // The step's own extinction falls off exponentially within the step.
                radiance += volume.albedo * arriving * (transmittance * phase * (1.0 - inside));
            }
            transmittance *= inside;
        }
        radiance + background * transmittance
    }
}
