//! Cost of a look-up inside an estimator, beside the bare look-up.
//!
//! `cargo bench --bench lookups` measures with criterion, and then prints ratios of two loops that ran in turn within
//! this run: on a machine whose speed drifts, ratios are what can be compared.

use criterion::{BenchmarkId, Criterion, Throughput};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_harness::estimator::{ControlSpec, DoubleParticleSpec, EstimatorKind, Trial};
use fairflight_harness::field::{AnyProfile, VoxelLattice};
use fairflight_media::{
    AnalyticCosine, Bounds, Certified, Constant, Counted, ExpressionProfile, Extinction, Perlin,
    PerlinParameters, Ray, Vacuum, Voxels,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::{Tracking, TransmittanceEstimator};
use glam::{DAffine3, DVec3};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const LENGTH: f64 = 20.0;

/// Look-ups per timed loop, about.
const LOOKUPS: u64 = 200_000;

/// One look-up, one uniform variate, one logarithm: the least that a collision can cost.
fn bare<F: Extinction>(field: &F, lookups: u64, source: &mut Seeded) -> f64 {
    let mut sum = 0.0;
    for _ in 0..lookups {
        let u = source.next_uniform();
        sum += field.sigma_t(field.length() * u) + (1.0 - u).ln();
    }
    sum
}

fn ratio_tracking(length: f64, sigma_samp: f64) -> Tracking<DoubleParticle, Vacuum, Constant> {
    Tracking::new(model(), Vacuum::new(length), Constant::new(sigma_samp, length).expect("finite"))
}

fn model() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// Estimates until about `LOOKUPS` look-ups were made.
fn estimates<F: Extinction, E: TransmittanceEstimator<F>>(
    field: &F,
    estimator: &E,
    count: u64,
    source: &mut Seeded,
) -> f64 {
    (0..count).map(|_| estimator.estimate(field, source)).sum()
}

/// The same estimates as the harness draws them: a batch per call, its look-ups watched.
fn batch(trial: &dyn Trial, estimates: &mut [f64], source: &mut Seeded) -> f64 {
    trial.draw(source, estimates).expect("the profile has no unlawful value");
    estimates.iter().sum()
}

/// The look-ups that `count` estimates make from seed 1.
fn lookups_of<F: Extinction + Copy>(field: F, sigma_samp: f64, count: u64) -> u64 {
    let counted = Counted::new(field);
    let estimator = ratio_tracking(field.length(), sigma_samp);
    estimates(&counted, &estimator, count, &mut Seeded::new(1));
    counted.lookups()
}

/// Nanoseconds per look-up of both loops, in turn, as the median of their ratio.
fn paired(mut a: impl FnMut() -> f64, mut b: impl FnMut() -> f64) -> f64 {
    let time = |work: &mut dyn FnMut() -> f64| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    let mut ratios: Vec<f64> = (0..41).map(|_| time(&mut a) / time(&mut b)).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

/// Criterion's figures and the paired ratios of one field, which is that of the profile.
fn bench_field<F: Extinction + Copy>(
    criterion: &mut Criterion,
    name: &str,
    (field, profile): (F, &AnyProfile),
    sigma_samp: f64,
) {
    let length = field.length();
    let count = (LOOKUPS as f64 / (sigma_samp * length)) as u64;
    let lookups = lookups_of(field, sigma_samp, count);
    let direct = ratio_tracking(length, sigma_samp);
    let spec = DoubleParticleSpec::at(sigma_samp, ControlSpec::none());
    let registry = spec.prepare(profile).expect("lawful").trial;
    let mut buffer = vec![0.0; count as usize];

    let mut group = criterion.benchmark_group("lookups");
    group.sample_size(30).throughput(Throughput::Elements(lookups));
    group.bench_function(BenchmarkId::new("bare", name), |b| {
        b.iter(|| bare(&field, lookups, &mut Seeded::new(1)));
    });
    group.bench_function(BenchmarkId::new("ratio_tracking", name), |b| {
        b.iter(|| estimates(&field, &direct, count, &mut Seeded::new(1)));
    });
    group.bench_function(BenchmarkId::new("registry", name), |b| {
        b.iter(|| batch(&*registry, &mut buffer, &mut Seeded::new(1)));
    });
    group.finish();

    let to_bare = paired(
        || estimates(&field, &direct, count, &mut Seeded::new(1)),
        || bare(&field, lookups, &mut Seeded::new(1)),
    );
    let to_direct = paired(
        || batch(&*registry, &mut buffer, &mut Seeded::new(1)),
        || estimates(&field, &direct, count, &mut Seeded::new(1)),
    );
    println!(
        "{name}: ratio tracking / (look-up + uniform + logarithm) = {to_bare:.2}; registry / direct = {to_direct:.2}"
    );
}

fn main() {
    let mut criterion = Criterion::default().without_plots().configure_from_args();
    let axis = |origin: DVec3, direction: DVec3, bounds: &Bounds| {
        bounds.clip(origin, direction, None).expect("finite").expect("the ray meets the bounds")
    };
    let constant = Constant::new(0.5, LENGTH).expect("finite");
    bench_field(&mut criterion, "constant", (constant, &AnyProfile::Constant(constant)), 1.0);
    // Five times as many look-ups per walk: what the end of a walk costs shows in the difference.
    let long = Constant::new(0.5, 5.0 * LENGTH).expect("finite");
    bench_field(&mut criterion, "constant, long", (long, &AnyProfile::Constant(long)), 1.0);

    let cosine = Arc::new(AnalyticCosine::new(1.0).expect("finite"));
    let clip = axis(DVec3::ZERO, DVec3::Z, &AnalyticCosine::default_bounds());
    let profile = AnyProfile::AnalyticCosine(Ray::new(Arc::clone(&cosine), &clip));
    bench_field(&mut criterion, "eq21", (Ray::new(&*cosine, &clip), &profile), 1.0);

    let bytes = include_bytes!("../../tests/fixtures/eq21_64.vdb");
    let grid = fairflight_volumes::read_float_grid(bytes, None).expect("a fixture of ours");
    let bounds = Bounds::aligned_box(DVec3::splat(0.0), DVec3::splat(63.0)).expect("ordered");
    let voxels = Arc::new(Voxels::new(VoxelLattice(grid), DAffine3::IDENTITY, 0.3).expect("finite"));
    let clip = axis(DVec3::new(-10.0, 20.0, 17.0), DVec3::new(1.0, 0.3, 0.4), &bounds);
    let profile = AnyProfile::Voxels(Ray::new(Arc::clone(&voxels), &clip));
    bench_field(&mut criterion, "voxels", (Ray::new(&*voxels, &clip), &profile), 0.35);

    let formula =
        ExpressionProfile::new("0.3 + 0.25*sin(7*s)*exp(-0.2*s)", LENGTH, Some(0.6)).expect("a formula");
    let profile = AnyProfile::Expression(Certified::new(formula.clone()));
    bench_field(&mut criterion, "expression", (&formula, &profile), 0.6);

    let perlin = Arc::new(Perlin::new(PerlinParameters::default()).expect("lawful"));
    let clip = axis(DVec3::new(0.3, 0.2, 0.0), DVec3::Z, &AnalyticCosine::default_bounds());
    let profile = AnyProfile::Perlin(Certified::new(Ray::new(Arc::clone(&perlin), &clip)));
    bench_field(&mut criterion, "perlin", (Ray::new(&*perlin, &clip), &profile), 1.0);
    criterion.final_summary();
}
