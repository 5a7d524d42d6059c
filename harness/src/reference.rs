//! The truth about a planned experiment, before a sample is drawn; and whether the experiment is lawful at all.

use crate::Failure;
use crate::estimator::{AnyPieces, Prepared};
use crate::field::{AnyProfile, Knowledge, ThicknessMethod};
use fairflight_laws::Unit;
use fairflight_media::{Doubt, RayQuadrature, Tolerance, Violation};
use fairflight_stats::Certainty;
use fairflight_transmittance::Theory;

/// The optical thickness of a profile, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// ∫ σ_t ds.
    pub optical_thickness: f64,
    /// Absolute error of the optical thickness: a bound, or an estimate where there is a `doubt`.
    pub thickness_error: f64,
    /// Reason why no bound of the error is proved, and proved bounds of the optical thickness; `None` for what is certified.
    pub doubt: Option<(Doubt, (f64, f64))>,
    /// Method by which the optical thickness is known.
    pub method: ThicknessMethod,
    /// Facts about the profile.
    pub knowledge: Knowledge,
    /// The least and the greatest value of σ_t that was met.
    pub observed: (f64, f64),
}

impl Truth {
    /// exp(−∫ σ_t ds).
    #[must_use]
    pub fn transmittance(&self) -> f64 {
        (-self.optical_thickness).exp()
    }

    /// Certainty of the transmittance, in the unit of a verdict: proved, or estimated.
    #[must_use]
    pub fn certainty(&self, unit: Unit) -> Certainty {
        match self.doubt {
            None => Certainty::Certified,
            Some((_, (low, high))) => Certainty::Estimated { low: unit.exp(-high), high: unit.exp(-low) },
        }
    }

    /// A declared majorant far above all that was met, named for a person, where something may have been missed: only there.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        /// A majorant is hardly ever tight; of this many times the greatest extinction it says that more is expected.
        const FAR_ABOVE: f64 = 4.0;
        let (majorant, seen) = (self.knowledge.upper_bound?, self.observed.1);
        let far = majorant > FAR_ABOVE * seen.max(0.0);
        self.doubt.filter(|_| far).map(|(doubt, _)| {
            format!(
                "the declared majorant {majorant} is far above all that was met of sigma_t, {seen}, and the reference is not \
                 certified: {doubt}"
            )
        })
    }

    /// Absolute error of the transmittance, as far as that of the optical thickness is one.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.transmittance() * self.thickness_error.exp_m1()
    }

    /// The truth about a profile.
    ///
    /// # Errors
    /// If σ_t is not finite somewhere, exceeds the majorant that the profile declares, or cannot be integrated.
    pub fn of(profile: &AnyProfile, tolerance: Tolerance) -> Result<Self, Failure> {
        let field = profile.field();
        let knowledge = field.knowledge();
        let certificate = field.certificate();
        let certified = certificate.filter(|certificate| certificate.doubt().is_none());
        let mut quadrature = RayQuadrature::new(field as AnyPieces<'_>, &[]);
        let bound = knowledge.upper_bound.unwrap_or(f64::INFINITY);
        // A closed form needs the integral of |sigma_t| only, roughly: its rounding is relative to that. A certificate needs nothing: the
        // values at its nodes are looked at alone.
        let is_known = knowledge.optical_thickness.is_some() || certified.is_some();
        let tolerance = if is_known { Tolerance::to(0.1) } else { tolerance };
        let integral = quadrature.integrate(tolerance, |_, sigma_t| [sigma_t, sigma_t.abs()]);
        let mut observed = (f64::INFINITY, f64::NEG_INFINITY);
        for (s, sigma_t) in quadrature.nodes() {
            if !sigma_t.is_finite() {
                return Err(not_finite(profile, s, sigma_t));
            }
            if sigma_t > bound {
                return Err(above_declared(profile, s, sigma_t, bound));
            }
            observed = (observed.0.min(sigma_t), observed.1.max(sigma_t));
        }
        let (optical_thickness, thickness_error) = match (knowledge.optical_thickness, certified) {
            (Some(exact), _) => (exact, CLOSED_FORM_ROUNDING * integral.value[1]),
            (None, Some(certificate)) => (certificate.thickness, certificate.error),
            (None, None) => (integral.value[0], integral.error[0]),
        };
        let doubt = certificate.and_then(|certificate| Some((certificate.doubt()?, certificate.bounds)));
        if !optical_thickness.is_finite() || !thickness_error.is_finite() {
            return Err(Failure::refused(
                "profile: sigma_t cannot be integrated: its optical thickness is not finite",
            ));
        }
        Ok(Truth { optical_thickness, thickness_error, doubt, method: knowledge.method, knowledge, observed })
    }
}

/// Rounding of a closed form, relative to ∫ |σ_t|: a few dozen terms, each rounded a few times.
const CLOSED_FORM_ROUNDING: f64 = 64.0 * f64::EPSILON;

fn not_finite(profile: &AnyProfile, s: f64, sigma_t: f64) -> Failure {
    Failure::refused(format!("profile: sigma_t is {sigma_t} at {}", profile.place(s)))
}

fn above_declared(profile: &AnyProfile, s: f64, sigma_t: f64, bound: f64) -> Failure {
    Failure::refused(format!(
        "profile: sigma_t = {sigma_t} exceeds the declared majorant {bound} at {}",
        profile.place(s)
    ))
}

/// Failure of a look-up that was not lawful, in words.
#[must_use]
pub fn explain(profile: &AnyProfile, estimator: &Prepared, truth: &Truth, violation: Violation) -> Failure {
    let Violation { s, sigma_t } = violation;
    if !sigma_t.is_finite() {
        return not_finite(profile, s, sigma_t);
    }
    if let Some(bound) = truth.knowledge.upper_bound
        && sigma_t > bound
    {
        return above_declared(profile, s, sigma_t, bound);
    }
    let place = profile.place(s);
    estimator.objection(&place, s, sigma_t)
}

/// Law of one estimate on a profile, and the range of σ_t that was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The law of one estimate, in units of T.
    pub theory: Theory,
    /// The range of σ_t that was met while integrating.
    pub observed: (f64, f64),
}

/// The law of `estimator` on `profile`, whose truth is known.
///
/// # Errors
/// If the estimator is not defined somewhere on the profile: a majorant that is none, a version outside its domain, a
/// sampling extinction of zero where it may not be.
pub fn predict(
    profile: &AnyProfile,
    estimator: &Prepared,
    truth: &Truth,
    tolerance: Tolerance,
) -> Result<Prediction, Failure> {
    if let (Some(majorant), Some(maximum)) = (estimator.claimed_majorant, truth.knowledge.maximum)
        && maximum > majorant
        && profile.length() > 0.0
    {
        return Err(Failure::refused(format!(
            "estimator.majorant: {majorant} is none, since sigma_t reaches {maximum}"
        )));
    }
    let mut nodes = RayQuadrature::new(profile.field() as AnyPieces<'_>, &estimator.breakpoints);
    // Before the integrals, so that a bad value is named and not integrated.
    observed(profile, estimator, truth, &nodes)?;
    let theory = estimator.trial.theory(&mut nodes, truth.optical_thickness, tolerance);
    Ok(Prediction { theory, observed: observed(profile, estimator, truth, &nodes)? })
}

/// The range of σ_t that was met, if all of it is lawful.
fn observed(
    profile: &AnyProfile,
    estimator: &Prepared,
    truth: &Truth,
    nodes: &RayQuadrature<AnyPieces<'_>>,
) -> Result<(f64, f64), Failure> {
    let mut observed = truth.observed;
    for (s, sigma_t) in nodes.nodes() {
        if !(sigma_t.is_finite() && estimator.trial.admits(s, sigma_t)) {
            return Err(explain(profile, estimator, truth, Violation { s, sigma_t }));
        }
        observed = (observed.0.min(sigma_t), observed.1.max(sigma_t));
    }
    Ok(observed)
}
