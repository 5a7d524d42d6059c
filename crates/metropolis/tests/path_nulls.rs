//! Null collisions in the state: mutations keep the contribution where transmittance is estimated, if paths start with the points of a flight.

mod path_common;

use fairflight_media::Medium;
use fairflight_metropolis::Mutation;
use fairflight_metropolis::laws::{Drift, Judged, Probe, Probes, Steps};
use fairflight_metropolis::path::{
    Caustic, Lens, NullCollisions, PathState, PathWorld, Propagation, Towards,
};
use fairflight_scene::Segment;
use fairflight_sources::Seeded;
use path_common::{Traced, probes, sizes, smoke};

/// Points of an edge for a path that was found.
type Points = fn(&dyn PathWorld, &Segment, &mut Seeded) -> f64;

/// Judges mutations in smoke of which they know a majorant, on paths of one kind whose weights have its closed form.
fn judged(kinds: &'static str, points: Points, (samples, seed): (u64, u64)) -> Vec<(&'static str, Judged)> {
    let scene = smoke();
    let exact = scene.view();
    let majorant = 1.2 * scene.volume.medium.upper_bound().unwrap();
    let view = scene.view_by(NullCollisions::new(&scene.volume.medium, majorant).unwrap());
    let traced = Traced { world: &exact, kinds };
    let mut source = Seeded::new(seed);
    let threshold = 10.0 * traced.mean_weight(&mut source);
    let bank: Vec<(PathState, f64)> = (0..samples + samples / 4)
        .map(|_| {
            let (mut path, weight) = traced.even_sample(threshold, &mut source);
            for i in 0..path.len() {
                path.edges[i].ln_transmittance = points(&view, &path.segment(i), &mut source);
            }
            (path, weight / threshold)
        })
        .collect();
    // Of the points, too.
    let mut moved = probes(&[0, 1, 2, 3, 5]);
    moved.push(&|x: &PathState| x.edges[0].ln_transmittance.exp());
    let last: Probe<'_, PathState> = &|x| x.edges[x.len() - 1].ln_transmittance.exp();
    moved.push(last);
    let mutations: [(&str, Box<dyn Mutation<PathState> + '_>); 3] = [
        ("lens, scaled", Box::new(Lens::new(&view, sizes()).scaling())),
        ("caustic", Box::new(Caustic::new(&view, sizes()))),
        ("propagation", Box::new(Propagation::new(&view, sizes(), Towards::Light))),
    ];
    let mut all = Vec::new();
    for (name, mut mutation) in mutations {
        let mut states = bank.iter();
        let sample = |source: &mut Seeded, each: &mut dyn FnMut(&PathState, f64, &mut Seeded)| {
            let (path, weight) = states.next().unwrap();
            each(path, *weight, source);
        };
        let steps = Steps { samples, seed, alpha: 1e-6 };
        all.push((name, steps.judge(Probes { moved: &moved, kept: &[] }, sample, &mut *mutation)));
    }
    all
}

#[test]
fn paths_with_the_points_of_their_flights_are_a_start() {
    for kinds in ["V", "VV"] {
        for (name, judged) in
            judged(kinds, |world, segment, source| world.ln_found(segment, source), (40_000, 1))
        {
            let reach = |drift: &Drift| drift.verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
            let least = judged.drifts.iter().map(reach).fold(f64::INFINITY, f64::min);
            println!("{kinds} {name:12} acceptance {:.2} z {:+.1}", judged.acceptance, judged.worst().z);
            assert!(!judged.is_rejected(), "{kinds} {name}: {:#?}", judged.worst());
            assert!(least < 0.2, "{kinds} {name}: {least}");
        }
    }
}

#[test]
fn fresh_points_attached_to_a_path_are_a_bias() {
    // The pilots' z of 40 000 paths: 27 to 42.
    let fresh: Points = |world, segment, source| world.ln_transmittance(segment, source);
    for (name, judged) in judged("V", fresh, (40_000, 1)) {
        println!("{name:12} z {:+.1}, drift {:+.3}", judged.worst().z, judged.worst().relative);
        assert!(judged.is_rejected(), "{name}: {:#?}", judged.worst());
    }
}
