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
const REPLICAS: usize = 48;
/// Estimates of a mean.
const SAMPLES: [u64; 6] = [1, 4, 16, 64, 256, 1024];
/// A progressive majorant begins with this share of the majorant.
const GUESS: f64 = 0.1;

pub(super) fn steps() -> u64 {
    2 * 10
}

pub(super) fn study(run: &Run<'_>) -> Result<Section, Failure> {
    let smooth = seed_ray::ray(run)?;
    let profile = AnyProfile::PiecewiseConstant(rough_profile(&mut Seeded::new(
        run.seed("convergence/the rough ray"),
    ))?);
    let truth = Truth::of(&profile, Tolerance::TIGHT)?;
    let rough = TestRay { profile, truth, majorant: 1.0 };
    let text = format!(
        "Root mean squared error over T of means of 1 to {} estimates, over {REPLICAS} independent means each, with 95 % intervals. Unbiased \
         estimators fall like one over the square root; biased ones stop at their bias; a progressive majorant, which begins at {GUESS} of the \
         majorant, is consistent: it falls all the same. Costs are those of all estimates of a mean together; pilots are not charged.",
        SAMPLES[SAMPLES.len() - 1]
    );
    let smooth = charts(run, ("smooth", "the seed ray", &smooth))?;
    let rough = charts(run, ("rough", "a rough ray", &rough))?;
    Ok(Section::new("convergence", "Error against cost").with(text).with_all(smooth).with_all(rough))
}

fn players(ray: &TestRay, seed: u64) -> Result<Vec<(&'static str, Prepared)>, Failure> {
    let build = |spec: EstimatorSpec| spec.kind().prepare(&ray.profile);
    let depth = ray.majorant * ray.profile.length();
    let marching = |shape| build(UnbiasedRayMarchingSpec::of(shape, 1).by_the_rule(depth).into());
    let facts = facts_of(ray, seed);
    let half = |teeth: u32| (teeth / 2).max(1);
    let rule = fairflight_transmittance::teeth_for(depth);
    let telescoping =
        TelescopingSpec { teeth: depth.round() as u32, level_ratio: 0.65, endpoint_matching: false };
    let progressive = ProgressiveMajorantSpec { start: GUESS * ray.majorant };
    Ok(vec![
        ("hybrid", Prepared::hybrid(&facts.experience, &ray.profile, ray.majorant, Hybrid::USUAL_BUDGET)?),
        ("unbiased ray marching, matched", marching(CombShape::EndpointMatched)?),
        ("unbiased ray marching", marching(CombShape::Uniform)?),
        ("telescoping", build(telescoping.into())?),
        ("jittered ratio, 0.25", build(JitteredRatioSpec::below(ray.majorant, 0.25).into())?),
        ("ratio tracking", build(DoubleParticleSpec::at(ray.majorant, ControlSpec::none()).into())?),
        ("track length", build(WoodcockSpec { majorant: ray.majorant }.into())?),
        ("jackknife (biased)", build(JackknifeSpec { teeth: half(rule) }.into())?),
        ("naive (biased)", build(NaiveSpec { teeth: half(rule) }.into())?),
        ("progressive majorant (biased)", build(progressive.into())?),
    ])
}

fn charts(run: &Run<'_>, (id, name, ray): (&str, &str, &TestRay)) -> Result<[Chart; 2], Failure> {
    let facts = run.seed(format_args!("convergence/{id}/facts"));
    let (mut by_lookups, mut by_seconds) = (Vec::new(), Vec::new());
    for (e, (label, _)) in players(ray, facts)?.into_iter().enumerate() {
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for &samples in &SAMPLES {
            let seed = run.seed(format_args!("convergence/{id}/{label}/{samples}"));
            let means = try_in_parallel(REPLICAS, &|replica| {
                // An estimator of its own: one that learns begins anew.
                let seed = named_seed(seed, &format!("replica {replica}"));
                let (_, estimator) = players(ray, named_seed(seed, "facts"))?.swap_remove(e);
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
