//! Metropolis sampling over integrators: the image of a path tracer.

#[path = "../../bidirectional/tests/common/mod.rs"]
mod common;

use common::{Made, Scene, bulb, glass, mixed, sky};
use fairflight_bidirectional::{Bidirectional, Exact, Midpoint, Walking, WeightThickness};
use fairflight_media::{LineThickness, Medium};
use fairflight_metropolis::{
    Acceptance, Bootstrap, Chain, FromBothEnds, FromCamera, Integrand, Lengths, Multiplexed, Plan, Primary,
    Splats,
};
use fairflight_paths::{Heuristic, PathTracer, Ratio, RayTransmittance, Uniform};
use fairflight_sources::{Layout, Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;
use std::num::NonZeroU32;

/// Seed of all laws.
const SEED: u64 = 1;

/// The brightness of an image of 2 · 2 pixels, and that of its left half.
fn seen([column, _]: [u32; 2], value: f64) -> [f64; 2] {
    [value, if column == 0 { value } else { 0.0 }]
}

fn tracer<M: Medium, T: RayTransmittance<M>>(scene: &Scene<M>, shadow: T) -> PathTracer<'_, Made<M, T>> {
    PathTracer::new(scene.world(), scene.walk, shadow, Heuristic::Balance)
}

/// Replicas less path tracing, of which the means agree, with the mean of the latter added, and that mean, for both quantities of [`seen`]. A sample
/// holds a replica, and half as many paths as that has evaluations.
fn differences<M: Medium, T: RayTransmittance<M>>(
    name: &str,
    (scene, shadow): (&Scene<M>, T),
    (plan, replicas): (Plan, u64),
    target: &mut Primary<'_, f64>,
) -> [(Moments, f64); 2] {
    let mut paths = FromCamera::new(&scene.camera, tracer(scene, shadow));
    let mut splats = Splats::default();
    let mut traced = |source: &mut Seeded, samples: u64| {
        let mut sums = [0.0; 2];
        for _ in 0..samples {
            splats.clear();
            paths.sample(&mut splats, source);
            for &(pixel, value) in splats.list() {
                sums = std::array::from_fn(|i| sums[i] + seen(pixel, value)[i] / samples as f64);
            }
        }
        sums
    };
    let evaluations = plan.evaluations() / 2;
    let scale = traced(&mut Seeded::new(derive_seed(SEED, 1)), evaluations * replicas / 4);
    let mut other = Seeded::new(derive_seed(SEED, 2));
    let mut moments = [Moments::new(); 2];
    let mut kinds = [Acceptance::default(); 2];
    for index in 0..replicas {
        let mut sums = scale;
        let replica = plan.replica(target, (index, derive_seed(SEED, 3)), &mut |pixel, value| {
            sums = std::array::from_fn(|i| sums[i] + seen(pixel, value)[i]);
        });
        for (all, one) in kinds.iter_mut().zip(replica.unwrap().acceptance) {
            all.merge(&one);
        }
        let other = traced(&mut other, evaluations);
        for (i, moments) in moments.iter_mut().enumerate() {
            moments.push(sums[i] - other[i]);
        }
    }
    println!("{name}: acceptance {:?}", kinds.map(|kind| kind.mean()));
    std::array::from_fn(|i| (moments[i], scale[i]))
}

fn agrees<M: Medium, T: RayTransmittance<M>>(
    name: &str,
    scene: (&Scene<M>, T),
    replicas: u64,
    target: &mut Primary<'_, f64>,
) {
    for (moments, scale) in differences(name, scene, (short(), replicas), target) {
        let verdict = judge(&moments, &Reference::exact(scale).with_mild_tails(), 1e-4);
        println!("  z {:+.1}, {:?}", verdict.mean_z.unwrap_or(0.0), verdict.detectable_relative_bias);
        assert_eq!(verdict.sound, Some(true), "{name}: {}", verdict.reason);
    }
}

fn short() -> Plan {
    Plan::new(60, 2, 40).unwrap()
}

/// Replicas over bidirectional path tracing.
fn over_both_ends<M: Medium, T: RayTransmittance<M> + Clone, K: WeightThickness<M>>(
    name: &str,
    (scene, shadow, thickness): (&Scene<M>, T, K),
    replicas: u64,
) {
    let emitters = scene.emitters::<T>();
    let weigh = scene.weigh(&emitters, Heuristic::Balance, thickness);
    let integrator = Bidirectional::new(weigh, Walking::new(scene.walk), shadow.clone());
    let mut integrand = FromBothEnds::new(integrator);
    agrees(name, (scene, shadow), replicas, &mut Primary::new(&mut integrand));
    assert_eq!(integrand.integrator().truncated(), 0);
}

#[test]
fn over_bidirectional_paths_among_mirrors() {
    over_both_ends("mixed", (&mixed().in_pixels([2, 2]), Regular, Exact), 2000);
}

#[test]
fn over_bidirectional_paths_to_a_lamp_in_glass() {
    over_both_ends("bulb", (&bulb().in_pixels([2, 2]), Regular, Exact), 2000);
}

#[test]
fn over_bidirectional_paths_with_random_transmittance() {
    // Ratio tracking below the extinction: contributions of either sign.
    let ratio = Ratio(Uniform::new(0.6).unwrap());
    let nodes = Midpoint(NonZeroU32::new(2).unwrap());
    over_both_ends("glass", (&glass().in_pixels([2, 2]), ratio, nodes), 2000);
}

#[test]
fn over_paths_by_rows_and_flat() {
    let scene = mixed().in_pixels([2, 2]);
    for layout in [Layout::Rows, Layout::Flat] {
        let mut integrand = FromCamera::new(&scene.camera, tracer(&scene, Regular));
        let mut target = Primary::new(&mut integrand).with_layout(layout);
        agrees("paths", (&scene, Regular), 3000, &mut target);
    }
}

/// Replicas by one strategy per sample.
fn multiplexed<M: LineThickness>(name: &str, scene: &Scene<M>) {
    let emitters = scene.emitters::<Regular>();
    let integrator = || {
        let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
        Bidirectional::new(weigh, Walking::new(scene.walk), Regular)
    };
    let light = FromBothEnds::new(integrator()).light_by_length(1000, &mut Seeded::new(9));
    let lengths = Lengths::new(1, &light, (0.2, 0.7)).unwrap();
    let mut integrand = Multiplexed::new(integrator(), lengths);
    let plan = Plan::new(100, 1, 30).unwrap();
    let found = differences(name, (scene, Regular), (plan, 8000), &mut Primary::new(&mut integrand));
    // Long paths of a rare strategy are worth hundreds of others: the judge would ask for a hundred times as many samples. Five standard errors, of at
    // most an eightieth.
    for (moments, scale) in found {
        let (error, deviation) = (moments.standard_error().unwrap(), moments.mean().unwrap() - scale);
        println!("  z {:+.1}, error {:.4}", deviation / error, error / scale);
        assert!(
            deviation.abs() < 5.0 * error && error < scale / 80.0,
            "{name}: {deviation} of {scale}, {error}"
        );
    }
    assert_eq!(integrand.integrator().truncated(), 0);
}

#[test]
fn by_one_strategy_per_sample() {
    multiplexed("sky, one strategy", &sky().in_pixels([2, 2]));
    let sky = Scene { light_paths_per_pixel: 0.0, ..sky() };
    multiplexed("sky, one strategy, no light image", &sky.in_pixels([2, 2]));
}

#[test]
fn a_step_allocates_nothing() {
    let scene = bulb().in_pixels([2, 2]);
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
    let integrator = Bidirectional::new(weigh, Walking::new(scene.walk), Regular);
    let mut integrand = FromBothEnds::new(integrator);
    let mut target = Primary::new(&mut integrand);
    let mut counts = [Acceptance::default(); 2];
    let set = Bootstrap::draw(&mut target, 100, 1).unwrap();
    let mut sum = 0.0;
    let mut run = || {
        set.start(&mut target, 0);
        let (mut chain, mut source) = (Chain::new(&mut target, 1.0), Seeded::new(3));
        for _ in 0..5000 {
            chain.step(&mut |_, value| sum += value, &mut counts, &mut source).unwrap();
        }
    };
    // Once, so that the buffers are as long as these paths.
    run();
    let allocated = allocation_counter::measure(run);
    assert_eq!(allocated.count_total, 0);
    assert!(sum > 0.0);
}
