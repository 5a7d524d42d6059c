//! Cost of steps of chains, beside that of the samples of the integrators that they move over.
//!
//! `cargo bench -p fairflight-metropolis --bench steps` measures with criterion, and then prints ratios of two loops that ran in turn within this run: of a
//! step in primary space over path tracing to a path tracer's sample, and of a step of the lens mutation to a bidirectional sample.

#[path = "../../bidirectional/tests/common/mod.rs"]
mod common;

use common::{Scene, bulb, forward, glass, mixed};
use criterion::{BenchmarkId, Criterion, Throughput};
use fairflight_bidirectional::{Bidirectional, Exact, Walking};
use fairflight_collision::Version;
use fairflight_media::{Homogeneous, LineThickness};
use fairflight_metropolis::path::{Lens, PathTarget, StepSizes, View};
use fairflight_metropolis::{
    Acceptance, Bootstrap, Chain, FromBothEnds, FromCamera, Integrand, Primary, Splats, Target, Which,
};
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_scene::{Camera, Volume};
use fairflight_sources::{Counting, Seeded, UniformSource, derive_seed};
use fairflight_transmittance::Regular;
use std::hint::black_box;
use std::time::Instant;

/// Samples or steps of a timed loop.
const LENGTH: u64 = 20_000;
/// Timed pairs of loops.
const PAIRS: u64 = 31;
/// Independent samples that a chain starts from.
const SET: u64 = 1000;
const RESOLUTION: [u32; 2] = [96, 96];

/// [`mixed`] with a medium of several mean free paths.
fn dense() -> Scene<Homogeneous> {
    let Scene { camera, light_paths_per_pixel, volume, surfaces, lights, .. } = mixed();
    let medium = Homogeneous::new(4.0).unwrap();
    let walk = Walk::new(Version::NonTerminating, Uniform::new(4.0).unwrap());
    Scene { camera, light_paths_per_pixel, volume: Volume { medium, ..volume }, surfaces, lights, walk }
}

/// An image, so that what is found has to be written somewhere.
fn image() -> Vec<f64> {
    vec![0.0; RESOLUTION.iter().product::<u32>() as usize]
}

fn add(image: &mut [f64], [column, row]: [u32; 2], value: f64) {
    image[(row * RESOLUTION[0] + column) as usize] += value;
}

/// Steps of one chain: from one start, by stream `seed`.
fn steps(target: &mut dyn Target<f64>, set: &Bootstrap, image: &mut [f64], seed: u64) {
    let mut source = Seeded::new(derive_seed(3, seed));
    set.start(target, set.choose(&mut source).unwrap());
    let mut counts = vec![Acceptance::default(); target.kinds().len()];
    let mut chain = Chain::new(target, 1.0);
    let mut film = |pixel, value| add(image, pixel, value);
    for _ in 0..LENGTH {
        chain.step(&mut film, &mut counts, &mut source).unwrap();
    }
    chain.finish(&mut film);
}

/// Measures `step` beside `sample`, each told the number of its stream.
fn compare(
    criterion: &mut Criterion,
    (group, scene): (&str, &str),
    (sample, step): (&mut dyn FnMut(u64), &mut dyn FnMut(u64)),
) {
    let mut group_of = criterion.benchmark_group(group);
    group_of.sample_size(10).throughput(Throughput::Elements(LENGTH));
    group_of.bench_function(BenchmarkId::new("sample", scene), |b| b.iter(|| sample(0)));
    group_of.bench_function(BenchmarkId::new("step", scene), |b| b.iter(|| step(0)));
    group_of.finish();
    let time = |work: &mut dyn FnMut(u64), seed: u64| {
        let start = Instant::now();
        work(seed);
        start.elapsed().as_secs_f64() / LENGTH as f64
    };
    let mut pairs: Vec<[f64; 2]> = (0..PAIRS).map(|seed| [time(step, seed), time(sample, seed)]).collect();
    pairs.sort_unstable_by(|a, b| (a[0] / a[1]).total_cmp(&(b[0] / b[1])));
    let ratio = |index: usize| pairs[index][0] / pairs[index][1];
    let [step, sample] = pairs[pairs.len() / 2].map(|seconds| 1e9 * seconds);
    println!(
        "{group}, {scene}: step/sample = {:.2} ({:.2} to {:.2} of {PAIRS} pairs), {step:.0} ns and {sample:.0} ns",
        ratio(pairs.len() / 2),
        ratio(0),
        ratio(pairs.len() - 1),
    );
}

/// One path through any pixel.
fn traced(
    camera: &Camera,
    tracer: &mut impl Integrator<f64>,
    source: &mut impl UniformSource,
) -> ([u32; 2], f64) {
    let at = RESOLUTION.map(|side| f64::from(side) * source.next_uniform());
    let pixel = at.map(|at| at as u32);
    (pixel, tracer.radiance(&camera.ray(pixel, at.map(f64::fract)), source))
}

/// Steps over path tracing, and how many variates a state has beside a sample.
fn primary<M: LineThickness>(criterion: &mut Criterion, name: &str, scene: Scene<M>) {
    let scene = scene.in_pixels(RESOLUTION);
    let tracer = || PathTracer::new(scene.world(), scene.walk, Regular, Heuristic::Balance);
    let (mut independent, mut integrand) = (tracer(), FromCamera::new(&scene.camera, tracer()));
    let mut target = Primary::new(&mut integrand);
    let set = Bootstrap::draw(&mut target, SET, 1).unwrap();
    let (mut of_samples, mut of_steps) = (image(), image());
    let mut counting = Counting::new(Seeded::new(2));
    for _ in 0..LENGTH {
        traced(&scene.camera, &mut independent, &mut counting);
    }
    let drawn = counting.drawn() as f64 / LENGTH as f64;
    let (mut lengths, mut source) = (0, Seeded::new(4));
    set.start(&mut target, set.choose(&mut source).unwrap());
    for _ in 0..LENGTH {
        let mut chain = Chain::new(&mut target, 1.0);
        chain.step(&mut |_, _| (), &mut [Acceptance::default(); 2], &mut source).unwrap();
        lengths += target.variates().len();
    }
    let ratio = lengths as f64 / LENGTH as f64 / drawn;
    println!("primary, {name}: {drawn:.1} variates of a sample, {ratio:.2} times as many of a state");
    let mut sample = |seed: u64| {
        let mut source = Seeded::new(derive_seed(2, seed));
        for _ in 0..LENGTH {
            let (pixel, value) = traced(&scene.camera, &mut independent, &mut source);
            add(&mut of_samples, pixel, value);
        }
    };
    let mut step = |seed: u64| steps(&mut target, &set, &mut of_steps, seed);
    compare(criterion, ("primary", name), (&mut sample, &mut step));
    black_box((of_samples, of_steps));
}

/// Steps of the lens mutation.
fn lens<M: LineThickness>(criterion: &mut Criterion, name: &str, scene: Scene<M>) {
    let scene = scene.in_pixels(RESOLUTION);
    let emitters = scene.emitters::<Regular>();
    let joined = || {
        let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
        Bidirectional::new(weigh, Walking::new(scene.walk), Regular)
    };
    let view = View { world: scene.world::<Regular>(), camera: &scene.camera, edges: Exact };
    let mutation = Lens::new(&view, StepSizes::of_image(RESOLUTION));
    let mut target = PathTarget::new(joined(), &view, vec![("lens", Box::new(mutation))], 2).unwrap();
    let set = Bootstrap::draw(&mut target, SET, 1).unwrap();
    let mut independent = FromBothEnds::new(joined()).with_first_order(2);
    let (mut of_samples, mut of_steps) = (image(), image());
    let mut splats = Splats::default();
    let mut sample = |seed: u64| {
        let mut source = Seeded::new(derive_seed(2, seed));
        for _ in 0..LENGTH {
            splats.clear();
            independent.sample(&mut splats, &mut source);
            splats.list().iter().for_each(|&(pixel, value)| add(&mut of_samples, pixel, value));
        }
    };
    let mut step = |seed: u64| steps(&mut target, &set, &mut of_steps, seed);
    compare(criterion, ("lens", name), (&mut sample, &mut step));
    assert!(!target.path(Which::Present).is_empty());
    black_box((of_samples, of_steps));
}

fn main() {
    let mut criterion = Criterion::default().without_plots().configure_from_args();
    primary(&mut criterion, "mixed", mixed());
    primary(&mut criterion, "bulb", bulb());
    primary(&mut criterion, "glass", glass());
    primary(&mut criterion, "forward", forward());
    primary(&mut criterion, "dense", dense());
    lens(&mut criterion, "mixed", mixed());
    lens(&mut criterion, "bulb", bulb());
    lens(&mut criterion, "dense", dense());
    criterion.final_summary();
}
