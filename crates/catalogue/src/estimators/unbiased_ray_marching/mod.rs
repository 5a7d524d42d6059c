//! Unbiased ray marching: combs, their symmetric means and a roulette, on a profile of each kind that they tell apart: kinks, smoothness,
//! signs and noise.

mod twins;

use super::Kind;
use super::on_profile::estimator;
use super::profiles::{rough_cells, seed_ray, signed, tent};
use super::add;
use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField};
use crate::hard_cases::Subject;
use fairflight_freeflight::HIGHEST_MOMENT;
use fairflight_laws::CheckResult;
use fairflight_laws::lookups::{self, LookupLaw};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Scores;
use fairflight_transmittance::{Comb, CombShape, Roulette, RunningCumulant, UnbiasedRayMarching};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind { name: "unbiased_ray_marching", checks, twins: twins::twins, subjects, spared: &[] };

/// Samples of a quick run: of a roulette that goes on once in ten, of one that does every other time, and of several segments. The look-ups
/// of roulettes have closed moments. The shape of the estimates is that of the sample, which asks for what is left.
const RARE: u64 = 300_000;
const FREQUENT: u64 = 160_000;
const SEGMENTS: u64 = 80_000;
/// Combs that resolve their profile have next to no variance.
const RESOLVED: u64 = 60_000;

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    let matched = |teeth: u32| (teeth, CombShape::EndpointMatched);

    let specimen = tent();
    for (name, shape) in [
        ("comb_uniform", CombShape::Uniform),
        ("comb_endpoint_matched", CombShape::EndpointMatched),
        ("comb_bernoulli_2", CombShape::Bernoulli2),
        ("comb_bernoulli_3", CombShape::Bernoulli3),
        ("comb_periodised", CombShape::Periodised),
    ] {
        checks.push(marching(&specimen, name, FREQUENT, (2, shape), 0.5, 1));
    }
    checks.push(marching(&specimen, "comb_segments_matched", SEGMENTS, matched(1), 0.5, 4));
    checks.push(marching(&specimen, "comb_kettunen", RARE, (3, CombShape::Uniform), 0.9, 1));
    checks.push(tuned(&specimen, RARE, (2, CombShape::Uniform)));

    let specimen = seed_ray();
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (15, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_endpoint_matched", RESOLVED, matched(25), 0.5, 1));
    checks.push(marching(&specimen, "comb_bernoulli_3", RESOLVED, (25, CombShape::Bernoulli3), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments_matched", RESOLVED, matched(5), 0.5, 5));

    let specimen = signed();
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (3, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 5));

    let specimen = rough_cells();
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (12, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_bernoulli_2", FREQUENT, (12, CombShape::Bernoulli2), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 12));
    checks
}

fn marching<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    samples: u64,
    (teeth, shape): (u32, CombShape),
    stop_probability: f64,
    segments: u32,
) -> Check {
    let comb = Comb::new(teeth, shape).expect(LAWFUL);
    let roulette = Roulette::new(stop_probability).expect(LAWFUL);
    let estimator = UnbiasedRayMarching::new(comb, roulette).in_segments(segments).expect(LAWFUL);
    add(specimen, name, Law::Transmittance, samples, move |specimen, run| {
        specimen.examine_in_lanes(&estimator, &[], |_| Scores::Unbounded, |_| lookups_of(&estimator), run)
    })
    .about([KIND.name])
}

/// The look-ups of an estimate: those that combs share, and the teeth of 1 + N combs in each segment, N the order of its roulette.
fn lookups_of(estimator: &UnbiasedRayMarching) -> LookupLaw {
    let (comb, roulette) = (estimator.comb(), estimator.roulette());
    let teeth = f64::from(comb.teeth());
    let powers = |x: f64| -> [f64; HIGHEST_MOMENT] { std::array::from_fn(|i| x.powi(i as i32 + 1)) };
    let mut segment = [0.0; HIGHEST_MOMENT];
    // P(N ≥ 40) = P 2^39/40! < 1e-36.
    for order in 0..40_u32 {
        let probability = roulette.reached(order) - roulette.reached(order + 1);
        let moments = powers(teeth * f64::from(1 + order));
        segment.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += probability * moment);
    }
    let shared = powers(comb.shared_lookups(estimator.segments()));
    LookupLaw::Moments((0..estimator.segments()).fold(shared, |whole, _| lookups::sum(&whole, &segment)))
}

/// Check of the roulette that a thousand earlier estimates have tuned.
fn tuned<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    samples: u64,
    (teeth, shape): (u32, CombShape),
) -> Check {
    let estimator = UnbiasedRayMarching::new(Comb::new(teeth, shape).expect(LAWFUL), Roulette::KETTUNEN);
    add(specimen, "comb_tuned", Law::Transmittance, samples, move |specimen, run| {
        let (mut earlier, mut source) = (RunningCumulant::new(), Seeded::new(derive_seed(run.seed, 1 << 40)));
        for _ in 0..1000 {
            estimator.estimate_and_observe(&specimen.field, &mut source, &mut earlier);
        }
        // One in ten goes on: none of a thousand with a probability of 0.9^1000 = 1.7e-46.
        let Some(k2) = earlier.value() else {
            return CheckResult::exact(false, "no estimate of a thousand had a second comb");
        };
        let estimator = estimator.with_roulette(Roulette::tuned(k2));
        specimen.examine_in_lanes(&estimator, &[], |_| Scores::Unbounded, |_| lookups_of(&estimator), run)
    })
    .about([KIND.name])
}

fn subjects() -> Vec<Subject> {
    vec![
        estimator!("whole", above: true, below: true, |_| UnbiasedRayMarching::new(four_teeth(), Roulette::KETTUNEN)),
        estimator!("in segments", above: true, below: true, |_| {
            UnbiasedRayMarching::new(four_teeth(), Roulette::KETTUNEN).in_segments(4).expect(LAWFUL)
        }),
    ]
}

/// A comb for the profiles of hard cases.
pub(super) fn four_teeth() -> Comb {
    Comb::new(4, CombShape::EndpointMatched).expect(LAWFUL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_of_look_ups_has_the_expected_number_as_its_mean() {
        for (shape, segments) in [(CombShape::Uniform, 1), (CombShape::EndpointMatched, 4)] {
            let comb = Comb::new(3, shape).unwrap();
            let estimator = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN).in_segments(segments).unwrap();
            let LookupLaw::Moments(raw) = lookups_of(&estimator) else { panic!("known in full") };
            assert!((raw[0] / estimator.expected_lookups() - 1.0).abs() < 1e-12, "{raw:?}");
        }
    }
}
