//! Error against cost: what a budget of look-ups or of seconds buys.

use super::seed_ray;
use super::sets::rough_profile;
use crate::Failure;
use crate::comparison::{TestRay, facts_of};
use crate::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, JackknifeSpec, JitteredRatioSpec, NaiveSpec, Prepared,
    ProgressiveMajorantSpec, TelescopingSpec, UnbiasedRayMarchingSpec, WoodcockSpec,
};
use crate::experiment::draw;
use crate::field::AnyProfile;
use crate::reference::Truth;
use crate::report::document::{Axis, Chart, Curve, Mark, Section};
use crate::report::run::Run;
use fairflight_media::Tolerance;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_transmittance::{CombShape, Hybrid};
use rayon::prelude::*;

/// The part of the report, for its seeds.
const PART: u64 = 4;
/// Independent means per point.
const REPLICAS: u64 = 48;
/// Estimates of a mean.
const SAMPLES: [u64; 6] = [1, 4, 16, 64, 256, 1024];
/// A progressive majorant begins with this share of the majorant.
const GUESS: f64 = 0.1;

pub(super) fn steps() -> u64 {
    2 * 10
}

pub(super) fn study(run: &Run<'_>) -> Result<Section, Failure> {
    let smooth = seed_ray::ray(run)?;
    let profile = AnyProfile::PiecewiseConstant(rough_profile(&mut Seeded::new(run.seed(PART, 0)))?);
    let truth = Truth::of(&profile, Tolerance::TIGHT)?;
    let rough = TestRay { profile, truth, majorant: 1.0 };
    let mut section = Section::new("convergence", "Error against cost");
    section.text = vec![format!(
        "Root mean squared error over T of means of 1 to {} estimates, over {REPLICAS} independent means each, with 95 % intervals. Unbiased \
         estimators fall like one over the square root; biased ones stop at their bias; a progressive majorant, which begins at {GUESS} of the \
         majorant, is consistent: it falls all the same. Costs are those of all estimates of a mean together; pilots are not charged.",
        SAMPLES[SAMPLES.len() - 1]
    )];
    for (k, (id, name, ray)) in
        (1..).zip([("smooth", "the seed ray", &smooth), ("rough", "a rough ray", &rough)])
    {
        section.charts.extend(charts(run, (id, name, ray), k)?);
    }
    Ok(section)
}

fn players(ray: &TestRay, seed: u64) -> Result<Vec<(&'static str, Prepared)>, Failure> {
    let build = |spec: EstimatorSpec| spec.kind().prepare(&ray.profile);
    let depth = ray.majorant * ray.profile.length();
    let marching = |shape| build(UnbiasedRayMarchingSpec::of(shape, 1).by_the_rule(depth).into());
    let facts = facts_of(ray, seed);
    let half = |teeth: u32| (teeth / 2).max(1);
    let rule = fairflight_transmittance::teeth_for(depth);
    Ok(vec![
        ("hybrid", Prepared::hybrid(&facts.experience, &ray.profile, ray.majorant, Hybrid::USUAL_BUDGET)?),
        ("unbiased ray marching, matched", marching(CombShape::EndpointMatched)?),
        ("unbiased ray marching", marching(CombShape::Uniform)?),
        (
            "telescoping",
            build(
                TelescopingSpec { teeth: depth.round() as u32, level_ratio: 0.65, endpoint_matching: false }
                    .into(),
            )?,
        ),
        ("jittered ratio, 0.25", build(JitteredRatioSpec::below(ray.majorant, 0.25).into())?),
        ("ratio tracking", build(DoubleParticleSpec::at(ray.majorant, ControlSpec::none()).into())?),
        ("track length", build(WoodcockSpec { majorant: ray.majorant }.into())?),
        ("jackknife (biased)", build(JackknifeSpec { teeth: half(rule) }.into())?),
        ("naive (biased)", build(NaiveSpec { teeth: half(rule) }.into())?),
        (
            "progressive majorant (biased)",
            build(ProgressiveMajorantSpec { start: GUESS * ray.majorant }.into())?,
        ),
    ])
}

fn charts(run: &Run<'_>, (id, name, ray): (&str, &str, &TestRay), k: u64) -> Result<[Chart; 2], Failure> {
    let seed = run.seed(PART, k);
    let (mut by_lookups, mut by_seconds) = (Vec::new(), Vec::new());
    for (e, (label, _)) in (0..).zip(players(ray, seed)?) {
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for (i, &samples) in (0..).zip(&SAMPLES) {
            let means: Result<Vec<[f64; 3]>, Failure> = (0..REPLICAS)
                .into_par_iter()
                .map(|replica| {
                    // An estimator of its own: one that learns begins anew.
                    let seed = derive_seed(derive_seed(derive_seed(seed, e), i), replica);
                    let (_, estimator) = players(ray, seed)?.swap_remove(e as usize);
                    let measured =
                        draw(&ray.profile, &estimator, &ray.truth, (samples, seed, samples), &|_| ())?;
                    let mean = measured.moments.mean().unwrap_or(f64::NAN);
                    let error = (mean * ray.truth.optical_thickness.exp() - 1.0).powi(2);
                    Ok([error, measured.lookups_per_sample * samples as f64, measured.seconds])
                })
                .collect();
            let means = means?;
            let average = |of: usize| means.iter().map(|mean| mean[of]).sum::<f64>() / REPLICAS as f64;
            let squared = average(0);
            let deviation = (means.iter().map(|mean| (mean[0] - squared).powi(2)).sum::<f64>()
                / (REPLICAS * (REPLICAS - 1)) as f64)
                .sqrt();
            let interval = [(squared - 1.96 * deviation).max(0.25 * squared), squared + 1.96 * deviation];
            let interval = interval.map(f64::sqrt);
            lookups.push(Mark::measured(average(1).max(1.0), squared.sqrt(), interval));
            seconds.push(Mark::measured(average(2), squared.sqrt(), interval));
        }
        run.advance();
        by_lookups.push(curve(label, lookups));
        by_seconds.push(curve(label, seconds));
    }
    let chart = |by: &str, unit: &str, curves| {
        let mut chart = Chart::new(
            &format!("convergence-{id}-{by}"),
            &format!("Error against {by}: {name}"),
            Axis::logarithmic(&format!("{by} [{unit}]")),
            Axis::logarithmic("RMSE / T [1]").within(1e-7, 1e2),
        );
        chart.curves = curves;
        chart
    };
    Ok([chart("look-ups", "1", by_lookups), chart("seconds", "s", by_seconds)])
}

fn curve(label: &str, marks: Vec<Mark>) -> Curve {
    let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
    Curve::method(label).with_line(line).with_marks(marks)
}
