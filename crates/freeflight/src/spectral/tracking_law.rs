//! The law of spectral tracking: moments of its weights, and its look-ups, by quadrature over the ray.

use super::scheme::{MaxScheme, Scheme};
use super::{AverageScheme, SpectralTracking};
use crate::ClosedForm;
use crate::theory::{HIGHEST_MOMENT, lookups_of_a_race, powers, times_exp};
use fairflight_media::{
    Integral, InvertOpticalThickness, RayQuadrature, SpectralExtinction, Tolerance, Wavelength,
};

/// The event probabilities at one place, with the max scheme.
struct Events {
    control: f64,
    sampling: f64,
    /// Of the wavelength in question.
    ratio: f64,
    collides: f64,
    passes: f64,
}

impl<R: InvertOpticalThickness, C: InvertOpticalThickness> SpectralTracking<MaxScheme, R, C> {
    fn events<F: SpectralExtinction<N>, const N: usize>(&self, field: &Wavelength<F, N>, s: f64) -> Events {
        let (control, sampling) = (self.control.sigma_t(s), self.sampling.sigma_t(s));
        if sampling == 0.0 {
            return Events { control, sampling, ratio: 0.0, collides: 0.0, passes: 1.0 };
        }
        let ratios = self.ratios(s, &field.spectrum().sigma_t(s));
        let [collides, passes] = MaxScheme.sizes(&[1.0; N], &ratios);
        let sum = collides + passes;
        let ratio = ratios[field.index()];
        Events { control, sampling, ratio, collides: collides / sum, passes: passes / sum }
    }

    /// Splits the ray where max |r_l| and max |1 − r_l| are not smooth: where a ratio passes 0 or 1, and where two are as far from
    /// either: r_i = r_j, r_i = −r_j, r_i = 2 − r_j.
    fn split_at_kinks<F: SpectralExtinction<N> + Copy, const N: usize>(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
    ) {
        let spectrum = *quadrature.field().spectrum();
        let mut split = |function: &dyn Fn(&[f64; N]) -> f64| {
            quadrature.split_at_zeros(tolerance, &|s, _| {
                let may_collide = self.sampling.sigma_t(s) > 0.0;
                if may_collide { function(&self.ratios(s, &spectrum.sigma_t(s))) } else { 1.0 }
            });
        };
        for i in 0..N {
            split(&|r| r[i]);
            split(&|r| r[i] - 1.0);
            for j in 0..i {
                split(&|r| r[i] - r[j]);
                split(&|r| r[i] + r[j]);
                split(&|r| r[i] + r[j] - 2.0);
            }
        }
    }
}

impl Events {
    /// σ_samp times the k-th moment of the weight of a collision, k = 1 … 8.
    fn collided(&self) -> [f64; HIGHEST_MOMENT] {
        moments(self.sampling, self.ratio, self.collides)
    }

    /// d ln M_k/ds.
    fn growth(&self) -> [f64; HIGHEST_MOMENT] {
        moments(self.sampling, 1.0 - self.ratio, self.passes).map(|rate| rate - self.sampling - self.control)
    }
}

/// rate · probability · (factor/probability)^k; nothing where the event has no probability.
fn moments(rate: f64, factor: f64, probability: f64) -> [f64; HIGHEST_MOMENT] {
    if probability == 0.0 {
        return [0.0; HIGHEST_MOMENT];
    }
    powers(factor / probability).map(|power| rate * probability * power)
}

impl<F, R, C, const N: usize> ClosedForm<Wavelength<F, N>> for SpectralTracking<MaxScheme, R, C>
where
    F: SpectralExtinction<N> + Copy,
    R: InvertOpticalThickness,
    C: InvertOpticalThickness,
{
    fn collided(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
        score: &dyn Fn(f64) -> f64,
    ) -> Integral<HIGHEST_MOMENT> {
        self.split_at_kinks(quadrature, tolerance);
        let field = *quadrature.field();
        quadrature.integrate_nested(
            tolerance,
            |s, _| self.events(&field, s).growth(),
            |s, _, growth| {
                let (events, scores) = (self.events(&field, s), powers(score(s)));
                let collided = events.collided();
                std::array::from_fn(|i| times_exp(events.control + collided[i], growth[i], scores[i]))
            },
        )
    }

    fn escaped(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
    ) -> [f64; HIGHEST_MOMENT] {
        self.split_at_kinks(quadrature, tolerance);
        let field = *quadrature.field();
        quadrature.integrate(tolerance, |s, _| self.events(&field, s).growth()).value.map(f64::exp)
    }

    fn lookups(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
    ) -> Option<[f64; HIGHEST_MOMENT]> {
        self.split_at_kinks(quadrature, tolerance);
        let field = *quadrature.field();
        Some(lookups_of_a_race(quadrature, tolerance, &|s, _| {
            let events = self.events(&field, s);
            [events.control, events.sampling * events.collides, events.sampling * events.passes]
        }))
    }
}

/// Within 0 ≤ σ_l − c ≤ σ_samp for every l. Of the weights only the mean has a closed form, the rest is NaN; for look-ups
/// see [`super::HeroWavelength`].
impl<F, R, C, const N: usize> ClosedForm<Wavelength<F, N>> for SpectralTracking<AverageScheme, R, C>
where
    F: SpectralExtinction<N> + Copy,
    R: InvertOpticalThickness,
    C: InvertOpticalThickness,
{
    fn collided(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
        score: &dyn Fn(f64) -> f64,
    ) -> Integral<HIGHEST_MOMENT> {
        super::hero::mean_of_collisions(quadrature, tolerance, score)
    }

    fn escaped(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
    ) -> [f64; HIGHEST_MOMENT] {
        super::hero::mean_of_escapes(quadrature, tolerance)
    }

    fn lookups(
        &self,
        quadrature: &mut RayQuadrature<Wavelength<F, N>>,
        tolerance: Tolerance,
    ) -> Option<[f64; HIGHEST_MOMENT]> {
        Some(super::hero::lookups_of_a_mixture(quadrature, tolerance, &self.control, &self.sampling))
    }
}
