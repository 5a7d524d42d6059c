//! Every sampler of free flights of several wavelengths by its kind: the profile in three tints, each wavelength judged.

use super::profile::Profile;
use super::{Found, Subject};
use crate::hard_cases::LAWFUL;
use fairflight_freeflight::ClosedForm;
use fairflight_freeflight::spectral::{
    AverageScheme, HeroWavelength, MaxScheme, SeparateSolve, SharedDistance, SpectralFlight,
    SpectralFreeFlight, SpectralTracking,
};
use fairflight_laws::freeflight::{FlightExpectation, Weights};
use fairflight_laws::spectral::{ObservedSpectrum, check};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::{Extinction, RayQuadrature, Scaled, Tolerance, Wavelength};
use fairflight_sources::derive_seed;

/// Wavelengths.
const N: usize = 3;

/// σ_t of each over that of the profile.
const TINTS: [f64; N] = [1.0, 0.8, 0.4];

type Tinted = Scaled<Profile, N>;

macro_rules! wavelengths {
    ($kind:literal, $name:literal, above: $above:literal, below: $below:literal, $weights:expr, |$profile:ident| $make:expr) => {
        Subject::new(
            ($kind, $name),
            ($above, $below),
            |$profile, run| law($profile, &$make, $weights, run),
            |$profile| law($profile, &$make, Weights::Any, super::WATCHED),
            |$profile, source| {
                let field = Scaled::new($profile.clone(), TINTS).expect(LAWFUL);
                is_lawful($profile, $make.sample(&field, source))
            },
        )
    };
}

/// Spectral samplers of every kind, several of a kind with schemes.
pub(super) fn subjects() -> Vec<Subject> {
    vec![
        wavelengths!("spectral_tracking", "max scheme", above: true, below: true, Weights::Any, |profile| {
            SpectralTracking::new(MaxScheme, profile.rates(1.0))
        }),
        wavelengths!("spectral_tracking", "average scheme", above: true, below: true, Weights::Any, |profile| {
            SpectralTracking::new(AverageScheme, profile.rates(1.0))
        }),
        wavelengths!("hero_wavelength", "hero wavelength", above: false, below: false, Weights::UpTo(3), |profile| {
            HeroWavelength::new(profile.rates(1.0))
        }),
        wavelengths!("separate_solve", "separate solve", above: false, below: false, Weights::UpTo(3), |profile| {
            SeparateSolve::new(TINTS.map(|tint| profile.rates(tint)))
        }),
        wavelengths!("shared_distance", "shared distance", above: true, below: true, Weights::Any, |profile| {
            SharedDistance::new(profile.rates(1.0))
        }),
    ]
}

/// True if each wavelength has a finite weight, and a collision that counts for one is where matter is.
fn is_lawful(profile: &Profile, flight: SpectralFlight<N>) -> bool {
    (0..N).map(|wavelength| flight.of(wavelength)).all(|flight| {
        let collides = |s: f64| (0.0..=profile.length()).contains(&s) && profile.sigma_t(s) > 0.0;
        flight.weight().is_finite() && flight.distance().is_none_or(collides)
    })
}

/// The law of each wavelength: as many flights as it asks for, and as `run` says, within the budget.
fn law<E>(profile: &Profile, sampler: &E, weights: Weights, run: Run) -> Found
where
    for<'f> E: ClosedForm<Wavelength<&'f Tinted, N>> + SpectralFreeFlight<Tinted, N>,
    for<'f> E: SpectralFreeFlight<ObservedSpectrum<'f, Tinted, E>, N>,
{
    const NAMES: [&str; N] = ["wavelength 0", "wavelength 1", "wavelength 2"];
    let field = Scaled::new(profile.clone(), TINTS).expect(LAWFUL);
    let mut refused = None;
    let results = NAMES.into_iter().enumerate().map(|(index, name)| {
        let wave = Wavelength::new(&field, index).expect(LAWFUL);
        let mut quadrature = RayQuadrature::new(wave, &profile.borders());
        let expected = FlightExpectation::new(&mut quadrature, sampler, weights, Tolerance::TIGHT);
        // Some closed forms of look-ups hold within the bounds only.
        let expected = if profile.keeps_its_bounds() { expected } else { expected.uncounted() };
        let seed = derive_seed(run.seed, index as u64);
        let run = expected.sufficient(Run { seed, alpha: run.alpha / N as f64, ..run });
        let run = Run { samples: super::affordable(run.samples, profile.depth_in_cells()), ..run };
        let evidence = check(&field, sampler, index, &expected, run);
        let result = CheckResult::of_flights(&evidence);
        refused = refused.take().or(evidence.err().map(|refusal| refusal.to_string()));
        (name, result)
    });
    let result = CheckResult::of_all(results);
    Found { result, refused }
}
