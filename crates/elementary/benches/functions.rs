//! Time of a function, over that of the system's, and in lanes.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fairflight_elementary::{self as elementary, lanes};
use std::hint::black_box;

const LANES: usize = 16;

fn functions(criterion: &mut Criterion) {
    let uniforms: Vec<[f64; LANES]> = (0..64)
        .map(|row| std::array::from_fn(|lane| ((row * LANES + lane) as f64 + 0.5) * 0.618_033_988_75 % 1.0))
        .collect();
    let mut compare = |name: &str,
                       ours: fn(f64) -> f64,
                       system: fn(f64) -> f64,
                       in_lanes: fn(&[f64; LANES]) -> [f64; LANES]| {
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements((uniforms.len() * LANES) as u64));
        let all = |function: fn(f64) -> f64| {
            uniforms.iter().flatten().map(|&x| function(black_box(x))).sum::<f64>()
        };
        group.bench_function("system", |bencher| bencher.iter(|| all(system)));
        group.bench_function("ours", |bencher| bencher.iter(|| all(ours)));
        group.bench_function("ours in lanes", |bencher| {
            bencher.iter(|| {
                let mut sums = [0.0; LANES];
                for row in &uniforms {
                    let values = in_lanes(black_box(row));
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                }
                sums
            });
        });
        group.finish();
    };
    compare("ln", elementary::ln, f64::ln, lanes::ln);
    compare("ln_1p", elementary::ln_1p, f64::ln_1p, lanes::ln_1p);
    compare("exp", elementary::exp, f64::exp, lanes::exp);
    compare("exp_m1", elementary::exp_m1, f64::exp_m1, lanes::exp_m1);
    compare("sin", elementary::sin, f64::sin, |x| lanes::sin_cos(x).0);
}

criterion_group!(benches, functions);
criterion_main!(benches);
