//! The z-test of a mean, where N is large enough for the shape of the law and for the bias that should show.

use crate::approximation::{MOST_OF_ONE, NormalApproximation};
use crate::evidence::{MeanJudgement, relative};
use crate::moments::Moments;
use crate::normal::upper_quantile;
use crate::policy::{MAX_DETECTABLE_RELATIVE_BIAS, POWER};
use crate::reference::{Reference, Tails};
use crate::sample_size::for_power;

/// Skewness and excess kurtosis, and the N from which on they let a mean be taken as normal.
struct Shape {
    shape: Option<(f64, f64)>,
    needed: f64,
    origin: &'static str,
}

const OF_THE_LAW: &str = "of the law";

impl Shape {
    /// The shape of the law where all of it is known, else that of the sample, under stricter limits.
    fn of(measured: &Moments, reference: &Reference, test: &NormalApproximation) -> Self {
        let closed =
            reference.closed_moments().and_then(|moments| moments.skewness().zip(moments.excess_kurtosis()));
        if let Some((skewness, kurtosis)) = closed {
            let needed = test.samples_needed(skewness, kurtosis);
            return Self { shape: closed, needed, origin: OF_THE_LAW };
        }
        let sample = measured.skewness().zip(measured.excess_kurtosis());
        let needed = sample.map_or(f64::INFINITY, |(skewness, kurtosis)| {
            test.studentised_samples_needed(skewness, kurtosis)
        });
        Self { shape: sample, needed, origin: if sample.is_some() { "of the sample" } else { "unknown" } }
    }
}

/// The N from which on a normal approximation of the mean holds at `level`, by the shape of the law, or else of the sample.
pub(crate) fn normal_samples(measured: &Moments, reference: &Reference, level: f64) -> f64 {
    Shape::of(measured, reference, &NormalApproximation::for_level(level)).needed
}

/// A z-test for which N suffices.
pub(crate) struct ZTest {
    /// The p-value of the deviation.
    pub(crate) p: f64,
    /// The relative bias that it shows.
    pub(crate) detectable: Option<f64>,
    /// The N that its shape and its power ask for.
    pub(crate) samples_needed: f64,
    /// True if it may reject: variance and shape are those of the law, or its tails are known to be mild, and no single sample makes up
    /// much of the deviation. A sample's own are blind to what that sample lacks: otherwise they agree, and do not reject.
    pub(crate) may_reject: bool,
    /// True if it may reject other samples of this law at this N: what is left of the level is then all that another test has.
    pub(crate) shares_level: bool,
    /// Name of the standard error, in words.
    pub(crate) name: &'static str,
}

/// A variance that is known to this factor: z is then known to half as much, and its tail to exp(z²/2000), 1.014 at z = 5.3.
const EXACT: f64 = 1.001;

/// The z-test, where N is large enough for the shape of the law; else why it is not.
pub(crate) fn z_test(
    measured: &Moments,
    reference: &Reference,
    mean: f64,
    level: f64,
) -> Result<ZTest, MeanJudgement> {
    let (n, closed) = (measured.count() as f64, reference.closed_moments());
    let not_testable = |samples_needed: Option<f64>, why: String| {
        MeanJudgement::not_testable(samples_needed, format!("not testable at N = {n}: {why}"))
    };
    let closed_variance = closed.and_then(|moments| moments.variance());
    let Some(variance) = closed_variance.or_else(|| measured.sample_variance()) else {
        return Err(not_testable(None, "a single sample of a law with unknown variance".to_owned()));
    };
    if variance.is_infinite() {
        return Err(not_testable(Some(f64::INFINITY), "the variance is infinite".to_owned()));
    }

    let test = NormalApproximation::for_level(level);
    let Shape { shape, needed, origin } = Shape::of(measured, reference, &test);
    let closed_shape = shape.filter(|_| origin == OF_THE_LAW);
    let samples_needed = needed.max(for_power(&test, reference, variance, MAX_DETECTABLE_RELATIVE_BIAS));
    if n < needed {
        let Some((skewness, kurtosis)) = shape else {
            return Err(not_testable(None, "the shape of the law is unknown".to_owned()));
        };
        // The shape of a sample says nothing of what that sample has missed: no N can be promised from it.
        let samples_needed = if closed_shape.is_some() { Some(samples_needed) } else { None };
        return Err(not_testable(
            samples_needed,
            format!(
                "skewness^2/N = {:.2e} and excess kurtosis/N = {:.2e} {origin} exceed what a normal approximation \
                 bears at z = {:.2} (with the exact standard error {:.2e} and {:.2e})",
                skewness * skewness / n,
                kurtosis / n,
                test.critical_z,
                test.skewness_limit(),
                test.excess_kurtosis_limit()
            ),
        ));
    }
    let is_of_the_law = closed_variance.is_some() && closed_shape.is_some();
    let is_exact = reference.variance_bound.is_none_or(|bound| bound <= EXACT * variance);
    let shares_level = (is_of_the_law && is_exact) || reference.tails == Tails::Mild;
    let error = (variance / n).sqrt();
    let reach = test.critical_z + upper_quantile(1.0 - POWER);
    let deviation = ((mean - reference.mean).abs() - reference.allowance()).max(0.0);
    let extremes = [measured.minimum(), measured.maximum()];
    let greatest =
        extremes.into_iter().flatten().fold(0.0_f64, |greatest, x| greatest.max((x - reference.mean).abs()));
    Ok(ZTest {
        p: NormalApproximation::p_value(deviation / error),
        detectable: relative(reach * error + 2.0 * reference.allowance(), reference),
        samples_needed,
        may_reject: shares_level && greatest <= MOST_OF_ONE * n * error,
        shares_level,
        name: match (closed_variance.is_some(), closed_shape.is_some()) {
            (true, true) => "z with the closed-form standard error",
            (true, false) => "z with the closed-form standard error, shape from the sample",
            (false, _) => {
                "z with the sample's standard error and shape, blind to events that the sample lacks"
            }
        },
    })
}
