//! Importons and photons estimate one image (the adjoint identity).

use fairflight_laws::{CheckResult, NotFinite, Run, batch_count, batch_moments, draw_batch, measure};
use fairflight_media::{LineThickness, PhaseFunction};
use fairflight_paths::{Attenuation, Integrator, ParticleTracer, PhotonTracer, SamplingExtinction, Walk};
use fairflight_scene::Scene;
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;

/// **Law.** For the sum of all pixels, and for the sum with the weights 1, 2, 3 … in the order of rows,
/// E\[importons\] − what comes unscattered = E\[photons\].
///
/// One sample is an importon in each pixel, less the background through the closed form of transmittance, and less the mean of
/// `photons_per_sample` photons, all independent: its expectation is 0, and its variance holds both standard errors. A constant is added so that power can be told
/// as a relative bias: the mean of the importons in a run of their own. Half of the false alarm goes to each of the two sums. The second
/// tells pixels apart; an asymmetric phase function, a camera off the axis and uneven lights make a mistaken direction show. (A pixel
/// alone would ask for ten times the samples: few photons are seen in it.)
///
/// # Errors
/// If an estimate is no number.
pub fn check<M: LineThickness, P: PhaseFunction, R: SamplingExtinction + Copy>(
    scene: &Scene<M, P, f64>,
    walk: &Walk<R>,
    photons_per_sample: u32,
    run: Run,
) -> Result<CheckResult, NotFinite> {
    let Scene { camera, volume, lights } = scene;
    let mut tracer = ParticleTracer::new(volume, lights, *walk);
    let mut photons = PhotonTracer::new(camera, volume, lights, *walk);
    let mut unscattered = Attenuation::new(volume, lights, Regular);
    let [columns, rows] = camera.resolution();
    let weight = |[column, row]: [u32; 2]| f64::from(row * columns + column + 1);
    // Both sums, by importons.
    let mut importons = |source: &mut Seeded| {
        let mut sums = [0.0; 2];
        for pixel in (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row])) {
            let line = camera.ray(pixel, [source.next_uniform(), source.next_uniform()]);
            let scattered = tracer.radiance(&line, source) - unscattered.radiance(&line, source);
            sums[0] += scattered;
            sums[1] += weight(pixel) * scattered;
        }
        sums
    };
    let pilot = (derive_seed(run.seed, 1), run.samples / 4);
    let scale = [0, 1].map(|i| measure(pilot.0, pilot.1, |source| importons(source)[i]));
    let [Ok(scale), Ok(weighted_scale)] = scale.map(|moments| moments.map(|m| m.mean().unwrap_or(0.0)))
    else {
        return Ok(CheckResult::exact(false, "refused: an importon is no number"));
    };

    let (mut plain, mut weighted) = (Moments::new(), Moments::new());
    let (mut values, mut others) = (Vec::new(), Vec::new());
    for batch in 0..batch_count(run.samples) {
        others.clear();
        draw_batch(run.seed, batch, run.samples, &mut values, |source| {
            let [mut sum, mut weighted_sum] = importons(source);
            for _ in 0..photons_per_sample {
                photons.trace(source, |pixel, value| {
                    sum -= value / f64::from(photons_per_sample);
                    weighted_sum -= weight(pixel) * value / f64::from(photons_per_sample);
                });
            }
            others.push(weighted_scale + weighted_sum);
            scale + sum
        });
        plain.merge(&batch_moments(run.seed, batch, &values)?);
        weighted.merge(&batch_moments(run.seed, batch, &others)?);
    }
    let half = 0.5 * run.alpha;
    let parts = [("sum", plain, scale), ("weighted sum", weighted, weighted_scale)];
    Ok(CheckResult::of_all(parts.map(|(name, moments, scale)| {
        let verdict = judge(&moments, &Reference::exact(scale).with_mild_tails(), half);
        (name, CheckResult::of_verdict(&verdict, run.samples))
    })))
}
