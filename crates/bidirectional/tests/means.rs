//! All integrators have one expectation: bidirectional path tracing, that of path tracing.

mod common;

use common::{Scene, bulb, forward, glass, mixed, sky};
use fairflight_bidirectional::{Bidirectional, Exact, Midpoint, Subpath, Walking, WeightThickness};
use fairflight_media::{AnalyticCosine, Medium, Ray};
use fairflight_paths::{Heuristic, Integrator, PathTracer, Ratio, RayTransmittance, Uniform};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};
use fairflight_transmittance::Regular;
use std::cell::{Cell, RefCell};
use std::num::NonZeroU32;
use std::rc::Rc;

/// False alarm of one check, 1e-3 for the ten of this file together.
const ALPHA: f64 = 1e-4;

/// Path tracer samples for one of bidirectional path tracing: they are cheaper, and have more variance.
const TRACED: u32 = 4;

/// Estimator of the radiance of a scene.
#[derive(Clone)]
struct How<K, T> {
    heuristic: Heuristic,
    thickness: K,
    shadow: T,
    roulette: Option<f64>,
    /// Per sample of the pixel.
    light_paths: u32,
    /// By what the light image is multiplied: 1, but for a mistake.
    splats: f64,
}

fn usual() -> How<Exact, Regular> {
    let heuristic = Heuristic::Balance;
    How { heuristic, thickness: Exact, shadow: Regular, roulette: None, light_paths: 1, splats: 1.0 }
}

/// Bidirectional path tracing less path tracing, of which the means agree, with the mean of the latter added.
///
/// One sample holds a sample of either, independent of each other, so that its variance is that of both.
fn verdict<M: Medium, T: RayTransmittance<M> + Clone, K: WeightThickness<M> + Clone>(
    scene: &Scene<M>,
    how: &How<K, T>,
    (samples, seed): (u64, u64),
) -> Verdict {
    let emitters = scene.emitters::<T>();
    let mut weigh = scene.weigh(&emitters, how.heuristic, how.thickness.clone());
    weigh.light_paths *= f64::from(how.light_paths);
    let mut both = Bidirectional::new(weigh, Walking::new(scene.walk), how.shadow.clone())
        .with_connection_roulette(how.roulette);
    let mut tracer = PathTracer::new(scene.world(), scene.walk, how.shadow.clone(), Heuristic::Balance);
    let ray = |source: &mut Seeded| {
        let within = [source.next_uniform(), source.next_uniform()];
        scene.camera.ray([0, 0], within)
    };
    let [mut source, mut other, mut pilot] = [1, 2, 3].map(|stream| Seeded::new(derive_seed(seed, stream)));
    let mut traced = |source: &mut Seeded| tracer.radiance(&ray(source), source);
    // A constant by which the power is told as a relative bias.
    let scale = (0..samples).map(|_| traced(&mut pilot)).sum::<f64>() / samples as f64;
    let mut light = Subpath::empty();
    let moments: Moments = (0..samples)
        .map(|_| {
            let mut sum = scale;
            for path in 0..how.light_paths {
                both.trace_light(&mut light, &mut source);
                if scene.light_paths_per_pixel > 0.0 {
                    both.light_image(&light, &mut source, |_, value| sum += how.splats * value);
                }
                if path == 0 {
                    sum += both.radiance(&ray(&mut source), &light, &mut source);
                }
            }
            let of_paths: f64 = (0..TRACED).map(|_| traced(&mut other)).sum();
            sum - of_paths / f64::from(TRACED)
        })
        .collect();
    assert_eq!(both.truncated(), 0);
    judge(&moments, &Reference::exact(scale).with_mild_tails(), ALPHA)
}

fn agrees<M: Medium, T: RayTransmittance<M> + Clone, K: WeightThickness<M> + Clone>(
    (name, scene): (&str, &Scene<M>),
    how: &How<K, T>,
    samples: u64,
) {
    let verdict = verdict(scene, how, (samples, 1));
    assert_eq!(verdict.sound, Some(true), "{name}: {}", verdict.reason);
}

#[test]
fn a_mirror_and_lamps_that_reflect() {
    agrees(("mixed", &mixed()), &usual(), 100_000);
}

#[test]
fn a_point_light_beside_glass() {
    agrees(("glass", &glass()), &usual(), 80_000);
}

#[test]
fn light_from_infinitely_far() {
    agrees(("sky", &sky()), &usual(), 60_000);
}

#[test]
fn forward_scattering() {
    agrees(("forward", &forward()), &usual(), 80_000);
}

#[test]
fn a_lamp_in_glass() {
    agrees(("bulb", &bulb()), &usual(), 120_000);
}

#[test]
fn without_a_light_image() {
    agrees(("mixed", &Scene { light_paths_per_pixel: 0.0, ..mixed() }), &usual(), 100_000);
}

#[test]
fn every_heuristic() {
    for heuristic in [Heuristic::Power, Heuristic::Maximum] {
        agrees(("sky", &sky()), &How { heuristic, ..usual() }, 30_000);
    }
}

#[test]
fn random_transmittance_in_contributions_and_a_crude_one_in_weights() {
    let thickness = Midpoint(NonZeroU32::new(2).unwrap());
    let How { heuristic, roulette, light_paths, splats, .. } = usual();
    let how = How { heuristic, thickness, shadow: ratio(0.6), roulette, light_paths, splats };
    agrees(("glass", &glass()), &how, 80_000);
}

#[test]
fn connections_by_roulette() {
    agrees(("sky", &sky()), &How { roulette: Some(0.05), ..usual() }, 30_000);
}

#[test]
fn several_light_paths_for_a_pixel() {
    let how = How { light_paths: 4, ..usual() };
    agrees(("sky", &sky()), &how, 30_000);
    // bdpt_pixel_count: a light image that is not divided by its number of light paths.
    let twin = verdict(&sky(), &How { splats: 4.0, ..how }, (60_000, 1));
    assert_eq!(twin.sound, Some(false), "{}", twin.reason);
}

/// Ratio tracking.
fn ratio(sigma_samp: f64) -> Ratio<Uniform> {
    Ratio(Uniform::new(sigma_samp).unwrap())
}

/// The last transmittance that a connection drew.
type Last = Rc<Cell<Option<f64>>>;

#[derive(Clone)]
struct Remembered(Ratio<Uniform>, Last);

impl<M: Medium> RayTransmittance<M> for Remembered {
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64 {
        let drawn = self.0.estimate(ray, source);
        self.1.set(Some(drawn));
        drawn
    }
}

/// Weights by the transmittance that the contribution has drawn, others drawn anew.
#[derive(Clone)]
struct Random(Last, RefCell<Seeded>);

impl<M: Medium> WeightThickness<M> for Random {
    fn thickness(&self, ray: &Ray<&M>) -> f64 {
        let drawn = self.0.take().unwrap_or_else(|| ratio(THICK).estimate(ray, &mut *self.1.borrow_mut()));
        -drawn.max(1e-12).ln()
    }
}

/// The greatest extinction of a medium that takes much.
const THICK: f64 = 3.0;

#[test]
fn a_random_transmittance_in_weights_is_a_bias() {
    // bdpt_random_tau: raab-2008 section 4.3 warns of it.
    let mut scene = glass();
    scene.volume.medium = AnalyticCosine::new(THICK).unwrap();
    scene.walk = fairflight_paths::Walk::new(scene.walk.version(), Uniform::new(THICK).unwrap());
    let last = Last::default();
    let random = Random(last.clone(), RefCell::new(Seeded::new(7)));
    let shadow = Remembered(ratio(THICK), last);
    let How { heuristic, roulette, light_paths, splats, .. } = usual();
    let how = How { heuristic, thickness: random.clone(), shadow, roulette, light_paths, splats };
    let twin = verdict(&scene, &how, (60_000, 1));
    assert_eq!(twin.sound, Some(false), "{}", twin.reason);
    // The weights of one path do not sum to one.
    let found = common::defects(&scene, (heuristic, random), 200, |_, _, _| {});
    assert!(found.mean() > 0.1, "{found:?}");
}
