//! Trying a twin: judged as the estimator that it pretends to be.

use super::Rejection;
use fairflight_freeflight::{Flight, FreeFlight};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::check_estimates;
use fairflight_laws::{Expectation, Run, Truth, Unit};
use fairflight_media::{Breakpoints, Extinction, OpticalThickness};
use fairflight_sources::UniformSource;
use fairflight_stats::Scores;
pub(crate) use fairflight_transmittance::theory_on;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};

/// A profile or parameter of a twin that is not lawful would be a bug of its own.
pub(crate) const LAWFUL: &str = "the twins' profiles are lawful";

/// A profile that states another optical thickness than its own.
pub(crate) struct Misstated<F> {
    pub(crate) field: F,
    /// The optical thickness between two distances that it states.
    pub(crate) thickness: fn(&F, f64, f64) -> f64,
}

impl<F: Extinction> Extinction for Misstated<F> {
    fn sigma_t(&self, s: f64) -> f64 {
        self.field.sigma_t(s)
    }
    fn length(&self) -> f64 {
        self.field.length()
    }
}

impl<F: Extinction> OpticalThickness for Misstated<F> {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        (self.thickness)(&self.field, from, to)
    }
}

impl<F: Breakpoints> Breakpoints for Misstated<F> {
    fn breakpoints(&self) -> Vec<f64> {
        self.field.breakpoints()
    }
}

/// An estimator of transmittance, or a sampler of flights, with one line wrong.
pub(crate) trait Wrong<F, T = f64> {
    /// Draws one estimate, or one flight.
    fn draw(&self, field: &F, source: &mut impl UniformSource) -> T;
}

/// A wrong one among the right ones. It is said to be defined everywhere, so that only its numbers give it away.
pub(crate) struct Pretending<'a, W>(pub(crate) &'a W);

impl<F: Extinction, W: Wrong<F>> TransmittanceEstimator<F> for Pretending<'_, W> {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.0.draw(field, source)
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Extinction, W: Wrong<F, Flight>> FreeFlight<F> for Pretending<'_, W> {
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        self.0.draw(field, source)
    }
    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

/// Judges a `wrong` estimator by the law and the closed forms of the `right` one.
pub(crate) fn judged_as<F, R, W>(right: &R, wrong: &W, field: &F, run: Run) -> Rejection
where
    F: OpticalThickness + Breakpoints,
    R: for<'f> ClosedForm<&'f F>,
    W: for<'f> Wrong<&'f F>,
{
    judged(field, &Pretending(wrong), theory_on(field, right, &[]), run)
}

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
