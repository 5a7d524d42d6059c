//! Cost of a collision of a particle tracer, beside the least that it can cost.
//!
//! `cargo bench --bench walks` measures with criterion, and then prints ratios of two loops that ran in turn within this run.

use criterion::{BenchmarkId, Criterion, Throughput};
use fairflight_collision::Version;
use fairflight_media::phase::Rayleigh;
use fairflight_media::{
    AnalyticCosine, Bounds, Homogeneous, Line, Medium, Observed, Perlin, PerlinParameters, PhaseFunction,
};
use fairflight_paths::{Integrator, ParticleTracer, Uniform, Walk};
use fairflight_scene::{Background, Lights, Volume};
use fairflight_sources::{Seeded, UniformSource};
use glam::{DVec3, dvec3};
use std::hint::black_box;
use std::time::Instant;

/// Walks per timed loop.
const WALKS: u64 = 10_000;
const ALBEDO: f64 = 0.7;

/// A camera ray through the middle of the sphere of szirmay-kalos-2017 eq. 21.
const CAMERA: Line = Line { origin: dvec3(0.3, 0.2, -20.0), direction: DVec3::Z };

/// One look-up at a point of the sphere, three uniform variates, one logarithm, one direction by the phase function.
fn bare<M: Medium>(medium: &M, collisions: u64, source: &mut Seeded) -> f64 {
    let mut sum = 0.0;
    for _ in 0..collisions {
        let [u, v, w] = [source.next_uniform(), source.next_uniform(), source.next_uniform()];
        let point = dvec3(0.3, 0.2, 20.0 * u);
        sum += medium.sigma_t_local(point) + (1.0 - u).ln();
        sum += Rayleigh.sample(DVec3::Z, v, w).direction.x;
    }
    sum
}

/// `WALKS` importons of the particle tracer.
fn walks<M: Medium>(volume: &Volume<M, Rayleigh, f64>, sigma_samp: f64, source: &mut Seeded) -> f64 {
    let lights = Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() };
    let walk = Walk::new(Version::Adaptive, Uniform::new(sigma_samp).expect("positive"));
    let mut tracer = ParticleTracer::new(volume, &lights, walk);
    (0..WALKS).map(|_| tracer.radiance(&CAMERA, source)).sum()
}

fn bench_medium<M: Medium + Copy>(criterion: &mut Criterion, name: &str, medium: M, sigma_samp: f64) {
    let bounds: Bounds = AnalyticCosine::default_bounds();
    let volume = Volume { medium, bounds, albedo: ALBEDO, phase: Rayleigh };
    let observed = Volume { medium: Observed::new(medium), bounds, albedo: ALBEDO, phase: Rayleigh };
    walks(&observed, sigma_samp, &mut Seeded::new(1));
    let collisions = observed.medium.lookups();

    let mut group = criterion.benchmark_group("walks");
    group.sample_size(20).throughput(Throughput::Elements(collisions));
    group.bench_function(BenchmarkId::new("bare", name), |b| {
        b.iter(|| bare(&medium, collisions, &mut Seeded::new(1)));
    });
    group.bench_function(BenchmarkId::new("particle_tracer", name), |b| {
        b.iter(|| walks(&volume, sigma_samp, &mut Seeded::new(1)));
    });
    group.finish();

    let time = |work: &mut dyn FnMut() -> f64| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    let mut ratios: Vec<f64> = (0..41)
        .map(|_| {
            let ours = time(&mut || walks(&volume, sigma_samp, &mut Seeded::new(1)));
            ours / time(&mut || bare(&medium, collisions, &mut Seeded::new(1)))
        })
        .collect();
    ratios.sort_unstable_by(f64::total_cmp);
    println!(
        "{name}: {:.1} collisions per walk; collision / (look-up + 3 uniforms + logarithm + phase sample) = {:.2}",
        collisions as f64 / WALKS as f64,
        ratios[ratios.len() / 2]
    );
}

fn main() {
    let mut criterion = Criterion::default().without_plots().configure_from_args();
    let homogeneous = Homogeneous::new(0.25).expect("finite");
    bench_medium(&mut criterion, "homogeneous", homogeneous, 0.25);
    bench_medium(&mut criterion, "eq21", AnalyticCosine::new(1.0).expect("finite"), 1.0);
    let noise = PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() };
    let perlin = Perlin::new(noise).expect("lawful");
    bench_medium(&mut criterion, "perlin", &perlin, 1.0);
    criterion.final_summary();
}
