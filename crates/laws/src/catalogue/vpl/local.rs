//! Compensation of one step on tiny scenes.

use super::{Check, LAWFUL, Law, STRATEGIES, result};
use crate::vpl::local::{Local, estimate};
use crate::vpl::tiny;
use crate::{CheckResult, Run};
use fairflight_collision::Version;
use fairflight_compensation::{
    Compensation, CompensationOptions, LocalMean, Placement, Strategy, Visibility,
};
use fairflight_media::Homogeneous;
use fairflight_paths::{Ratio, RayTransmittance, Uniform, Walk};
use fairflight_scene::Geometry;
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
        ("one light in a medium", || tiny::medium(1), 360_000, &all[..1]),
        ("two lights in a medium", || tiny::medium(2), 330_000, all),
        ("a floor and lights in a medium", tiny::above_floor, 280_000, all),
        ("a medium and lights on a floor and in it", || tiny::near_floor(tiny::SIGMA_T), 500_000, &all[..1]),
        ("a corner in a medium", || tiny::corner(tiny::SIGMA_T), 200_000, all),
        ("a corner without medium", || tiny::corner(0.0), 250_000, all),
    ];
    let mut checks = Vec::new();
    for (name, scene, samples, strategies) in cases {
        for &(strategy, of) in strategies {
            let id = format!("vpl/local/{name}/{of}");
            let estimator = format!("compensation {of}, one step");
            checks.push(Check::new(id, Law::Compensation, estimator, name, samples, move |run| {
                every_placement(&scene(), strategy, run)
            }));
        }
    }
    checks
}

/// Flights, and vertices as if the medium were homogeneous; on the floor, the same at a rate below the extinction, and as if
/// the medium were half as dense.
fn every_placement(scene: &Local, strategy: Strategy, run: Run) -> CheckResult {
    let reference = scene.reference();
    let walk = |rate| Walk::new(Version::NonTerminating, Uniform::new(rate * tiny::SIGMA_T).expect(LAWFUL));
    let bounds = &scene.volume.bounds;
    let true_mean = LocalMean::of(&scene.volume.medium, bounds, [1; 3], 1);
    let other = Homogeneous::new(0.5 * tiny::SIGMA_T).expect(LAWFUL);
    let other_mean = LocalMean::of(&other, bounds, [1; 3], 1);
    let options = CompensationOptions { strategy, steps: Some(1), ..CompensationOptions::EXACT };
    let local = CompensationOptions { placement: Placement::LocallyHomogeneous, ..options };
    let also = strategy == Strategy::OneToMany && Geometry::<f64>::surfaces(&scene.surfaces).len() == 1;
    let share = if also { 0.25 } else { 0.5 };
    let part = |index| Run { seed: derive_seed(run.seed, index), alpha: share * run.alpha, ..run };
    let (flights, homogeneous) =
        (Compensation::new(options, &true_mean), Compensation::new(local, &true_mean));
    let mut parts = vec![
        ("flights", tried(scene, (walk(1.5), Regular), &flights, &reference, part(1))),
        ("homogeneous", tried(scene, (walk(1.5), Regular), &homogeneous, &reference, part(2))),
    ];
    if also {
        let ratio = Ratio(Uniform::new(1.2 * tiny::SIGMA_T).expect(LAWFUL));
        let half = Compensation::new(local, &other_mean);
        parts.push(("flights below", tried(scene, (walk(0.8), ratio), &flights, &reference, part(3))));
        parts.push(("half as dense", tried(scene, (walk(1.5), ratio), &half, &reference, part(4))));
    }
    for options in [options, local] {
        if let Some(index) = local_visibility_differs(scene, walk(1.5), options, &true_mean, run) {
            return CheckResult::exact(false, format!("local visibility: estimate {index} differs"));
        }
    }
    CheckResult::of_all(parts)
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

/// What lies further away than the region cannot matter: local visibility gives the same numbers. The first estimate that differs.
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
