//! One distance for all wavelengths by the density of one extinction: the case that raab-2008 section 3.2 warns of.

use super::{SpectralFlight, SpectralFreeFlight};
use crate::theory::{HIGHEST_MOMENT, Moments, powers, times_exp};
use crate::weight_law::WeightProducts;
use crate::{ClosedForm, WeightLaw};
use fairflight_elementary::exp_m1;
use fairflight_media::{
    InvertOpticalThickness, RayQuadrature, SpectralExtinction, SpectralOpticalThickness, Tolerance,
    Wavelength,
};
use fairflight_sources::UniformSource;

/// Draws the distance with the density q = σ_samp exp(−∫ σ_samp), e.g. that of one wavelength, and weighs each wavelength by
/// σ_l T_l/q, exactly.
///
/// **Law.** Importance sampling: E\[weight_l g\] = ∫ q (σ_l T_l/q) g, and at the end exp(−∫ σ_samp) · T_l/exp(−∫ σ_samp).
///
/// **Moments.** E\[weight_l^k; collided\] = ∫ (σ_l T_l)^k q^(1 − k) ds, E\[weight_l^k; escaped\] = T_l^k exp((k − 1) ∫ σ_samp).
/// The second grows as exp(∫ (σ_samp − 2 σ_l)): in an endless medium it is infinite from σ_samp = 2 σ_l on, where
/// E\[weight_l²\] = σ_l²/(σ_samp (2 σ_l − σ_samp)) ends (raab-2008 section 3.2). Weights are unbounded already from σ_samp > σ_l on.
///
/// **Cost.** A look-up where it collides, none else: exp(−∫ σ_samp) of the flights escape.
///
/// **Domain.** Any σ_l where σ_samp > 0, all 0 where it is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedDistance<R> {
    sampling: R,
}

impl<R: InvertOpticalThickness> SharedDistance<R> {
    /// Distances drawn through `sampling`, which covers the profile to be sampled and no more.
    pub fn new(sampling: R) -> Self {
        Self { sampling }
    }
}

impl<F: SpectralOpticalThickness<N>, R: InvertOpticalThickness, const N: usize> SpectralFreeFlight<F, N>
    for SharedDistance<R>
{
    #[inline]
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        debug_assert_eq!(field.length(), self.sampling.length(), "prepared for another profile");
        // T_l/exp(−∫ σ_samp) up to s as one exponential: neither of the two need be a number by itself.
        let exponents = |s: f64| {
            let (spectrum, drawn) =
                (field.optical_thickness(0.0, s), self.sampling.optical_thickness(0.0, s));
            spectrum.map(|tau| drawn - tau)
        };
        match self.sampling.invert(0.0, source.next_exponential()) {
            Some(distance) => {
                let (sigma_t, exponents) = (field.sigma_t(distance), exponents(distance));
                let sampling = self.sampling.sigma_t(distance);
                let weights =
                    std::array::from_fn(|l| times_exp(past[l], exponents[l], sigma_t[l] / sampling));
                SpectralFlight::Collided { distance, weights }
            }
            None => {
                let exponents = exponents(field.length());
                SpectralFlight::Escaped {
                    weights: std::array::from_fn(|l| times_exp(past[l], exponents[l], 1.0)),
                }
            }
        }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: &[f64; N]) -> bool {
        self.sampling.sigma_t(s) > 0.0 || sigma_t.iter().all(|&sigma| sigma == 0.0)
    }
}

/// d ln/ds of T^k q^(1 − k) without its factors of σ.
fn growth(sigma_t: f64, sampling: f64) -> Moments {
    std::array::from_fn(|i| i as f64 * sampling - (i + 1) as f64 * sigma_t)
}

impl<F: SpectralExtinction<N>, R: InvertOpticalThickness, const N: usize> ClosedForm<Wavelength<F, N>>
    for SharedDistance<R>
{
    fn weights(&self) -> WeightLaw<'_, Wavelength<F, N>> {
        let growth = |_: &_, s: f64, sigma_t: f64| growth(sigma_t, self.sampling.sigma_t(s));
        let collided = |_: &_, s: f64, sigma_t: f64, logarithms: Moments, score: f64| {
            let sampling = self.sampling.sigma_t(s);
            if sampling == 0.0 {
                return [0.0; HIGHEST_MOMENT];
            }
            let weights = powers(sigma_t / sampling * score);
            std::array::from_fn(|i| times_exp(sampling * weights[i], logarithms[i], 1.0))
        };
        WeightLaw::Products(WeightProducts {
            kinks: Vec::new(),
            growth: Box::new(growth),
            collided: Box::new(collided),
        })
    }

    fn lookups(
        &self,
        _nodes: &mut RayQuadrature<Wavelength<F, N>>,
        _tolerance: Tolerance,
    ) -> Option<Moments> {
        let drawn = self.sampling.optical_thickness(0.0, self.sampling.length());
        Some([-exp_m1(-drawn); HIGHEST_MOMENT])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{constant, spectrum};
    use approx::assert_relative_eq;
    use fairflight_media::{Constant, Scaled};
    use fairflight_sources::Scripted;

    #[test]
    fn weights_are_ratios_of_densities() {
        let field = spectrum([1.0, 2.0]);
        let shared = SharedDistance::new(constant(2.0));
        let flight = shared.sample(&field, &mut Scripted::new([0.5]));
        let s = 0.5 * std::f64::consts::LN_2;
        assert_relative_eq!(flight.weights()[0], 0.5 * s.exp(), max_relative = 1e-14);
        assert_relative_eq!(flight.weights()[1], 1.0, max_relative = 1e-14);
        let escaped = shared.sample(&field, &mut Scripted::new([0.9])).weights();
        assert_relative_eq!(escaped[0], 1.0_f64.exp(), max_relative = 1e-14);
    }

    /// raab-2008 section 3.2 over a finite length: (1 − exp(−(2 − ρ) L))/(ρ (2 − ρ)) for σ_1 = 1, σ_2 = ρ.
    #[test]
    fn a_wavelength_that_meets_nothing_counts_nothing_however_dense_the_other() {
        // exp(1500) is no number; beside σ_t = 0 at the collision it is not asked for.
        let steps = |values: [f64; 2]| {
            fairflight_media::PiecewiseConstant::new(vec![0.0, 1.0, 2.0], values.to_vec()).unwrap()
        };
        let field = fairflight_media::Profiles::new([steps([1500.0, 1.0]), steps([0.0, 0.0])]).unwrap();
        let shared = SharedDistance::new(steps([1500.0, 1.0]));
        for u in [0.3, 1.0 - 1e-16] {
            let weights = shared.sample(&field, &mut Scripted::new([u])).weights();
            assert!(weights[0] >= 0.0 && weights[1] == 0.0, "{u}: {weights:?}");
        }
        let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 1).unwrap(), &[]);
        let collided = shared.weights().collided(&mut quadrature, Tolerance::to(1e-6), &|_| 1.0);
        assert_eq!(collided.value, [0.0; HIGHEST_MOMENT]);
    }

    #[test]
    fn the_second_moment_is_the_paper_s() {
        for (ratio, length) in [(0.7, 40.0), (1.9, 20.0), (2.0, 20.0), (2.1, 20.0)] {
            let constant = |sigma| Constant::new(sigma, length).unwrap();
            let field = Scaled::new(constant(1.0), [1.0, ratio]).unwrap();
            let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 0).unwrap(), &[]);
            let shared = SharedDistance::new(constant(ratio));
            let found = shared.weights().collided(&mut quadrature, Tolerance::TIGHT, &|_| 1.0).value[1];
            let rest = 2.0 - ratio;
            let covered = if rest == 0.0 { length } else { -(-rest * length).exp_m1() / rest };
            assert_relative_eq!(found, covered / ratio, max_relative = 1e-10);
        }
    }

    /// A flight of the rate 2 escapes a length of 1 with e^−2, and weighs e for a wavelength of σ_t = 1: M_k = e^(k − 2).
    #[test]
    fn the_moments_of_an_escape_by_hand() {
        let field = spectrum([1.0, 2.0]);
        let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 0).unwrap(), &[]);
        let escaped = SharedDistance::new(constant(2.0)).weights().escaped(&mut quadrature, Tolerance::TIGHT);
        for (k, found) in (1..).zip(escaped) {
            assert_relative_eq!(found, f64::from(k - 2).exp(), max_relative = 1e-12);
        }
    }
}
