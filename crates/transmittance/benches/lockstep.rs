//! Estimates in lanes over estimates one after the other: look-ups per second, by instruction set.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_elementary::InstructionSet;
use fairflight_media::{
    AnalyticCosine, Bounded, Clip, Constant, Extinction, Line, Perlin, PerlinParameters, Ray, Vacuum,
};
use fairflight_sources::Seeded;
use fairflight_transmittance::lockstep::{Batches, Lockstep, fill_by};
use fairflight_transmittance::{
    Comb, CombShape, Jackknife, JitteredRatio, Offset, RayMarching, Roulette, Telescoping, Tracking,
    UnbiasedRayMarching, Woodcock,
};
use glam::{DVec3, dvec3};

const LANES: usize = 16;
const ESTIMATES: usize = 256;
/// Look-ups of a walk by ratio tracking.
const DEPTH: f64 = 20.0;

/// A row: one after the other, and in lanes on each instruction set that the machine has.
fn compare<F: Extinction, E: Lockstep<F>>(criterion: &mut Criterion, name: &str, estimator: &E, field: &F) {
    let seeds: [u64; LANES] = std::array::from_fn(|lane| lane as u64);
    let mut estimates = vec![[0.0; ESTIMATES]; LANES];
    let mut slices = estimates.iter_mut().map(<[f64; ESTIMATES]>::as_mut_slice);
    let mut slices: [&mut [f64]; LANES] = std::array::from_fn(|_| slices.next().unwrap());
    let mut in_lanes = |set| {
        let lookups = fill_by(set, (estimator, field), seeds, &mut Batches::new(&mut slices, None));
        lookups.iter().sum::<u64>()
    };
    let lookups = in_lanes(InstructionSet::Common);
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(lookups));
    group.bench_function("one after the other", |bencher| {
        bencher.iter(|| {
            let mut sum = 0.0;
            for seed in seeds {
                let mut source = Seeded::new(seed);
                sum += (0..ESTIMATES).map(|_| estimator.estimate(field, &mut source)).sum::<f64>();
            }
            sum
        });
    });
    for set in InstructionSet::of_this_machine() {
        group.bench_function(format!("in lanes, {}", set.name()), |bencher| bencher.iter(|| in_lanes(set)));
    }
    group.finish();
}

fn rows(criterion: &mut Criterion) {
    let constant = |sigma_t| Constant::new(sigma_t, DEPTH).unwrap();
    let albedo = Albedo::new(0.0).unwrap();
    let ratio = Tracking::new(DoubleParticle { albedo }, Vacuum::new(DEPTH), constant(1.0));
    compare(criterion, "ratio tracking, constant", &ratio, &constant(0.3));

    let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap().unwrap();
    let cosine = Bounded::new(Ray::new(AnalyticCosine::new(1.0).unwrap(), &clip), 1.0).unwrap();
    compare(criterion, "ratio tracking, eq. 21", &ratio, &cosine);
    compare(criterion, "Woodcock tracking, eq. 21", &Woodcock, &cosine);
    let model = SingleParticle { version: Version::Adaptive, albedo };
    let single = Tracking::new(model, Vacuum::new(DEPTH), constant(1.0));
    compare(criterion, "adaptive single particles, eq. 21", &single, &cosine);
    compare(criterion, "jittered ratio, eq. 21", &JitteredRatio::new(0.5).unwrap(), &cosine);
    let comb = Comb::new(20, CombShape::EndpointMatched).unwrap();
    let marching = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN);
    compare(criterion, "unbiased ray marching, eq. 21", &marching, &cosine);
    let telescoping = Telescoping::new(20, 0.8, CombShape::EndpointMatched).unwrap();
    compare(criterion, "telescoping, eq. 21", &telescoping, &cosine);
    compare(criterion, "jackknife, eq. 21", &Jackknife::new(comb), &cosine);
    let marching = RayMarching::new(20, Offset::Jittered).unwrap();
    compare(criterion, "ray marching, eq. 21", &marching, &cosine);

    let line = Line { origin: dvec3(1.0, 2.0, 3.0), direction: dvec3(0.6, 0.48, 0.64) };
    let noise = Perlin::new(PerlinParameters { offset: 0.3, ..PerlinParameters::default() }).unwrap();
    let noise = Ray::new(noise, &Clip { line, length: DEPTH, entry_distance: 0.0 });
    compare(criterion, "ratio tracking, Perlin noise of twelve octaves", &ratio, &noise);
}

criterion_group!(benches, rows);
criterion_main!(benches);
