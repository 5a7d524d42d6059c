//! The bidirectional mutation: fresh paths of all kinds and lengths.

mod path_common;

use fairflight_metropolis::Mutation;
use fairflight_metropolis::laws::{Drift, Judged, Probes, Steps};
use fairflight_metropolis::path::{Fresh, PathState};
use fairflight_paths::Uniform;
use fairflight_sources::{Seeded, UniformSource};
use path_common::{Paths, SIGMA_T, Scene, bank, glass, hall, mirrored, probes, sky};

/// Edges of the longest paths: a target that is 0 beyond.
const LONGEST: u32 = 4;

/// A mutation of paths up to that length, with a mistake or none.
struct Short<'m> {
    mutation: &'m mut dyn Mutation<PathState>,
    mistake: fn(&PathState) -> f64,
}

impl Mutation<PathState> for Short<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let ratio = self.mutation.propose(x, y, source)?;
        (y.len() <= LONGEST as usize).then(|| ratio + (self.mistake)(y) - (self.mistake)(x))
    }
}

/// Judges the mutation on the paths of a scene, and with each of some mistakes.
fn judged(scene: &Scene, mistakes: &[fn(&PathState) -> f64], count: usize) -> Vec<Judged> {
    let longest = |path: &PathState| path.len() > 1 && path.len() <= LONGEST as usize;
    let bank = bank(scene, (LONGEST, 6.0), longest, (count, 1));
    let emitters = scene.emitters();
    let majorant = Uniform::new(1.3 * SIGMA_T).unwrap();
    let mut fresh = Fresh::new((scene.world(), &scene.camera), &emitters, majorant, 0.5).unwrap();
    let mut moved = probes(&[0, 1, 2, 3, 4, 5, 6, 7]);
    moved.push(&|x: &PathState| x.len() as f64);
    // The pilot has a quarter of the samples besides.
    let steps = Steps { samples: count as u64 * 4 / 5, seed: 1, alpha: 1e-6 };
    let judge = |&mistake: &fn(&PathState) -> f64| {
        let mut states = bank.iter();
        let sample = |source: &mut Seeded, each: &mut dyn FnMut(&PathState, f64, &mut Seeded)| {
            for (path, weight) in states.next().unwrap() {
                each(path, *weight, source);
            }
        };
        let mut short = Short { mutation: &mut fresh, mistake };
        steps.judge(Probes { moved: &moved, kept: &[] }, sample, &mut short)
    };
    mistakes.iter().map(judge).collect()
}

fn agrees(judged: &Judged) {
    let reach = |drift: &Drift| drift.verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
    let least = judged.drifts.iter().map(reach).fold(f64::INFINITY, f64::min);
    println!("acceptance {:.3} z {:+.1} shows {least:.3}", judged.acceptance, judged.worst().z);
    assert!(!judged.is_rejected(), "{:#?}", judged.worst());
    assert!(least < 0.2, "{least}");
}

#[test]
fn fresh_paths_of_any_kind_and_length_keep_the_contribution() {
    for scene in [mirrored(), glass(), sky()] {
        agrees(&judged(&scene, &[|_| 0.0], 60_000)[0]);
    }
}

#[test]
fn densities_without_a_choice_or_without_albedos_are_found() {
    let without_length = |x: &PathState| 0.5f64.ln() * x.len() as f64;
    let without_albedo =
        |x: &PathState| 0.8f64.ln() * x.vertices.iter().filter(|vertex| vertex.is_in_medium()).count() as f64;
    let judged = judged(&hall(), &[|_| 0.0, without_length, without_albedo], 120_000);
    agrees(&judged[0]);
    // The pilot's |z|: 33 and 9.7.
    for judged in &judged[1..] {
        println!("z {:+.1}", judged.worst().z);
        assert!(judged.is_rejected(), "{:#?}", judged.worst());
    }
}

#[test]
fn a_majorant_that_is_none_is_refused() {
    let scene = hall();
    let emitters = scene.emitters();
    let majorant = Uniform::new(0.99 * SIGMA_T).unwrap();
    let refused = Fresh::new((scene.world(), &scene.camera), &emitters, majorant, 0.5);
    assert_eq!(refused.unwrap_err().bound, Some(SIGMA_T));
}

#[test]
fn a_fresh_path_allocates_nothing() {
    let scene = glass();
    let emitters = scene.emitters();
    let majorant = Uniform::new(SIGMA_T).unwrap();
    let mut fresh = Fresh::new((scene.world(), &scene.camera), &emitters, majorant, 0.7).unwrap();
    let mut x = PathState::default();
    let mut seeds = Seeded::new(2);
    Paths::new(&scene, &emitters, LONGEST).sample(&mut seeds, &mut |path, _, _| x = path.clone());
    let (mut y, mut proposed) = (PathState::default(), 0);
    let mut run = || {
        let mut source = Seeded::new(3);
        for _ in 0..20_000 {
            proposed += usize::from(fresh.propose(&x, &mut y, &mut source).is_some());
        }
    };
    // Once, so that the buffers are as long as these paths.
    run();
    assert_eq!(allocation_counter::measure(run).count_total, 0);
    assert!(proposed > 1000, "{proposed}");
}
