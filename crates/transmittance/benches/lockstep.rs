//! Estimates in lanes over estimates one after the other: look-ups per second, by instruction set.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Constant, Vacuum};
use fairflight_sources::Seeded;
use fairflight_transmittance::{Tracking, TransmittanceEstimator, lockstep};

const LANES: usize = 16;
const ESTIMATES: usize = 512;
/// Look-ups of a walk.
const DEPTH: f64 = 20.0;

fn tracking(criterion: &mut Criterion) {
    let field = Constant::new(0.3, DEPTH).unwrap();
    let sampling = Constant::new(1.0, DEPTH).unwrap();
    let model = DoubleParticle { albedo: Albedo::new(0.0).unwrap() };
    let estimator = Tracking::new(model, Vacuum::new(DEPTH), sampling);
    let seeds = std::array::from_fn(|lane| lane as u64);
    let mut group = criterion.benchmark_group("ratio tracking, constant");
    group.throughput(Throughput::Elements((DEPTH as usize * LANES * ESTIMATES) as u64));
    group.bench_function("one after the other", |bencher| {
        bencher.iter(|| {
            let mut sum = 0.0;
            for seed in seeds {
                let mut source = Seeded::new(seed);
                sum += (0..ESTIMATES).map(|_| estimator.estimate(&field, &mut source)).sum::<f64>();
            }
            sum
        });
    });
    let mut estimates = vec![[0.0; ESTIMATES]; LANES];
    let mut slices = estimates.iter_mut().map(<[f64; ESTIMATES]>::as_mut_slice);
    let mut slices: [&mut [f64]; LANES] = std::array::from_fn(|_| slices.next().unwrap());
    group.bench_function("in lanes", |bencher| {
        bencher.iter(|| lockstep::fill(&estimator, &field, seeds, &mut slices));
    });
    group.finish();
}

criterion_group!(benches, tracking);
criterion_main!(benches);
