//! Each wavelength by itself: what raab-2008 section 3.2 advises where extinction depends on the wavelength.

use super::flight::{magnitude, pick};
use super::{SpectralFlight, SpectralFreeFlight};
use crate::theory::{HIGHEST_MOMENT, Moments, lookups_of_a_walk};
use crate::{ClosedForm, Flight, FreeFlight, WeightLaw, Woodcock};
use fairflight_media::{InvertOpticalThickness, RayQuadrature, SpectralExtinction, Tolerance, Wavelength};
use fairflight_sources::UniformSource;

/// Woodcock tracking of one wavelength at a time, each through a majorant of its own: the baseline of all that share a path.
///
/// [`sample_each`](Self::sample_each) makes N flights, one for each wavelength, with weights of 1. As a
/// [`SpectralFreeFlight`] it makes one, of a wavelength drawn at random, which counts N times for it and not at all for the
/// others: N of these cost what one round of the former does, and vary more.
///
/// **Law.** Woodcock's, for the wavelength drawn.
///
/// **Moments.** E\[weight_l^k; escaped\] = N^(k − 1) T_l, E\[weight_l^k; collided\] = N^(k − 1) (1 − T_l). They are the least upper bound
/// of those of [`super::HeroWavelength`]: what it saves is what wavelengths have in common.
///
/// **Cost.** (1/N) Σ_j ∫ majorant_j T_j ds look-ups of the one flight, N times that of a round.
///
/// **Domain.** 0 ≤ σ_l(s) ≤ majorant_l(s) for each wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparateSolve<R, const N: usize> {
    flights: [Woodcock<R>; N],
}

impl<R: InvertOpticalThickness, const N: usize> SeparateSolve<R, N> {
    /// A majorant for each wavelength.
    pub fn new(majorants: [R; N]) -> Self {
        Self { flights: majorants.map(Woodcock::new) }
    }

    /// A flight for each wavelength, independent of each other.
    pub fn sample_each<F: SpectralExtinction<N>>(
        &self,
        field: &F,
        source: &mut impl UniformSource,
    ) -> [Flight; N] {
        std::array::from_fn(|l| self.sample_one(field, l, source))
    }

    #[inline]
    fn sample_one<F: SpectralExtinction<N>>(
        &self,
        field: &F,
        wavelength: usize,
        source: &mut impl UniformSource,
    ) -> Flight {
        let field = Wavelength::new(field, wavelength).expect("an index below N");
        self.flights[wavelength].sample(&field, source)
    }
}

impl<F: SpectralExtinction<N>, R: InvertOpticalThickness, const N: usize> SpectralFreeFlight<F, N>
    for SeparateSolve<R, N>
{
    #[inline]
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        let drawn = pick(&past, source);
        let mut weights = [0.0; N];
        weights[drawn] = magnitude(&past).copysign(past[drawn]);
        match self.sample_one(field, drawn, source) {
            Flight::Collided { distance, .. } => SpectralFlight::Collided { distance, weights },
            Flight::Escaped { .. } => SpectralFlight::Escaped { weights },
        }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: &[f64; N]) -> bool {
        let bounds = self.flights.iter().map(|flight| flight.majorant().sigma_t(s));
        sigma_t.iter().zip(bounds).all(|(sigma, majorant)| (0.0..=majorant).contains(sigma))
    }
}

impl<F: SpectralExtinction<N> + Copy, R: InvertOpticalThickness, const N: usize> ClosedForm<Wavelength<F, N>>
    for SeparateSolve<R, N>
{
    fn weights(&self) -> WeightLaw<'_, Wavelength<F, N>> {
        WeightLaw::OneIn(N)
    }

    fn lookups(&self, nodes: &mut RayQuadrature<Wavelength<F, N>>, tolerance: Tolerance) -> Option<Moments> {
        let field = *nodes.field();
        let mut mean = [0.0; HIGHEST_MOMENT];
        for (l, flight) in self.flights.iter().enumerate() {
            let of_one = lookups_of_a_walk(nodes, tolerance, &|s, _| {
                let sigma_t = field.spectrum().sigma_t(s)[l];
                [sigma_t, flight.majorant().sigma_t(s) - sigma_t]
            });
            for (sum, moment) in mean.iter_mut().zip(of_one) {
                *sum += moment / N as f64;
            }
        }
        Some(mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{constant, spectrum};
    use fairflight_sources::{LARGEST_VARIATE, Scripted};

    #[test]
    fn one_wavelength_counts_for_all_that_are_not_drawn() {
        let field = spectrum([0.5, 0.0]);
        let separate = SeparateSolve::new([constant(0.5), constant(0.0)]);
        let drawn = |u: f64| separate.sample(&field, &mut Scripted::new([u, LARGEST_VARIATE]));
        assert_eq!(drawn(0.4), SpectralFlight::Escaped { weights: [2.0, 0.0] });
        assert_eq!(drawn(0.6), SpectralFlight::Escaped { weights: [0.0, 2.0] });
        let [first, second] = separate.sample_each(&field, &mut Scripted::new([0.1, 0.9, 0.5]));
        assert!(first.distance().is_some() && first.weight() == 1.0);
        assert_eq!(second, Flight::Escaped { weight: 1.0 });
    }

    #[test]
    fn expected_look_ups_are_the_mean_over_wavelengths() {
        let field = spectrum([0.5, 0.0]);
        let separate = SeparateSolve::new([constant(0.5), constant(0.0)]);
        let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 1).unwrap(), &[]);
        let lookups = separate.lookups(&mut quadrature, Tolerance::TIGHT).unwrap();
        // 0.5 ∫ exp(−s/2) = 1 − e^−½ of the first, none of the second.
        assert!((lookups[0] - 0.5 * -(-0.5_f64).exp_m1()).abs() < 1e-14);
    }
}
