//! Integrands in primary sample space: integrators as functions from variates to an image.

use crate::Splats;
use fairflight_bidirectional::{Bidirectional, Subpath, WeightThickness};
use fairflight_paths::Integrator;
use fairflight_paths::transport::Types;
use fairflight_scene::{Camera, Spectrum};
use fairflight_sources::UniformSource;

/// A function from variates to contributions F to an image.
///
/// **Law.** E\[sum of the contributions to a pixel\] is the radiance of the pixel, for each pixel, from any [`UniformSource`]. The film position
/// is drawn like everything else.
///
/// Random transmittance is a function of the variates as well. It stays with the state that they make: a chain that drew it anew for the state
/// it is in would follow another target.
pub trait Integrand<C> {
    /// Draws one sample of the whole image into `splats`, which is empty.
    fn sample(&mut self, splats: &mut Splats<C>, source: &mut dyn UniformSource);
}

impl<C, F: FnMut(&mut Splats<C>, &mut dyn UniformSource)> Integrand<C> for F {
    fn sample(&mut self, splats: &mut Splats<C>, source: &mut dyn UniformSource) {
        self(splats, source);
    }
}

/// Draws a pixel, each as probable, and a point of it.
pub(crate) fn film_position(camera: &Camera, source: &mut dyn UniformSource) -> ([u32; 2], [f64; 2]) {
    let at = camera.resolution().map(|count| {
        let x = source.next_uniform() * f64::from(count);
        (x as u32, x.fract())
    });
    (at.map(|(pixel, _)| pixel), at.map(|(_, within)| within))
}

/// Number of pixels.
pub(crate) fn pixels(camera: &Camera) -> f64 {
    camera.resolution().map(f64::from).iter().product()
}

/// An integrator of rays, over the whole image: one ray per sample.
#[derive(Debug)]
pub struct FromCamera<'c, I> {
    camera: &'c Camera,
    integrator: I,
}

impl<'c, I> FromCamera<'c, I> {
    /// Rays of `camera`, followed by `integrator`.
    pub fn new(camera: &'c Camera, integrator: I) -> Self {
        Self { camera, integrator }
    }

    /// The integrator.
    pub fn integrator(&self) -> &I {
        &self.integrator
    }
}

impl<C: Spectrum, I: Integrator<C>> Integrand<C> for FromCamera<'_, I> {
    fn sample(&mut self, splats: &mut Splats<C>, mut source: &mut dyn UniformSource) {
        let (pixel, within) = film_position(self.camera, source);
        let radiance = self.integrator.radiance(&self.camera.ray(pixel, within), &mut source);
        splats.push(pixel, radiance * pixels(self.camera));
    }
}

/// Bidirectional path tracing over the whole image: one eye subpath and one light subpath per sample, the light image included.
pub struct FromBothEnds<'s, W: Types, K> {
    integrator: Bidirectional<'s, W, K>,
    light: Subpath<W::Spectrum>,
    first_order: u32,
}

impl<W: Types, K> std::fmt::Debug for FromBothEnds<'_, W, K> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { integrator, first_order, .. } = self;
        formatter
            .debug_struct("FromBothEnds")
            .field("integrator", integrator)
            .field("first_order", first_order)
            .finish_non_exhaustive()
    }
}

impl<'s, W: Types, K: WeightThickness<W::Medium>> FromBothEnds<'s, W, K> {
    /// Samples of `integrator`.
    pub fn new(integrator: Bidirectional<'s, W, K>) -> Self {
        Self { integrator, light: Subpath::empty(), first_order: 1 }
    }

    /// The same without the paths of fewer than `first_order` edges: 2 leaves out lights that are seen directly, which are cheaper drawn pixel by
    /// pixel.
    #[must_use]
    pub fn with_first_order(self, first_order: u32) -> Self {
        Self { first_order, ..self }
    }

    /// Mean light of the paths of 1, 2, … edges, by its magnitude, of so many samples: what [`Lengths`](crate::Lengths) are chosen by.
    pub fn light_by_length(&mut self, samples: u32, mut source: &mut dyn UniformSource) -> Vec<f64> {
        let Self { integrator, light, .. } = self;
        let (camera, light_paths) = (integrator.weigh().camera, integrator.weigh().light_paths);
        let mut found = Vec::new();
        let mut add = |edges: u32, value: f64| {
            let index = edges as usize - 1;
            if index >= found.len() {
                found.resize(index + 1, 0.0);
            }
            found[index] += value / f64::from(samples);
        };
        for _ in 0..samples {
            let (pixel, within) = film_position(camera, source);
            integrator.trace_light(light, &mut source);
            integrator.strategies(&camera.ray(pixel, within), light, &mut source, |_, one| {
                add(one.strategy.light + one.strategy.eye - 1, one.value.magnitude() * pixels(camera));
            });
            for index in 0..if light_paths > 0.0 { light.steps.len() } else { 0 } {
                if let Some((_, one)) = integrator.splat(light, index, &mut source) {
                    add(one.strategy.light, one.value.magnitude() * light_paths);
                }
            }
        }
        found
    }

    /// The integrator.
    pub fn integrator(&self) -> &Bidirectional<'s, W, K> {
        &self.integrator
    }
}

impl<W: Types, K: WeightThickness<W::Medium>> Integrand<W::Spectrum> for FromBothEnds<'_, W, K> {
    fn sample(&mut self, splats: &mut Splats<W::Spectrum>, mut source: &mut dyn UniformSource) {
        let Self { integrator, light, first_order } = self;
        let (camera, light_paths) = (integrator.weigh().camera, integrator.weigh().light_paths);
        let (pixel, within) = film_position(camera, source);
        integrator.trace_light(light, &mut source);
        let mut radiance = W::Spectrum::ZERO;
        integrator.strategies(&camera.ray(pixel, within), light, &mut source, |_, found| {
            if found.strategy.light + found.strategy.eye > *first_order {
                radiance += found.value;
            }
        });
        splats.push(pixel, radiance * pixels(camera));
        if light_paths > 0.0 {
            let skipped = (*first_order as usize).saturating_sub(2);
            for index in skipped..light.steps.len() {
                if let Some((pixel, found)) = integrator.splat(light, index, &mut source) {
                    // Of n_L light paths that make the image this is one.
                    splats.push(pixel, found.value * light_paths);
                }
            }
        }
    }
}
