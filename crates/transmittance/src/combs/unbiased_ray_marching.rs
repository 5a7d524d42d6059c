//! Unbiased ray marching: kettunen-2021, with any comb, any stop probability and any number of segments.

use super::deviation::DeviationLaw;
use super::power_series::of_draws;
use super::second_moment::relative_variance;
use super::symmetric_means::IN_PLACE;
use super::{Comb, Prepared, Roulette, RunningCumulant};
use crate::allowance::{Allowance, NODES};
use crate::{ClosedForm, HIGHEST_MOMENT, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_elementary::{exp, exp_m1, ln, ln_1p};
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

    /// The end of the `segment`-th of so many segments, from 1 on.
    #[inline]
    pub(crate) fn end_of(length: f64, segment: u32, segments: u32) -> f64 {
        if segment == segments { length } else { length * (f64::from(segment) / f64::from(segments)) }
    }

    /// The product over the segments. `observe` sees X_0 − X_i, i = 0 … N, of each segment with N > 0.
    #[inline]
    fn product<F: Extinction>(
        &self,
        field: &F,
        source: &mut impl UniformSource,
        mut observe: impl FnMut(&[f64]),
    ) -> f64 {
        let end = |segment: u32| Self::end_of(field.length(), segment, self.segments);
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
            let end = Self::end_of(field.length(), segment, self.segments);
            let prepared = match &before {
                None => self.comb.prepare(field, 0.0, end),
                Some(before) => self.comb.prepare_next(field, before, end),
            };
            let mut law = DeviationLaw::new((&self.comb, field, &prepared), tolerance, allowance)?;
            let (variance, relative) = relative_variance(&mut law, self.roulette)?;
            // Independent factors: second moments multiply.
            log_square += ln_1p(variance);
            error += relative * variance / (1.0 + variance);
            before = Some(prepared);
        }
        let variance = exp_m1(log_square);
        let mut relative_central = [f64::NAN; HIGHEST_MOMENT - 1];
        if variance == 0.0 {
            relative_central = [0.0; HIGHEST_MOMENT - 1];
        }
        relative_central[0] = variance;
        Some(Theory {
            relative_central,
            log_relative_variance: if log_square > 1.0 {
                log_square + ln_1p(-exp(-log_square))
            } else {
                ln(variance)
            },
            // dVar/Var = dL exp(L)/(exp(L) − 1), L = Σ ln(1 + v) over the segments.
            relative_variance_error: if variance > 0.0 { error / -exp_m1(-log_square) } else { 0.0 },
            ..Theory::mean_only(self.expected_lookups())
        })
    }
}

#[cfg(test)]
#[path = "unbiased_ray_marching_tests.rs"]
mod tests;
