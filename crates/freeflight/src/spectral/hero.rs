//! Hero wavelength sampling: one wavelength decides, all share the path, the balance heuristic weighs them (wilkie-2014).

use super::flight::{centred, magnitude, pick};
use super::{SpectralFlight, SpectralFreeFlight};
use crate::theory::{HIGHEST_MOMENT, Moments, lookups_of_a_race};
use crate::{ClosedForm, WeightLaw};
use fairflight_media::{
    Extinction, InvertOpticalThickness, RayQuadrature, SpectralExtinction, Tolerance, Vacuum, Wavelength,
};
use fairflight_sources::UniformSource;

/// Draws one wavelength, the hero, and flies by Woodcock tracking of it; each wavelength is weighed by the single-sample
/// balance heuristic over all that could have been the hero.
///
/// A path is its tentative collisions with what came of each. The density of a path if j is the hero is p_j = Π e_j, with
/// e_j = σ_j/majorant at a collision and 1 − σ_j/majorant at a null collision, times the density of the tentative distances,
/// which all share. The balance heuristic weighs l by
///
/// > w_l = p_l / ((1/N) Σ_j p_j),
///
/// kept as running ratios (as miller-2019 does for techniques): at each event w_l ← w_l e_l Σ|w|/Σ|w e|, so that neither densities nor majorants
/// are ever formed, and nothing underflows.
///
/// **Law.** The path has the density (1/N) Σ_j p_j, so that E\[w_l ...\] is the expectation under p_l, Woodcock tracking of l.
///
/// **Moments.** 0 ≤ w_l ≤ N and Σ_l w_l = N: E\[w_l^k\] ≤ N^(k − 1) E\[w_l\], in every medium and at any length. No closed form
/// is known beyond the mean, except series for particular media.
///
/// **The same law as the average scheme.** Given the events so far, the next one is a collision with probability
/// Σ_j p_j r_j/Σ_j p_j = Σ_j w_j r_j/Σ_j w_j: exactly what the history-aware average of kutz-2017 draws it with, and with
/// the same weights. [`super::SpectralTracking`] with [`super::AverageScheme`] is this sampler with the hero summed over, wherever
/// 0 ≤ σ_l ≤ majorant; it needs no hero, and its events are as likely.
///
/// **Cost.** (1/N) Σ_j ∫ majorant T_j ds look-ups, and one variate for the hero.
///
/// **Domain.** 0 ≤ σ_l(s) ≤ majorant(s) for every wavelength. With `past` weights the hero is drawn in proportion to
/// their magnitude, and Σ|w| is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeroWavelength<R> {
    majorant: R,
}

impl<R: InvertOpticalThickness> HeroWavelength<R> {
    /// Hero wavelength sampling through `majorant`, a bound of all wavelengths, which covers the profile to be sampled and
    /// no more.
    pub fn new(majorant: R) -> Self {
        Self { majorant }
    }
}

impl<F: SpectralExtinction<N>, R: InvertOpticalThickness, const N: usize> SpectralFreeFlight<F, N>
    for HeroWavelength<R>
{
    #[inline]
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        debug_assert_eq!(field.length(), self.majorant.length(), "prepared for another profile");
        let (mut weights, unit) = centred(past);
        let hero = pick(&weights, source);
        let mut s = 0.0;
        while let Some(next) = self.majorant.invert(s, source.next_exponential()) {
            s = next;
            let majorant = self.majorant.sigma_t(s);
            let ratios = field.sigma_t(s).map(|sigma| sigma / majorant);
            // By the same ratio that weighs: an event that is drawn has e_hero > 0, and the sum below too.
            if source.next_uniform() < ratios[hero] {
                let weights = balanced(&weights, &ratios).map(|weight| weight * unit);
                return SpectralFlight::Collided { distance: s, weights };
            }
            weights = balanced(&weights, &ratios.map(|r| 1.0 - r));
        }
        SpectralFlight::Escaped { weights: weights.map(|weight| weight * unit) }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: &[f64; N]) -> bool {
        let majorant = self.majorant.sigma_t(s);
        sigma_t.iter().all(|sigma| (0.0..=majorant).contains(sigma))
    }
}

/// The weights after an event that wavelength l draws with probability `events[l]`.
#[inline]
fn balanced<const N: usize>(weights: &[f64; N], events: &[f64; N]) -> [f64; N] {
    let after: [f64; N] = std::array::from_fn(|l| weights[l] * events[l]);
    let probability = magnitude(&after) / magnitude(weights);
    after.map(|weight| weight / probability)
}

/// The moments of the number of look-ups, where each wavelength is as likely to decide: the mean of those of N walks.
pub(super) fn lookups_of_a_mixture<
    F: SpectralExtinction<N> + Copy,
    C: Extinction,
    R: Extinction,
    const N: usize,
>(
    quadrature: &mut RayQuadrature<Wavelength<F, N>>,
    tolerance: Tolerance,
    control: &C,
    sampling: &R,
) -> Moments {
    let field = *quadrature.field();
    let mut mean = [0.0; HIGHEST_MOMENT];
    for hero in 0..N {
        let of_one = lookups_of_a_race(quadrature, tolerance, &|s, _| {
            let (control, sampling) = (control.sigma_t(s), sampling.sigma_t(s));
            let rest = field.spectrum().sigma_t(s)[hero] - control;
            [control, rest, sampling - rest]
        });
        for (sum, moment) in mean.iter_mut().zip(of_one) {
            *sum += moment / N as f64;
        }
    }
    mean
}

impl<F: SpectralExtinction<N> + Copy, R: InvertOpticalThickness, const N: usize> ClosedForm<Wavelength<F, N>>
    for HeroWavelength<R>
{
    fn weights(&self) -> WeightLaw<'_, Wavelength<F, N>> {
        WeightLaw::MeanOnly
    }

    fn lookups(&self, nodes: &mut RayQuadrature<Wavelength<F, N>>, tolerance: Tolerance) -> Option<Moments> {
        let control = Vacuum::new(self.majorant.length());
        Some(lookups_of_a_mixture(nodes, tolerance, &control, &self.majorant))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectral::{AverageScheme, SpectralTracking};
    use crate::test_support::{constant, spectrum};
    use approx::assert_relative_eq;
    use fairflight_media::{PiecewiseConstant, Profiles};
    use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};

    #[test]
    fn weights_are_n_times_a_density_over_the_sum() {
        // Majorant 1, ratios 1/2, 1/4: after a null collision and a collision p = (1/4, 3/16).
        let field = spectrum([0.5, 0.25]);
        let hero = HeroWavelength::new(constant(1.0));
        let flight = hero.sample(&field, &mut Scripted::new([0.1, 0.1, 0.6, 0.1, 0.4]));
        assert!(matches!(flight, SpectralFlight::Collided { .. }));
        assert_relative_eq!(flight.weights()[0], 8.0 / 7.0, max_relative = 1e-15);
        assert_relative_eq!(flight.weights()[1], 6.0 / 7.0, max_relative = 1e-15);
    }

    /// Two samplers, one law: the same scores in expectation, up to their squares. The second moments have no closed form in a
    /// varying medium, so that one sampler is the reference of the other.
    #[test]
    fn it_is_the_average_scheme() {
        let steps = |values: [f64; 2]| PiecewiseConstant::new(vec![0.0, 0.4, 1.0], values.to_vec()).unwrap();
        let field = Profiles::new([steps([2.0, 0.3]), steps([0.5, 3.0])]).unwrap();
        let (hero, average) =
            (HeroWavelength::new(constant(3.0)), SpectralTracking::new(AverageScheme, constant(3.0)));
        let n = 400_000;
        let squares = |sample: &mut dyn FnMut() -> SpectralFlight<2>| {
            let (mut sum, mut squared) = ([0.0; 3], [0.0; 3]);
            for _ in 0..n {
                let flight = sample();
                let [first, second] = flight.weights();
                let scores = match flight {
                    SpectralFlight::Collided { distance, .. } => {
                        [0.0, first * first * distance, second * second]
                    }
                    SpectralFlight::Escaped { .. } => [first * first, 0.0, 0.0],
                };
                for (i, score) in scores.into_iter().enumerate() {
                    sum[i] += score / f64::from(n);
                    squared[i] += score * score / f64::from(n);
                }
            }
            (sum, squared)
        };
        let (mut one, mut other) = (Seeded::new(1), Seeded::new(2));
        let (by_hero, errors) = squares(&mut || hero.sample(&field, &mut one));
        let (by_average, _) = squares(&mut || average.sample(&field, &mut other));
        for i in 0..3 {
            // Six standard errors of the difference: a false alarm of 6e-9 in all.
            let error = (2.0 * (errors[i] - by_hero[i] * by_hero[i]) / f64::from(n)).sqrt();
            assert!((by_hero[i] - by_average[i]).abs() < 6.0 * error, "{i}: {by_hero:?} {by_average:?}");
        }
    }

    /// In a homogeneous medium the second moment of an escape is a series over the Poisson number of null collisions:
    /// E[w_l²] = N Σ_n Pois(n) (1 − r_l)^(2n)/Σ_j (1 − r_j)^n.
    #[test]
    fn the_second_moment_of_an_escape_in_a_homogeneous_medium() {
        let field = spectrum([0.4, 1.6]);
        let mu = 2.0_f64;
        let passes = [0.8_f64, 0.2];
        let (mut poisson, mut exact) = ((-mu).exp(), 0.0);
        for n in 0..60 {
            exact += poisson * 2.0 * passes[0].powi(2 * n) / (passes[0].powi(n) + passes[1].powi(n));
            poisson *= mu / f64::from(n + 1);
        }
        let hero = HeroWavelength::new(constant(mu));
        let (mut source, n) = (Seeded::new(7), 200_000);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            if let SpectralFlight::Escaped { weights } = hero.sample(&field, &mut source) {
                sum += weights[0].powi(2);
                squares += weights[0].powi(4);
            }
        }
        let (mean, square) = (sum / f64::from(n), squares / f64::from(n));
        let error = ((square - mean * mean) / f64::from(n)).sqrt();
        assert!((mean - exact).abs() < 5.0 * error, "{mean} for {exact} ± {error}");
        // Between the square of the mean and N times it.
        assert!(exact > (-0.8_f64).exp() && exact < 2.0 * (-0.4_f64).exp());
    }

    /// A path that hardly counts any more: in products of denormal weights the shares of the wavelengths would be 0/0.
    #[test]
    fn weights_at_the_ends_of_the_numbers_are_those_in_the_middle() {
        let field = spectrum([0.9, 0.2]);
        let hero = HeroWavelength::new(constant(1.3));
        let average = SpectralTracking::new(AverageScheme, constant(1.3));
        let both = |past: [f64; 2], seed: u64| {
            [
                hero.sample_from(&field, past, &mut Seeded::new(seed)),
                average.sample_from(&field, past, &mut Seeded::new(seed)),
            ]
        };
        for unit in [f64::from_bits(1 << 20), 2.0_f64.powi(1000)] {
            for seed in 0..100 {
                for (near, far) in both([1.0, 0.5], seed).into_iter().zip(both([unit, 0.5 * unit], seed)) {
                    assert_eq!(far.of(0).distance(), near.of(0).distance());
                    for (far, near) in far.weights().into_iter().zip(near.weights()) {
                        assert_relative_eq!(far / unit, near, max_relative = 1e-5);
                    }
                }
            }
        }
    }

    #[test]
    fn an_event_that_the_hero_cannot_draw_is_not_drawn() {
        // Hard case 7: the ratio of the first rounds to 1 or to the number below it.
        let near = 1.0 - f64::EPSILON / 2.0;
        for sigma in [1.0, near] {
            let field = spectrum([sigma, 0.0]);
            let script = Scripted::new([0.0, 0.1, LARGEST_VARIATE, LARGEST_VARIATE]);
            let flight = HeroWavelength::new(constant(1.0)).sample(&field, &mut { script });
            assert!(flight.weights().iter().all(|weight| weight.is_finite()), "{sigma}: {flight:?}");
        }
    }

    #[test]
    fn the_mean_weight_of_an_escape_is_the_transmittance() {
        let field = spectrum([0.5, 0.25]);
        for (l, sigma_t) in [0.5_f64, 0.25].into_iter().enumerate() {
            let mut quadrature = RayQuadrature::new(Wavelength::new(&field, l).unwrap(), &[]);
            let escaped =
                HeroWavelength::new(constant(1.0)).weights().escaped(&mut quadrature, Tolerance::TIGHT);
            assert_relative_eq!(escaped[0], (-sigma_t).exp(), max_relative = 1e-12);
            assert!(escaped[1..].iter().all(|moment| moment.is_nan()));
        }
    }
}
