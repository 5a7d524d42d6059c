//! The law of replicas: chains have the expectation of the paths that they are made of.

use crate::bidirectional::View;
use crate::bidirectional::scenes::Viewed;
use crate::checks::paths::LAWFUL;
use crate::extensions::{against_paths, plain};
use fairflight_bidirectional::{Bidirectional, Exact, Walking};
use fairflight_laws::{NotFinite, Run};
use fairflight_media::Homogeneous;
use fairflight_metropolis::{FromBothEnds, FromCamera, Integrand, Plan, Primary, Redistribution};
use fairflight_paths::Heuristic;
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::Verdict;
use fairflight_transmittance::Regular;

/// Integrators whose variates are the states of chains.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Over {
    PathTracer,
    Bidirectional,
}

/// Does `work` with the integrand.
fn over<R>(kind: Over, view: &View<Homogeneous>, work: impl FnOnce(&mut dyn Integrand<f64>) -> R) -> R {
    let emitters = view.emitters::<Regular>();
    let joined = || -> Bidirectional<'_, Viewed<Homogeneous, Regular>, Exact> {
        let weigh = view.weigh(&emitters, Heuristic::Balance, Exact);
        Bidirectional::new(weigh, Walking::new(view.walk), Regular)
    };
    match kind {
        Over::PathTracer => work(&mut FromCamera::new(&view.camera, plain(view))),
        Over::Bidirectional => work(&mut FromBothEnds::new(joined())),
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

/// **Law.** One pixel of a replica of two independent samples and one chain of three steps, most of them small, less one path is 0 on average: a start-up bias of
/// such a chain would be that of a chain that has only begun.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn replicas(kind: Over, view: &View<Homogeneous>, run: Run) -> Result<Verdict, NotFinite> {
    let plan = Plan::new(2, 1, 3).expect(LAWFUL);
    over(kind, view, |integrand| {
        let mut target = Primary::new(integrand).with_large_step(0.2).expect(LAWFUL);
        let replica = |source: &mut Seeded| {
            let mut sum = 0.0;
            let made = plan
                .replica(&mut target, (0, seed(source)), &mut |pixel, value: f64| sum += seen(pixel, value));
            made.map_or(f64::NAN, |_| sum)
        };
        against_paths(view, replica, run)
    })
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
