//! Judging a measured mean and variance against a reference: sound, unsound, or not testable at this N.
//!
//! The false alarm alpha of the call is split: alpha/2 for the mean, alpha/2 for the variance (Bonferroni, as the two are
//! dependent). Two-valued samples have one test only, the exact binomial one, which gets all of alpha.
//!
//! A rejection stands wherever the level of a test holds, however weak the test; a sample's own standard error and shape are no such
//! test, since they are blind to values that the sample lacks. An acceptance needs power as well: a test that
//! would have missed a relative bias of [`MAX_DETECTABLE_RELATIVE_BIAS`](crate::MAX_DETECTABLE_RELATIVE_BIAS) accepts nothing, it is not testable.
//! `sound` follows the mean; a variance without a test is named in the reason, one that differs makes the call unsound.
//!
//! Against a reference that is [`Estimated`](crate::Certainty::Estimated) only what was proved of it counts: the mean is rejected
//! if it is against every value that is not excluded, and accepted if the bounds leave the power to. Its closed moments are not used.

use crate::mean_test::judge_mean;
use crate::moments::Moments;
use crate::normal_test::normal_samples;
use crate::reference::{Certainty, Reference, Scores};
use crate::variance_test::judge_variance;
use crate::verdict::{MeanTest, StandardErrorSource, Verdict};

/// Relative tolerance for a sample to be one of its two values, or within its bounds: rounding of long products.
const SCORE_TOLERANCE: f64 = 1e-9;

/// Relative rounding error of a streamed mean, with room: 1e4 roundings of 1e-16.
const MEAN_ROUNDING: f64 = 1e-12;

/// Judges measured moments against a reference, with a false alarm of at most `alpha` for the whole call.
///
/// The absolute error of the reference (and rounding, see [`Reference::allowance`]) is subtracted from the deviation
/// before it is judged, and counts twice in the detectable bias. For a whole family of calls pass
/// [`crate::family::sidak_level`] as alpha, since the adequacy of an approximation depends on the level.
///
/// No samples: not testable. A measured mean that is not finite, or a sample that the scores exclude: unsound.
///
/// ```
/// use fairflight_stats::{Moments, Reference, Scores, judge};
/// let escaped: Moments = (0..100_000).map(|i| f64::from(i % 10 == 0)).collect();
/// let reference = Reference { scores: Scores::TwoValued { high: 1.0 }, ..Reference::exact(0.1) };
/// assert_eq!(judge(&escaped, &reference, 1e-6).sound, Some(true));
/// assert_eq!(judge(&escaped, &Reference { mean: 0.11, ..reference }, 1e-6).sound, Some(false));
/// ```
#[must_use]
pub fn judge(measured: &Moments, reference: &Reference, alpha: f64) -> Verdict {
    debug_assert!(alpha > 0.0 && alpha < 0.5, "a false alarm lies in (0, 1/2), found {alpha}");
    let mut verdict = Verdict {
        mean_z: None,
        variance_z: None,
        mean_p: None,
        variance_p: None,
        detectable_relative_bias: None,
        sound: None,
        reason: "not testable: no samples".to_owned(),
        samples_needed: None,
        normal_samples: f64::INFINITY,
        standard_error_source: StandardErrorSource::Sample,
        mean_test: MeanTest::NotTestable,
    };
    let Some(mean) = measured.mean() else { return verdict };
    let reference = &without_degenerate_scores(*reference);
    if reference.mean.is_nan() || reference.error.is_nan() || reference.error < 0.0 {
        verdict.reason = "not testable: the reference or its error is not a number".to_owned();
        return verdict;
    }
    if let Some(contradiction) = contradiction(measured, reference, mean) {
        verdict.sound = Some(false);
        verdict.reason = contradiction;
        verdict.mean_test = MeanTest::Contradiction;
        return verdict;
    }

    // The z-scores, printed whether or not they are evidence.
    let n = measured.count() as f64;
    let closed = reference.closed_moments();
    let closed_error = closed.and_then(|moments| moments.standard_error(n));
    if closed_error.is_some() {
        verdict.standard_error_source = StandardErrorSource::ClosedForm;
    }
    let is_noise = |error: f64| error <= reference.rounding() / n.sqrt();
    verdict.mean_z = closed_error
        .or_else(|| measured.standard_error())
        .filter(|&error| error > 0.0 && error.is_finite() && !is_noise(error))
        .map(|error| (mean - reference.mean) / error);

    verdict.normal_samples = normal_samples(measured, reference, 0.5 * alpha);

    // The tests.
    let mean_judgement = judge_mean(measured, reference, mean, alpha);
    let variance_judgement = judge_variance(measured, reference, mean, 0.5 * alpha);
    verdict.variance_z = variance_judgement.z;
    verdict.mean_p = mean_judgement.p;
    verdict.variance_p = variance_judgement.p;
    verdict.detectable_relative_bias = mean_judgement.detectable_relative_bias;
    verdict.mean_test = mean_judgement.test;
    verdict.sound =
        if variance_judgement.outcome == Some(false) { Some(false) } else { mean_judgement.outcome };
    if verdict.sound.is_none() {
        verdict.samples_needed = mean_judgement.samples_needed;
    }
    verdict.reason = format!(
        "{}mean {}; variance {}",
        uncertified(reference),
        mean_judgement.reason,
        variance_judgement.reason
    );
    verdict
}

/// Warning about an estimated reference, before anything that follows from it; empty for a certified one.
fn uncertified(reference: &Reference) -> String {
    let Certainty::Estimated { low, high } = reference.certainty else { return String::new() };
    let relative = |bound: f64| if reference.mean == 0.0 { bound } else { bound / reference.mean };
    format!(
        "the reference is not certified: its quadrature may lack features between its nodes, and proved is only a mean between \
         {:.3e} and {:.3e} of it; ",
        relative(low),
        relative(high)
    )
}

/// Two values that are one (a control's transmittance that underflows) leave nothing to count: a constant.
fn without_degenerate_scores(reference: Reference) -> Reference {
    match reference.scores {
        Scores::TwoValued { high: 0.0 } => {
            Reference { scores: Scores::Bounded { minimum: 0.0, maximum: 0.0 }, ..reference }
        }
        _ => reference,
    }
}

/// Contradiction of the sample to the facts of the reference, independently of any statistics; `None` without one.
fn contradiction(measured: &Moments, reference: &Reference, mean: f64) -> Option<String> {
    let (minimum, maximum) = (measured.minimum()?, measured.maximum()?);
    if !mean.is_finite() {
        return Some(format!("the measured mean is {mean}"));
    }
    match reference.scores {
        Scores::TwoValued { high } => {
            // Rounding leaves a zero alone.
            let belongs = |x: f64| x == 0.0 || (x - high).abs() <= SCORE_TOLERANCE * high.abs();
            if let Some(x) = [minimum, maximum].into_iter().find(|&x| !belongs(x)) {
                return Some(format!("a sample of {x:e} is neither 0 nor {high:e}"));
            }
            // Of values between 0 and high, only these two have sum x (high - x) = 0: variance = mean (high - mean).
            let (variance, expected) = (measured.population_variance()?, mean * (high - mean));
            let count = measured.count() as f64 * mean / high;
            let is_count = (count - count.round()).abs() <= 1e-3 + 10.0 * SCORE_TOLERANCE * count;
            let is_two_valued = (variance - expected).abs()
                <= 10.0 * SCORE_TOLERANCE * expected.abs() + MEAN_ROUNDING * high * high;
            (!is_count || !is_two_valued).then(|| {
                format!("the samples are not all 0 or {high:e}: {count} successes, variance {variance:e}")
            })
        }
        Scores::Bounded { minimum: low, maximum: high } => {
            // A bound that is none says nothing of the size of rounding: the mean does.
            let size = |bound: f64| if bound.is_finite() { bound.abs() } else { reference.mean.abs() };
            let tolerance = SCORE_TOLERANCE * size(low).max(size(high));
            let stranger = if minimum < low - tolerance { minimum } else { maximum };
            (stranger < low - tolerance || stranger > high + tolerance)
                .then(|| format!("a sample of {stranger:e} lies outside [{low:e}, {high:e}]"))
        }
        Scores::Unbounded => None,
    }
}
