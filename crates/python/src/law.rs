//! The law of one estimate in closed form.

use crate::profile::Profile;
use crate::spec::{self, exception};
use fairflight_harness::experiment::variance_is_known;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::{Truth, predict};
use fairflight_media::Tolerance;
use pyo3::prelude::*;

/// The law of one estimate: its moments in closed form, up to quadrature along the ray, and the truth that it estimates.
#[pyclass(frozen, get_all, module = "fairflight")]
#[derive(Debug)]
pub(crate) struct Law {
    /// The transmittance exp(-optical_thickness).
    transmittance: f64,
    /// The integral of sigma_t along the profile.
    optical_thickness: f64,
    /// Absolute error of the transmittance: a bound where `doubt` is None, else an estimate from values at nodes.
    error: f64,
    /// Reason why that error is not proved, in words; None where it is. Of a callable nothing is proved.
    doubt: Option<String>,
    /// Mean of one estimate: the transmittance, but for a biased baseline; None where it has no closed form.
    mean: Option<f64>,
    /// Variance of one estimate, possibly infinite; None where it has no closed form.
    variance: Option<f64>,
    /// Natural logarithm of the variance, finite where the variance overflows or underflows; None where there is no variance or no closed form.
    log_variance: Option<f64>,
    /// Central moments of order 2 to 8, None for those without a closed form.
    central: Vec<Option<f64>>,
    /// Expected look-ups of one estimate, preparation included; None where there is no closed form.
    lookups: Option<f64>,
    /// Method by which the variance is known, in words.
    method: String,
}

#[pymethods]
impl Law {
    fn __repr__(&self) -> String {
        let told = |value: Option<f64>| value.map_or_else(|| "None".to_owned(), |value| value.to_string());
        let (mean, variance, lookups) = (told(self.mean), told(self.variance), told(self.lookups));
        format!("<Law: mean {mean}, variance {variance}, {lookups} look-ups>")
    }
}

/// The law of one estimate of an estimator, given as the JSON of its spec, on a profile.
#[pyfunction]
pub(crate) fn moments(py: Python<'_>, profile: &Profile, estimator: &str) -> PyResult<Law> {
    let spec = spec::estimator(estimator).map_err(exception)?;
    profile.asked(py).run(py, |asked| {
        let plan = Plan::on(asked.profile.clone(), spec, 1, 0)?;
        let truth = Truth::of(&plan.profile, Tolerance::TIGHT)?;
        let theory = predict(&plan.profile, &plan.estimator, &truth, Tolerance::TIGHT)?.theory;
        let transmittance = truth.transmittance();
        let is_known = variance_is_known(&theory);
        let central = theory.relative_central.into_iter().zip(2..).map(|(relative, order)| {
            // A moment that is infinite stays so where the transmittance underflows.
            let moment = if relative.is_infinite() { relative } else { relative * transmittance.powi(order) };
            Some(moment).filter(|moment| is_known && !moment.is_nan())
        });
        let log_variance = theory.log_relative_variance - 2.0 * truth.optical_thickness;
        let number = |value: f64| Some(value).filter(|value| !value.is_nan());
        Ok(Law {
            transmittance,
            optical_thickness: truth.optical_thickness,
            error: truth.error(),
            doubt: truth.doubt.map(|(doubt, _)| doubt.to_string()),
            mean: number(theory.relative_mean * transmittance),
            variance: is_known.then(|| log_variance.exp()),
            log_variance: Some(log_variance).filter(|log| is_known && *log != f64::NEG_INFINITY),
            central: central.collect(),
            lookups: number(theory.lookups + plan.estimator.preparation_lookups as f64),
            method: plan.estimator.variance.clone(),
        })
    })
}
