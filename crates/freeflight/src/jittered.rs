//! Free flight with one candidate per stratum: the companion of jittered ratio tracking.

use crate::theory::{HIGHEST_MOMENT, Moments, one_more, poisson_moments};
use crate::{ClosedForm, Flight, FreeFlight};
use fairflight_elementary::exp;
use fairflight_media::{Epsilon, EpsilonError, Majorant, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// One uniform candidate x in each stratum \[a, a + h): accepted with the probability h σ_t(x), then put to a survival test, a
/// Woodcock flight from a to x that must not collide.
///
/// **Law.** A candidate is at x with the density 1/h, accepted with the probability h σ_t(x), and survives with T(a, x): the density
/// of a collision at x, given that the flight reached a, is σ_t(x) T(a, x), as it should be. What is left is
/// 1 − ∫ σ_t(x) T(a, x) dx = T(a, a + h), so that the next stratum is reached with the right probability as well, and by induction the
/// density is σ_t T everywhere. A candidate that fails leaves the whole stratum behind: nothing of the test is used again. Every
/// weight is 1.
///
/// **Moments.** E\[weight^k; collided\] = 1 − T, E\[weight^k; escaped\] = T.
///
/// **Cost.** With b(s) the end of the stratum that holds s, Σ T(a) over the strata + majorant ∫ T(s) τ(s, b(s)) ds look-ups: about 1/ε
/// times those of [`crate::Woodcock`] and a little more. What it buys is a fixed number of variates that matter (two per stratum).
///
/// **Domain.** 0 ≤ σ_t ≤ majorant: h σ_t(x) ≤ ε ≤ 1 is a probability.
///
/// **Source.** Ours; no publication of it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JitteredFlight {
    epsilon: Epsilon,
}

impl JitteredFlight {
    /// The sampler with strata of the optical thickness `epsilon` \[1\] in the majorant, or a little less.
    ///
    /// # Errors
    /// If `epsilon` is not in (0, 1\].
    pub fn new(epsilon: f64) -> Result<Self, EpsilonError> {
        Epsilon::new(epsilon).map(|epsilon| Self { epsilon })
    }

    /// The greatest optical thickness of a stratum in the majorant \[1\].
    #[must_use]
    pub fn epsilon(&self) -> f64 {
        self.epsilon.get()
    }

    /// The number of strata and the width of each; none where nothing can be met.
    #[inline]
    fn strata<F: Majorant>(&self, field: &F) -> (f64, f64) {
        let (length, thickness) = (field.length(), field.majorant() * field.length());
        let count = self.epsilon.strata(thickness);
        (count, length / count)
    }
}

/// Draws whether a Woodcock flight from `from` reaches `to`.
#[inline]
fn survives<F: Majorant>(field: &F, from: f64, to: f64, source: &mut impl UniformSource) -> bool {
    let majorant = field.majorant();
    let mut s = from;
    loop {
        s += source.next_exponential() / majorant;
        if s >= to {
            return true;
        }
        if source.next_uniform() * majorant < field.sigma_t(s) {
            return false;
        }
    }
}

impl<F: Majorant> FreeFlight<F> for JitteredFlight {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let (count, width) = self.strata(field);
        for i in 0..count as u64 {
            let from = i as f64 * width;
            // Rounding may carry the last candidate over the end.
            let s = ((i as f64 + source.next_uniform()) * width).min(field.length());
            if source.next_uniform() < width * field.sigma_t(s) && survives(field, from, s, source) {
                return Flight::Collided { distance: s, weight: 1.0 };
            }
        }
        Flight::Escaped { weight: 1.0 }
    }

    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        (0.0..=field.majorant()).contains(&sigma_t)
    }
}

impl<F: Majorant> ClosedForm<F> for JitteredFlight {
    /// Moments by strata, from the last to the first: with L look-ups in a stratum, A whether the flight ends there and N' look-ups behind
    /// it, N = L + (1 − A) N', hence
    ///
    /// > E\[N^k\] = E\[L^k\] + Σ_{i<k} C(k, i) E\[L^i (1 − A)\] E\[N'^{k−i}\].
    ///
    /// L is 1 where the candidate is not accepted. Else a Woodcock flight adds P to x, Poisson of mean ν(a, x) = ∫ (majorant − σ_t), or ends
    /// at y < x with 1 + P, P of mean ν(a, y):
    ///
    /// > E\[L^i A\] = ∫ σ_t(x) T(a, x) E\[(1 + P)^i\] dx,
    /// > E\[L^i (1 − A)\] = 1 − τ(a, b) + ∫ σ_t(y) T(a, y) τ(y, b) E\[(2 + P)^i\] dy.
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments> {
        let (count, width) = self.strata(quadrature.field());
        if count == 0.0 {
            return Some([0.0; HIGHEST_MOMENT]);
        }
        let (length, majorant) = (quadrature.field().length(), quadrature.field().majorant());
        let end = |i: usize| if i as f64 + 1.0 >= count { length } else { (i + 1) as f64 * width };
        let ends: Vec<f64> = (0..count as usize).map(end).collect();
        quadrature.split_at(&ends);
        let thickness = quadrature.cumulative(tolerance, |_, sigma_t| [sigma_t]);
        let tau = |s: f64| thickness.at(s)[0];
        let before: Vec<f64> = std::iter::once(0.0).chain(ends.iter().copied()).map(tau).collect();

        let (parts, _) = quadrature.integrate_parts(tolerance, &ends, |i, s, sigma_t| {
            let from = i as f64 * width;
            let passed = (tau(s) - before[i]).max(0.0);
            let (_, one) = poisson_moments((majorant * (s - from) - passed).max(0.0));
            let two = one_more(&one);
            let (density, rest) = (sigma_t * exp(-passed), before[i + 1] - tau(s));
            let accepted = one.map(|moment| density * moment);
            let failed = two.map(|moment| density * rest * moment);
            std::array::from_fn::<f64, { 2 * HIGHEST_MOMENT + 1 }, _>(|j| match j {
                0 => density * rest,
                j if j <= HIGHEST_MOMENT => accepted[j - 1],
                j => failed[j - 1 - HIGHEST_MOMENT],
            })
        });
        let mut behind = [0.0; HIGHEST_MOMENT];
        for (i, part) in parts.iter().enumerate().rev() {
            let refused = 1.0 - (before[i + 1] - before[i]);
            behind = std::array::from_fn(|k| {
                // Index 0 of `goes_on` is the power 0.
                let goes_on = |j: usize| refused + if j == 0 { part[0] } else { part[j + HIGHEST_MOMENT] };
                let power = k + 1;
                let (mut sum, mut binomial) = (part[power] + goes_on(power), 1.0);
                for j in 0..power {
                    sum += binomial * goes_on(j) * behind[power - j - 1];
                    binomial *= (power - j) as f64 / (j + 1) as f64;
                }
                sum
            });
        }
        Some(behind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{
        AnalyticCosine, Bounded, Clip, Constant, Counted, Extinction, PiecewiseConstant, Ray,
    };
    use fairflight_sources::{Scripted, Seeded};
    use glam::DVec3;

    /// u with −ln(1 − u) = depth.
    fn variate(depth: f64) -> f64 {
        -(-depth).exp_m1()
    }

    #[test]
    fn a_candidate_is_accepted_and_survives_or_its_stratum_is_over() {
        // Two strata of length 1 with h σ_t = 0.25, then 0.75.
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.25, 0.75]).unwrap();
        let field = Bounded::new(steps, 1.0).unwrap();
        let sample = |variates: &[f64]| {
            JitteredFlight::new(1.0).unwrap().sample(&field, &mut Scripted::new(variates.to_vec())).distance()
        };
        let past = variate(2.0);
        assert_eq!(sample(&[0.5, 0.24, past]), Some(0.5));
        assert_eq!(sample(&[0.5, 0.26, 0.5, 0.76]), None);
        // The flight to the candidate at 0.5 collides at 0.1: on to the second stratum.
        assert_eq!(sample(&[0.5, 0.24, variate(0.1), 0.2, 0.25, 0.74, past]), Some(1.25));
        // At 0.1 it does not collide, and passes.
        assert_eq!(sample(&[0.5, 0.24, variate(0.1), 0.3, past]), Some(0.5));
        // Both decisions change at the number itself.
        let (below, there) = (0.25_f64.next_down(), 0.25);
        assert_eq!(sample(&[0.5, below, variate(0.1), below, 0.25, 0.75_f64.next_down(), past]), Some(1.25));
        assert_eq!(sample(&[0.5, below, variate(0.1), there, past]), Some(0.5));
        assert_eq!(sample(&[0.5, there, 0.5, 0.75]), None);
    }

    #[test]
    fn expected_look_ups_of_a_constant_field_by_hand() {
        // One stratum, e = σ_t = majorant = 1: every candidate is accepted, and the flight to it at x looks up where it collides, with
        // the probability 1 − e^−x. On average 1 + ∫ (1 − e^−x) dx = 1 + e^−1.
        let field = Constant::new(1.0, 1.0).unwrap();
        let lookups = |field: Constant| {
            let mut quadrature = RayQuadrature::new(field, &[]);
            JitteredFlight::new(1.0).unwrap().lookups(&mut quadrature, Tolerance::TIGHT).unwrap()
        };
        let found = lookups(field);
        assert!((found[0] - 1.0 - (-1.0_f64).exp()).abs() < 1e-12, "{found:?}");
        // L is 1, or 2 with the probability e^−1.
        for (k, moment) in (1..).zip(found) {
            assert!((moment - 1.0 - (2.0_f64.powi(k) - 1.0) * (-1.0_f64).exp()).abs() < 1e-9);
        }
        assert_eq!(lookups(Constant::new(0.0, 5.0).unwrap()), [0.0; HIGHEST_MOMENT]);
    }

    #[test]
    fn the_seed_ray_costs_about_twice_woodcock_s_look_ups() {
        let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap();
        let clip = clip.unwrap_or_else(|| Clip::empty(DVec3::ZERO, DVec3::Z));
        let ray = Ray::new(AnalyticCosine::new(1.0).unwrap(), &clip);
        let sampler = JitteredFlight::new(0.5).unwrap();
        let raw = sampler.lookups(&mut RayQuadrature::new(&ray, &[]), Tolerance::TIGHT).unwrap();
        // The expectation as it stands in the documentation, by a midpoint sum.
        let n = 200_000;
        let (mut tau, mut reached, mut virtually) = (0.0_f64, 0.0, 0.0);
        let points: Vec<f64> =
            (0..n).map(|i| ray.sigma_t(20.0 * (f64::from(i) + 0.5) / f64::from(n))).collect();
        let step = 20.0 / f64::from(n);
        for stratum in points.chunks(n as usize / 40) {
            reached += (-tau).exp();
            let mut rest: f64 = stratum.iter().sum::<f64>() * step;
            for sigma_t in stratum {
                let half = 0.5 * sigma_t * step;
                (tau, rest) = (tau + half, rest - half);
                virtually += step * (-tau).exp() * rest;
                (tau, rest) = (tau + half, rest - half);
            }
        }
        assert!((raw[0] - reached - virtually).abs() < 1e-6, "{} {}", raw[0], reached + virtually);
        assert!((10.0..11.5).contains(&raw[0]), "{}", raw[0]);

        let counted = Counted::new(&ray);
        let (samples, mut source) = (100_000, Seeded::new(5));
        let escaped =
            (0..samples).filter(|_| sampler.sample(&counted, &mut source).distance().is_none()).count();
        assert!(escaped > 0);
        let mean = counted.lookups() as f64 / f64::from(samples);
        // Five standard errors: a chance of 6e-7.
        let error = ((raw[1] - raw[0] * raw[0]) / f64::from(samples)).sqrt();
        assert!((mean - raw[0]).abs() < 5.0 * error, "{mean} {} ± {error}", raw[0]);
    }
}
