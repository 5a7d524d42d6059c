//! Strategies one by one: those of one length hold the light of that length together.

mod common;

use common::{Scene, mixed, sample, sky};
use fairflight_bidirectional::{Bidirectional, Exact, Strategy, Subpath, Walking};
use fairflight_media::LineThickness;
use fairflight_paths::Heuristic;
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};
use fairflight_transmittance::Regular;

/// Lengths that are compared.
const LENGTHS: u32 = 3;

/// The light of each length up to 3 by strategies alone, less that by all together; but for one with `forgotten` eye vertices, a mistake.
fn verdicts<M: LineThickness>(
    scene: &Scene<M>,
    samples: u64,
    roulette: bool,
    forgotten: u32,
) -> Vec<Verdict> {
    let emitters = scene.emitters::<Regular>();
    let make = || {
        let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
        Bidirectional::new(weigh, Walking::new(scene.walk), Regular)
    };
    let (mut all, mut alone) = (make(), if roulette { make() } else { make().without_roulette() });
    let (mut light, mut other) = (Subpath::empty(), Subpath::empty());
    let mut together = |source: &mut Seeded| {
        let mut found = [0.0; LENGTHS as usize];
        sample(&mut all, &mut light, [0, 0], source, |one, _, _| {
            let length = (one.strategy.light + one.strategy.eye - 1) as usize;
            if length <= found.len() {
                found[length - 1] += one.value;
            }
        });
        found
    };
    let [mut pilot, mut first, mut second] = [1, 2, 3].map(|stream| Seeded::new(derive_seed(1, stream)));
    let mut scale = [0.0; LENGTHS as usize];
    for _ in 0..samples {
        let found = together(&mut pilot);
        scale = std::array::from_fn(|i| scale[i] + found[i] / samples as f64);
    }
    let mut moments = [Moments::new(); LENGTHS as usize];
    for _ in 0..samples {
        let found = together(&mut first);
        for length in 1..=LENGTHS {
            let index = length as usize - 1;
            let mut sum = scale[index] - found[index];
            for s in (0..=length).filter(|&s| (length > 1 || s == 0) && length + 1 - s != forgotten) {
                let strategy = Strategy { light: s, eye: length + 1 - s };
                let line = scene.camera.ray([0, 0], [second.next_uniform(), second.next_uniform()]);
                alone.alone(strategy, &line, &mut other, &mut second, |pixel, one| {
                    assert_eq!((one.strategy, pixel.is_some()), (strategy, strategy.eye == 1));
                    sum += one.value;
                });
            }
            moments[index].push(sum);
        }
    }
    assert_eq!((alone.truncated(), all.truncated()), (0, 0));
    let judge =
        |(moments, scale): (&Moments, f64)| judge(moments, &Reference::exact(scale).with_mild_tails(), 1e-4);
    moments.iter().zip(scale).map(judge).collect()
}

fn agree(name: &str, verdicts: &[Verdict]) {
    for (index, verdict) in verdicts.iter().enumerate() {
        let (z, bias) = (verdict.mean_z.unwrap_or(0.0), verdict.detectable_relative_bias);
        println!("{name}, length {}: z {z:+.1}, {bias:?}", index + 1);
        assert_eq!(verdict.sound, Some(true), "{name}, length {}: {}", index + 1, verdict.reason);
    }
}

#[test]
fn strategies_of_one_length_hold_its_light() {
    for roulette in [true, false] {
        agree("mixed", &verdicts(&mixed(), 60_000, roulette, 0));
        agree("sky", &verdicts(&sky(), 60_000, roulette, 0));
    }
}

#[test]
fn a_light_image_that_is_weighed_and_left_out_is_found() {
    for verdict in &verdicts(&mixed(), 60_000, false, 1)[1..] {
        println!("z {:+.1}", verdict.mean_z.unwrap_or(0.0));
        assert_eq!(verdict.sound, Some(false), "{}", verdict.reason);
    }
}
