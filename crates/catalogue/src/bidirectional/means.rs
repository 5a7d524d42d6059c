//! The whole, and paths of each length, against other integrators and a furnace.

use super::scenes::{View, Viewed};
use fairflight_bidirectional::{Bidirectional, Found, Subpath, Walking, WeightThickness};
use fairflight_laws::{CheckResult, NotFinite, Run, measure};
use fairflight_media::Medium;
use fairflight_paths::{Heuristic, Integrator, PathTracer, PhotonTracer, RayTransmittance};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Reference, Verdict, judge};
use glam::DVec3;

/// Parameters of the integrator, all of which leave its expectation as it is.
#[derive(Clone, Debug)]
pub struct Options<K, T> {
    /// Rule by which weights follow from densities.
    pub heuristic: Heuristic,
    /// Optical thickness in weights.
    pub thickness: K,
    /// Transmittance of connections.
    pub shadow: T,
    /// Radiance below which connections are made by chance.
    pub roulette: Option<f64>,
    /// Light paths for each sample; 0 for one that lights no image.
    pub light_paths: u32,
}

impl<M: Medium> View<M> {
    fn bidirectional<'s, K: WeightThickness<M> + Clone, T: RayTransmittance<M> + Clone>(
        &'s self,
        emitters: &'s fairflight_paths::transport::Emitters<f64>,
        options: &Options<K, T>,
    ) -> Bidirectional<'s, Viewed<M, T>, K> {
        let mut weigh = self.weigh(emitters, options.heuristic, options.thickness.clone());
        weigh.light_paths *= f64::from(options.light_paths);
        Bidirectional::new(weigh, Walking::new(self.walk), options.shadow.clone())
            .with_connection_roulette(options.roulette)
    }

    /// The sum of `of` over all that one sample of the only pixel finds.
    fn sum<K: WeightThickness<M>, T: RayTransmittance<M>>(
        &self,
        (integrator, light): (&mut Bidirectional<'_, Viewed<M, T>, K>, &mut Subpath<f64>),
        light_paths: u32,
        source: &mut Seeded,
        of: &dyn Fn(&Found<f64>) -> f64,
    ) -> f64 {
        let mut sum = 0.0;
        for path in 0..light_paths.max(1) {
            integrator.trace_light(light, source);
            if path == 0 {
                let line = self.camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
                integrator.strategies(&line, light, source, |_, found| sum += of(&found));
            }
            if light_paths > 0 {
                for index in 0..light.steps.len() {
                    sum += integrator.splat(light, index, source).map_or(0.0, |(_, found)| of(&found));
                }
            }
        }
        sum
    }
}

/// **Law.** Bidirectional path tracing less path tracing is 0 on average.
///
/// One sample holds samples of either, independent of each other, so that its variance is that of both; a constant is added so that power
/// can be told as a relative bias.
///
/// # Errors
/// If an estimate is no number.
pub fn against_paths<M: Medium, K: WeightThickness<M> + Clone, T: RayTransmittance<M> + Clone>(
    view: &View<M>,
    options: &Options<K, T>,
    run: Run,
) -> Result<Verdict, NotFinite> {
    up_to(view, options, u32::MAX, run)
}

/// **Law.** The same of paths with at most so many vertices between camera and light, where no light has an extent: those of a path tracer
/// of as many.
///
/// # Errors
/// If an estimate is no number.
pub fn up_to<M: Medium, K: WeightThickness<M> + Clone, T: RayTransmittance<M> + Clone>(
    view: &View<M>,
    options: &Options<K, T>,
    vertices: u32,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let emitters = view.emitters::<T>();
    let mut both = view.bidirectional(&emitters, options);
    let mut light = Subpath::empty();
    let tracer = PathTracer::new(view.world(), view.walk, options.shadow.clone(), Heuristic::Balance);
    let mut tracer = tracer.with_max_vertices(vertices);
    let mut traced = |source: &mut Seeded| -> f64 {
        let line = view.camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
        tracer.radiance(&line, source)
    };
    let scale = measure(derive_seed(run.seed, 1), run.samples, &mut traced)?.mean().unwrap_or(0.0);
    // s + t − 2 vertices between the ends.
    let of = |found: &Found<f64>| {
        let between = found.strategy.light + found.strategy.eye - 2;
        if between <= vertices { found.value } else { 0.0 }
    };
    let measured = measure(run.seed, run.samples, |source| {
        let found = view.sum((&mut both, &mut light), options.light_paths, source, &of);
        scale + found - traced(source)
    })?;
    Ok(judge(&measured, &Reference::exact(scale).with_mild_tails(), run.alpha))
}

/// **Law.** The radiance of a furnace is known without error.
///
/// # Errors
/// If an estimate is no number.
pub fn furnace<M: Medium, K: WeightThickness<M> + Clone, T: RayTransmittance<M> + Clone>(
    view: &View<M>,
    options: &Options<K, T>,
    radiance: f64,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let emitters = view.emitters::<T>();
    let mut integrator = view.bidirectional(&emitters, options);
    let mut light = Subpath::empty();
    let measured = measure(run.seed, run.samples, |source| {
        let parts = (&mut integrator, &mut light);
        view.sum(parts, options.light_paths, source, &|found| found.value)
    })?;
    Ok(judge(&measured, &Reference::exact(radiance).with_mild_tails(), run.alpha))
}

/// **Law.** Light paths connected with the camera, unweighted, and photons (szirmay-kalos-2017 section 4.1) light one image: in a scene
/// without surfaces, for the sum of all pixels and the sum with the weights 1, 2, 3 … in the order of rows.
///
/// # Errors
/// If an estimate is no number.
pub fn light_image<M: fairflight_media::LineThickness>(
    view: &View<M>,
    run: Run,
) -> Result<CheckResult, NotFinite> {
    let options = Options {
        heuristic: Heuristic::Balance,
        thickness: fairflight_bidirectional::Neglected,
        shadow: fairflight_transmittance::Regular,
        roulette: None,
        light_paths: 1,
    };
    let emitters = view.emitters::<fairflight_transmittance::Regular>();
    let mut integrator = view.bidirectional(&emitters, &options);
    let mut photons = PhotonTracer::new(&view.camera, &view.volume, &view.lights, view.walk);
    let mut light = Subpath::empty();
    let pixels = view.pixels();
    let columns = view.camera.resolution()[0];
    let parts = ["sum", "weighted sum"].into_iter().enumerate().map(|(part, name)| {
        let weight = |[column, row]: [u32; 2]| [1.0, f64::from(row * columns + column + 1)][part];
        let mut traced = |source: &mut Seeded| {
            let mut sum = 0.0;
            photons.trace(source, |pixel, value| sum += weight(pixel) * value / pixels);
            sum
        };
        let scale = measure(derive_seed(run.seed, 1), run.samples, &mut traced)?.mean().unwrap_or(0.0);
        let measured = measure(run.seed, run.samples, |source| {
            integrator.trace_light(&mut light, source);
            let mut sum = scale;
            for index in 0..light.steps.len() {
                if let Some((pixel, found)) = integrator.splat(&light, index, source) {
                    sum += weight(pixel) * found.value / found.weight;
                }
            }
            sum - traced(source)
        })?;
        let reference = Reference::exact(scale).with_mild_tails();
        let verdict = judge(&measured, &reference, 0.5 * run.alpha);
        Ok((name, CheckResult::of_verdict(&verdict, run.samples)))
    });
    Ok(CheckResult::of_all(parts.collect::<Result<Vec<_>, NotFinite>>()?))
}

/// The direction of the camera's axis.
#[must_use]
pub fn axis<M>(view: &View<M>) -> DVec3 {
    view.camera.ray([0, 0], [0.5, 0.5]).direction
}
