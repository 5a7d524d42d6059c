//! Spectral tracking: one walk through a sampling extinction, with a weight for each wavelength (kutz-2017).

use super::flight::centred;
use super::scheme::Scheme;
use super::{SpectralFlight, SpectralFreeFlight};
use fairflight_media::{InvertOpticalThickness, SpectralExtinction, Vacuum, rounding_of_difference};
use fairflight_sources::UniformSource;

/// Flies through σ_samp; at each tentative collision one decision is made for all wavelengths, by a [`Scheme`].
///
/// ```text
/// w_l = 1 for all l; s = 0
/// repeat  s += free flight of sigma_samp
///         stop when s > length: escaped with the weights w
///         r_l = sigma_l(s) / sigma_samp(s)
///         with probability P = a/(a + b), (a, b) the sizes of the scheme: collided at s with the weights w_l r_l / P
///         else: w_l *= (1 − r_l) / (1 − P)
/// ```
///
/// **Law.** For each l the expected weight of a flight under way changes by σ_samp (−1 + (1 − r_l)) = −σ_l per length, and
/// that of a collision is σ_samp r_l = σ_l times it: T_l and σ_l T_l, for any probabilities and any σ_samp that is
/// positive wherever a σ_l is not 0.
///
/// **With a control** ([`with_control`](Self::with_control)) c(s) ≥ 0 that all wavelengths share, the same walk goes
/// through σ_l − c in place of σ_l, and races with a flight through c alone, which is drawn first and by inversion. If that
/// ends first, the flight has collided there, with the weights as they are: it has lost c more per length and gained
/// c T_l, whatever l. A collision with the control costs no look-up.
///
/// **Moments.** (`tracking_law.rs`) With [`MaxScheme`](super::MaxScheme) events do not depend on the past, and with P(s) the weights have a product law,
///
/// > M_k(s) = exp(∫_0^s σ_samp ((1 − r_l)^k (1 − P)^(1 − k) − 1) − c),
/// > E\[weight_l^k; collided\] = ∫ (c + σ_samp r_l^k P^(1 − k)) M_k ds,   E\[weight_l^k; escaped\] = M_k(length).
///
/// All are finite on a finite ray. For 0 ≤ r ≤ 1 the second grows as exp(∫ σ_samp ((1 − r_l)² (1 + r_max − r_min)/(1 − r_min) − 1)):
/// in an endless medium with σ_samp = σ_max it is infinite for the thinnest wavelength from σ_max/σ_min = (3 + √5)/2 = 2.618 on, and a
/// loose majorant makes it worse, down to 2. With [`AverageScheme`](super::AverageScheme) and 0 ≤ r_l ≤ 1 all weights lie in \[0, N\], so that
/// E\[weight_l²\] ≤ N E\[weight_l\]; only the mean has a closed form.
///
/// **Cost.** ∫ σ_samp · P(still under way) ds look-ups; for the average scheme within its bound that is the mean over
/// wavelengths of ∫ σ_samp T_l ds: see [`super::HeroWavelength`], which has the same law.
///
/// **Domain.** Any σ_l where σ_samp > 0, all 0 where it is 0. Outside 0 ≤ σ_l − c ≤ σ_samp only the variance suffers, but
/// it grows geometrically. (Weights of a wavelength that are no number stay no number.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralTracking<S, R, C = Vacuum> {
    scheme: S,
    pub(super) sampling: R,
    pub(super) control: C,
}

impl<S: Scheme, R: InvertOpticalThickness> SpectralTracking<S, R> {
    /// Spectral tracking by `scheme` through the sampling extinction `sampling`, which covers the profile to be sampled and
    /// no more.
    pub fn new(scheme: S, sampling: R) -> Self {
        let control = Vacuum::new(sampling.length());
        Self { scheme, sampling, control }
    }
}

impl<S: Scheme, R: InvertOpticalThickness, C: InvertOpticalThickness> SpectralTracking<S, R, C> {
    /// As [`new`](Self::new), with a `control` \[1/length\] of all wavelengths; `sampling` is then that of what is left.
    pub fn with_control(scheme: S, control: C, sampling: R) -> Self {
        debug_assert_eq!(control.length(), sampling.length(), "made for two profiles");
        Self { scheme, sampling, control }
    }

    /// r_l at `s`.
    #[inline]
    pub(super) fn ratios<const N: usize>(&self, s: f64, sigma_t: &[f64; N]) -> [f64; N] {
        let (control, sampling) = (self.control.sigma_t(s), self.sampling.sigma_t(s));
        sigma_t.map(|sigma| (sigma - control) / sampling)
    }
}

impl<
    F: SpectralExtinction<N>,
    S: Scheme,
    R: InvertOpticalThickness,
    C: InvertOpticalThickness,
    const N: usize,
> SpectralFreeFlight<F, N> for SpectralTracking<S, R, C>
{
    #[inline]
    fn sample_from(&self, field: &F, past: [f64; N], source: &mut impl UniformSource) -> SpectralFlight<N> {
        debug_assert_eq!(field.length(), self.sampling.length(), "prepared for another profile");
        let (mut weights, unit) = centred(past);
        // An empty control takes no variate.
        let has_control = self.control.optical_thickness(0.0, self.control.length()) > 0.0;
        let control = if has_control { self.control.invert(0.0, source.next_exponential()) } else { None };
        let end = control.unwrap_or(f64::INFINITY);
        let mut s = 0.0;
        while let Some(next) = self.sampling.invert(s, source.next_exponential()) {
            if next >= end {
                break;
            }
            s = next;
            let ratios = self.ratios(s, &field.sigma_t(s));
            let [collides, passes] = self.scheme.sizes(&weights, &ratios);
            let probability = collides / (collides + passes);
            if source.next_uniform() < probability {
                // Divided in this order, a gray flight keeps a weight of exactly 1.
                let weights = std::array::from_fn(|l| weights[l] * (ratios[l] / probability) * unit);
                return SpectralFlight::Collided { distance: s, weights };
            }
            let probability = passes / (collides + passes);
            weights = std::array::from_fn(|l| weights[l] * ((1.0 - ratios[l]) / probability));
        }
        let weights = weights.map(|weight| weight * unit);
        match control {
            Some(distance) => SpectralFlight::Collided { distance, weights },
            None => SpectralFlight::Escaped { weights },
        }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: &[f64; N]) -> bool {
        let control = self.control.sigma_t(s);
        let is_control = |&sigma: &f64| (sigma - control).abs() <= rounding_of_difference(sigma, control);
        self.sampling.sigma_t(s) > 0.0 || sigma_t.iter().all(is_control)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectral::{AverageScheme, MaxScheme};
    use crate::test_support::{assert_law, constant, spectrum};
    use crate::{ClosedForm, Flight};
    use approx::assert_relative_eq;
    use fairflight_media::{PiecewiseConstant, Profiles, RayQuadrature, Tolerance, Wavelength};
    use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};

    #[test]
    fn events_by_hand() {
        // sigma_samp 1, ratios 1/2 and 1/4: sizes 1/2 and 3/4 by the max scheme, P = 2/5.
        let tracking = SpectralTracking::new(MaxScheme, constant(1.0));
        let field = spectrum([0.5, 0.25]);
        let sample = |u: f64| tracking.sample(&field, &mut Scripted::new([0.1, u, LARGEST_VARIATE]));
        let near = |found: SpectralFlight<2>, wanted: [f64; 2]| {
            for (found, wanted) in found.weights().into_iter().zip(wanted) {
                assert_relative_eq!(found, wanted, max_relative = 1e-15);
            }
        };
        assert!(matches!(sample(0.399), SpectralFlight::Collided { .. }));
        near(sample(0.399), [1.25, 0.625]);
        near(sample(0.401), [0.5 / 0.6, 1.25]);
        // By the average: 3/4 and 5/4 of 2, P = 3/8.
        let tracking = SpectralTracking::new(AverageScheme, constant(1.0));
        let sample = |u: f64| tracking.sample(&field, &mut Scripted::new([0.1, u, LARGEST_VARIATE]));
        near(sample(0.374), [4.0 / 3.0, 2.0 / 3.0]);
        near(sample(0.376), [0.8, 1.2]);
    }

    #[test]
    fn a_gray_field_has_weights_of_exactly_one() {
        let mut source = Seeded::new(3);
        let field = spectrum([0.37; 3]);
        for _ in 0..200 {
            let by_max = SpectralTracking::new(MaxScheme, constant(1.3)).sample(&field, &mut source);
            assert_eq!(by_max.weights(), [1.0; 3]);
            let by_average = SpectralTracking::new(AverageScheme, constant(1.3)).sample(&field, &mut source);
            for weight in by_average.weights() {
                assert_relative_eq!(weight, 1.0, max_relative = 1e-14);
            }
        }
    }

    #[test]
    fn the_weights_of_the_average_scheme_keep_their_sum() {
        let edges = || vec![0.0, 0.4, 1.0];
        let steps = |values: [f64; 2]| PiecewiseConstant::new(edges(), values.to_vec()).unwrap();
        let field = Profiles::new([steps([9.0, 0.0]), steps([1.0, 30.0]), steps([0.0, 12.0])]).unwrap();
        let tracking = SpectralTracking::new(AverageScheme, constant(30.0));
        let mut source = Seeded::new(5);
        for _ in 0..1000 {
            let weights = tracking.sample(&field, &mut source).weights();
            assert_relative_eq!(weights.iter().sum::<f64>(), 3.0, max_relative = 1e-12);
            assert!(weights.iter().all(|&weight| weight >= 0.0));
        }
    }

    /// The first moments are the law itself, by quadrature, with and without a control, below and above σ_samp.
    #[test]
    fn the_expected_weights_are_those_of_the_law() {
        let edges = || vec![0.0, 0.3, 1.0];
        let steps = |values: [f64; 2]| PiecewiseConstant::new(edges(), values.to_vec()).unwrap();
        let field = Profiles::new([steps([1.0, 0.4]), steps([0.2, 2.0])]).unwrap();
        for (control, sampling) in [(0.0, 2.0), (0.2, 1.8), (0.6, 0.9)] {
            let tracking = SpectralTracking::with_control(MaxScheme, constant(control), constant(sampling));
            for (l, tau) in [0.58_f64, 1.46].into_iter().enumerate() {
                assert_law(Wavelength::new(&field, l).unwrap(), &tracking, tau);
            }
        }
    }

    /// σ_max/σ_min = (3 + √5)/2 with the tightest majorant: the second moment of the thin wavelength neither grows nor falls.
    #[test]
    fn the_max_scheme_ends_at_the_square_of_the_golden_ratio() {
        let golden = f64::midpoint(3.0, 5.0_f64.sqrt());
        let tracking = SpectralTracking::new(MaxScheme, constant(golden));
        let field = spectrum([1.0, golden]);
        let mut quadrature = RayQuadrature::new(Wavelength::new(&field, 0).unwrap(), &[]);
        let second = tracking.weights().escaped(&mut quadrature, Tolerance::TIGHT)[1];
        assert_relative_eq!(second, 1.0, max_relative = 1e-12);
    }

    #[test]
    fn a_collision_with_the_control_takes_no_look_up() {
        let tracking = SpectralTracking::with_control(AverageScheme, constant(1.0), constant(0.5));
        let field = spectrum([1.5, 1.2]);
        // The control collides at 0.69, the first tentative collision lies behind.
        let flight = tracking.sample(&field, &mut Scripted::new([0.5, 0.9]));
        assert_eq!(flight.weights(), [1.0; 2]);
        assert_relative_eq!(flight.of(0).distance().unwrap(), std::f64::consts::LN_2, max_relative = 1e-15);
    }

    #[test]
    fn a_value_that_is_no_number_is_not_hidden() {
        struct Hole;
        impl SpectralExtinction<2> for Hole {
            fn sigma_t(&self, _s: f64) -> [f64; 2] {
                [0.5, f64::NAN]
            }
            fn length(&self) -> f64 {
                1.0
            }
        }
        for u in [0.1, 0.9] {
            let script = || Scripted::new([0.1, u, LARGEST_VARIATE]);
            let flight = SpectralTracking::new(MaxScheme, constant(1.0)).sample(&Hole, &mut script());
            assert!(flight.weights()[1].is_nan(), "{flight:?}");
            let flight = SpectralTracking::new(AverageScheme, constant(1.0)).sample(&Hole, &mut script());
            assert!(flight.of(1).weight().is_nan() && matches!(flight.of(1), Flight::Escaped { .. }));
        }
    }
}
