//! Trying a twin: judged as the estimator that it pretends to be.

use super::Rejection;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::check_estimates;
use fairflight_laws::{Expectation, Run, Truth, Unit};
use fairflight_media::OpticalThickness;
use fairflight_stats::Scores;
pub(crate) use fairflight_transmittance::theory_on;
use fairflight_transmittance::{Theory, TransmittanceEstimator};

/// A profile or parameter of a twin that is not lawful would be a bug of its own.
pub(crate) const LAWFUL: &str = "the twins' profiles are lawful";

/// Judges `twin` by the law and the `theory` of its right sibling. Nothing is said of its scores, so that only the numbers
/// give it away.
pub(crate) fn judged<F: OpticalThickness, E: for<'f> TransmittanceEstimator<&'f F>>(
    field: &F,
    twin: &E,
    theory: Theory,
    run: Run,
) -> Rejection {
    judged_with_scores(field, twin, (theory, |_| Scores::Unbounded), run)
}

/// Judges as [`judged`], with the scores that the estimator can have for a transmittance.
pub(crate) fn judged_with_scores<F: OpticalThickness, E: for<'f> TransmittanceEstimator<&'f F>>(
    field: &F,
    twin: &E,
    (theory, scores): (Theory, fn(Unit) -> Scores),
    run: Run,
) -> Rejection {
    let truth = Truth::closed_form(field);
    let scores = scores(Unit::of(truth.optical_thickness));
    let expected = Expectation { truth, theory, scores, lookups: LookupLaw::MeanOnly };
    match check_estimates(field, twin, &expected, run) {
        Ok(verdict) => Rejection { variance_z: verdict.variance_z, ..Rejection::of_mean(verdict) },
        Err(error) => Rejection::exact(true, error.to_string()),
    }
}
