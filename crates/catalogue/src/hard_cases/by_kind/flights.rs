//! Every sampler of free flights along a line by its kind.

use super::ends::is_lawful;
use super::profile::Profile;
use super::{Found, Subject};
use crate::hard_cases::LAWFUL;
use fairflight_collision::Version;
use fairflight_freeflight::spectral::DecompositionTracking;
use fairflight_freeflight::{
    ClosedForm, FreeFlight, Inversion, JitteredFlight, Newton, Regular, Tracking, Woodcock,
};
use fairflight_laws::freeflight::{FlightExpectation, ObservedFlight, Weights, check};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{Extinction, RayQuadrature, Tolerance};

/// Makes a subject, as the macro of estimators; `weights` says what is known of the weights of its flights.
macro_rules! flight {
    ($kind:literal, $name:literal, above: $above:literal, below: $below:literal, $weights:expr, |$profile:pat_param| $make:expr) => {
        Subject::new(
            ($kind, $name),
            ($above, $below),
            |profile, run| {
                let $profile = profile;
                law(profile, &$make, $weights, run)
            },
            |profile| {
                let $profile = profile;
                watched(profile, &$make)
            },
            |profile, source| {
                let $profile = profile;
                is_lawful(profile, $make.sample(profile, source))
            },
        )
    };
}

/// Samplers of every kind, several of a kind with versions.
pub(super) fn subjects() -> Vec<Subject> {
    vec![
        flight!("inversion_flight", "inversion", above: true, below: false, Weights::One, |_| Inversion),
        flight!("newton_flight", "newton", above: true, below: false, Weights::One, |_| Newton),
        flight!("regular_flight", "regular", above: true, below: false, Weights::One, |_| Regular),
        flight!("woodcock_flight", "woodcock", above: false, below: false, Weights::One, |profile| {
            Woodcock::new(profile.rates(1.0))
        }),
        flight!("jittered_flight", "jittered", above: false, below: false, Weights::One, |_| {
            JitteredFlight::new(0.5).expect(LAWFUL)
        })
        // Its law of look-ups is one of each stratum.
        .tried_where(|profile| profile.depth() <= 3e3),
        flight!("decomposition_tracking", "decomposition", above: true, below: true, Weights::Any, |profile| {
            DecompositionTracking::new(Version::Adaptive, profile.rates(0.0), profile.rates(1.0))
        }),
        flight!("tracking_flight", "terminating", above: false, below: false, Weights::Any, |profile| {
            Tracking::new(Version::Terminating, profile.rates(1.0))
        }),
        flight!("tracking_flight", "non-terminating", above: true, below: true, Weights::Any, |profile| {
            Tracking::new(Version::NonTerminating, profile.rates(1.0))
        }),
        flight!("tracking_flight", "adaptive", above: true, below: true, Weights::Any, |profile| {
            Tracking::new(Version::Adaptive, profile.rates(1.0))
        }),
    ]
}

/// Look-ups of a flight at most: at the rates of cells where it has some.
fn cost(profile: &Profile) -> f64 {
    profile.depth_in_cells()
}

/// The law of `sampler`: as many flights as it asks for, and as `run` says, within the budget.
fn law<E>(profile: &Profile, sampler: &E, weights: Weights, run: Run) -> Found
where
    E: ClosedForm<Profile>,
    for<'f, 'e> &'e E: FreeFlight<&'f Profile> + FreeFlight<ObservedFlight<&'f Profile, &'e E>>,
{
    let mut quadrature = RayQuadrature::new(profile.clone(), &profile.borders());
    let expected = FlightExpectation::new(&mut quadrature, sampler, weights, Tolerance::TIGHT);
    let samples = super::affordable(expected.sufficient(run).samples, cost(profile));
    let evidence = check(profile, sampler, &expected, Run { samples, ..run });
    let result = CheckResult::of_flights(&evidence);
    Found { result, refused: evidence.err().map(|refusal| refusal.to_string()) }
}

/// Refusals among the look-ups of a hundred flights.
fn watched<E>(profile: &Profile, sampler: &E) -> Found
where
    for<'f, 'e> &'e E: FreeFlight<&'f Profile> + FreeFlight<ObservedFlight<&'f Profile, &'e E>>,
{
    let harmless = Profile::constant(0.5, profile.length(), (0.0, 1.0));
    let mut quadrature = RayQuadrature::new(harmless, &[]);
    // What is expected does not matter: nothing is judged before every look-up was lawful.
    let expected = FlightExpectation::new(&mut quadrature, &Inversion, Weights::Any, Tolerance::TIGHT);
    let evidence = check(profile, sampler, &expected, super::WATCHED);
    Found { result: CheckResult::default(), refused: evidence.err().map(|refusal| refusal.to_string()) }
}
