//! At which order of the power series to stop: the roulette of bhanot-1985 as kettunen-2021 uses it.

use super::expected_order;
use fairflight_sources::UniformSource;

/// The orders that are taken for sure once the roulette goes on at all: K, and the c of the probability c/k of going
/// on to order k (bhanot-1985; K = c = 2 in kettunen-2021).
const SURE: u32 = 2;
const C: f64 = 2.0;

/// A random order N ≥ 0 without an upper bound:
///
/// > P(N ≥ 0) = 1, P(N ≥ 1) = P(N ≥ 2) = P, P(N ≥ k) = P Π_{i=3..k} 2/i = P 2^{k−1}/k!,
///
/// with P = 1 − p_Z, p_Z the probability of stopping at order 0. A series Σ_k a_k/k! is estimated without bias by
/// Σ_{k≤N} a_k w_k, w_k = 1/(k! P(N ≥ k)) = 2^{1−k}/P, if N is independent of the a_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roulette {
    /// P = 1 − p_Z.
    going_on: f64,
}

/// Why a roulette was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RouletteError {
    /// The probability of stopping at order 0 is negative, or not a number.
    #[error("the stop probability must be at least 0, found {0}")]
    StopProbabilityNotAtLeastZero(f64),
    /// It is 1 or more: the series would be cut off, a bias.
    #[error("the stop probability must be below 1, found {0}")]
    StopProbabilityNotBelowOne(f64),
}

impl Roulette {
    /// p_Z = 0.9, that of kettunen-2021.
    pub const KETTUNEN: Self = Self { going_on: 0.1 };

    /// The P that [`Self::tuned`] does not leave.
    pub const TUNED_RANGE: [f64; 2] = [1e-3, 0.5];

    /// The roulette that stops at order 0 with this probability.
    ///
    /// # Errors
    /// If the probability is not in \[0, 1).
    pub fn new(stop_probability: f64) -> Result<Self, RouletteError> {
        if stop_probability >= 1.0 {
            return Err(RouletteError::StopProbabilityNotBelowOne(stop_probability));
        }
        if stop_probability >= 0.0 {
            Ok(Self { going_on: 1.0 - stop_probability })
        } else {
            Err(RouletteError::StopProbabilityNotAtLeastZero(stop_probability))
        }
    }

    /// The roulette for combs of variance `k2`: P = sqrt(k2/(2 (β − 2/3))) = 0.445 sqrt(k2), within \[10^-3, 1/2\].
    ///
    /// **Derivation.** By [`predicted_relative_variance`](super::predicted_relative_variance) variance times look-ups
    /// is proportional to (1 − 2P/3 + k2/(2P)) (1 + βP), β = E\[N\]/P = 2 + (e² − 5)/2. To first order in P and k2/P
    /// that is 1 + (β − 2/3) P + k2/(2P), least at the P above.
    ///
    /// **The range.** Below P = 10^-3 the corrections cost βP < 0.32 % of the look-ups, so that nothing is left to
    /// save, while a k2 that turns out larger than believed costs k2²/(2P). Above 1/2 the expansion says nothing: k2
    /// > 1.26 is outside the domain of the law, where combs need more teeth or more segments and not another P.
    ///
    /// `k2` from anything that is independent of the estimate (earlier rays:
    /// [`RunningCumulant`](super::RunningCumulant)) leaves the estimate unbiased. A `k2` that is not a number, or not
    /// positive, counts as 0.
    #[must_use]
    pub fn tuned(k2: f64) -> Self {
        let [least, greatest] = Self::TUNED_RANGE;
        let slope = 2.0 * (expected_order(0.0, SURE, C) - 2.0 / 3.0);
        let optimum = (k2.max(0.0) / slope).sqrt();
        Self { going_on: optimum.clamp(least, greatest) }
    }

    /// P = P(N ≥ 1) = 1 − p_Z.
    #[must_use]
    pub fn going_on(&self) -> f64 {
        self.going_on
    }

    /// p_Z = P(N = 0).
    #[must_use]
    pub fn stop_probability(&self) -> f64 {
        1.0 - self.going_on
    }

    /// P(N ≥ `order`).
    #[must_use]
    pub fn reached(&self, order: u32) -> f64 {
        if order == 0 {
            return 1.0;
        }
        (SURE + 1..=order).fold(self.going_on, |reached, k| reached * (C / f64::from(k)))
    }

    /// w_0 = 1, w_k = 1/(k! P(N ≥ k)) = 2^{1−k}/P.
    #[must_use]
    pub fn weight(&self, order: u32) -> f64 {
        if order == 0 { 1.0 } else { 0.5_f64.powi(order as i32 - 1) / self.going_on }
    }

    /// E\[N\].
    #[must_use]
    pub fn expected_order(&self) -> f64 {
        expected_order(self.stop_probability(), SURE, C)
    }

    /// Draws N: one variate, and one more for each order from the third on that is tried.
    ///
    /// The published codes compare one variate with all P(N ≥ k). On the lattice of multiples of 2^-53 that is wrong
    /// from about order 20 on, where P(N ≥ k) falls below the lattice's step, and the variate 0 never stops: terms
    /// (D/2)^k of such orders are not small for a comb of large deviation D. A variate for every decision makes each
    /// probability exact to 2^-53, and costs 0.22 variates more for P = 0.1.
    #[inline]
    pub fn sample_order(&self, source: &mut impl UniformSource) -> u32 {
        if source.next_uniform() >= self.going_on {
            return 0;
        }
        let mut order = SURE;
        while source.next_uniform() * f64::from(order + 1) < C {
            order += 1;
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};

    #[test]
    fn weights_undo_the_roulette() {
        let roulette = Roulette::new(0.7).unwrap();
        let mut factorial = 1.0;
        for k in 0..25_u32 {
            factorial *= f64::from(k.max(1));
            let product = roulette.weight(k) * factorial * roulette.reached(k);
            assert_relative_eq!(product, 1.0, max_relative = 1e-14);
        }
        let mean: f64 = (1..40).map(|k| roulette.reached(k)).sum();
        assert_relative_eq!(mean, roulette.expected_order(), max_relative = 1e-14);
        assert_relative_eq!(Roulette::KETTUNEN.expected_order(), 0.319_452_8, max_relative = 1e-7);
    }

    #[test]
    fn each_order_is_a_decision_of_its_own() {
        let roulette = Roulette::KETTUNEN;
        let order = |script: &[f64]| {
            let mut source = Scripted::new(script.iter().copied());
            let order = roulette.sample_order(&mut source);
            assert_eq!(source.remaining(), 0);
            order
        };
        assert_eq!(order(&[0.1]), 0);
        assert_eq!(order(&[LARGEST_VARIATE]), 0);
        assert_eq!(order(&[0.05, 0.7]), 2);
        assert_eq!(order(&[0.0, 0.66, 0.49, 0.41]), 4);
        // No cap: variates of 0 go on for as long as there are any.
        let mut script = vec![0.0; 200];
        script.push(0.5);
        assert_eq!(order(&script), 201);
    }

    #[test]
    fn orders_have_their_probabilities() {
        let (roulette, mut source) = (Roulette::new(0.4).unwrap(), Seeded::new(5));
        let n = 200_000;
        let mut counts = [0.0; 6];
        for _ in 0..n {
            let order = roulette.sample_order(&mut source) as usize;
            counts.iter_mut().take(order + 1).for_each(|count| *count += 1.0);
        }
        for (k, count) in counts.into_iter().enumerate() {
            let p = roulette.reached(k as u32);
            let error = (p * (1.0 - p) / f64::from(n)).sqrt();
            // Six counts at a false alarm of 1e-6 together.
            assert!((count / f64::from(n) - p).abs() <= 5.2 * error, "P(N >= {k}) = {p}");
        }
    }

    #[test]
    fn the_tuned_roulette_minimises_variance_times_cost() {
        for k2 in [1e-4_f64, 1e-2, 0.05] {
            let tuned = Roulette::tuned(k2).going_on();
            assert_relative_eq!(tuned, 0.4447 * k2.sqrt(), max_relative = 1e-3);
            let beta = Roulette::new(0.0).unwrap().expected_order();
            let figure = |p: f64| 1.0 + (beta - 2.0 / 3.0) * p + k2 / (2.0 * p);
            assert!(figure(tuned) < figure(1.01 * tuned) && figure(tuned) < figure(0.99 * tuned));
        }
        assert_eq!([0.0, -1.0, f64::NAN, 1e-9].map(|k2| Roulette::tuned(k2).going_on()), [1e-3; 4]);
        assert_eq!(Roulette::tuned(f64::INFINITY).going_on(), 0.5);
    }

    #[test]
    fn a_series_is_not_cut_off() {
        assert_eq!(Roulette::new(1.0), Err(RouletteError::StopProbabilityNotBelowOne(1.0)));
        assert_eq!(Roulette::new(-0.1), Err(RouletteError::StopProbabilityNotAtLeastZero(-0.1)));
        assert!(Roulette::new(f64::NAN).is_err());
    }
}
