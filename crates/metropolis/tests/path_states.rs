//! States: their contribution, proposals as paths, and the laws of all mutations on all kinds of paths that the bidirectional integrator finds.

mod path_common;

use fairflight_metropolis::Mutation;
use fairflight_metropolis::laws::{Drift, Judged, Probes, Steps};
use fairflight_metropolis::path::{
    Caustic, LaiLens, Lens, PathSite, PathState, PathVertex, PathWorld, Propagation, Scattering, Towards,
};
use fairflight_scene::Segment;
use fairflight_sources::Seeded;
use path_common::{
    Bank, Boxed, SIGMA_T, Scene, Traced, bank, fine_sizes, glass, hall, probes, signature, sky,
};
use std::collections::BTreeSet;

type Named = (&'static str, fn(&dyn PathWorld) -> Boxed<'_>);

const ALL: [Named; 8] = [
    ("lens", |world| Box::new(Lens::new(world, fine_sizes()))),
    ("lens, scaled", |world| Box::new(Lens::new(world, fine_sizes()).scaling())),
    ("Lai's lens", |world| Box::new(LaiLens::new(world, fine_sizes()))),
    ("caustic", |world| Box::new(Caustic::new(world, fine_sizes()))),
    ("scattering, eye", |world| Box::new(Scattering::new(world, fine_sizes(), Towards::Eye))),
    ("scattering, light", |world| Box::new(Scattering::new(world, fine_sizes(), Towards::Light))),
    ("propagation, eye", |world| Box::new(Propagation::new(world, fine_sizes(), Towards::Eye))),
    ("propagation, light", |world| Box::new(Propagation::new(world, fine_sizes(), Towards::Light))),
];

fn judge(bank: &Bank, mutation: &mut dyn Mutation<PathState>, seed: u64) -> Judged {
    let moved = probes(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let mut states = bank.iter();
    // The pilot has a quarter of the samples besides.
    let steps = Steps { samples: bank.len() as u64 * 4 / 5, seed, alpha: 1e-6 };
    let sample = |source: &mut Seeded, each: &mut dyn FnMut(&PathState, f64, &mut Seeded)| {
        for (path, weight) in states.next().unwrap() {
            each(path, *weight, source);
        }
    };
    steps.judge(Probes { moved: &moved, kept: &[] }, sample, mutation)
}

/// Every mutation keeps the contribution of all kinds of paths together, and the best of its functions would show a drift of `detectable`.
fn agree(mutations: &[Named], bank: &Bank, scene: &Scene, (kinds, detectable): (usize, f64), seed: u64) {
    let found: BTreeSet<String> = bank.iter().flatten().map(|(path, _)| signature(path)).collect();
    assert!(found.len() >= kinds, "{} kinds", found.len());
    let view = scene.view();
    for (name, make) in mutations {
        let judged = judge(bank, &mut *make(&view), seed);
        let reach = |drift: &Drift| drift.verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
        let least = judged.drifts.iter().map(reach).fold(f64::INFINITY, f64::min);
        println!("{name:20} acceptance {:.2} z {:+.1} shows {least:.3}", judged.acceptance, judged.worst().z);
        assert!(!judged.is_rejected(), "{name}: {:#?}", judged.worst());
        assert!(least <= detectable, "{name}: {least}");
    }
}

#[test]
fn kinds_with_mirrors_and_glass() {
    let scene = glass();
    let wanted = |path: &PathState| path.len() > 1 && path.vertices.iter().any(PathVertex::is_smooth);
    let bank = bank(&scene, (6, 24.0), wanted, (40_000, 1));
    agree(&ALL, &bank, &scene, (100, 0.5), 1);
}

#[test]
fn kinds_under_a_sky_with_lights_of_all_sorts() {
    let scene = sky();
    let bank = bank(&scene, (4, 24.0), |path| path.len() > 1, (40_000, 1));
    let ends: BTreeSet<String> =
        bank.iter().flatten().map(|(path, _)| format!("{:?}", path.vertices[path.len()].site)).collect();
    assert_eq!(ends.len(), 4, "{ends:?}");
    let few: Vec<Named> = ALL.into_iter().filter(|(name, _)| *name != "Lai's lens").collect();
    agree(&few, &bank, &scene, (20, 0.5), 1);
}

/// Lai's lens accepts one step of fifty here: of 40,000 paths its drift can be judged at eight of twenty seeds, of 160,000 at all of eight that were tried, and then
/// shows 0.24 at most.
#[test]
fn a_lens_that_seldom_accepts_under_a_sky() {
    let scene = sky();
    let bank = bank(&scene, (4, 24.0), |path| path.len() > 1, (160_000, 1));
    let lens: Vec<Named> = ALL.into_iter().filter(|(name, _)| *name == "Lai's lens").collect();
    agree(&lens, &bank, &scene, (20, 0.5), 1);
}

#[test]
fn the_contribution_is_weight_times_density() {
    let scene = hall();
    let view = scene.view();
    let mut source = Seeded::new(3);
    // The density of a point of the lamp, and of the ray through the half of the film that sees the floor.
    for (kinds, ln_ends) in
        [("V", 0.25f64.ln()), ("VV", 0.25f64.ln()), ("D", 0.5f64.ln()), ("DV", 0.5f64.ln())]
    {
        let traced = Traced { world: &view, kinds };
        let mut checked = 0;
        while checked < 100 {
            let Some((path, weight)) = traced.sample(&mut source) else { continue };
            let mut ln_density = ln_ends + scene.camera.importance(path.vertices[1].position).ln();
            for i in 1..path.len() {
                let [before, vertex] = [&path.vertices[i - 1], &path.vertices[i]];
                let edge = &path.edges[i - 1];
                if i > 1 {
                    let cosine = before.facing(edge.direction);
                    let PathSite::Diffuse { .. } = before.site else {
                        // The phase function is σ_t times that at a vertex.
                        let scattered = before.scatter(&view, path.edges[i - 2].direction, edge.direction);
                        ln_density += (scattered / SIGMA_T / (edge.length * edge.length)).ln();
                        ln_density += SIGMA_T.ln() - SIGMA_T * edge.length;
                        continue;
                    };
                    ln_density += (cosine / std::f64::consts::PI / (edge.length * edge.length)).ln();
                }
                ln_density += if vertex.is_in_medium() {
                    SIGMA_T.ln() - SIGMA_T * edge.length
                } else {
                    vertex.facing(edge.direction).ln()
                };
            }
            let expected = weight.ln() + ln_density;
            let found = path.ln_contribution(&view);
            assert!((found - expected).abs() < 1e-10, "{kinds}: {found} {expected}");
            checked += 1;
        }
    }
}

#[test]
fn a_proposal_is_a_path_of_the_same_kind() {
    for scene in [glass(), sky()] {
        let view = scene.view();
        let bank = bank(&scene, (5, 4.0), |path| path.len() > 1, (2000, 7));
        let mut source = Seeded::new(8);
        for (name, make) in ALL {
            let mut mutation = make(&view);
            let (mut y, mut proposed) = (PathState::default(), 0);
            for (x, _) in bank.iter().flatten() {
                let Some(ratio) = mutation.propose(x, &mut y, &mut source) else { continue };
                proposed += 1;
                assert!(ratio.is_finite() && signature(x) == signature(&y) && x.len() == y.len());
                let film = scene.camera.film(y.vertices[1].position).unwrap_or(y.film);
                assert!((0..2).all(|axis| (film[axis] - y.film[axis]).abs() < 1e-9), "{name}");
                for (i, edge) in y.edges.iter().enumerate() {
                    let [from, to] = [&y.vertices[i], &y.vertices[i + 1]];
                    let far = edge.length == f64::INFINITY;
                    let offset = if far { to.position } else { (to.position - from.position) / edge.length };
                    assert!((offset - edge.direction).length() < 1e-7, "{name}: edge {i} of {y:?}");
                    let line = fairflight_media::Line { origin: from.position, direction: edge.direction };
                    let segment =
                        Segment { line, length: edge.length, from: from.surface(), to: to.surface() };
                    assert!(!view.is_occluded(&segment), "{name}: edge {i} of {y:?}");
                    let ln_transmittance = view.ln_transmittance(&segment, &mut source);
                    assert!((ln_transmittance - edge.ln_transmittance).abs() < 1e-9);
                }
            }
            assert!(proposed > 20, "{name}: {proposed}");
        }
    }
}

#[test]
fn a_step_allocates_nothing() {
    let scene = glass();
    let view = scene.view();
    let bank = bank(&scene, (6, 4.0), |path| path.len() > 1, (500, 7));
    for (name, make) in ALL {
        let mut mutation = make(&view);
        let mut y = PathState::default();
        let mut source = Seeded::new(9);
        let mut run = || {
            for (x, _) in bank.iter().flatten() {
                mutation.propose(x, &mut y, &mut source);
            }
        };
        // Once, so that the buffers are as long as these paths.
        run();
        assert_eq!(allocation_counter::measure(run).count_total, 0, "{name}");
    }
}
