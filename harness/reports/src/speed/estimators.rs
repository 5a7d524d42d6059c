//! Look-ups of several estimators on the ray of eq. 21, one after the other and in lanes.

use super::in_turn::{Loops, Row};
use super::media::{cosine, ray};
use crate::run::Run;
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_document::Table;
use fairflight_elementary::{InstructionSet, ln};
use fairflight_harness::Failure;
use fairflight_media::{Bounded, Constant, Counted, Extinction, Vacuum};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::lockstep::{Batches, LANES, Lockstep, fill_by};
use fairflight_transmittance::{
    Comb, CombShape, Jackknife, JitteredRatio, Offset, RayMarching, Roulette, Telescoping, Tracking,
    TransmittanceEstimator, UnbiasedRayMarching, Woodcock,
};

/// Look-ups of a loop, about.
const LOOKUPS: f64 = 200_000.0;

pub(super) const STEPS: u64 = 9;

/// The seeds of the lanes.
fn seeds() -> [u64; LANES] {
    std::array::from_fn(|lane| lane as u64)
}

pub(super) fn ratio_tracking(length: f64, sigma_samp: f64) -> Tracking<DoubleParticle, Vacuum, Constant> {
    let albedo = Albedo::new(0.0).expect("absorption only");
    let sampling = Constant::new(sigma_samp, length).expect("finite");
    Tracking::new(DoubleParticle { albedo }, Vacuum::new(length), sampling)
}

/// The sum of so many estimates from the stream of each lane.
fn one_by_one<F: Extinction>(estimator: &impl TransmittanceEstimator<F>, field: &F, each: usize) -> f64 {
    let of_stream = |seed| {
        let mut source = Seeded::new(seed);
        (0..each).map(|_| estimator.estimate(field, &mut source)).sum::<f64>()
    };
    seeds().into_iter().map(of_stream).sum()
}

/// So many look-ups at random places, each with a logarithm.
fn bare<F: Extinction>(field: &F, lookups: u64) -> f64 {
    let mut source = Seeded::new(1);
    let mut sum = 0.0;
    for _ in 0..lookups {
        let u = source.next_uniform();
        sum += field.sigma_t(field.length() * u) + ln(1.0 - u);
    }
    sum
}

/// Times the look-ups of an estimator.
pub(super) fn row<F: Extinction, E: Lockstep<F> + for<'a> TransmittanceEstimator<Counted<&'a F>>>(
    run: &Run<'_>,
    name: impl Into<String>,
    estimator: &E,
    field: &F,
) -> Result<Row, Failure> {
    let lookups_of = |each: usize| {
        let counted = Counted::new(field);
        one_by_one(estimator, &counted, each);
        counted.lookups()
    };
    let each = (LOOKUPS * 4.0 / lookups_of(4) as f64).ceil().max(1.0) as usize;
    let lookups = lookups_of(each);
    let mut estimates = vec![0.0; LANES * each];
    let mut in_lanes = |set: InstructionSet| {
        let mut slices = estimates.chunks_exact_mut(each);
        let mut slices = std::array::from_fn(|_| slices.next().expect("a slice for each lane"));
        fill_by(set, (estimator, field), seeds(), &mut Batches::new(&mut slices, None));
        estimates[0]
    };
    let loops = Loops {
        bare: &mut || bare(field, lookups),
        one_by_one: &mut || one_by_one(estimator, field, each),
        in_lanes: &mut in_lanes,
    };
    Row::of(run, name, (lookups as f64, (LANES * each) as f64), loops)
}

/// Every estimator that has lanes, on the ray of eq. 21.
pub(super) fn study(run: &Run<'_>) -> Result<Vec<Row>, Failure> {
    let field = Bounded::new(ray(cosine()), 1.0).expect("the greatest extinction");
    let length = field.length();
    let model =
        SingleParticle { version: Version::Adaptive, albedo: Albedo::new(0.0).expect("absorption only") };
    let sampling = Constant::new(1.0, length).expect("finite");
    let single = Tracking::new(model, Vacuum::new(length), sampling);
    let comb = Comb::new(20, CombShape::EndpointMatched).expect("teeth");
    let telescoping = Telescoping::new(20, 0.8, CombShape::EndpointMatched).expect("teeth");
    let marching = RayMarching::new(20, Offset::Jittered).expect("steps");
    Ok(vec![
        row(run, "ratio tracking", &ratio_tracking(length, 1.0), &field)?,
        row(run, "ratio tracking, σ_samp = 0.5", &ratio_tracking(length, 0.5), &field)?,
        row(run, "Woodcock tracking", &Woodcock, &field)?,
        row(run, "adaptive single particles", &single, &field)?,
        row(run, "jittered ratio, ε = 1/2", &JitteredRatio::new(0.5).expect("in (0, 1]"), &field)?,
        row(
            run,
            "unbiased ray marching, 20 teeth",
            &UnbiasedRayMarching::new(comb, Roulette::KETTUNEN),
            &field,
        )?,
        row(run, "telescoping, 20 teeth", &telescoping, &field)?,
        row(run, "jackknife, 20 teeth", &Jackknife::new(comb), &field)?,
        row(run, "ray marching, 20 steps (biased)", &marching, &field)?,
    ])
}

pub(super) fn table(rows: &[Row]) -> Table {
    let caption = "The ray of eq. 21 from a point near its axis, majorant 1. Bare parts as above: combs take fewer variates and no logarithm.";
    Row::table(["estimators-table", "A look-up of each estimator", caption], ["look-up", "estimate"], rows)
}
