//! Unbiased ray marching: kettunen-2021, with any comb, any stop probability and any number of segments.

use super::deviation::DeviationLaw;
use super::power_series::of_draws;
use super::second_moment::relative_variance;
use super::symmetric_means::IN_PLACE;
use super::{Comb, Prepared, Roulette, RunningCumulant};
use crate::allowance::{Allowance, NODES};
use crate::{ClosedForm, HIGHEST_MOMENT, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_media::{Breakpoints, Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use smallvec::SmallVec;

/// exp(−X) of a comb, with what it lacks added by a power series in the deviations of further combs.
///
/// ```text
/// N = order of the roulette; X_0 … X_N independent draws of the comb
/// T̂ = 1/(N+1) Σ_j exp(−X_j) Σ_{k≤N} m_k({X_j − X_i}_{i≠j}) / (k! P(N ≥ k))           (kettunen-2021)
/// ```
///
/// m_k the elementary symmetric means ([`crate::SymmetricMeans`]). With a uniform comb and [`Roulette::KETTUNEN`] it is the
/// estimator of the paper.
///
/// **Law.** Unbiased on every profile. *Proof.* N is independent of all X, and X_j of the other X, so that E\[m_k |
/// X_j\] = (X_j − τ)^k for k ≤ N; the roulette's weights make of the sum E\[Σ | X_j\] = Σ_k (X_j − τ)^k/k! = exp(X_j
/// − τ), for every j, and exp(−X_j) cancels. No majorant is needed. Estimates may be negative.
///
/// **Segments.** [`Self::in_segments`] makes the product of independent estimates over equal parts of the ray. The
/// second-order noise falls from k2²/(2P) to k2²/(2GP). A ray whose combs resolve it is better off in one piece.
///
/// **Variance.** Exact, by `second_moment`; [`super::predicted_relative_variance`] is the law of small deviations. Zero on a
/// constant profile, and for endpoint matching on a linear one (not for the periodised comb).
///
/// **Cost.** G M (1 + E\[N\]) look-ups and the comb's shared ones; neighbouring segments share the one at their border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnbiasedRayMarching {
    comb: Comb,
    roulette: Roulette,
    segments: u32,
}

/// A profile has at least one segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("segments must be at least 1, found 0")]
pub struct NoSegments;

impl UnbiasedRayMarching {
    /// The estimator of the whole profile at once.
    #[must_use]
    pub fn new(comb: Comb, roulette: Roulette) -> Self {
        Self { comb, roulette, segments: 1 }
    }

    /// The product of estimates over `segments` equal parts, each with the whole comb and a roulette of its own.
    ///
    /// # Errors
    /// If `segments` is 0.
    pub fn in_segments(self, segments: u32) -> Result<Self, NoSegments> {
        if segments == 0 { Err(NoSegments) } else { Ok(Self { segments, ..self }) }
    }

    /// The same with another roulette: one tuned by the rays before.
    #[must_use]
    pub fn with_roulette(self, roulette: Roulette) -> Self {
        Self { roulette, ..self }
    }

    /// The comb.
    #[must_use]
    pub fn comb(&self) -> Comb {
        self.comb
    }

    /// The roulette.
    #[must_use]
    pub fn roulette(&self) -> Roulette {
        self.roulette
    }

    /// The number of segments.
    #[must_use]
    pub fn segments(&self) -> u32 {
        self.segments
    }

    /// The expected number of look-ups, which is the same on every profile.
    #[must_use]
    pub fn expected_lookups(&self) -> f64 {
        let combs = f64::from(self.segments) * (1.0 + self.roulette.expected_order());
        self.comb.shared_lookups(self.segments) + f64::from(self.comb.teeth()) * combs
    }

    /// As [`TransmittanceEstimator::estimate`], and shows `earlier` the sample variance of the draws of each segment
    /// that had more than one: k2 of a segment, without bias, at no look-up. For the roulettes of *later* estimates.
    pub fn estimate_and_observe<F: Extinction>(
        &self,
        field: &F,
        source: &mut impl UniformSource,
        earlier: &mut RunningCumulant,
    ) -> f64 {
        self.product(field, source, |deviations| earlier.observe(sample_variance(deviations)))
    }

    /// The product over the segments. `observe` sees X_0 − X_i, i = 0 … N, of each segment with N > 0.
    #[inline]
    fn product<F: Extinction>(
        &self,
        field: &F,
        source: &mut impl UniformSource,
        mut observe: impl FnMut(&[f64]),
    ) -> f64 {
        let length = field.length();
        let end = |segment: u32| {
            if segment == self.segments {
                length
            } else {
                length * (f64::from(segment) / f64::from(self.segments))
            }
        };
        let (mut product, mut thickness) = (SignedProduct::ONE, 0.0);
        let mut prepared = self.comb.prepare(field, 0.0, end(1));
        for segment in 1..=self.segments {
            if segment > 1 {
                prepared = self.comb.prepare_next(field, &prepared, end(segment));
            }
            let order = self.roulette.sample_order(source);
            let first = self.comb.thickness(field, &prepared, source.next_uniform());
            thickness += first;
            if order > 0 {
                let (sum, exponent) = self.series(field, &prepared, source, first, order, &mut observe);
                product.multiply(sum);
                thickness -= exponent;
            }
        }
        product.times_exp(-thickness)
    }

    /// exp(X_0) times the estimate of a segment, from X_0 and the draws of `order` further combs: as s exp(t), see [`of_draws`].
    fn series<F: Extinction>(
        &self,
        field: &F,
        prepared: &Prepared,
        source: &mut impl UniformSource,
        first: f64,
        order: u32,
        observe: &mut impl FnMut(&[f64]),
    ) -> (f64, f64) {
        // X_0 − X_i: only differences enter, and they lose no digits to a large thickness.
        let mut deviations: SmallVec<[f64; IN_PLACE]> = SmallVec::new();
        deviations.push(0.0);
        for _ in 0..order {
            deviations.push(first - self.comb.thickness(field, prepared, source.next_uniform()));
        }
        observe(&deviations);
        of_draws(self.roulette, &deviations)
    }
}

/// Σ (x − x̅)²/N of N + 1 values.
fn sample_variance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)
}

impl<F: Extinction> TransmittanceEstimator<F> for UnbiasedRayMarching {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.product(field, source, |_| ())
    }

    fn admits(&self, _field: &F, _s: f64, _sigma_t: f64) -> bool {
        true
    }
}

impl<F: Breakpoints> ClosedForm<F> for UnbiasedRayMarching {
    /// Variance and look-ups; the higher central moments have no closed form here.
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let allowance = Allowance::usual();
        self.theory_within(&allowance, quadrature.field(), tolerance)
            .unwrap_or_else(|| Theory::without(allowance.unreached(2), self.expected_lookups()))
    }
}

impl UnbiasedRayMarching {
    /// The law, if its quadratures are within the allowance.
    fn theory_within<F: Breakpoints>(
        &self,
        allowance: &Allowance,
        field: &F,
        tolerance: Tolerance,
    ) -> Option<Theory> {
        // The mean and the deviations at the nodes of one panel for each segment: before any of them.
        let least = 2.0 * NODES * f64::from(self.comb.teeth()) * f64::from(self.segments);
        if !allowance.has(least) {
            return None;
        }
        let (mut log_square, mut error) = (0.0, 0.0);
        let mut before: Option<Prepared> = None;
        for segment in 1..=self.segments {
            let end = if segment == self.segments {
                field.length()
            } else {
                field.length() * (f64::from(segment) / f64::from(self.segments))
            };
            let prepared = match &before {
                None => self.comb.prepare(field, 0.0, end),
                Some(before) => self.comb.prepare_next(field, before, end),
            };
            let mut law = DeviationLaw::new((&self.comb, field, &prepared), tolerance, allowance)?;
            let (variance, relative) = relative_variance(&mut law, self.roulette)?;
            // Independent factors: second moments multiply.
            log_square += variance.ln_1p();
            error += relative * variance / (1.0 + variance);
            before = Some(prepared);
        }
        let variance = log_square.exp_m1();
        let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
        if variance == 0.0 {
            relative_central = [0.0; HIGHEST_MOMENT - 1];
        }
        relative_central[0] = variance;
        Some(Theory {
            relative_central,
            log_relative_variance: if log_square > 1.0 {
                log_square + (-(-log_square).exp()).ln_1p()
            } else {
                variance.ln()
            },
            // dVar/Var = dL exp(L)/(exp(L) − 1), L = Σ ln(1 + v) over the segments.
            relative_variance_error: if variance > 0.0 { error / -(-log_square).exp_m1() } else { 0.0 },
            ..Theory::mean_only(self.expected_lookups())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::combs::CombShape;
    use crate::test_support::{agrees, seed_ray, tent, theory_of};
    use approx::assert_relative_eq;
    use fairflight_media::{Constant, PiecewiseConstant, PiecewiseLinear};
    use fairflight_sources::{Scripted, Seeded};

    fn comb(teeth: u32, shape: CombShape) -> Comb {
        Comb::new(teeth, shape).unwrap()
    }

    #[test]
    fn exact_variances_on_the_seed_ray() {
        // Teeth, roulette, variance and look-ups as measured with 10^6 samples by the prototype of these estimators.
        let ray = seed_ray();
        let tuned = |teeth, shape| {
            Roulette::tuned(comb(teeth, shape).cumulants(&ray, 0.0, 20.0, Tolerance::TIGHT).k2)
        };
        let kettunen = Roulette::KETTUNEN;
        for (teeth, shape, roulette, variance, lookups) in [
            (8, CombShape::Uniform, kettunen, 6.7, 10.6),
            (15, CombShape::Uniform, kettunen, 0.589, 19.8),
            (20, CombShape::Uniform, kettunen, 0.0497, 26.4),
            (25, CombShape::Uniform, kettunen, 0.0271, 33.0),
            (25, CombShape::EndpointMatched, kettunen, 3.59e-4, 35.0),
            (25, CombShape::Bernoulli3, tuned(25, CombShape::Bernoulli3), 3.51e-4, 31.7),
        ] {
            let theory = theory_of(ray, &UnbiasedRayMarching::new(comb(teeth, shape), roulette));
            assert_relative_eq!(theory.relative_central[0], variance, max_relative = 0.006);
            assert_relative_eq!(theory.lookups, lookups, max_relative = 0.005);
            assert!(theory.relative_variance_error < 1e-9);
        }
    }

    #[test]
    fn segments_on_the_seed_ray() {
        // Five combs of five teeth with endpoint matching, the stop probability of each its own: 1.49e-3 at 31.5.
        // With one for all:
        let ray = seed_ray();
        let comb = comb(5, CombShape::EndpointMatched);
        let k2: f64 = (0..5)
            .map(|g| comb.cumulants(&ray, 4.0 * f64::from(g), 4.0 * f64::from(g + 1), Tolerance::TIGHT).k2)
            .sum();
        let estimator = UnbiasedRayMarching::new(comb, Roulette::tuned(k2 / 5.0)).in_segments(5).unwrap();
        let theory = theory_of(ray, &estimator);
        assert_relative_eq!(theory.relative_central[0], 1.49e-3, max_relative = 0.02);
        assert_relative_eq!(theory.lookups, 31.5, max_relative = 0.02);
    }

    /// Segments of which each is affordable and all are not: humps that no breakpoint tells of.
    #[test]
    fn all_segments_share_the_allowance() {
        struct Humps {
            length: f64,
            lookups: std::cell::Cell<f64>,
        }
        impl Extinction for Humps {
            fn sigma_t(&self, s: f64) -> f64 {
                self.lookups.set(self.lookups.get() + 1.0);
                (7.3 * s).sin().abs()
            }
            fn length(&self) -> f64 {
                self.length
            }
        }
        impl Breakpoints for Humps {
            fn breakpoints(&self) -> Vec<f64> {
                Vec::new()
            }
        }
        let estimator = UnbiasedRayMarching::new(comb(3, CombShape::Uniform), Roulette::KETTUNEN);
        let within = |most: f64, segments: u32| {
            let humps = Humps { length: 10.0 * f64::from(segments), lookups: std::cell::Cell::new(0.0) };
            let estimator = estimator.in_segments(segments).unwrap();
            let theory = estimator.theory_within(&Allowance::of(most), &humps, Tolerance::to(1e-6));
            (theory.is_some(), humps.lookups.get())
        };
        let (known, one) = within(1e6, 1);
        assert!(known);
        let (known, taken) = within(10.0 * one, 30);
        assert!(!known && taken > one && taken <= 10.0 * one, "{taken} of {}", 10.0 * one);
    }

    /// Periods of a saw, one to a segment: where each variance v is off by a share e, ln Π (1 + v) is off by n e v/(1 + v).
    #[test]
    fn the_error_of_many_factors_is_that_of_their_logarithms() {
        let saw = |periods: u32| {
            let nodes = (0..=2 * periods).map(|i| f64::from(4 * (i / 2) + i % 2)).collect();
            let values = (0..=2 * periods).map(|i| if i % 2 == 0 { 0.0 } else { 6.0 }).collect();
            PiecewiseLinear::new(nodes, values).unwrap()
        };
        let estimator = UnbiasedRayMarching::new(comb(2, CombShape::Uniform), Roulette::new(0.5).unwrap());
        let loose = Tolerance { most_panels: 2, ..Tolerance::to(1e-9) };
        let theory = |periods: u32| {
            let estimator = estimator.in_segments(periods).unwrap();
            estimator.theory(&mut RayQuadrature::new(saw(periods), &[]), f64::NAN, loose)
        };
        let one = theory(1);
        let (v, e) = (one.relative_central[0], one.relative_variance_error);
        assert!(v > 1.0 && e > 1e-12, "{one:?}");
        for n in [2_u32, 5] {
            let found = theory(n);
            let variance = (1.0 + v).powi(n as i32) - 1.0;
            assert_relative_eq!(found.relative_central[0], variance, max_relative = 1e-9);
            let exact = f64::from(n) * e * v / (1.0 + v) * (1.0 + variance) / variance;
            assert_relative_eq!(found.relative_variance_error, exact, max_relative = 1e-2);
        }
    }

    #[test]
    fn mean_variance_and_look_ups_are_those_of_samples() {
        let (field, mut source) = (tent(), Seeded::new(13));
        let cases = CombShape::ALL.map(|shape| (shape, 1)).into_iter().chain([(CombShape::Bernoulli2, 2)]);
        for (shape, segments) in cases {
            let estimator = UnbiasedRayMarching::new(comb(2, shape), Roulette::new(0.6).unwrap());
            agrees(&field, &estimator.in_segments(segments).unwrap(), 200_000, &mut source);
        }
    }

    #[test]
    fn the_variance_has_its_digits_however_small_it_is() {
        // A line has uniform deviations; k2 falls by eight orders with each case. To leading order V = k2 (1 − P (1 −
        // E[1/(N + 1) | N ≥ 2])).
        let average: f64 = (2..40)
            .map(|k| {
                let all = Roulette::new(0.0).unwrap();
                (all.reached(k) - all.reached(k + 1)) / f64::from(k + 1)
            })
            .sum();
        assert_relative_eq!(1.0 - average, 0.7447, max_relative = 1e-3);
        for rise in [1e-4, 1e-8, 1e-12] {
            let line = PiecewiseLinear::new(vec![0.0, 2.0], vec![1.0, 1.0 + rise]).unwrap();
            // D = h (2 u − 1) rise/2, h = 2/3.
            let k2 = rise * rise / 27.0;
            for p in [0.1, 1e-3] {
                let roulette = Roulette::new(1.0 - p).unwrap();
                let estimator = UnbiasedRayMarching::new(comb(3, CombShape::Uniform), roulette);
                let theory = theory_of(&line, &estimator);
                let exact = k2 * (1.0 - p * (1.0 - average));
                // The quadratic term is of the relative size k2/P; D has its own rounding.
                let error = 2.0 * k2 / p + 1e-13 + 1e-15 / rise;
                assert_relative_eq!(theory.relative_central[0], exact, max_relative = error);
            }
        }
    }

    #[test]
    fn a_constant_profile_has_no_variance() {
        let field = Constant::new(0.7, 3.0).unwrap();
        let mut source = Seeded::new(3);
        for shape in [CombShape::Uniform, CombShape::EndpointMatched, CombShape::Bernoulli3] {
            let estimator = UnbiasedRayMarching::new(comb(4, shape), Roulette::new(0.2).unwrap());
            let estimator = estimator.in_segments(3).unwrap();
            assert_eq!(theory_of(field, &estimator).relative_central, [0.0; HIGHEST_MOMENT - 1]);
            for _ in 0..100 {
                let found = estimator.estimate(&field, &mut source);
                assert_relative_eq!(found, (-2.1_f64).exp(), max_relative = 1e-14);
            }
        }
        // Nothing to look up is an exact answer too.
        let empty = Constant::new(0.7, 0.0).unwrap();
        let estimator = UnbiasedRayMarching::new(comb(4, CombShape::Bernoulli3), Roulette::KETTUNEN);
        assert_eq!(estimator.estimate(&empty, &mut source), 1.0);
        assert_eq!(theory_of(empty, &estimator).relative_central[0], 0.0);
    }

    #[test]
    fn an_estimate_of_order_two_by_hand() {
        // σ_t = 2 s on [0, 1], one tooth: X = 2 u.
        let line = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
        let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::new(0.75).unwrap());
        // One variate for the first order, one that refuses the third, three combs.
        let mut source = Scripted::new([0.2, 0.7, 0.25, 0.5, 0.125]);
        let x: [f64; 3] = [0.5, 1.0, 0.25];
        let exact: f64 = (0..3)
            .map(|j| {
                let [y1, y2] = [x[j] - x[(j + 1) % 3], x[j] - x[(j + 2) % 3]];
                (-x[j]).exp() * (1.0 + 4.0 * 0.5 * (y1 + y2) + 2.0 * y1 * y2)
            })
            .sum();
        let mut seen = RunningCumulant::new();
        let found = estimator.estimate_and_observe(&line, &mut source, &mut seen);
        assert_relative_eq!(found, exact / 3.0, max_relative = 1e-14);
        // Mean 7/12, squares of −1/12, 5/12, −4/12 over 2.
        assert_relative_eq!(seen.value().unwrap(), 42.0 / 288.0, max_relative = 1e-14);
        assert_eq!(source.remaining(), 0);
        // Order 0 is exp(−X) and observes nothing.
        let found = estimator.estimate_and_observe(&line, &mut Scripted::new([0.25, 0.5]), &mut seen);
        assert_eq!((found, seen.count()), ((-1.0_f64).exp(), 1));
    }

    #[test]
    fn dense_steps_are_what_logarithms_say() {
        // X is 0.2 at a tooth in the thin part and 80 000 in the dense one, or both: the estimate by hand, term by term in logarithms.
        let step = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.1, 4e4]).unwrap();
        let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::new(0.5).unwrap());
        let (thin, dense) = (0.2_f64, 8e4_f64);
        for (combs, x) in [([0.7, 0.1, 0.9], [dense, thin, dense]), ([0.1, 0.2, 0.9], [thin, thin, dense])] {
            let exact: f64 = (0..3)
                .map(|j| {
                    let [y1, y2] = [x[j] - x[(j + 1) % 3], x[j] - x[(j + 2) % 3]];
                    (-x[j]).exp() * (1.0 + 2.0 * 0.5 * (y1 + y2) + y1 * y2)
                })
                .sum::<f64>()
                / 3.0;
            let mut source = Scripted::new([0.2, 0.7].into_iter().chain(combs));
            let found = estimator.estimate(&step, &mut source);
            assert_relative_eq!(found, exact, max_relative = 1e-10);
        }
    }

    #[test]
    fn orders_have_no_cap() {
        let line = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
        let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::KETTUNEN);
        // Variates of 0 go on to order 50; the combs that follow are equidistant.
        let order = 50;
        let going = [0.0; 49].into_iter().chain([0.99]);
        let combs = (0..=order).map(|i| f64::from(i) / f64::from(order + 1));
        let mut source = Scripted::new(going.chain(combs));
        assert!(estimator.estimate(&line, &mut source).is_finite());
        assert_eq!(source.remaining(), 0);
        assert_eq!(estimator.in_segments(0), Err(NoSegments));
    }
}
