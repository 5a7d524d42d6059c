//! The law of spectral tracking: moments of its weights, and its look-ups, by quadrature over the ray.

use super::hero::lookups_of_a_mixture;
use super::scheme::{MaxScheme, Scheme};
use super::{AverageScheme, SpectralTracking};
use crate::theory::{HIGHEST_MOMENT, Moments, lookups_of_a_race, powers};
use crate::weight_law::Along;
use crate::{ClosedForm, WeightLaw};
use fairflight_media::{InvertOpticalThickness, RayQuadrature, SpectralExtinction, Tolerance, Wavelength};

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

    /// Where max |r_l| and max |1 − r_l| are not smooth: where a ratio passes 0 or 1, and where two are as far from either: r_i = r_j,
    /// r_i = −r_j, r_i = 2 − r_j.
    fn kinks<F: SpectralExtinction<N>, const N: usize>(&self) -> Vec<Along<'_, Wavelength<F, N>, f64>> {
        let mut kinks = Vec::new();
        for i in 0..N {
            kinks.push(self.along(move |r| r[i]));
            kinks.push(self.along(move |r| r[i] - 1.0));
            for j in 0..i {
                kinks.push(self.along(move |r| r[i] - r[j]));
                kinks.push(self.along(move |r| r[i] + r[j]));
                kinks.push(self.along(move |r| r[i] + r[j] - 2.0));
            }
        }
        kinks
    }

    /// A function of the ratios, where a collision is possible.
    fn along<'a, F: SpectralExtinction<N>, const N: usize>(
        &'a self,
        function: impl Fn(&[f64; N]) -> f64 + 'a,
    ) -> Along<'a, Wavelength<F, N>, f64> {
        Box::new(move |field, s, _| {
            let may_collide = self.sampling.sigma_t(s) > 0.0;
            if may_collide { function(&self.ratios(s, &field.spectrum().sigma_t(s))) } else { 1.0 }
        })
    }
}

impl Events {
    /// σ_samp times the k-th moment of the weight of a collision, k = 1 … 8.
    fn collided(&self) -> Moments {
        moments(self.sampling, self.ratio, self.collides)
    }

    /// d ln M_k/ds.
    fn growth(&self) -> Moments {
        moments(self.sampling, 1.0 - self.ratio, self.passes).map(|rate| rate - self.sampling - self.control)
    }
}

/// rate · probability · (factor/probability)^k; nothing where the event has no probability.
fn moments(rate: f64, factor: f64, probability: f64) -> Moments {
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
    fn weights(&self) -> WeightLaw<'_, Wavelength<F, N>> {
        WeightLaw::products(
            self.kinks(),
            |field: &Wavelength<F, N>, s, _| self.events(field, s).growth(),
            |field: &Wavelength<F, N>, s, _| {
                let events = self.events(field, s);
                events.collided().map(|collided| events.control + collided)
            },
        )
    }

    fn lookups(&self, nodes: &mut RayQuadrature<Wavelength<F, N>>, tolerance: Tolerance) -> Option<Moments> {
        self.weights().split_at_kinks(nodes, tolerance);
        let field = *nodes.field();
        Some(lookups_of_a_race(nodes, tolerance, &|s, _| {
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
    fn weights(&self) -> WeightLaw<'_, Wavelength<F, N>> {
        WeightLaw::MeanOnly
    }

    fn lookups(&self, nodes: &mut RayQuadrature<Wavelength<F, N>>, tolerance: Tolerance) -> Option<Moments> {
        Some(lookups_of_a_mixture(nodes, tolerance, &self.control, &self.sampling))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{constant, spectrum};

    /// max |r_l| and max |1 − r_l| are not smooth on five lines of the plane of two ratios, and a function passes 0 on each of them alone.
    #[test]
    fn a_kink_is_found_on_each_line_where_two_sizes_agree() {
        // Ratios are those of what is above the control, which may be below it.
        let tracking = SpectralTracking::with_control(MaxScheme, constant(1.0), constant(1.0));
        let zeros = |ratios: [f64; 2]| {
            let field = spectrum(ratios.map(|r| 1.0 + r));
            let field = Wavelength::new(&field, 0).unwrap();
            tracking.kinks().iter().filter(|kink| kink(&field, 0.5, 1.0 + ratios[0]).abs() < 1e-12).count()
        };
        assert_eq!(zeros([0.3, 0.8]), 0);
        for on_a_line in [[0.0, 0.8], [1.0, 0.8], [0.7, 0.7], [-0.7, 0.7], [0.6, 1.4]] {
            assert_eq!(zeros(on_a_line), 1, "{on_a_line:?}");
        }
    }
}
