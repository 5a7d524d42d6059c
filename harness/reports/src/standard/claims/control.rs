//! S8: the best constant control.
//!
//! Criterion: the minimum of the closed-form variance over constant controls lies at the mean of the ray to 1e-3 of it, on
//! every medium; and of the variances measured at 0, 1/2, 1, 3/2 and 2 times the mean that at the mean is not above any
//! other by more than 4 standard errors, and below both outer ones by as many.

use super::case::Case;
use super::{Evidence, SIGMAS, claim};
use crate::standard::Subject;
use crate::standard::laws::SharedLaws;
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::estimator::{ControlSpec, DoubleParticleSpec, EstimatorSpec};
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;

const FACTORS: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];

pub(super) fn s8(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let mut parts = Vec::new();
    let mut at_the_mean = true;
    for subject in evidence.subjects {
        let best = best_control(subject)?;
        at_the_mean &= (best / subject.facts.mean - 1.0).abs() < 1e-3;
        parts.push(format!("{} at {:.5} of a mean of {:.5}", subject.id, best, subject.facts.mean));
    }
    let subject = evidence.analytic();
    let seconds = 2.0 * evidence.effort.claim_seconds;
    let cases = try_in_parallel(FACTORS.len(), &|i| {
        let spec = spec(4.0 * subject.majorant, FACTORS[i] * subject.facts.mean);
        let seed = evidence.seed(format_args!("S8/{}", FACTORS[i]));
        Case::measure(&subject.profile, spec, seed, seconds, subject.lookup_nanoseconds)
    })?;
    let at_mean = &cases[2];
    let separation = |case: &Case| (case.measured - at_mean.measured) / case.error.hypot(at_mean.error);
    let not_above = cases.iter().enumerate().all(|(i, case)| i == 2 || separation(case) > -SIGMAS);
    let shown = separation(&cases[0]) > SIGMAS && separation(&cases[4]) > SIGMAS;
    let measured: Vec<String> =
        FACTORS.iter().zip(&cases).map(|(factor, case)| format!("{factor}: {}", case.text())).collect();
    let verdict = match (at_the_mean && not_above, shown) {
        (true, true) => ClaimVerdict::Holds,
        (true, false) => ClaimVerdict::NotTestable,
        (false, _) => ClaimVerdict::DoesNotHold,
    };
    Ok(claim(
        "S8",
        "The best constant control is the mean of the extinction.",
        format!(
            "Minimum of the closed-form variance over constant controls, at a constant sampling extinction: {}. Var/T² \
             measured on the ray of eq. 21 with sigma_samp = 4 majorants, control in units of the mean: {}.",
            parts.join("; "),
            measured.join(", ")
        ),
        verdict,
        "With a constant sampling extinction and the double particle model. It is an oracle: who knows the mean along the ray \
         knows its transmittance; a mean of the medium or of a neighbouring ray is not the best control of this ray.",
    ))
}

fn spec(sigma_samp: f64, control: f64) -> EstimatorSpec {
    DoubleParticleSpec::at(sigma_samp, ControlSpec::constant(control)).into()
}

/// The constant control of the least closed-form variance: golden-section search of ln(Var/T²) from 0 to 4 times the mean.
fn best_control(subject: &Subject) -> Result<f64, Failure> {
    let laws = SharedLaws::of(subject);
    let log_variance = |control: f64| -> Result<f64, Failure> {
        let plan = Plan::on(subject.profile.clone(), spec(subject.majorant, control), 0, 0)?;
        let prediction = laws.law(subject, &plan.estimator)?;
        Ok(prediction.map_or(f64::INFINITY, |prediction| prediction.theory.log_relative_variance))
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.0, 4.0 * subject.facts.mean);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (log_variance(left)?, log_variance(right)?);
    while high - low > 1e-5 * subject.facts.mean {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = log_variance(left)?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = log_variance(right)?;
        }
    }
    Ok(0.5 * (low + high))
}
