//! The test of a measured variance against its closed form.
//!
//! s^2 is the mean of (x - mu)^2 less (mean - mu)^2 (and times N/(N-1)). The first part is the mean of N independent
//! values, whose standard error and shape come from mu_4, mu_6 and mu_8; the second is below z^2 V/N whenever the mean
//! passes its own test, and is granted.

use crate::approximation::NormalApproximation;
use crate::evidence::p_value_text;
use crate::moments::Moments;
use crate::policy::Outcome;
use crate::reference::{Reference, Scores};

/// Result of the test of the variance.
pub(crate) struct VarianceJudgement {
    pub(crate) outcome: Outcome,
    pub(crate) z: Option<f64>,
    pub(crate) p: Option<f64>,
    pub(crate) reason: String,
}

/// Judges the variance of n >= 1 samples with the measured mean `mean`.
pub(crate) fn judge_variance(
    measured: &Moments,
    reference: &Reference,
    mean: f64,
    level: f64,
) -> VarianceJudgement {
    let without =
        |z: Option<f64>, why: &str| VarianceJudgement { outcome: None, z, p: None, reason: why.to_owned() };
    let Some(measured_variance) = measured.sample_variance() else {
        return without(None, "not tested (a single sample)");
    };
    let Some((moments, variance)) = reference.closed_moments().and_then(|m| Some((m, m.variance()?))) else {
        return without(None, "not tested (no closed form)");
    };
    if variance.is_infinite() {
        return without(None, "not tested (infinite)");
    }
    let is_two_valued = matches!(reference.scores, Scores::TwoValued { .. });
    if !is_two_valued && reference.is_rounding(variance) {
        let agrees = reference.is_rounding(measured_variance);
        let reason = if agrees {
            "vanishes as it should".to_owned()
        } else {
            format!("should vanish and is {measured_variance:.3e}")
        };
        return VarianceJudgement { outcome: Some(agrees), z: None, p: None, reason };
    }

    let n = measured.count() as f64;
    let closed_error = moments.variance_standard_error(n);
    let z = closed_error
        .or_else(|| measured.variance_standard_error())
        .filter(|error| *error > 0.0 && error.is_finite())
        .map(|error| (measured_variance - variance) / error);
    if is_two_valued {
        return without(z, "follows from the mean (two values)");
    }
    let (Some(error), Some(skewness), Some(kurtosis)) =
        (closed_error, moments.squares_skewness(), moments.squares_excess_kurtosis())
    else {
        return without(z, "not tested (moments up to the eighth are not known or not finite)");
    };
    let test = NormalApproximation::for_level(level);
    let needed = test.samples_needed(skewness, kurtosis);
    if n < needed {
        return without(z, &format!("not testable at this N (its own shape needs N = {needed:.2e})"));
    }
    let granted = test.critical_z * test.critical_z * variance / n + allowance(reference, mean, variance);
    let deviation = ((measured_variance - variance).abs() - granted).max(0.0);
    let p = NormalApproximation::p_value(deviation / error);
    let agrees = p > level;
    let verb = if agrees { "agrees with" } else { "differs from" };
    VarianceJudgement {
        outcome: Some(agrees),
        z,
        p: Some(p),
        reason: format!("{verb} its closed form: p = {}, level {level:.1e}", p_value_text(p)),
    }
}

/// Error of a closed-form variance V = E\[X^2\] - mean^2: if the mean has the relative error d, a factor common to all
/// scores has, and V that of its two terms, 2 d (V + mean^2) at most; and their difference is rounded.
fn allowance(reference: &Reference, mean: f64, variance: f64) -> f64 {
    let square = reference.mean * reference.mean;
    let of_reference = if reference.mean == 0.0 {
        0.0
    } else {
        2.0 * reference.error / reference.mean.abs() * (variance + square)
    };
    // Rounding: of V relatively, twice that of the mean; of the two terms by a few units in the last place.
    let relative =
        if reference.mean == 0.0 { 0.0 } else { 2.0 * reference.rounding() / reference.mean.abs() };
    of_reference + relative * variance + 8.0 * f64::EPSILON * square.max(mean * mean)
}
