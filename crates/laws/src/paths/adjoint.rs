//! Importons and photons estimate one image (the adjoint identity).

use crate::{CheckResult, NotFinite, Run, batch_count, batch_moments, draw_batch, measure};
use fairflight_media::{LineThickness, PhaseFunction};
use fairflight_paths::{Attenuation, Integrator, ParticleTracer, PhotonTracer, SamplingExtinction, Walk};
use fairflight_scene::Scene;
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;

/// **Law.** For the first pixel alone, and for the sum of all, E\[importons\] = E\[photons\] + what comes unscattered.
///
/// One sample is an importon, minus a photon, minus the background through the closed form of transmittance, all independent: its mean
/// is 0, and its variance holds both standard errors. A constant is added so that power can be told as a relative bias: the mean of
/// importons in a run of its own. Half of the false alarm goes to each of the two. An asymmetric phase function, a
/// camera off the axis and uneven lights make a mistaken direction show.
///
/// # Errors
/// If an estimate is no number.
pub fn check<M, P, R>(scene: &Scene<M, P, f64>, walk: &Walk<R>, run: Run) -> Result<CheckResult, NotFinite>
where
    M: LineThickness,
    P: PhaseFunction,
    R: SamplingExtinction + Copy,
{
    let Scene { camera, volume, lights } = scene;
    let mut importons = ParticleTracer::new(volume, lights, *walk);
    let mut photons = PhotonTracer::new(camera, volume, lights, *walk);
    let mut unscattered = Attenuation::new(volume, lights, Regular);
    let [columns, rows] = camera.resolution();
    let pixels = f64::from(columns) * f64::from(rows);
    let within = |source: &mut Seeded| [source.next_uniform(), source.next_uniform()];
    let anywhere = |source: &mut Seeded| {
        let index = (source.next_uniform() * pixels) as u32;
        camera.ray([index % columns, index / columns], within(source))
    };
    let pilot = Run { samples: run.samples / 4, seed: derive_seed(run.seed, 1), ..run };
    let scale = [
        measure(pilot.seed, pilot.samples, |source| {
            let line = camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
            importons.radiance(&line, source)
        })?,
        measure(derive_seed(run.seed, 2), pilot.samples, |source| {
            let line = anywhere(source);
            pixels * importons.radiance(&line, source)
        })?,
    ]
    .map(|moments| moments.mean().unwrap_or(0.0));

    let mut first = Moments::new();
    let mut all = Moments::new();
    let (mut values, mut sums) = (Vec::new(), Vec::new());
    for batch in 0..batch_count(run.samples) {
        sums.clear();
        draw_batch(run.seed, batch, run.samples, &mut values, |source| {
            let line = camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
            let mut one = importons.radiance(&line, source) - unscattered.radiance(&line, source);
            let line = anywhere(source);
            let mut sum = pixels * (importons.radiance(&line, source) - unscattered.radiance(&line, source));
            photons.trace(source, |pixel, value| {
                sum -= value;
                if pixel == [0, 0] {
                    one -= value;
                }
            });
            sums.push(scale[1] + sum);
            scale[0] + one
        });
        first.merge(&batch_moments(run.seed, batch, &values)?);
        all.merge(&batch_moments(run.seed, batch, &sums)?);
    }
    let half = 0.5 * run.alpha;
    let results =
        [("first pixel", first, scale[0]), ("all pixels", all, scale[1])].map(|(name, moments, scale)| {
            let verdict = judge(&moments, &Reference::exact(scale), half);
            (name, CheckResult::of_verdict(&verdict, run.samples))
        });
    Ok(CheckResult::of_all(results))
}
