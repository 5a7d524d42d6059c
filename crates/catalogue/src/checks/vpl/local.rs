//! Compensation of one step on tiny scenes.

use super::{Check, LAWFUL, Law, STRATEGIES, result};
use crate::vpl::local::{Local, estimate};
use crate::vpl::tiny;
use fairflight_collision::Version;
use fairflight_compensation::{
    Compensation, CompensationOptions, LocalMean, Placement, Strategy, Visibility,
};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::Homogeneous;
use fairflight_paths::{Ratio, RayTransmittance, Uniform, Walk};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Reference;
use fairflight_transmittance::Regular;

/// A scene, the estimates that its tails ask for of each way to place vertices, and the strategies that tell something there: one light
/// makes all of them one.
type Case = (&'static str, fn() -> Local, u64, &'static [(Strategy, &'static str)]);

/// Every strategy on every pair of vertices, with every placement.
pub(super) fn checks() -> Vec<Check> {
    let all = &STRATEGIES[..];
    let cases: [Case; 6] = [
        ("one light in a medium", || tiny::medium(1), 420_000, &all[..1]),
        ("two lights in a medium", || tiny::medium(2), 600_000, all),
        ("a floor and lights in a medium", tiny::above_floor, 280_000, all),
        ("a medium and lights on a floor and in it", || tiny::near_floor(tiny::SIGMA_T), 550_000, &all[..1]),
        ("a corner in a medium", || tiny::corner(tiny::SIGMA_T), 280_000, all),
        ("a corner without medium", || tiny::corner(0.0), 300_000, all),
    ];
    let mut checks = Vec::new();
    for (name, scene, samples, strategies) in cases {
        for &(strategy, of) in strategies {
            let id = format!("vpl/local/{name}/{of}");
            let estimator = format!("compensation {of}, one step");
            // One pair at a time varies more, and is less skewed.
            let samples = if strategy == Strategy::OneToOne { samples / 2 } else { samples };
            checks.push(Check::new(id, Law::Compensation, estimator, name, samples, move |run| {
                every_placement(&scene(), strategy, run)
            }));
        }
    }
    // Connections by ratio tracking have heavy tails; here they are mildest.
    let name = "a medium and lights on a floor and in it";
    let id = format!("vpl/local/{name}/other rates");
    let estimator = "compensation, one step, below the extinction";
    checks.push(Check::new(id, Law::Compensation, estimator, name, 950_000, |run| {
        at_other_rates(&tiny::near_floor(tiny::SIGMA_T), run)
    }));
    checks
}

/// Flights, and vertices as if the medium were homogeneous, with full and with local visibility.
fn every_placement(scene: &Local, strategy: Strategy, run: Run) -> CheckResult {
    let reference = scene.reference();
    let mean = LocalMean::of(&scene.volume.medium, &scene.volume.bounds, [1; 3], 1);
    let flights = CompensationOptions { strategy, steps: Some(1), ..CompensationOptions::EXACT };
    let homogeneous = CompensationOptions { placement: Placement::LocallyHomogeneous, ..flights };
    for options in [flights, homogeneous] {
        if let Some(index) = local_visibility_differs(scene, walk(1.5), options, &mean, run) {
            return CheckResult::exact(false, format!("local visibility: estimate {index} differs"));
        }
    }
    let way = || (walk(1.5), Regular);
    let [flights, homogeneous] = [flights, homogeneous].map(|options| Compensation::new(options, &mean));
    CheckResult::of_all([
        ("flights", tried(scene, way(), &flights, &reference, part(run, 1))),
        ("homogeneous", tried(scene, way(), &homogeneous, &reference, part(run, 2))),
    ])
}

/// Flights at a rate below the extinction, with weights of either sign, and vertices as if the medium were half as dense, connected by
/// an estimated transmittance.
fn at_other_rates(scene: &Local, run: Run) -> CheckResult {
    let reference = scene.reference();
    let half = Homogeneous::new(0.5 * tiny::SIGMA_T).expect(LAWFUL);
    let mean = LocalMean::of(&half, &scene.volume.bounds, [1; 3], 1);
    let flights = CompensationOptions { steps: Some(1), ..CompensationOptions::EXACT };
    let homogeneous = CompensationOptions { placement: Placement::LocallyHomogeneous, ..flights };
    let ratio = Ratio(Uniform::new(1.2 * tiny::SIGMA_T).expect(LAWFUL));
    let [flights, homogeneous] = [flights, homogeneous].map(|options| Compensation::new(options, &mean));
    CheckResult::of_all([
        ("flights below", tried(scene, (walk(0.8), ratio), &flights, &reference, part(run, 1))),
        ("half as dense", tried(scene, (walk(1.5), ratio), &homogeneous, &reference, part(run, 2))),
    ])
}

/// Flights at a multiple of the extinction.
fn walk(rate: f64) -> Walk<Uniform> {
    Walk::new(Version::NonTerminating, Uniform::new(rate * tiny::SIGMA_T).expect(LAWFUL))
}

/// The run of one of two parts of a check.
fn part(run: Run, index: u64) -> Run {
    Run { seed: derive_seed(run.seed, index), alpha: 0.5 * run.alpha, ..run }
}

fn tried<T: RayTransmittance<Homogeneous>>(
    scene: &Local,
    way: (Walk<Uniform>, T),
    correction: &Compensation<'_>,
    reference: &Reference,
    run: Run,
) -> CheckResult {
    result(&scene.check(way, correction, reference, run), run)
}

/// The first estimate that differs under local visibility; `None` as long as surfaces further away than the region do not matter, and it
/// gives the same numbers.
fn local_visibility_differs(
    scene: &Local,
    walk: Walk<Uniform>,
    options: CompensationOptions,
    mean: &LocalMean,
    run: Run,
) -> Option<usize> {
    let estimates = |options: CompensationOptions| -> Vec<f64> {
        let (mut source, mut gather) = (Seeded::new(run.seed), scene.gather(walk, Regular));
        let mut correction = Compensation::new(options, mean);
        let pairing = correction.pairing();
        (0..500).map(|_| estimate(&mut gather, &mut correction, pairing, &scene.y, &mut source)).collect()
    };
    let local = estimates(CompensationOptions { visibility: Visibility::Local, ..options });
    estimates(options).iter().zip(&local).position(|(full, local)| full != local)
}
