//! The test of a mean: exact binomial, normal where that is adequate, Bernstein's inequality, or none.

use crate::binomial::Binomial;
use crate::binomial_inference::trials_needed;
use crate::evidence::{Evidence, MeanJudgement, relative};
use crate::moments::Moments;
use crate::normal_test::normal;
use crate::policy::{MAX_DETECTABLE_RELATIVE_BIAS, Outcome, POWER};
use crate::reference::{Reference, Scores};
use crate::sample_size::{bernstein_law, bernstein_reach, least_sufficient};
use crate::verdict::MeanTest;

/// Judges the mean of n >= 1 samples. The level is alpha for two-valued samples, which have no other test, else alpha/2.
pub(crate) fn judge_mean(measured: &Moments, reference: &Reference, mean: f64, alpha: f64) -> MeanJudgement {
    let n = measured.count() as f64;
    if let (Scores::TwoValued { high }, Some(p)) = (reference.scores, reference.success_probability()) {
        return binomial(measured.count(), (n * mean / high).round(), p, reference, high, alpha);
    }
    let level = 0.5 * alpha;
    let closed_variance = reference.closed_moments().and_then(|moments| moments.variance);
    if closed_variance.is_some_and(|variance| reference.is_rounding(variance)) {
        return rounding(reference, mean, "the law has no variance", Some(false));
    }
    if closed_variance.is_none()
        && measured.sample_variance().is_some_and(|variance| reference.is_rounding(variance))
    {
        // Samples that agree among themselves but not with the reference prove nothing: a rare large one may be missing.
        let judgement = rounding(reference, mean, "all samples are equal", None);
        if judgement.outcome.is_some() || reference.scores == Scores::Unbounded {
            return judgement;
        }
    }
    let normal = normal(measured, reference, mean, level);
    if normal.test == MeanTest::Normal {
        return normal;
    }
    let Some(bounded) = bernstein(reference, mean, n, level) else { return normal };
    // Whichever test becomes possible first.
    let samples_needed =
        bounded.samples_needed.map(|needed| needed.min(normal.samples_needed.unwrap_or(f64::INFINITY)));
    MeanJudgement { samples_needed, ..bounded }
}

/// Agreement up to the allowance of the reference, where there is no variance to measure a deviation by.
///
/// An allowance as large as the bias that should show accepts nothing.
fn rounding(reference: &Reference, mean: f64, why: &str, otherwise: Outcome) -> MeanJudgement {
    let deviation = (mean - reference.mean).abs();
    let detectable = relative(2.0 * reference.allowance(), reference);
    let outcome = match detectable {
        _ if deviation > reference.allowance() => otherwise,
        Some(detectable) if detectable >= MAX_DETECTABLE_RELATIVE_BIAS => None,
        _ => Some(true),
    };
    let reason = match outcome {
        Some(true) => format!("equals the reference to its error and rounding ({why})"),
        Some(false) => {
            format!("differs from the reference by {deviation:.3e}, more than its error and rounding ({why})")
        }
        None => format!("not testable: {why}, and differs from the reference by {deviation:.3e}"),
    };
    MeanJudgement {
        test: if outcome.is_some() { MeanTest::Rounding } else { MeanTest::NotTestable },
        outcome,
        p: None,
        detectable_relative_bias: detectable.filter(|_| outcome.is_some()),
        samples_needed: None,
        reason,
    }
}

/// The exact test of a number of successes.
///
/// The reference's error widens p to an interval: the p-value is that of the value in it which suits the count best.
fn binomial(n: u64, successes: f64, p: f64, reference: &Reference, high: f64, level: f64) -> MeanJudgement {
    // Unlike sums of weights, counts are exact: what is granted beyond the error is the rounding of p alone.
    let rounding = if p < 1.0 { 4.0 * f64::EPSILON * (1.0 - p.ln()) * p } else { 0.0 };
    let slack = reference.error / high.abs() + if p > 0.0 { rounding } else { 0.0 };
    let fraction = successes / n as f64;
    let closest = fraction.clamp((p - slack).max(0.0), (p + slack).min(1.0));
    let p_value = Binomial::new(n, closest).ok().map(|law| law.two_sided_p_value(successes as u64));
    let detectable = Binomial::new(n, p)
        .ok()
        .and_then(|law| law.detectable_relative_deviation(level, POWER))
        .map(|deviation| deviation + 2.0 * slack / p);
    // An error of the reference that hides the bias leaves less to detect, or nothing.
    let room = MAX_DETECTABLE_RELATIVE_BIAS - 2.0 * slack / p;
    let samples_needed = || if room > 0.0 { trials_needed(p, level, POWER, room) } else { f64::INFINITY };
    Evidence {
        test: MeanTest::Binomial,
        p: p_value,
        level,
        detectable,
        samples_needed: &samples_needed,
        name: "exact binomial",
    }
    .decide()
}

/// Bernstein's inequality for bounded samples.
fn bernstein(reference: &Reference, mean: f64, n: f64, level: f64) -> Option<MeanJudgement> {
    let law = bernstein_law(reference)?;
    let deviation = ((mean - reference.mean).abs() - reference.allowance()).max(0.0);
    let detectable = |n: f64| relative(bernstein_reach(&law, reference, level, n), reference);
    let enough = |n: f64| detectable(n).is_some_and(|d| d < MAX_DETECTABLE_RELATIVE_BIAS);
    Some(
        Evidence {
            test: MeanTest::Bernstein,
            p: Some(law.p_value(deviation, n)),
            level,
            detectable: detectable(n),
            samples_needed: &|| least_sufficient(enough),
            name: "Bernstein bound",
        }
        .decide(),
    )
}
