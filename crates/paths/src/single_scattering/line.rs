//! Single scattering by raab-2008 algorithm 2.

use crate::{Integrator, RayTransmittance, arriving};
use fairflight_media::{Bounded, Line, Medium, PhaseFunction};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{LineIntegral, Starts};

/// The line integral of eq. 13 with c_V = σ_t a Σ ρ E T(s → light) and c_∂V the background: flights through a majorant, each
/// collision lit by all lights.
///
/// **Law.** E\[radiance\] = that of [`super::SingleScattering`], for 0 ≤ σ_t ≤ majorant on the camera ray.
#[derive(Debug)]
pub struct LineSampled<'s, M, P, C, T> {
    volume: &'s Volume<M, P, C>,
    lights: &'s Lights<C>,
    line: LineIntegral,
    starts: Starts,
    majorant: f64,
    shadow: T,
}

impl<'s, M, P, C, T> LineSampled<'s, M, P, C, T> {
    /// The estimator by one set of flights through `majorant` \[1/length\] per camera ray; transmittance of shadow rays by `shadow`.
    pub fn new(
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        (line, starts, majorant): (LineIntegral, Starts, f64),
        shadow: T,
    ) -> Self {
        Self { volume, lights, line, starts, majorant, shadow }
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum, T: RayTransmittance<M>> Integrator<C>
    for LineSampled<'_, M, P, C, T>
{
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> C {
        let Self { volume, lights, shadow, .. } = self;
        let background = lights.background.radiance(line.direction);
        let Some(ray) = volume.enter(line, None) else { return background };
        let bounded = Bounded::new(&ray, self.majorant).expect("a majorant is checked to be a number");
        self.line.integrate(&bounded, self.starts, source, background, |s, _sigma_t, source| {
            let point = ray.world_point(s);
            let mut scattered = C::ZERO;
            for light in &lights.sources {
                let Some(connection) = light.connect(point) else { continue };
                let phase = volume.phase.eval(line.direction.dot(connection.towards));
                scattered += arriving(volume, point, &connection, shadow, source) * phase;
            }
            volume.albedo * scattered
        })
    }
}
