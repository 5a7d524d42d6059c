//! An estimator on a profile of a hard case: its law, and what it refuses.

use crate::hard_cases::{Found, Profile, WATCHED, affordable};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::{Observed, check};
use fairflight_laws::{CheckResult, Expectation, Run, Truth};
use fairflight_media::{RayQuadrature, Tolerance};
use fairflight_stats::Scores;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};

/// One majorant for a spike: row 11.
pub(super) const ONE_MAJORANT: (u32, &str) =
    (11, "one majorant for all of the ray would ask for 1e9 look-ups: a case for rates and bounds in cells");
/// A look-up for each mean free path of one majorant.
pub(super) fn one_lookup_a_mean_free_path(profile: &Profile) -> bool {
    profile.depth() <= 1e7
}

/// An estimator called `name`, which admits σ_t `above` the majorant and `below` 0 as it is stated; a function of the
/// profile makes it. A macro, because no bound says of a type that it is an estimator for every lifetime of an observed field.
macro_rules! estimator {
    ($name:literal, above: $above:literal, below: $below:literal, |$profile:pat_param| $make:expr) => {
        crate::hard_cases::Subject::new(
            ("", $name),
            ($above, $below),
            |profile, run| {
                let $profile = profile;
                crate::estimators::on_profile::law(profile, &$make, run)
            },
            |profile| {
                let $profile = profile;
                crate::estimators::on_profile::watched(profile, &$make)
            },
            |profile, source| {
                let $profile = profile;
                fairflight_transmittance::TransmittanceEstimator::estimate(&$make, profile, source)
                    .is_finite()
            },
        )
    };
}
pub(crate) use estimator;

/// The law of `estimator`: as many estimates as it asks for, and as `run` says, within the budget.
pub(super) fn law<'f, E>(profile: &'f Profile, estimator: &E, run: Run) -> Found
where
    E: ClosedForm<Profile>,
    for<'e> &'e E: TransmittanceEstimator<&'f Profile> + TransmittanceEstimator<Observed<&'f Profile, &'e E>>,
{
    let truth = Truth::closed_form(profile);
    let mut quadrature = RayQuadrature::new(profile.clone(), &profile.borders());
    let theory = estimator.theory(&mut quadrature, truth.optical_thickness, Tolerance::TIGHT);
    let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::Unknown };
    let cost = if theory.lookups.is_finite() { theory.lookups } else { profile.depth() };
    let samples = affordable(expected.sufficient(run).samples, cost);
    let evidence = check(profile, estimator, &expected, Run { samples, ..run });
    Found {
        result: CheckResult::of_evidence(&evidence),
        refused: evidence.err().map(|refusal| refusal.to_string()),
    }
}

/// Refusals among the look-ups of a hundred estimates.
pub(super) fn watched<'f, E>(profile: &'f Profile, estimator: &E) -> Found
where
    for<'e> &'e E: TransmittanceEstimator<&'f Profile> + TransmittanceEstimator<Observed<&'f Profile, &'e E>>,
{
    // What is expected does not matter: nothing is judged before every look-up was lawful.
    let truth = Truth { optical_thickness: 1.0, error: 0.0 };
    let theory = Theory::mean_only(1.0);
    let expected = Expectation { truth, theory, scores: Scores::Unbounded, lookups: LookupLaw::Unknown };
    let evidence = check(profile, estimator, &expected, WATCHED);
    Found { result: CheckResult::default(), refused: evidence.err().map(|refusal| refusal.to_string()) }
}
