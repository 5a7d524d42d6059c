//! Cost of the estimators beyond the papers beside their look-ups, and of a field behind a pointer.
//!
//! `cargo bench --bench estimators` measures with criterion, and then prints ratios of two loops that ran in turn within this run.

use criterion::{BenchmarkId, Criterion, Throughput};
use fairflight_media::{
    AnalyticCosine, Bounded, Bounds, Constant, Counted, Extinction, Perlin, PerlinParameters, Ray,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::{
    Comb, CombShape, JitteredRatio, NextFlight, NextFlightVersion, Roulette, TransmittanceEstimator,
    UnbiasedRayMarching,
};
use glam::DVec3;
use std::hint::black_box;
use std::time::Instant;

const LENGTH: f64 = 20.0;
/// Estimates per timed loop.
const ESTIMATES: u64 = 4000;

fn estimates<F: Extinction, E: TransmittanceEstimator<F>>(field: &F, estimator: &E, count: u64) -> f64 {
    let mut source = Seeded::new(1);
    (0..count).map(|_| estimator.estimate(field, &mut source)).sum()
}

/// The same with field and source behind pointers, as the harness has them.
fn behind_pointers<'a, E: TransmittanceEstimator<Bounded<&'a dyn Extinction>>>(
    field: &'a dyn Extinction,
    estimator: &E,
    count: u64,
) -> f64 {
    let mut seeded = Seeded::new(1);
    (0..count)
        .map(|_| {
            let bounded = Bounded::new(field, 1.0).expect("1 is a majorant");
            let mut source: &mut dyn UniformSource = &mut seeded;
            estimator.estimate(&bounded, &mut source)
        })
        .sum()
}

fn seconds(work: &mut dyn FnMut() -> f64) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Medians of the times of two loops that run in turn.
fn in_turn(mut a: impl FnMut() -> f64, mut b: impl FnMut() -> f64) -> [f64; 2] {
    let (mut first, mut second): (Vec<f64>, Vec<f64>) =
        (0..31).map(|_| (seconds(&mut a), seconds(&mut b))).unzip();
    [&mut first, &mut second].map(|times| {
        times.sort_unstable_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

/// An estimator on constant fields, counted or not.
trait OnConstants:
    for<'a> TransmittanceEstimator<Bounded<&'a Constant>>
    + for<'a> TransmittanceEstimator<Counted<Bounded<&'a Constant>>>
{
}

impl<E> OnConstants for E where
    E: for<'a> TransmittanceEstimator<Bounded<&'a Constant>>
        + for<'a> TransmittanceEstimator<Counted<Bounded<&'a Constant>>>
{
}

/// One estimator: its own arithmetic over a Perlin look-up, and pointers over none on eq. 21.
fn bench<E>(
    criterion: &mut Criterion,
    name: &str,
    estimator: &E,
    eq21: &Ray<&AnalyticCosine>,
    perlin: &Ray<&Perlin>,
) where
    E: OnConstants + for<'a> TransmittanceEstimator<Bounded<&'a dyn Extinction>>,
    E: for<'a, 'b> TransmittanceEstimator<Bounded<&'a Ray<&'b AnalyticCosine>>>,
{
    let constant = Constant::new(0.3, LENGTH).expect("finite");
    let free = Bounded::new(&constant, 1.0).expect("1 is a majorant");
    let counted = Counted::new(free);
    estimates(&counted, estimator, ESTIMATES);
    let lookups = counted.lookups();
    let mut group = criterion.benchmark_group("estimators");
    group.sample_size(20).throughput(Throughput::Elements(lookups));
    group.bench_function(BenchmarkId::new("constant", name), |b| {
        b.iter(|| estimates(&free, estimator, ESTIMATES));
    });
    group.finish();

    let noise = || {
        let mut source = Seeded::new(1);
        (0..lookups / 16).map(|_| perlin.sigma_t(LENGTH * source.next_uniform() * 0.9)).sum()
    };
    let [own, noise] = in_turn(|| estimates(&free, estimator, ESTIMATES), noise);
    let (own, noise) = (own / lookups as f64, noise / (lookups / 16) as f64);
    let field = Bounded::new(eq21, 1.0).expect("1 is a majorant");
    let [pointers, direct] =
        in_turn(|| behind_pointers(eq21, estimator, ESTIMATES), || estimates(&field, estimator, ESTIMATES));
    println!(
        "{name}: {:.1} ns a look-up of its own, {:.3} of a Perlin look-up ({:.0} ns); behind pointers / direct on eq. 21 = {:.2}",
        1e9 * own,
        own / noise,
        1e9 * noise,
        pointers / direct
    );
}

fn main() {
    let mut criterion = Criterion::default().without_plots().configure_from_args();
    let cosine = AnalyticCosine::new(1.0).expect("finite");
    let noise = Perlin::new(PerlinParameters::default()).expect("lawful");
    let clip = |origin: DVec3, bounds: Bounds| {
        bounds.clip(origin, DVec3::Z, None).expect("finite").expect("the ray meets the bounds")
    };
    let eq21 = Ray::new(&cosine, &clip(DVec3::ZERO, AnalyticCosine::default_bounds()));
    let perlin = Ray::new(&noise, &clip(DVec3::new(0.3, 0.2, 0.0), AnalyticCosine::default_bounds()));
    let marching = |teeth, shape, going_on: f64, segments| {
        UnbiasedRayMarching::new(
            Comb::new(teeth, shape).expect("teeth"),
            Roulette::new(1.0 - going_on).expect("a probability"),
        )
        .in_segments(segments)
        .expect("segments")
    };
    let criterion = &mut criterion;
    bench(criterion, "next-flight ratio", &NextFlight::new(NextFlightVersion::Ratio), &eq21, &perlin);
    bench(
        criterion,
        "matched comb, 25 teeth",
        &marching(25, CombShape::EndpointMatched, 0.1, 1),
        &eq21,
        &perlin,
    );
    bench(
        criterion,
        "matched comb, 100 teeth, P = 0.001",
        &marching(100, CombShape::EndpointMatched, 0.001, 1),
        &eq21,
        &perlin,
    );
    bench(
        criterion,
        "100 segments of one tooth, P = 0.05",
        &marching(1, CombShape::Uniform, 0.05, 100),
        &eq21,
        &perlin,
    );
    bench(criterion, "jittered ratio, 0.25", &JitteredRatio::new(0.25).expect("at most 1"), &eq21, &perlin);
    criterion.final_summary();
}
