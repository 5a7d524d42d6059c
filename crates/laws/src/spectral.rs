//! The law of free flight for each wavelength of a sampler that draws one distance for all of them.
//!
//! It is the law of [`crate::freeflight`], wavelength by wavelength: weighted flights integrate any test function against
//! σ_l T_l. Weights of one flight depend on each other, which no test of one wavelength asks.

use crate::Run;
use crate::freeflight::{FlightEvidence, FlightExpectation, FlightRefusal, measure};
use fairflight_freeflight::spectral::SpectralFreeFlight;
use fairflight_media::{SpectralExtinction, SpectralOpticalThickness, Violation};
use std::cell::Cell;

/// A spectral field whose look-ups are counted, and watched for values that a sampler does not admit.
#[derive(Debug)]
pub struct ObservedSpectrum<'a, F, E> {
    field: &'a F,
    sampler: &'a E,
    lookups: Cell<u64>,
    violation: Cell<Option<Violation>>,
}

impl<'a, F, E> ObservedSpectrum<'a, F, E> {
    fn new(field: &'a F, sampler: &'a E) -> Self {
        Self { field, sampler, lookups: Cell::new(0), violation: Cell::new(None) }
    }
}

impl<F: SpectralExtinction<N>, E: SpectralFreeFlight<F, N>, const N: usize> SpectralExtinction<N>
    for ObservedSpectrum<'_, F, E>
{
    fn sigma_t(&self, s: f64) -> [f64; N] {
        self.lookups.set(self.lookups.get() + 1);
        let spectrum = self.field.sigma_t(s);
        let is_finite = spectrum.iter().all(|sigma| sigma.is_finite());
        if !(is_finite && self.sampler.admits(self.field, s, &spectrum)) && self.violation.get().is_none() {
            // The one that is no number, or else the greatest.
            let sigma_t = spectrum.iter().copied().reduce(|a, b| if a > b || a.is_nan() { a } else { b });
            self.violation.set(Some(Violation { s, sigma_t: sigma_t.unwrap_or(f64::NAN) }));
        }
        spectrum
    }
    fn length(&self) -> f64 {
        self.field.length()
    }
}

/// A closed form is no look-up.
impl<F: SpectralOpticalThickness<N>, E: SpectralFreeFlight<F, N>, const N: usize> SpectralOpticalThickness<N>
    for ObservedSpectrum<'_, F, E>
{
    fn optical_thickness(&self, from: f64, to: f64) -> [f64; N] {
        self.field.optical_thickness(from, to)
    }
}

/// Runs `sampler` on `field` and judges its flights for one `wavelength`, of which `expected` is.
///
/// # Errors
/// If a look-up or a flight is not lawful: a law says nothing then.
pub fn check<F: SpectralExtinction<N>, E, const N: usize>(
    field: &F,
    sampler: &E,
    wavelength: usize,
    expected: &FlightExpectation,
    run: Run,
) -> Result<FlightEvidence, FlightRefusal>
where
    E: SpectralFreeFlight<F, N>,
    for<'a> E: SpectralFreeFlight<ObservedSpectrum<'a, F, E>, N>,
{
    let observed = ObservedSpectrum::new(field, sampler);
    let sample = |source: &mut _| sampler.sample(&observed, source).of(wavelength);
    let measured = measure(sample, expected, run, || observed.lookups.get());
    match observed.violation.get() {
        Some(violation) => Err(FlightRefusal::Unlawful(violation)),
        None => Ok(measured?.judged(expected, run)),
    }
}

/// Judges as [`check`], unwatched and uncounted: what a wrong twin is tried with.
///
/// # Errors
/// If a flight is not lawful.
pub fn check_flights<F: SpectralExtinction<N>, E: SpectralFreeFlight<F, N>, const N: usize>(
    field: &F,
    sampler: &E,
    wavelength: usize,
    expected: &FlightExpectation,
    run: Run,
) -> Result<FlightEvidence, FlightRefusal> {
    let uncounted = expected.uncounted();
    let sample = |source: &mut _| sampler.sample(field, source).of(wavelength);
    Ok(measure(sample, &uncounted, run, || 0)?.judged(&uncounted, run))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::freeflight::Weights;
    use fairflight_freeflight::spectral::HeroWavelength;
    use fairflight_media::{Constant, RayQuadrature, Scaled, Tolerance, Wavelength};

    const RUN: Run = Run { samples: 20_000, seed: 3, alpha: 1e-6 };

    #[test]
    fn a_right_sampler_passes_another_field_does_not_and_a_low_majorant_is_refused() {
        let constant = |sigma| Constant::new(sigma, 2.0).unwrap();
        let field = Scaled::new(constant(1.0), [0.4, 1.2]).unwrap();
        let other = Scaled::new(constant(1.0), [0.4, 0.9]).unwrap();
        let hero = HeroWavelength::new(constant(1.2));
        let expected = |wavelength: usize| {
            let mut quadrature = RayQuadrature::new(Wavelength::new(&field, wavelength).unwrap(), &[]);
            FlightExpectation::new(&mut quadrature, &hero, Weights::UpTo(2), Tolerance::TIGHT)
        };
        for wavelength in 0..2 {
            let evidence = check(&field, &hero, wavelength, &expected(wavelength), RUN).unwrap();
            assert_eq!(evidence.holds(), Some(true), "{evidence:?}");
        }
        let evidence = check(&other, &hero, 1, &expected(1), RUN).unwrap();
        assert_eq!(evidence.holds(), Some(false));
        let low = HeroWavelength::new(constant(1.0));
        let refused = check(&field, &low, 0, &expected(0), RUN);
        assert!(
            matches!(refused, Err(FlightRefusal::Unlawful(Violation { sigma_t: 1.2, .. }))),
            "{refused:?}"
        );
    }
}
