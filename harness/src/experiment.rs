//! One experiment from its plan to its result: predict, measure, analyse.

use crate::Failure;
use crate::budget::Budget;
use crate::estimator::{Expected, Prepared as PreparedEstimator, Work};
use crate::field::{AnyProfile, MediumLibrary, ThicknessMethod};
use crate::measure::{Draws, Measurement, measure};
use crate::plan::Plan;
use crate::reference::{Prediction, Truth, explain, predict};
use crate::result::{Cost, Efficiency, Estimate, ExperimentResult, Provenance, ReferenceResult};
use crate::spec::Experiment;
use fairflight_laws::Unit;
use fairflight_media::{Tolerance, Violation};
use fairflight_stats::{ClosedMoments, DEFAULT_ALPHA, Reference, Verdict, judge};
use fairflight_transmittance::Theory;

/// An experiment of which all is known that can be known before a sample is drawn.
#[derive(Debug)]
pub struct Prepared {
    plan: Plan,
    truth: Truth,
    prediction: Prediction,
    /// Look-ups that it is expected to make; infinite where nobody can tell.
    pub lookups: f64,
}

impl Prepared {
    /// Prepares an experiment, unless it is expected to make more look-ups than the `budget` allows.
    ///
    /// # Errors
    /// If a file cannot be read, the parts do not fit, or they would take too long.
    pub fn of(experiment: &Experiment, library: &MediumLibrary, budget: Budget) -> Result<Self, Failure> {
        let profile = experiment.profile.kind().build(library)?;
        let work = Work::on(&profile, &experiment.estimator);
        let samples = experiment.samples;
        let check = |each: f64| {
            let (total, length) = (work.total(samples, each), profile.length());
            let by_rate = each > 1.0 || work.preparation > samples as f64;
            let because = if by_rate {
                let preparation = match work.preparation {
                    0.0 => String::new(),
                    lookups => format!(" and {lookups:.3e} before the first"),
                };
                format!(
                    "samples: {samples} of {each:.3e} each{preparation}, over profile.length = {length:e}"
                )
            } else {
                format!("samples: {samples}, each of one at least")
            };
            let key = if by_rate { work.key } else { "samples" };
            budget.check(key, total, &because).map(|()| total)
        };
        // What is known before anything is built costs nothing; else the closed form tells, where there is one.
        check(work.estimate.least())?;
        let plan = Plan::on(profile.clone(), experiment.estimator.clone(), samples, experiment.seed)?;
        let truth = Truth::of(&plan.profile, Tolerance::TIGHT)?;
        let prediction = predict(&plan.profile, &plan.estimator, &truth, Tolerance::TIGHT)?;
        let known = Some(prediction.theory.lookups).filter(|lookups| !lookups.is_nan());
        let lookups = check(match (work.estimate, known) {
            (Expected::Between(..), Some(known)) => known,
            (estimate, _) => estimate.most(),
        })?;
        Ok(Self { plan, truth, prediction, lookups })
    }

    /// The plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The truth about the profile: its optical thickness.
    #[must_use]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Draws the samples, and puts what was measured beside what is known.
    ///
    /// # Errors
    /// If the experiment is refused while it runs.
    pub fn run(
        &self,
        provenance: Provenance,
        advance: &(dyn Fn(u64) + Sync),
    ) -> Result<ExperimentResult, Failure> {
        let Self { plan, truth, prediction, .. } = self;
        let measurement = measure_plan(plan, truth, advance)?;
        Ok(analyse(plan, truth, prediction, &measurement, provenance))
    }
}

/// Draws the samples of a plan.
///
/// # Errors
/// If a look-up is not lawful, or an estimate not finite.
pub fn measure_plan(
    plan: &Plan,
    truth: &Truth,
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Measurement, Failure> {
    let &Plan { ref profile, ref estimator, samples, seed, counted, .. } = plan;
    let draws = Draws { samples, seed, counted, sequential: estimator.is_sequential, in_lanes: true };
    measure(&*estimator.trial, draws, &|violation| explain(profile, estimator, truth, violation), advance)
}

/// Draws `samples` estimates of the transmittance of a profile from `seed`; of `counted` of them the look-ups are counted. One after the other: the times of
/// estimators that are compared are those of the same kind of loop, and not all run in lanes.
///
/// # Errors
/// If a look-up is not lawful, or an estimate not finite.
pub fn draw(
    profile: &AnyProfile,
    estimator: &PreparedEstimator,
    truth: &Truth,
    (samples, seed, counted): (u64, u64, u64),
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Measurement, Failure> {
    let draws = Draws { samples, seed, counted, sequential: estimator.is_sequential, in_lanes: false };
    let place = |violation: Violation| explain(profile, estimator, truth, violation);
    measure(&*estimator.trial, draws, &place, advance)
}

/// Comparison of a measurement with the reference.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The unit of both: T where that can be divided by.
    pub unit: Unit,
    /// The closed moments of one estimate.
    pub closed: ClosedMoments,
    /// Verdict on mean and variance, at the false alarm that was asked for.
    pub verdict: Verdict,
}

/// Judges a measurement, with a false alarm of `alpha`.
#[must_use]
pub fn compare(
    plan: &Plan,
    truth: &Truth,
    prediction: &Prediction,
    measurement: &Measurement,
    alpha: f64,
) -> Comparison {
    let unit = Unit::of(truth.optical_thickness);
    let closed = closed_moments(prediction, unit.exp(-truth.optical_thickness));
    let reference = Reference {
        error: truth.error() * unit.scale(),
        certainty: truth.certainty(unit),
        moments: Some(closed),
        variance_bound: variance_bound(&prediction.theory).filter(|_| closed.mean == 1.0),
        scores: plan.estimator.scores(unit),
        ..Reference::exact(closed.mean)
    };
    let mut verdict = judge(&measurement.moments.scaled(unit.scale()), &reference, alpha);
    if let (None, Some(unreached)) = (verdict.sound, prediction.theory.unreached) {
        verdict.reason.push_str(&format!("; {unreached}"));
    }
    Comparison { unit, closed, verdict }
}

/// Puts what was measured beside what is known.
#[must_use]
pub fn analyse(
    plan: &Plan,
    truth: &Truth,
    prediction: &Prediction,
    measurement: &Measurement,
    provenance: Provenance,
) -> ExperimentResult {
    let Measurement { moments, lookups_per_sample, seconds, .. } = *measurement;
    let n = moments.count() as f64;
    let transmittance = truth.transmittance();
    let theory = &prediction.theory;

    let Comparison { unit, closed, verdict } = compare(plan, truth, prediction, measurement, DEFAULT_ALPHA);

    let known = variance_is_known(theory);
    let scale = |value: f64, power: i32| value / unit.scale().powi(power);
    let mean_error = closed.standard_error(n).map(|e| scale(e, 1)).or_else(|| moments.standard_error());
    let variance_error =
        closed.variance_standard_error(n).map(|e| scale(e, 2)).or_else(|| moments.variance_standard_error());
    let log_variance = 2.0 * -truth.optical_thickness + theory.log_relative_variance;
    let preparation = plan.estimator.preparation_lookups as f64;
    let lookups = lookups_per_sample + preparation;
    let mean = moments.mean().unwrap_or(f64::NAN);
    let efficiency = |cost: f64| {
        let variance = moments.population_variance().filter(|variance| *variance > 0.0 && cost > 0.0)?;
        let bias = mean - transmittance;
        Some(1.0 / ((variance + bias * bias) * cost))
    };
    ExperimentResult {
        estimate: Estimate {
            mean,
            mean_standard_error: mean_error,
            variance: moments.sample_variance(),
            variance_standard_error: variance_error,
            minimum: moments.minimum().unwrap_or(f64::NAN),
            maximum: moments.maximum().unwrap_or(f64::NAN),
        },
        reference: ReferenceResult {
            transmittance,
            optical_thickness: truth.optical_thickness,
            variance: known.then(|| log_variance.exp()),
            log_variance: Some(log_variance).filter(|log| known && *log != f64::NEG_INFINITY),
            error: truth.error(),
            lookups_per_sample: Some(theory.lookups + preparation).filter(|lookups| !lookups.is_nan()),
            method: method(plan, truth, prediction, known),
        },
        cost: Cost { samples: moments.count(), lookups_per_sample: lookups, seconds },
        efficiency: Efficiency { per_lookup: efficiency(lookups), per_second: efficiency(seconds / n) },
        verdict: verdict.into(),
        provenance,
    }
}

/// Relative error beyond which an integral of the variance has not converged: it may well be infinite.
const DIVERGENCE: f64 = 1e-2;

/// True if the closed form of the variance has converged.
#[must_use]
pub fn variance_is_known(theory: &Theory) -> bool {
    // The relative error of a variance of zero is 0/0: no divergence.
    let error = theory.relative_variance_error;
    !theory.log_relative_variance.is_nan() && (error.is_nan() || error <= DIVERGENCE)
}

/// An upper bound of the variance of one estimate, in units of T²: the closed form with the error of its integral, or what else is
/// known.
fn variance_bound(theory: &Theory) -> Option<f64> {
    let bound = if variance_is_known(theory) {
        theory.relative_central[0] * (1.0 + theory.relative_variance_error.max(0.0))
    } else {
        theory.relative_variance_bound
    };
    Some(bound).filter(|bound| bound.is_finite())
}

/// The closed moments in the unit of the verdict: as they are where that is T itself; where T is no number to divide by,
/// only moments of zero are known in it.
fn closed_moments(prediction: &Prediction, mean: f64) -> ClosedMoments {
    if !variance_is_known(&prediction.theory) {
        return ClosedMoments::with_mean(mean);
    }
    let in_units_of_t = mean == 1.0;
    let central =
        prediction.theory.relative_central.map(|moment| (in_units_of_t || moment == 0.0).then_some(moment));
    ClosedMoments::from_central(mean, &central)
}

/// Method by which the reference is known, in words.
fn method(plan: &Plan, truth: &Truth, prediction: &Prediction, known: bool) -> String {
    let thickness = match (truth.method, &truth.doubt) {
        (_, Some((doubt, _))) => &format!("adaptive Gauss-Kronrod quadrature (not certified: {doubt})"),
        (ThicknessMethod::ClosedForm, None) => "closed form (certified)",
        (ThicknessMethod::GaussPerCell, None) => {
            "two-point Gauss-Legendre per voxel cell (exact, thus certified)"
        }
        (ThicknessMethod::Quadrature, None) => {
            "quadrature with a bound of its error on every panel (certified)"
        }
    };
    let variance = &plan.estimator.variance;
    let errors =
        if known { "standard errors: closed-form moments" } else { "standard errors: sample moments" };
    let mut method = format!("optical thickness: {thickness}; {variance}; {errors}");
    if plan.profile.misses() {
        method.push_str("; the ray misses the medium: T = 1");
    }
    if truth.transmittance() == 0.0 {
        method.push_str("; the transmittance underflows to 0 in double precision");
    }
    if let Some(unreached) = prediction.theory.unreached {
        method.push_str(&format!("; {unreached}"));
    }
    if prediction.theory.relative_variance_error > DIVERGENCE {
        method.push_str(
            "; the integral of sigma_diff^2/sigma_samp does not converge: the variance may be infinite",
        );
    }
    method
}
