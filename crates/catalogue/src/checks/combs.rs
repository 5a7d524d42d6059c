//! The estimators made of combs, on a profile of each kind that they tell apart: kinks, smoothness, signs and noise.

use super::estimators::add;
use super::media::{LAWFUL, analytic_cosine};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_freeflight::HIGHEST_MOMENT;
use fairflight_laws::CheckResult;
use fairflight_laws::lookups::{self, LookupLaw};
use fairflight_media::{PiecewiseConstant, PiecewiseLinear};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Scores;
use fairflight_transmittance::{
    Comb, CombShape, Jackknife, Roulette, RunningCumulant, Telescoping, UnbiasedRayMarching,
};
use glam::DVec3;
use std::sync::Arc;

/// Samples of a quick run: of a roulette that goes on once in ten, of one that does every other time, of several segments, and of
/// levels. The look-ups of roulettes have closed moments; those of geometric levels double with each: their skewness is infinite at
/// the ratios in use, and no N tests them. The shape of the estimates is that of the sample, which asks for what is left.
const RARE: u64 = 300_000;
const FREQUENT: u64 = 160_000;
const SEGMENTS: u64 = 80_000;
const LEVELS: u64 = 250_000;
/// Combs that resolve their profile have next to no variance.
const RESOLVED: u64 = 60_000;

/// Checks of combs, for the catalogue.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = Vec::new();

    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_linear", tent));
    for (name, shape) in [
        ("comb_uniform", CombShape::Uniform),
        ("comb_endpoint_matched", CombShape::EndpointMatched),
        ("comb_bernoulli_2", CombShape::Bernoulli2),
        ("comb_bernoulli_3", CombShape::Bernoulli3),
        ("comb_periodised", CombShape::Periodised),
    ] {
        checks.push(marching(&specimen, name, FREQUENT, (2, shape), 0.5, 1));
    }
    let matched = |teeth: u32| (teeth, CombShape::EndpointMatched);
    checks.push(marching(&specimen, "comb_segments_matched", SEGMENTS, matched(1), 0.5, 4));
    checks.push(marching(&specimen, "comb_kettunen", RARE, (3, CombShape::Uniform), 0.9, 1));
    checks.push(tuned(&specimen, RARE, (2, CombShape::Uniform)));
    checks.extend(telescoping(&specimen, LEVELS, 2, Telescoping::matched_ratio(4.0)));
    checks.push(jackknife(&specimen, 2));

    let specimen = Arc::new(Specimen::closed("eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (15, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_endpoint_matched", RESOLVED, matched(25), 0.5, 1));
    checks.push(marching(&specimen, "comb_bernoulli_3", RESOLVED, (25, CombShape::Bernoulli3), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments_matched", RESOLVED, matched(5), 0.5, 5));
    // The difference of level k falls like 4^−k and is divided by its probability r (1 − r)^k: with r = 3/4 no level stands out, and
    // skewness and kurtosis exist. (With 0.9 they do not, and one estimate of a high level makes a run untestable.)
    checks.extend(telescoping(&specimen, RESOLVED, 20, 0.75));
    checks.push(jackknife(&specimen, 8));

    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_constant_negative", signed));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (3, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 5));
    checks.extend(telescoping(&specimen, 2 * LEVELS, 3, 0.75));

    let specimen = Arc::new(Specimen::closed("rough_cells", rough_cells()));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (12, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_bernoulli_2", FREQUENT, (12, CombShape::Bernoulli2), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 12));
    checks.extend(telescoping(&specimen, LEVELS, 12, Telescoping::matched_ratio(2.0)));
    checks.push(jackknife(&specimen, 12));
    checks
}

/// Sixty cells of a twentieth each, of values that follow no pattern: nothing that a dozen teeth resolve.
fn rough_cells() -> PiecewiseConstant {
    const CELLS: u32 = 60;
    let edges = (0..=CELLS).map(|i| f64::from(i) / 20.0).collect();
    // Multiples of a prime: three-digit noise.
    let values = (0..CELLS).map(|i| f64::from((i * i * 379 + i * 811) % 997) / 700.0).collect();
    PiecewiseConstant::new(edges, values).expect(LAWFUL)
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
        specimen.examine(&estimator, &[], |_| Scores::Unbounded, lookups_of(&estimator), run)
    })
    .about(["unbiased_ray_marching"])
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
        specimen.examine(&estimator, &[], |_| Scores::Unbounded, lookups_of(&estimator), run)
    })
    .about(["unbiased_ray_marching"])
}

/// Checks of telescoping combs without and with endpoint matching.
fn telescoping<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    samples: u64,
    teeth: u32,
    ratio: f64,
) -> [Check; 2] {
    [("telescoping", CombShape::Uniform), ("telescoping_matched", CombShape::EndpointMatched)].map(
        |(name, shape)| {
            let estimator = Telescoping::new(teeth, ratio, shape).expect(LAWFUL);
            add(specimen, name, Law::Transmittance, samples, move |specimen, run| {
                specimen.examine(&estimator, &[], |_| Scores::Unbounded, LookupLaw::Unknown, run)
            })
            .about(["telescoping"])
        },
    )
}

/// The baseline: its own expectation.
fn jackknife<F: SpecimenField>(specimen: &Arc<Specimen<F>>, teeth: u32) -> Check {
    let comb = Comb::new(teeth, CombShape::Uniform).expect(LAWFUL);
    add(specimen, "jackknife", Law::OwnExpectation, LEVELS, move |specimen, run| {
        let jackknife = Jackknife::new(comb);
        let result = specimen.examine(&jackknife, &[], |_| Scores::Unbounded, LookupLaw::Fixed, run);
        specimen.baseline(&jackknife, result)
    })
    .about(["jackknife"])
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
