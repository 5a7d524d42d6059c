//! Ray marching for single scattering (perlin-1989): **biased**, and labelled so.

use crate::{Integrator, arriving};
use fairflight_elementary::exp;
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
            let inside = exp(-sigma_t * step);
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

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::Isotropic;
    use fairflight_media::{Bounds, Homogeneous};
    use fairflight_scene::{Background, Source};
    use fairflight_sources::Scripted;
    use glam::DVec3;
    use std::f64::consts::PI;

    /// A camera ray through the middle of a homogeneous ball, towards a distant light, and n steps of the length h: with S the way
    /// through, each step adds a ρ E (1 − e^{−σh}) e^{−σkh} e^{−σ(S − (k + o) h)}, hence all the same.
    #[test]
    fn a_homogeneous_ball_by_hand() {
        let (sigma_t, albedo, irradiance, background) = (0.4_f64, 0.6, 5.0, 0.3);
        let volume = Volume {
            medium: Homogeneous::new(sigma_t).unwrap(),
            bounds: Bounds::sphere(DVec3::ZERO, 1.5).unwrap(),
            albedo,
            phase: Isotropic,
        };
        let light = Source::directional(-DVec3::Z, irradiance).unwrap();
        let lights =
            Lights { background: Background { constant: background, maps: vec![] }, sources: vec![light] };
        let line = Line { origin: -4.0 * DVec3::Z, direction: DVec3::Z };
        for (steps, offset, u) in
            [(1, Offset::Fixed, 0.5), (4, Offset::Fixed, 0.5), (3, Offset::Jittered, 0.25)]
        {
            let shadow = RayMarching::new(7, Offset::Fixed).unwrap();
            let mut marching = Marching::new(&volume, &lights, (steps, offset), shadow);
            let variates: &[f64] = if offset == Offset::Jittered { &[0.25] } else { &[] };
            let mut source = Scripted::new(variates.iter().copied());
            let found: f64 = marching.radiance(&line, &mut source);
            assert_eq!(source.remaining(), 0);
            let (length, n) = (3.0, f64::from(steps));
            let h = length / n;
            let step = albedo * irradiance / (4.0 * PI) * -(-sigma_t * h).exp_m1();
            let exact =
                n * step * (-sigma_t * (length - u * h)).exp() + background * (-sigma_t * length).exp();
            assert!((found - exact).abs() < 1e-14, "{steps} {offset:?}: {found} for {exact}");
        }
    }
}
