//! One estimator on one ray.

use super::TestRay;
use crate::Failure;
use crate::estimator::Prepared;
use crate::experiment::draw;
use crate::reference::predict;
use fairflight_media::Tolerance;

/// Result of one estimator on one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bout {
    /// Var/T², in closed form where there is one, else as measured.
    pub relative_variance: f64,
    /// Var/T² as measured.
    pub measured_variance: f64,
    /// Standard error of the measured variance, from its sample's fourth moment.
    pub variance_error: f64,
    /// True if `relative_variance` is the closed form.
    pub is_closed: bool,
    /// Look-ups of one estimate.
    pub lookups: f64,
    /// CPU seconds of one estimate.
    pub seconds: f64,
    /// E\[estimate\]/T as measured.
    pub relative_mean: f64,
    /// Standard error of the mean, from the variance above.
    pub mean_error: f64,
    /// The share of estimates below zero.
    pub negative: f64,
    /// The greatest estimate over T.
    pub maximum: f64,
    /// The excess kurtosis of the estimates, where it could be measured.
    pub kurtosis: Option<f64>,
    /// Estimates drawn.
    pub samples: u64,
    /// True if the transmittance of the ray is certified.
    pub is_certified: bool,
}

impl Bout {
    /// Deviation of the mean from the truth, in standard errors; `None` where there is no error but rounding, the truth is
    /// not certified, or the law is not mild: a heavy tail that was not met shows a mean too small, and a variance too small with it.
    #[must_use]
    pub fn z(&self) -> Option<f64> {
        /// A mean of T is rounded to about this.
        const ROUNDING: f64 = 1e-13;
        /// A kurtosis of this over the number of samples leaves their mean close to normal.
        const MILD: f64 = 0.02;
        let is_mild = self.kurtosis.is_some_and(|kurtosis| kurtosis < MILD * self.samples as f64);
        (is_mild && self.is_certified && self.mean_error > ROUNDING)
            .then(|| (self.relative_mean - 1.0) / self.mean_error)
    }
}

/// The z-scores of many results as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pooled {
    /// Sum of the z-scores over the square root of their number: a standard normal variate if all means are right.
    pub z: f64,
    /// Number of the results.
    pub bouts: usize,
}

impl Pooled {
    /// True if chance explains it, in tables of a hundred rows.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        const CRITICAL: f64 = 6.0;
        self.z.abs() <= CRITICAL
    }
}

/// The pooled z-score of the results whose law is mild.
pub fn pooled<'a>(bouts: impl Iterator<Item = &'a Bout>) -> Pooled {
    let scores: Vec<f64> = bouts.filter_map(Bout::z).collect();
    let z = scores.iter().sum::<f64>() / (scores.len().max(1) as f64).sqrt();
    Pooled { z, bouts: scores.len() }
}

/// Effort of the measurement on a ray: its estimates, and whether closed forms are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Estimates.
    pub samples: u64,
    /// Estimates whose look-ups are counted.
    pub counted: u64,
    /// True if closed forms are evaluated, where there are any and they take no tens of milliseconds.
    pub closed: bool,
}

/// Lets an estimator estimate the transmittance of a ray.
///
/// # Errors
/// If the estimator is not defined on the ray.
pub fn fight(ray: &TestRay, estimator: &Prepared, effort: Effort, seed: u64) -> Result<Bout, Failure> {
    let draws = (effort.samples, seed, effort.counted);
    let measurement = draw(&ray.profile, estimator, &ray.truth, draws, &|_| ())?;
    let moments = measurement.moments.scaled((ray.truth.optical_thickness).exp());
    let samples = moments.count();
    let measured = moments.population_variance().unwrap_or(f64::NAN);
    let theory = if effort.closed && !estimator.closed_form_is_costly {
        let tolerance = Tolerance::to(1e-6);
        Some(predict(&ray.profile, estimator, &ray.truth, tolerance)?.theory)
    } else {
        None
    };
    // An infinite one says that its sum over levels or orders did not converge; what is measured may then be far too small.
    let known =
        theory.map(|theory| theory.log_relative_variance.exp()).filter(|variance| variance.is_finite());
    let relative_variance = known.unwrap_or(measured);
    let lookups = theory
        .map(|theory| theory.lookups)
        .filter(|lookups| lookups.is_finite())
        .unwrap_or(measurement.lookups_per_sample)
        + estimator.preparation_lookups as f64;
    Ok(Bout {
        relative_variance,
        measured_variance: measured,
        variance_error: moments.variance_standard_error().unwrap_or(f64::NAN),
        is_closed: known.is_some(),
        lookups,
        seconds: measurement.seconds / samples as f64,
        relative_mean: moments.mean().unwrap_or(f64::NAN),
        mean_error: (relative_variance / samples as f64).sqrt(),
        negative: measurement.negative as f64 / samples as f64,
        maximum: moments.maximum().unwrap_or(f64::NAN),
        kurtosis: moments.excess_kurtosis(),
        samples,
        is_certified: ray.truth.doubt.is_none(),
    })
}
