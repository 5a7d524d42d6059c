//! Short runs judged by the law, for the cases that have no set-up without variance.

use super::Outcome;
use fairflight_collision::CollisionModel;
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::scores::{Interval, Ranged, ratio_range, tracking, weights};
use fairflight_laws::transmittance::check;
use fairflight_laws::{CheckResult, Expectation, Run, Truth, Unit};
use fairflight_media::{
    Breakpoints, InvertOpticalThickness, Majorant, Minorant, OpticalThickness, RayQuadrature, Tolerance,
};
use fairflight_transmittance::{ClosedForm, Tracking};

/// The law of a walk on a profile with a closed form.
pub(super) fn judge_walk<F, M: CollisionModel, C, R>(
    field: &F,
    estimator: &Tracking<M, C, R>,
    run: Run,
) -> Outcome
where
    F: OpticalThickness + Breakpoints + Majorant + Minorant,
    C: OpticalThickness + Breakpoints + Ranged,
    R: InvertOpticalThickness + Breakpoints + Ranged,
{
    let (control, sampling) = (estimator.control(), estimator.sampling());
    let truth = Truth::closed_form(field);
    let unit = Unit::of(truth.optical_thickness);
    let also = [control.breakpoints(), sampling.breakpoints()].concat();
    let mut quadrature = RayQuadrature::new(field, &also);
    let theory = estimator.theory(&mut quadrature, truth.optical_thickness, Tolerance::TIGHT);
    let ratios = ratio_range(Interval::bounds_of(field), control.range(), sampling.range());
    let main = control.optical_thickness(0.0, field.length());
    let survives = ratios.is_some_and(|ratios| weights(estimator.model(), ratios).survives);
    let expected = Expectation {
        truth,
        theory,
        scores: tracking(estimator.model(), ratios, main, unit),
        lookups: if survives { LookupLaw::Poisson } else { LookupLaw::MeanOnly },
    };
    let evidence = check(field, estimator, &expected, expected.sufficient(run));
    let mean = evidence.as_ref().ok().and_then(|evidence| evidence.estimates.mean()).unwrap_or(f64::NAN);
    Outcome::judged(CheckResult::of_evidence(&evidence), mean / unit.scale())
}
