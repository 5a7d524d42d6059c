//! The estimators made of combs, on a profile of each kind that they tell apart: kinks, smoothness, signs and noise.

use super::estimators::add;
use super::media::{LAWFUL, analytic_cosine};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use crate::CheckResult;
use crate::lookups::LookupLaw;
use fairflight_media::{PiecewiseConstant, PiecewiseLinear};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Scores;
use fairflight_transmittance::{
    Comb, CombShape, Jackknife, Roulette, RunningCumulant, Telescoping, UnbiasedRayMarching,
};
use glam::DVec3;
use std::sync::Arc;

/// Samples of a quick run. The look-ups of a roulette that goes on with probability 0.1 have a skewness of 3.1, of
/// which a normal approximation at the level of the catalogue bears 10^6 samples; 0.5 brings it down to 1.1, and
/// several segments further. The look-ups of geometric levels double with each: their skewness is infinite at the
/// ratios in use, and no N tests them.
const RARE: u64 = 1_000_000;
const FREQUENT: u64 = 160_000;
const SEGMENTS: u64 = 80_000;
const LEVELS: u64 = 250_000;

/// All of them.
pub(super) fn combs() -> Vec<Check> {
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
    checks.push(marching(
        &specimen,
        "comb_segments_matched",
        SEGMENTS,
        (1, CombShape::EndpointMatched),
        0.5,
        4,
    ));
    checks.push(marching(&specimen, "comb_kettunen", RARE, (3, CombShape::Uniform), 0.9, 1));
    checks.push(tuned(&specimen, RARE, (2, CombShape::Uniform)));
    checks.extend(telescoping(&specimen, 2, Telescoping::matched_ratio(4.0)));
    checks.push(jackknife(&specimen, 2));

    let specimen = Arc::new(Specimen::closed("eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (15, CombShape::Uniform), 0.5, 1));
    checks.push(marching(
        &specimen,
        "comb_endpoint_matched",
        FREQUENT,
        (25, CombShape::EndpointMatched),
        0.5,
        1,
    ));
    checks.push(marching(&specimen, "comb_bernoulli_3", FREQUENT, (25, CombShape::Bernoulli3), 0.5, 1));
    checks.push(marching(
        &specimen,
        "comb_segments_matched",
        SEGMENTS,
        (5, CombShape::EndpointMatched),
        0.5,
        5,
    ));
    checks.extend(telescoping(&specimen, 20, 0.9));
    checks.push(jackknife(&specimen, 8));

    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_constant_negative", signed));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (3, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 5));
    checks.extend(telescoping(&specimen, 3, 0.8));

    let specimen = Arc::new(Specimen::closed("rough_cells", rough_cells()));
    checks.push(marching(&specimen, "comb_uniform", FREQUENT, (12, CombShape::Uniform), 0.5, 1));
    checks.push(marching(&specimen, "comb_bernoulli_2", FREQUENT, (12, CombShape::Bernoulli2), 0.5, 1));
    checks.push(marching(&specimen, "comb_segments", SEGMENTS, (1, CombShape::Uniform), 0.5, 12));
    checks.extend(telescoping(&specimen, 12, Telescoping::matched_ratio(2.0)));
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
        specimen.examine(&estimator, &[], |_| Scores::Unbounded, LookupLaw::MeanOnly, run)
    })
}

/// With the roulette that a thousand earlier estimates have tuned.
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
        let Some(k2) = earlier.value() else {
            return CheckResult::exact(false, "no estimate of a thousand had a second comb");
        };
        let estimator = estimator.with_roulette(Roulette::tuned(k2));
        specimen.examine(&estimator, &[], |_| Scores::Unbounded, LookupLaw::MeanOnly, run)
    })
}

/// Without and with endpoint matching.
fn telescoping<F: SpecimenField>(specimen: &Arc<Specimen<F>>, teeth: u32, ratio: f64) -> [Check; 2] {
    [("telescoping", CombShape::Uniform), ("telescoping_matched", CombShape::EndpointMatched)].map(
        |(name, shape)| {
            let estimator = Telescoping::new(teeth, ratio, shape).expect(LAWFUL);
            add(specimen, name, Law::Transmittance, LEVELS, move |specimen, run| {
                specimen.examine(&estimator, &[], |_| Scores::Unbounded, LookupLaw::Unknown, run)
            })
        },
    )
}

/// The baseline: its own expectation.
fn jackknife<F: SpecimenField>(specimen: &Arc<Specimen<F>>, teeth: u32) -> Check {
    let comb = Comb::new(teeth, CombShape::Uniform).expect(LAWFUL);
    add(specimen, "jackknife", Law::OwnExpectation, LEVELS, move |specimen, run| {
        specimen.baseline(&Jackknife::new(comb), |_| Scores::Unbounded, LookupLaw::Fixed, run)
    })
}
