//! One estimator on one ray.

use super::TestRay;
use crate::Failure;
use crate::experiment::draw;
use crate::plan::AnyEstimator;
use crate::reference::predict;
use fairflight_media::Tolerance;

/// What an estimator did on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bout {
    /// Var/T², in closed form where there is one, else as measured.
    pub relative_variance: f64,
    /// As measured.
    pub measured_variance: f64,
    /// The standard error of the measured one, from its sample's fourth moment.
    pub variance_error: f64,
    /// Whether it is the closed form.
    pub is_closed: bool,
    /// Look-ups of one estimate.
    pub lookups: f64,
    /// CPU seconds of one estimate.
    pub seconds: f64,
    /// E\[estimate\]/T as measured.
    pub relative_mean: f64,
    /// Its standard error, from the variance above.
    pub mean_error: f64,
    /// The share of estimates below zero.
    pub negative: f64,
    /// The greatest estimate over T.
    pub maximum: f64,
    /// The excess kurtosis of the estimates, where it could be measured.
    pub kurtosis: Option<f64>,
    /// Estimates drawn.
    pub samples: u64,
}

/// How thoroughly a bout is fought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Estimates.
    pub samples: u64,
    /// Of how many the look-ups are counted.
    pub counted: u64,
    /// Whether closed forms are evaluated, where there are any and they take no tens of milliseconds.
    pub closed: bool,
}

/// Lets an estimator estimate the transmittance of a ray.
///
/// # Errors
/// If the estimator is not defined on the ray.
pub fn fight(ray: &TestRay, estimator: &AnyEstimator, effort: Effort, seed: u64) -> Result<Bout, Failure> {
    let draws = (effort.samples, seed, effort.counted);
    let measurement = draw(&ray.profile, estimator, &ray.truth, draws, &|_| ())?;
    let moments = measurement.moments.scaled((ray.truth.optical_thickness).exp());
    let samples = moments.count();
    let measured = moments.population_variance().unwrap_or(f64::NAN);
    let costly = matches!(estimator, AnyEstimator::Beyond(beyond) if beyond.closed_form_is_costly());
    let theory = if effort.closed && !costly {
        let tolerance = Tolerance::to(1e-6);
        Some(predict(&ray.profile, estimator, &ray.truth, tolerance)?.theory)
    } else {
        None
    };
    let known = theory.map(|theory| theory.log_relative_variance.exp()).filter(|variance| !variance.is_nan());
    let relative_variance = known.unwrap_or(measured);
    let lookups = theory
        .map(|theory| theory.lookups)
        .filter(|lookups| lookups.is_finite())
        .unwrap_or(measurement.lookups_per_sample)
        + estimator.preparation_lookups() as f64;
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
    })
}
