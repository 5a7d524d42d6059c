//! An estimate by combs, averaged over everything that it draws.

use super::decisions::expectation;
use fairflight_media::PiecewiseConstant;
use fairflight_sources::{LARGEST_VARIATE, Scripted};
use fairflight_transmittance::{Roulette, TransmittanceEstimator, UnbiasedRayMarching};

/// The highest order that is averaged.
const MOST: u32 = 12;

/// Error of the mean without higher orders: for deviations of at most 1, 1/13!.
pub const MEAN_GRANTED: f64 = 1e-9;

/// Error of the variance without them, relative to it: higher orders have the probability 2^12/13! < 1e-6, and weights below 1e-2.
pub const VARIANCE_GRANTED: f64 = 1e-6;

/// E\[estimate/T\] and Var\[estimate/T\] of an estimate with one segment and one tooth of equal weight, on a field of two cells of equal
/// length: the tooth stands in either with probability 1/2, X(u) has two values, and the average over all 2^(N + 1) choices is the
/// expectation for the order N. The probabilities of orders are those of the decisions that are drawn, not those that are told.
///
/// **Law.** The mean is 1; the variance is that of the estimator's theory.
pub fn mean_and_variance(
    estimator: &UnbiasedRayMarching,
    field: &PiecewiseConstant,
    thickness: f64,
) -> [f64; 2] {
    let scale = thickness.exp();
    let (mut reached, mut mean, mut square) = (1.0, 0.0, 0.0);
    for order in (0..=MOST).filter(|&order| order != 1) {
        // Of higher orders the first terms are those of the last one here.
        let goes_on = if order == MOST { 0.0 } else { goes_on(estimator.roulette(), order) };
        let probability = reached * (1.0 - goes_on);
        reached *= goes_on;
        let (mut first, mut second) = (0.0, 0.0);
        let choices = 1_u32 << (order + 1);
        for choice in 0..choices {
            let tooth = |i: u32| if choice >> i & 1 == 0 { 0.25 } else { 0.75 };
            let mut source = Scripted::new(decisions(order).chain((0..=order).map(tooth)));
            let estimate = scale * estimator.estimate(field, &mut source);
            first += estimate;
            second += (estimate - 1.0) * (estimate - 1.0);
        }
        mean += probability * first / f64::from(choices);
        square += probability * second / f64::from(choices);
    }
    [mean, square - (mean - 1.0) * (mean - 1.0)]
}

/// Variates of decisions that lead to this order: 0 goes on, the largest one stops. The second order follows the first for sure.
fn decisions(order: u32) -> impl Iterator<Item = f64> {
    (1..order.max(1)).map(|_| 0.0).chain([LARGEST_VARIATE])
}

/// The probability of an order above `order`, once it is reached.
fn goes_on(roulette: Roulette, order: u32) -> f64 {
    expectation(|u| {
        let before = (1..order.max(1)).map(|_| 0.0);
        let mut source = Scripted::new(before.chain([u, LARGEST_VARIATE]));
        if roulette.sample_order(&mut source) > order { 1.0 } else { 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_transmittance::{Comb, CombShape};

    #[test]
    fn decisions_have_the_probabilities_of_the_roulette() {
        let roulette = Roulette::new(0.3).unwrap();
        let reached = |order| roulette.reached(order);
        assert!((goes_on(roulette, 0) - reached(2)).abs() < 1e-15);
        for order in 2..9 {
            assert!((goes_on(roulette, order) - reached(order + 1) / reached(order)).abs() < 1e-15);
        }
    }

    #[test]
    fn the_average_over_all_draws_is_the_transmittance() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.4, 0.8]).unwrap();
        let comb = Comb::new(1, CombShape::Uniform).unwrap();
        let estimator = UnbiasedRayMarching::new(comb, Roulette::new(0.5).unwrap());
        let [mean, _] = mean_and_variance(&estimator, &field, 1.2);
        assert!((mean - 1.0).abs() < MEAN_GRANTED, "{mean}");
        // A thickness that is off by a millionth shows.
        let [mean, _] = mean_and_variance(&estimator, &field, 1.200_001);
        assert!((mean - 1.0).abs() > 1e-7);
    }
}
