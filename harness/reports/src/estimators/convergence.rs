//! Error against cost: what a budget of look-ups or of seconds buys.

use super::seed_ray;
use super::sets::rough_profile;
use crate::measured::{Measured, mean_and_error};
use crate::run::Run;
use fairflight_document::{Axis, Chart, Curve, Section};
use fairflight_harness::Failure;
use fairflight_harness::comparison::{TestRay, facts_of};
use fairflight_harness::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, JackknifeSpec, JitteredRatioSpec, NaiveSpec, Prepared,
    ProgressiveMajorantSpec, TelescopingSpec, UnbiasedRayMarchingSpec, WoodcockSpec,
};
use fairflight_harness::experiment::draw;
use fairflight_harness::field::AnyProfile;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::reference::Truth;
use fairflight_media::Tolerance;
use fairflight_sources::{Seeded, named_seed};
use fairflight_transmittance::{CombShape, Hybrid};

/// Independent means per point.
fn replicas(run: &Run<'_>) -> usize {
    run.quick_or(24, 48)
}

/// Estimates of a mean.
const SAMPLES: [u64; 6] = [1, 4, 16, 64, 256, 1024];
/// A progressive majorant begins with this share of the majorant.
const GUESS: f64 = 0.1;

pub(super) fn steps() -> u64 {
    2 * PLAYERS.len() as u64
}

pub(super) fn study(run: &Run<'_>) -> Result<Section, Failure> {
    let smooth = seed_ray::ray(run)?;
    let profile = AnyProfile::PiecewiseConstant(rough_profile(&mut Seeded::new(
        run.seed("convergence/the rough ray"),
    ))?);
    let truth = Truth::of(&profile, Tolerance::TIGHT)?;
    let rough = TestRay { profile, truth, majorant: 1.0 };
    let text = format!(
        "Root mean squared error over T of means of 1 to {} estimates, over {} independent means each, with 95 % intervals. Unbiased \
         estimators fall like one over the square root; biased ones stop at their bias; a progressive majorant, which begins at {GUESS} of the \
         majorant, is consistent: it falls all the same. Costs are those of all estimates of a mean together; pilots are not charged.",
        SAMPLES[SAMPLES.len() - 1],
        replicas(run)
    );
    let smooth = charts(run, ("smooth", "the seed ray", &smooth))?;
    let rough = charts(run, ("rough", "a rough ray", &rough))?;
    Ok(Section::new("convergence", "Error against cost").with(text).with_all(smooth).with_all(rough))
}

/// An estimator for a ray; one that learns takes pilots of this seed.
type Player = fn(&TestRay, u64) -> Result<Prepared, Failure>;

const PLAYERS: [(&str, Player); 10] = [
    ("hybrid", |ray, seed| {
        let experience = facts_of(ray, seed).experience;
        Prepared::hybrid(&experience, &ray.profile, ray.majorant, Hybrid::USUAL_BUDGET)
    }),
    ("unbiased ray marching, matched", |ray, _| marching(ray, CombShape::EndpointMatched)),
    ("unbiased ray marching", |ray, _| marching(ray, CombShape::Uniform)),
    ("telescoping", |ray, _| {
        let teeth = depth(ray).round() as u32;
        build(ray, TelescopingSpec { teeth, level_ratio: 0.65, endpoint_matching: false })
    }),
    ("jittered ratio, 0.25", |ray, _| build(ray, JitteredRatioSpec::below(ray.majorant, 0.25))),
    ("ratio tracking", |ray, _| build(ray, DoubleParticleSpec::at(ray.majorant, ControlSpec::none()))),
    ("track length", |ray, _| build(ray, WoodcockSpec { majorant: ray.majorant })),
    ("jackknife (biased)", |ray, _| build(ray, JackknifeSpec { teeth: half_the_rule(ray) })),
    ("naive (biased)", |ray, _| build(ray, NaiveSpec { teeth: half_the_rule(ray) })),
    ("progressive majorant (biased)", |ray, _| {
        build(ray, ProgressiveMajorantSpec { start: GUESS * ray.majorant })
    }),
];

fn build(ray: &TestRay, spec: impl Into<EstimatorSpec>) -> Result<Prepared, Failure> {
    spec.into().kind().prepare(&ray.profile)
}

fn marching(ray: &TestRay, shape: CombShape) -> Result<Prepared, Failure> {
    build(ray, UnbiasedRayMarchingSpec::of(shape, 1).by_the_rule(depth(ray)))
}

/// The optical thickness of the majorant.
fn depth(ray: &TestRay) -> f64 {
    ray.majorant * ray.profile.length()
}

/// Half of the teeth that unbiased ray marching has, at twice the look-ups per tooth.
fn half_the_rule(ray: &TestRay) -> u32 {
    (fairflight_transmittance::teeth_for(depth(ray)) / 2).max(1)
}

fn charts(run: &Run<'_>, (id, name, ray): (&str, &str, &TestRay)) -> Result<[Chart; 2], Failure> {
    let (mut by_lookups, mut by_seconds) = (Vec::new(), Vec::new());
    for (label, player) in PLAYERS {
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for &samples in &SAMPLES {
            let seed = run.seed(format_args!("convergence/{id}/{label}/{samples}"));
            let means = try_in_parallel(replicas(run), &|replica| {
                // An estimator of its own: one that learns begins anew.
                let seed = named_seed(seed, &format!("replica {replica}"));
                let estimator = player(ray, named_seed(seed, "facts"))?;
                let measured = draw(&ray.profile, &estimator, &ray.truth, (samples, seed, samples), &|_| ())?;
                let mean = measured.moments.mean().unwrap_or(f64::NAN);
                let error = (mean * ray.truth.optical_thickness.exp() - 1.0).powi(2);
                Ok([error, measured.lookups_per_sample * samples as f64, measured.seconds])
            })?;
            let all = |of: usize| means.iter().map(|mean| mean[of]).collect::<Vec<_>>();
            let Measured { value, interval: [low, high] } = Measured::mean(&all(0));
            let rmse = Measured { value, interval: [low.max(0.25 * value), high] }.map(f64::sqrt);
            lookups.push(rmse.mark(mean_and_error(&all(1)).0.max(1.0)));
            seconds.push(rmse.mark(mean_and_error(&all(2)).0));
        }
        run.advance();
        by_lookups.push(Curve::joined(label, lookups));
        by_seconds.push(Curve::joined(label, seconds));
    }
    let chart = |by: &str, unit: &str, curves| {
        Chart::new(
            &format!("convergence-{id}-{by}"),
            &format!("Error against {by}: {name}"),
            Axis::logarithmic(&format!("{by} [{unit}]")),
            Axis::logarithmic("RMSE / T [1]").within(1e-7, 1e2),
        )
        .with_curves(curves)
    };
    Ok([chart("look-ups", "1", by_lookups), chart("seconds", "s", by_seconds)])
}
