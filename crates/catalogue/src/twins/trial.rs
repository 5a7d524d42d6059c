//! Trying a twin: judged as the estimator that it pretends to be.

use super::Rejection;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::check_estimates;
use fairflight_laws::{Expectation, Run, Truth, Unit};
use fairflight_media::{Breakpoints, OpticalThickness, RayQuadrature, Tolerance};
use fairflight_stats::Scores;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};

/// A profile or parameter of a twin that is not lawful would be a bug of its own.
pub(super) const LAWFUL: &str = "the twins' profiles are lawful";

/// The theory of the estimator that a twin stands beside.
pub(super) fn theory_of<F: OpticalThickness + Breakpoints, E: for<'f> ClosedForm<&'f F>>(
    field: &F,
    right: &E,
    also: &[f64],
) -> Theory {
    let tau = field.optical_thickness(0.0, field.length());
    right.theory(&mut RayQuadrature::new(field, also), tau, Tolerance::TIGHT)
}

/// Judges `twin` by the law and the `theory` of its right sibling. Nothing is said of its scores, so that only the numbers
/// give it away.
pub(super) fn judged<F: OpticalThickness, E: for<'f> TransmittanceEstimator<&'f F>>(
    field: &F,
    twin: &E,
    theory: Theory,
    run: Run,
) -> Rejection {
    let truth = Truth::closed_form(field);
    let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::MeanOnly };
    match check_estimates(field, twin, &expected, run) {
        Ok(verdict) => Rejection {
            rejected: verdict.sound == Some(false),
            mean_z: verdict.mean_z,
            variance_z: verdict.variance_z,
            reason: verdict.reason,
        },
        Err(error) => Rejection::exact(true, error.to_string()),
    }
}

/// As [`judged`], for an estimator that scores 0 or 1.
pub(super) fn judged_as_coin<F: OpticalThickness, E: for<'f> TransmittanceEstimator<&'f F>>(
    field: &F,
    twin: &E,
    theory: Theory,
    run: Run,
) -> Rejection {
    let truth = Truth::closed_form(field);
    let scores = fairflight_laws::scores::woodcock(Unit::of(truth.optical_thickness));
    let expected = Expectation { truth, theory, scores, lookups: LookupLaw::MeanOnly };
    match check_estimates(field, twin, &expected, run) {
        Ok(verdict) => Rejection {
            rejected: verdict.sound == Some(false),
            mean_z: verdict.mean_z,
            variance_z: None,
            reason: verdict.reason,
        },
        Err(error) => Rejection::exact(true, error.to_string()),
    }
}
