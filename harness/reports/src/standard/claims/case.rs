//! One measured variance beside its closed form.

use crate::standard::effort::{COUNTED, samples_to_test};
use crate::standard::sweep::samples_needed;
use fairflight_collision::{Albedo, Version};
use fairflight_harness::Failure;
use fairflight_harness::estimator::{ControlSpec, EstimatorSpec, SamplingSpec, SingleParticleSpec};
use fairflight_harness::experiment::{compare, measure_plan};
use fairflight_harness::field::AnyProfile;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::{Truth, predict};
use fairflight_media::{Constant, Tolerance};
use fairflight_stats::DEFAULT_ALPHA;

/// Closed form and measurement, in units of T².
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// Var/T² in closed form.
    pub(super) closed: f64,
    /// Var/T² as measured.
    pub(super) measured: f64,
    /// Standard error of that, from the closed form where it is finite.
    pub(super) error: f64,
    /// Expected look-ups of one estimate, explorers included.
    pub(super) lookups: f64,
    pub(super) samples: u64,
    /// True if this N tests the variance; then its verdict.
    pub(super) testable: bool,
    pub(super) sound: Option<bool>,
}

impl Case {
    /// Measures for about `seconds`, a look-up costing `nanoseconds`; for up to four times as long if the variance can then
    /// be tested.
    ///
    /// # Errors
    /// If the estimator is not defined on the profile.
    pub(super) fn measure(
        profile: &AnyProfile,
        spec: EstimatorSpec,
        seed: u64,
        seconds: f64,
        nanoseconds: f64,
    ) -> Result<Self, Failure> {
        let mut plan = Plan::on(profile.clone(), spec, 0, seed)?;
        plan.counted = COUNTED;
        let truth = Truth::of(profile, Tolerance::TIGHT)?;
        let prediction = predict(profile, &plan.estimator, &truth, Tolerance::to(1e-9))?;
        let walk = prediction.theory.lookups * nanoseconds;
        plan.samples = samples_to_test(seconds, 4.0 * seconds, walk, samples_needed(&prediction.theory));
        let measurement = measure_plan(&plan, &truth, &|_| ())?;
        let comparison = compare(&plan, &truth, &prediction, &measurement, DEFAULT_ALPHA);
        let n = plan.samples as f64;
        let relative = measurement.moments.scaled(1.0 / truth.transmittance());
        let error = comparison.closed.variance_standard_error(n).filter(|error| error.is_finite());
        Ok(Self {
            closed: prediction.theory.log_relative_variance.exp(),
            measured: relative.sample_variance().unwrap_or(f64::NAN),
            error: error.or_else(|| relative.variance_standard_error()).unwrap_or(f64::NAN),
            lookups: prediction.theory.lookups + plan.estimator.preparation_lookups as f64,
            samples: plan.samples,
            testable: comparison.verdict.variance_p.is_some(),
            sound: comparison.verdict.sound,
        })
    }

    /// (measured − closed)/standard error.
    pub(super) fn z(&self) -> f64 {
        (self.measured - self.closed) / self.error
    }

    /// "19.1 ± 0.2": with the 95 % half width.
    pub(super) fn text(&self) -> String {
        with_error(self.measured, 1.96 * self.error)
    }
}

/// Var/T² in closed form alone.
///
/// # Errors
/// If the estimator is not defined on the profile.
pub(super) fn closed(profile: &AnyProfile, spec: EstimatorSpec) -> Result<f64, Failure> {
    let plan = Plan::on(profile.clone(), spec, 0, 0)?;
    let truth = Truth::of(profile, Tolerance::TIGHT)?;
    let prediction = predict(profile, &plan.estimator, &truth, Tolerance::to(1e-9))?;
    Ok(prediction.theory.log_relative_variance.exp())
}

/// A number to the digits that its error leaves.
pub(super) fn with_error(value: f64, half_width: f64) -> String {
    if !(half_width > 0.0 && half_width.is_finite()) {
        return format!("{value:.4}");
    }
    let digits = (1.0 - half_width.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$} ± {half_width:.digits$}")
}

/// A version of the single particle model without control.
pub(super) fn single(version: Version, albedo: f64, sigma_samp: f64) -> Result<EstimatorSpec, Failure> {
    let albedo = Albedo::new(albedo).map_err(Failure::refused)?;
    let (sigma_samp, control) = (SamplingSpec::Constant(sigma_samp), ControlSpec::none());
    Ok(SingleParticleSpec { version, albedo, sigma_samp, control }.into())
}

/// A homogeneous profile.
pub(super) fn homogeneous(sigma_t: f64, length: f64) -> Result<AnyProfile, Failure> {
    Ok(AnyProfile::Constant(Constant::new(sigma_t, length).map_err(Failure::refused)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_the_digits_of_their_error() {
        assert_eq!(with_error(19.0855, 0.234), "19.09 ± 0.23");
        assert_eq!(with_error(1234.5, 45.6), "1234 ± 46");
        assert_eq!(with_error(0.5, 0.0), "0.5000");
    }
}
