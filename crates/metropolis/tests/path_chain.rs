//! Chains in path space: the image of bidirectional path tracing.

mod path_common;

use fairflight_bidirectional::{Bidirectional, Exact, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_metropolis::path::{
    Caustic, Fresh, LaiLens, Lens, Named, PathTarget, PathWorld, Propagation, Scattering, StepSizes, Towards,
};
use fairflight_metropolis::{Acceptance, FromBothEnds, Integrand, Plan, Splats, Target};
use fairflight_paths::transport::Emitters;
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};
use fairflight_transmittance::Regular;
use path_common::{Made, Mistake, SIGMA_T, Scene, Twin, glass, hall, sky};

const SEED: u64 = 1;
/// Fewer leave a mean that is not testable.
const REPLICAS: u64 = 20_000;

/// A part of the image: what all pixels sum up to is the start's alone, and no step changes it.
type Seen = fn([u32; 2], f64) -> f64;

/// A quarter of the image.
fn corner([column, row]: [u32; 2], value: f64) -> f64 {
    if column < 2 && row >= 2 { value } else { 0.0 }
}

/// The quarter in the middle.
fn middle([column, row]: [u32; 2], value: f64) -> f64 {
    if (1..3).contains(&column) && (1..3).contains(&row) { value } else { 0.0 }
}

/// Judges replicas less independent samples against 0.
fn agrees(name: &str, scene: &Scene, mutations: for<'s> fn(&Stage<'s>) -> Vec<Named<'s>>) {
    let verdict = judged(name, (scene, corner), mutations);
    assert_eq!(verdict.sound, Some(true), "{name}: {}", verdict.reason);
    assert!(verdict.detectable_relative_bias.is_some_and(|bias| bias < 0.15), "{name}");
}

/// The verdict on replicas less independent samples; prints the acceptance of each mutation.
fn judged(
    name: &str,
    (scene, seen): (&Scene, Seen),
    mutations: for<'s> fn(&Stage<'s>) -> Vec<Named<'s>>,
) -> Verdict {
    let emitters = scene.emitters();
    let joined = || {
        let (world, camera, emitters) = (scene.world(), &scene.camera, &emitters);
        let (thickness, heuristic) = (Exact, Heuristic::Balance);
        let weigh = Weigh { world, camera, emitters, thickness, heuristic, light_paths: 16.0 };
        let walk = Walk::new(Version::NonTerminating, Uniform::new(SIGMA_T).unwrap());
        Bidirectional::<Made<_>, _>::new(weigh, Walking::new(walk), Regular)
    };
    let mut independent = FromBothEnds::new(joined()).with_first_order(2);
    let mut splats = Splats::default();
    let mut sampled = |source: &mut Seeded, samples: u64| {
        let mut sum = 0.0;
        for _ in 0..samples {
            splats.clear();
            independent.sample(&mut splats, source);
            sum +=
                splats.list().iter().map(|&(pixel, value)| seen(pixel, value)).sum::<f64>() / samples as f64;
        }
        sum
    };
    let plan = Plan::new(20, 1, 30).unwrap();
    let scale = sampled(&mut Seeded::new(derive_seed(SEED, 1)), 20 * REPLICAS);
    let view = scene.view();
    let stage = Stage { view: &view, scene, emitters: &emitters };
    let mut target = PathTarget::new(joined(), &view, mutations(&stage), 2).unwrap();
    let (mut moments, mut other) = (Moments::new(), Seeded::new(derive_seed(SEED, 2)));
    let mut kinds = vec![Acceptance::default(); target.kinds().len()];
    for index in 0..REPLICAS {
        let mut sum = scale;
        let replica = plan.replica(&mut target, (index, derive_seed(SEED, 3)), &mut |pixel, value| {
            sum += seen(pixel, value);
        });
        for (all, one) in kinds.iter_mut().zip(replica.unwrap().acceptance) {
            all.merge(&one);
        }
        moments.push(sum - sampled(&mut other, 20));
    }
    let verdict = judge(&moments, &Reference::exact(scale).with_mild_tails(), 1e-4);
    let accepted: Vec<_> =
        target.kinds().iter().zip(&kinds).map(|(name, kind)| (name, kind.mean())).collect();
    println!(
        "{name}: z {:+.1}, shows {:?}, {accepted:.2?}",
        verdict.mean_z.unwrap(),
        verdict.detectable_relative_bias
    );
    verdict
}

/// What mutations are made from.
struct Stage<'s> {
    view: &'s dyn PathWorld,
    scene: &'s Scene,
    emitters: &'s Emitters<f64>,
}

fn sizes() -> StepSizes {
    StepSizes { film: [0.05, 1.5], ..StepSizes::of_image([4, 4]) }
}

/// All but fresh paths: chains keep the number and the kinds of vertices that they start with.
fn small<'s>(stage: &Stage<'s>) -> Vec<Named<'s>> {
    let world = stage.view;
    vec![
        ("lens", Box::new(Lens::new(world, sizes()))),
        ("scaling lens", Box::new(Lens::new(world, sizes()).scaling())),
        ("lai lens", Box::new(LaiLens::new(world, sizes()))),
        ("caustic", Box::new(Caustic::new(world, sizes()))),
        ("scattering to the eye", Box::new(Scattering::new(world, sizes(), Towards::Eye))),
        ("scattering to the light", Box::new(Scattering::new(world, sizes(), Towards::Light))),
        ("propagation from the eye", Box::new(Propagation::new(world, sizes(), Towards::Eye))),
        ("propagation from the light", Box::new(Propagation::new(world, sizes(), Towards::Light))),
    ]
}

fn with_fresh<'s>(stage: &Stage<'s>) -> Vec<Named<'s>> {
    let mut all = small(stage);
    let majorant = Uniform::new(1.2 * SIGMA_T).unwrap();
    let fresh = Fresh::new((stage.scene.world(), &stage.scene.camera), stage.emitters, majorant, 0.7);
    all.push(("fresh", Box::new(fresh.unwrap())));
    all
}

fn in_pixels(scene: Scene) -> Scene {
    Scene { camera: scene.camera.with_resolution([4, 4]).unwrap(), ..scene }
}

#[test]
fn chains_of_small_mutations_are_unbiased_though_not_ergodic() {
    for (name, scene) in [("hall", hall()), ("glass", glass()), ("sky", sky())] {
        agrees(name, &in_pixels(scene), small);
    }
}

#[test]
fn chains_with_fresh_paths_are_unbiased() {
    for (name, scene) in [("hall", hall()), ("glass", glass()), ("sky", sky())] {
        agrees(name, &in_pixels(scene), with_fresh);
    }
}

/// Another point of the film alone.
fn lens<'s>(stage: &Stage<'s>) -> Vec<Named<'s>> {
    vec![("lens", Box::new(Lens::new(stage.view, sizes())))]
}

/// The same with the camera's Jacobian inverted, as antwerpen-2011 eq. 3.18 prints it.
fn inverted_lens<'s>(stage: &Stage<'s>) -> Vec<Named<'s>> {
    let mistake: Mistake = |_, x| -6.0 * x.edges[0].direction.z.ln();
    lens(stage)
        .into_iter()
        .map(|(name, right)| -> Named<'s> { (name, Box::new(Twin { right, world: stage.view, mistake })) })
        .collect()
}

#[test]
fn whole_replicas_find_a_wrong_jacobian() {
    // Expected |z| 64.
    let scene = in_pixels(hall());
    let right = judged("lens", (&scene, middle), lens);
    assert_eq!(right.sound, Some(true), "{}", right.reason);
    let wrong = judged("inverted lens", (&scene, middle), inverted_lens);
    assert_eq!(wrong.sound, Some(false), "{}", wrong.reason);
}
