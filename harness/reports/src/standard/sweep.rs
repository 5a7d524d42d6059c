//! Variance, cost and efficiency against the sampling extinction: every curve in closed form, some of its points measured.

use super::effort::{COUNTED, samples_to_test};
use super::laws::SharedLaws;
use super::preparation::preparation_seconds;
use super::result::{SweepCurve, SweepMeasurement, SweepPoint};
use super::series::Entry;
use super::{Effort, Run, Subject};
use fairflight_collision::Albedo;
use fairflight_harness::Failure;
use fairflight_harness::experiment::{compare, measure_plan, variance_is_known};
use fairflight_harness::measure::Measurement;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::Prediction;
use fairflight_stats::{ClosedMoments, DEFAULT_ALPHA, MeanTest, NormalApproximation};
use fairflight_transmittance::Theory;
use std::f64::consts::LN_10;

/// The sweep goes from 1/8 of the majorant to 8 times the majorant.
const LEAST_FACTOR: f64 = 0.125;

/// Curves of one subject.
pub(super) fn curves(
    run: &Run<'_>,
    subject: &Subject,
    laws: &SharedLaws,
    entries: &[Entry],
) -> Result<Vec<SweepCurve>, Failure> {
    let effort = Effort::of(run.options.quick);
    let sigmas = sampling_extinctions(subject, &effort);
    let points = try_in_parallel(entries.len() * sigmas.len(), &|task| {
        let (entry, i) = (entries[task / sigmas.len()], task % sigmas.len());
        // Six digits name a point: those of other numbers of points that are the same are not off by a rounding.
        let (name, factor) = (entry.name(), sigmas[i] / subject.majorant);
        let seed = effort
            .measures(i, entry.is_of_the_papers())
            .then(|| run.seed(format_args!("sweep/{}/{name}/{factor:.6}", subject.id)));
        let point = point(&effort, subject, laws, entry, sigmas[i], seed);
        run.advance();
        point
    })?;
    let mut points = points.into_iter();
    let curve = |entry: &Entry| SweepCurve {
        series: entry.series,
        parameters: entry.parameters(),
        albedo: entry.albedo.map(Albedo::get),
        points: points.by_ref().take(sigmas.len()).collect(),
    };
    Ok(entries.iter().map(curve).collect())
}

/// Log-spaced, the majorant of the ray in the middle.
fn sampling_extinctions(subject: &Subject, effort: &Effort) -> Vec<f64> {
    let last = (effort.sweep_points - 1) as f64;
    let factor = |i: usize| LEAST_FACTOR.powf(1.0 - 2.0 * i as f64 / last);
    (0..effort.sweep_points).map(|i| subject.majorant * factor(i)).collect()
}

fn point(
    effort: &Effort,
    subject: &Subject,
    laws: &SharedLaws,
    entry: Entry,
    sigma_samp: f64,
    seed: Option<u64>,
) -> Result<SweepPoint, Failure> {
    let undefined = SweepPoint {
        sigma_samp,
        in_domain: false,
        log10_relative_variance: None,
        lookups: None,
        log10_efficiency_per_lookup: None,
        measured: None,
    };
    let spec = entry.at(subject, sigma_samp);
    let mut plan = Plan::on(subject.profile.clone(), spec, 0, seed.unwrap_or_default())?;
    plan.counted = COUNTED;
    let Some(prediction) = laws.law(subject, &plan.estimator)? else { return Ok(undefined) };
    let lookups = prediction.theory.lookups + plan.estimator.preparation_lookups as f64;
    let log10_mse = log10_relative_mse(&prediction.theory);
    let measured = match seed {
        None => None,
        Some(_) => {
            let walk_nanoseconds = prediction.theory.lookups * subject.lookup_nanoseconds;
            let Effort { point_seconds, testable_seconds, .. } = *effort;
            // The papers' claims are about the variance of their own estimators: for those a test is worth its time.
            let at_most = if entry.is_of_the_papers() { testable_seconds } else { point_seconds };
            plan.samples =
                samples_to_test(point_seconds, at_most, walk_nanoseconds, samples_needed(&prediction.theory));
            Some(measured(&plan, subject, entry.series.is_baseline(), &prediction)?)
        }
    };
    Ok(SweepPoint {
        in_domain: true,
        log10_relative_variance: log10_mse.is_finite().then_some(log10_mse),
        lookups: Some(lookups),
        log10_efficiency_per_lookup: Some(-log10_mse - lookups.log10()).filter(|x| x.is_finite()),
        measured,
        ..undefined
    })
}

/// Samples that it takes to test the variance; infinite where no number does.
pub(super) fn samples_needed(theory: &Theory) -> f64 {
    if !variance_is_known(theory) {
        return f64::INFINITY;
    }
    let closed = closed_moments(theory);
    // Half of the false alarm is the variance's.
    let test = NormalApproximation::for_level(0.5 * DEFAULT_ALPHA);
    match (closed.squares_skewness(), closed.squares_excess_kurtosis()) {
        (Some(skewness), Some(kurtosis)) => test.samples_needed(skewness, kurtosis),
        _ => f64::INFINITY,
    }
}

/// log10(Var/T²), and for a baseline log10((Var + bias²)/T²), from logarithms that do not overflow.
pub(super) fn log10_relative_mse(theory: &Theory) -> f64 {
    let bias = theory.relative_mean - 1.0;
    if bias == 0.0 {
        theory.log_relative_variance / LN_10
    } else {
        (theory.log_relative_variance.exp() + bias * bias).log10()
    }
}

/// Draws the samples of a plan, and judges them by the law of one estimate.
pub(super) fn measured(
    plan: &Plan,
    subject: &Subject,
    is_baseline: bool,
    prediction: &Prediction,
) -> Result<SweepMeasurement, Failure> {
    let truth = &subject.truth;
    let measurement = measure_plan(plan, truth, &|_| ()).map_err(|failure| failure.within(subject.id))?;
    let comparison = compare(plan, truth, prediction, &measurement, DEFAULT_ALPHA);
    let Measurement { moments, lookups_per_sample, seconds, .. } = measurement;
    let n = moments.count() as f64;
    let relative = moments.scaled(1.0 / truth.transmittance());
    let relative_mean = relative.mean().unwrap_or(f64::NAN);
    // About the truth for a baseline: the bias is part of its error.
    let (relative_variance, error) = if is_baseline {
        let bias = relative_mean - 1.0;
        let mse = relative.population_variance().unwrap_or(f64::NAN) + bias * bias;
        let error = mse_standard_error(&prediction.theory, n);
        (mse, error.or_else(|| relative.variance_standard_error()))
    } else {
        let error = finite(comparison.closed.variance_standard_error(n));
        (relative.sample_variance().unwrap_or(f64::NAN), error.or_else(|| relative.variance_standard_error()))
    };
    let half_width = 1.96 * error.unwrap_or(f64::NAN);
    let per_estimate = seconds / n + preparation_seconds(subject, &plan.estimator);
    let verdict = comparison.verdict;
    let closed = known_variance(&prediction.theory).map(|_| log10_relative_mse(&prediction.theory));
    let log10_mse = closed.unwrap_or(relative_variance.log10());
    Ok(SweepMeasurement {
        samples: moments.count(),
        relative_mean,
        relative_variance,
        // A variance is not negative, whatever its normal interval says.
        relative_variance_interval: [
            (relative_variance - half_width).max(0.0),
            relative_variance + half_width,
        ],
        // The variance of a coin follows from its mean: where the exact test of that speaks, both are tested.
        testable: verdict.variance_p.is_some()
            || (verdict.mean_test == MeanTest::Binomial && verdict.sound.is_some()),
        mean_z: verdict.mean_z,
        variance_z: verdict.variance_z,
        sound: verdict.sound,
        lookups: lookups_per_sample + plan.estimator.preparation_lookups as f64,
        nanoseconds: 1e9 * per_estimate,
        log10_efficiency_per_second: Some(-log10_mse - per_estimate.log10()).filter(|x| x.is_finite()),
    })
}

/// Var/T² in closed form, if there is one and it is finite.
pub(super) fn known_variance(theory: &Theory) -> Option<f64> {
    Some(theory.log_relative_variance.exp()).filter(|variance| variance.is_finite())
}

fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

/// The standard error of a mean of n squared errors of a biased estimator, in units of T².
fn mse_standard_error(theory: &Theory, n: f64) -> Option<f64> {
    let [second, third, fourth, ..] = theory.relative_central;
    let bias = theory.relative_mean - 1.0;
    let mse = second + bias * bias;
    let fourth = fourth + 4.0 * bias * third + 6.0 * bias * bias * second + bias.powi(4);
    finite(Some(((fourth - mse * mse).max(0.0) / n).sqrt()))
}

/// The closed moments of a theory, in units of T.
fn closed_moments(theory: &Theory) -> ClosedMoments {
    let central = theory.relative_central.map(|moment| Some(moment).filter(|moment| !moment.is_nan()));
    ClosedMoments::from_central(theory.relative_mean, &central)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standard::result::Series;
    use crate::standard::series::of_the_papers;
    use crate::standard::subject;
    use fairflight_harness::experiment::analyse;
    use fairflight_harness::field::MediumLibrary;
    use fairflight_harness::reference::predict;
    use fairflight_harness::result::Provenance;
    use fairflight_media::Tolerance;

    #[test]
    fn a_point_agrees_with_the_experiment_that_it_stands_for() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        let laws = SharedLaws::of(&subject);
        let effort = Effort::of(true);
        let provenance = Provenance { seed: 3, ..Provenance::default() };
        for series in
            [Series::Woodcock, Series::DoubleParticleExplorers, Series::Adaptive, Series::LineIntegral]
        {
            let entry = of_the_papers().into_iter().find(|entry| entry.series == series).unwrap();
            let point = point(&effort, &subject, &laws, entry, 1.5, Some(3)).unwrap();
            let measured = point.measured.unwrap();
            let mut plan =
                Plan::on(subject.profile.clone(), entry.at(&subject, 1.5), measured.samples, 3).unwrap();
            // The same look-ups are counted.
            plan.counted = COUNTED;
            let prediction =
                predict(&plan.profile, &plan.estimator, &subject.truth, Tolerance::TIGHT).unwrap();
            let measurement = measure_plan(&plan, &subject.truth, &|_| ()).unwrap();
            let result = analyse(&plan, &subject.truth, &prediction, &measurement, provenance.clone());
            let t = subject.facts.transmittance;
            let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-8 * b.abs(), "{series:?}: {a} {b}");
            close(measured.relative_mean, result.estimate.mean / t);
            close(measured.relative_variance, result.estimate.variance.unwrap() / (t * t));
            close(measured.lookups, result.cost.lookups_per_sample);
            close(measured.mean_z.unwrap(), result.verdict.mean_z.unwrap());
            close(
                10f64.powf(point.log10_relative_variance.unwrap()),
                result.reference.variance.unwrap() / (t * t),
            );
            close(point.lookups.unwrap(), result.reference.lookups_per_sample.unwrap());
        }
    }

    #[test]
    fn no_samples_are_paid_for_a_variance_that_is_not_known() {
        let subject = subject::perlin(&MediumLibrary::default()).unwrap();
        let laws = SharedLaws::of(&subject);
        let entry = Entry::plain(Series::DoubleParticleExplorers);
        let spec = entry.at(&subject, subject.majorant);
        let plan = Plan::on(subject.profile.clone(), spec, 0, 0).unwrap();
        let theory = laws.law(&subject, &plan.estimator).unwrap().unwrap().theory;
        assert!(laws.is_rough() && samples_needed(&theory).is_infinite());
        let settled = Theory { relative_variance_error: 0.0, ..theory };
        assert!(samples_needed(&settled).is_finite());
    }

    #[test]
    fn a_version_outside_its_domain_leaves_a_gap() {
        let subject = subject::analytic(&MediumLibrary::default()).unwrap();
        let laws = SharedLaws::of(&subject);
        let effort = Effort::of(true);
        for (series, defined) in [
            (Series::Woodcock, false),
            (Series::LineIntegral, false),
            (Series::Terminating, false),
            (Series::NonTerminating, true),
            (Series::DoubleParticle, true),
        ] {
            let entry = of_the_papers().into_iter().find(|entry| entry.series == series).unwrap();
            let point = point(&effort, &subject, &laws, entry, 0.3, None).unwrap();
            assert_eq!((point.in_domain, point.lookups.is_some()), (defined, defined), "{series:?}");
        }
    }
}
