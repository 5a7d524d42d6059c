//! The law of replicas: chains have the expectation of the paths that they are made of.

use crate::bidirectional::View;
use crate::bidirectional::scenes::Viewed;
use crate::checks::paths::LAWFUL;
use crate::extensions::{against_paths, plain, ray};
use fairflight_bidirectional::{Bidirectional, Exact, Walking};
use fairflight_laws::{NotFinite, Run};
use fairflight_media::Homogeneous;
use fairflight_metropolis::path::{self, Caustic, Lens, Named, PathTarget, Propagation, StepSizes, Towards};
use fairflight_metropolis::{
    FromBothEnds, FromCamera, Importance, Integrand, Kernels, Plan, Primary, Redistribution, Target,
};
use fairflight_paths::Heuristic;
use fairflight_paths::transport::Emitters;
use fairflight_scene::Segment;
use fairflight_sources::{Seeded, SmallStep, UniformSource};
use fairflight_stats::Verdict;
use fairflight_transmittance::Regular;

/// Integrators whose variates are the states of chains.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Over {
    PathTracer,
    Bidirectional,
}

/// Paths from both ends.
fn joined<'s>(view: &'s View<Homogeneous>, emitters: &'s Emitters<f64>) -> Joined<'s> {
    let weigh = view.weigh(emitters, Heuristic::Balance, Exact);
    Bidirectional::new(weigh, Walking::new(view.walk), Regular)
}

type Joined<'s> = Bidirectional<'s, Viewed<Homogeneous, Regular>, Exact>;

/// Does `work` with the integrand.
fn over<R>(kind: Over, view: &View<Homogeneous>, work: impl FnOnce(&mut dyn Integrand<f64>) -> R) -> R {
    let emitters = view.emitters::<Regular>();
    match kind {
        Over::PathTracer => work(&mut FromCamera::new(&view.camera, plain(view))),
        Over::Bidirectional => work(&mut FromBothEnds::new(joined(view, &emitters))),
    }
}

/// The light of one of several pixels: what all of them sum up to is the brightness of the start, and no step changes it.
fn seen(pixel: [u32; 2], value: f64) -> f64 {
    if pixel == [0, 0] { value } else { 0.0 }
}

/// A seed from a stream.
fn seed(source: &mut Seeded) -> u64 {
    (source.next_uniform() * 9_007_199_254_740_992.0) as u64
}

/// Sizes of a replica: two independent samples, and one chain of three steps.
fn short() -> Plan {
    Plan::new(2, 1, 3).expect(LAWFUL)
}

/// One pixel of a replica of `target`; NaN where a contribution is not finite.
fn replica(target: &mut dyn Target<f64>, source: &mut Seeded) -> f64 {
    let mut sum = 0.0;
    let made = short().replica(target, (0, seed(source)), &mut |pixel, value: f64| sum += seen(pixel, value));
    made.map_or(f64::NAN, |_| sum)
}

/// What states of chains learnt elsewhere.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Taught {
    Nothing,
    /// Pixels of unequal importance.
    Importance,
    /// Sizes of steps of which each pixel prefers another.
    Sizes,
}

/// Importance of four pixels.
fn importance() -> Importance {
    Importance::new([2, 2], vec![6.0, 1.0, 0.5, 2.0]).expect(LAWFUL)
}

/// Sizes of steps in four pixels: the one that is seen mostly takes the least, its neighbours the largest.
fn sizes() -> Kernels {
    let even = Kernels::parting(SmallStep::default(), 3, [2, 2]).expect(LAWFUL);
    let mut experience = even.experience();
    for pixel in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        for size in 0..3 {
            let preferred = if pixel == [0, 0] { 0 } else { 2 };
            even.count(&mut experience, (pixel, size), if size == preferred { 1.0 } else { 0.0 });
        }
    }
    even.learn(&experience)
}

/// **Law.** One pixel of a replica of two independent samples and one chain of three steps, most of them small, less one path is 0 on average: a start-up bias of
/// such a chain would be that of a chain that has only begun. So it is whatever the chain was taught.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn replicas(
    (kind, taught): (Over, Taught),
    view: &View<Homogeneous>,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let (importance, sizes) = (importance(), sizes());
    over(kind, view, |integrand| {
        let target = Primary::new(integrand).with_large_step(0.2).expect(LAWFUL);
        let mut target = match taught {
            Taught::Nothing => target,
            Taught::Importance => target.with_importance(&importance),
            Taught::Sizes => target.with_kernels(&sizes),
        };
        against_paths(view, |source| replica(&mut target, source), run)
    })
}

/// **Law.** The same of a chain of paths, by mutations of unequal shares and with pixels of unequal importance, and of what it leaves out: light seen directly.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn of_paths(view: &View<Homogeneous>, run: Run) -> Result<Verdict, NotFinite> {
    let (emitters, importance) = (view.emitters::<Regular>(), importance());
    let world = view.world::<Regular>();
    let seen = path::View { world, camera: &view.camera, edges: Exact };
    let sizes = StepSizes { film: [0.05, 1.0], ..StepSizes::of_image([2, 2]) };
    let mutations: Vec<Named<'_>> = vec![
        ("lens", Box::new(Lens::new(&seen, sizes))),
        ("caustic", Box::new(Caustic::new(&seen, sizes))),
        ("propagation", Box::new(Propagation::new(&seen, sizes, Towards::Eye))),
    ];
    let target = PathTarget::new(joined(view, &emitters), &seen, mutations, 2).expect(LAWFUL);
    let mut target = target.with_shares(&[3.0, 0.5, 1.0]).expect(LAWFUL).with_importance(&importance);
    let mut shadow = Regular;
    let sample = |source: &mut Seeded| {
        let line = ray(view, source);
        let segment = Segment { line, length: f64::INFINITY, from: None, to: None };
        let is_free = fairflight_scene::Geometry::intersect(world.surfaces, &segment).is_none();
        let sky = if is_free { view.lights.background.radiance(line.direction) } else { 0.0 };
        let direct = if sky > 0.0 { sky * world.transmittance(&segment, &mut shadow, source) } else { 0.0 };
        direct + replica(&mut target, source)
    };
    against_paths(view, sample, run)
}

/// **Law.** One pixel of the energy of one sample, spread by chains of three small steps, less one path is 0 on average, with at most two chains of a sample.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn redistributed(view: &View<Homogeneous>, run: Run) -> Result<Verdict, NotFinite> {
    // A chain for each sample of average light.
    let rule = Redistribution::new(3, 0.1).and_then(|rule| rule.with_most_chains(2)).expect(LAWFUL);
    over(Over::Bidirectional, view, |integrand| {
        let mut target = Primary::new(integrand).with_large_step(0.0).expect(LAWFUL);
        let sample = |source: &mut Seeded| {
            let (mut sum, mut counts) = (0.0, [Default::default(); 2]);
            let made = rule.sample(&mut target, (0, seed(source)), &mut counts, &mut |pixel, value: f64| {
                sum += seen(pixel, value);
            });
            made.map_or(f64::NAN, |_| sum)
        };
        against_paths(view, sample, run)
    })
}
