//! Exact inference on a success probability: the two-sided test, the Clopper-Pearson interval, the power.

use crate::binomial::Binomial;
use crate::halving::{halved, halved_whole};
use crate::normal::{two_sided_quantile, upper_quantile};

impl Binomial {
    /// Exact two-sided p-value of k successes: min(1, 2 min(P(X <= k), P(X >= k))).
    ///
    /// Its probability to be at most alpha is at most alpha, for every N and p. Zero for k > N.
    #[must_use]
    pub fn two_sided_p_value(&self, k: u64) -> f64 {
        (2.0 * self.lower_tail(k).min(self.upper_tail(k))).min(1.0)
    }

    /// Smallest d such that every success probability with |p' - p| >= d p is rejected with probability `power` at least
    /// by the two-sided test at `level`.
    ///
    /// p' ends at 0 and 1: a direction in which not even that end is detected counts with its whole length, 1 below and
    /// 1/p - 1 above. So a result of 1 or more says that no success at all would not be noticed, while p = 1 gives
    /// 0 above. `None` where p is zero, as there is no relative deviation; 1 or more for no trials.
    #[must_use]
    pub fn detectable_relative_deviation(&self, level: f64, power: f64) -> Option<f64> {
        if self.p() == 0.0 {
            return None;
        }
        let (p, n, side) = (self.p(), self.trials(), 0.5 * level);
        // Above: rejected from `high` successes on. The power is reached where P(X <= high - 1) = 1 - power.
        let high = self.first_rejected_above(side);
        let above = if high > n { 1.0 } else { upper_limit(high - 1, n, 1.0 - power) };
        // Below: rejected up to `low` successes. The power is reached where P(X >= low + 1) = 1 - power.
        let below = self.last_rejected_below(side).map_or(0.0, |low| lower_limit(low + 1, n, 1.0 - power));
        Some((above / p - 1.0).max(1.0 - below / p))
    }

    /// Smallest k with P(X >= k) <= side; N + 1 if there is none below.
    fn first_rejected_above(&self, side: f64) -> u64 {
        halved_whole((0, self.trials() + 1), |k| self.upper_tail(k) <= side).1
    }

    /// Greatest k with P(X <= k) <= side, if there is one.
    fn last_rejected_below(&self, side: f64) -> Option<u64> {
        if self.lower_tail(0) > side {
            return None;
        }
        Some(halved_whole((0, self.trials()), |k| self.lower_tail(k) > side).0)
    }
}

/// Number of trials, to about a percent, from which on every relative deviation of p by `deviation` is detectable as in
/// [`Binomial::detectable_relative_deviation`]. Infinite for p = 0 or where p is no probability.
///
/// As f64, since N p matters alone where p is small, and N may exceed every integer type.
#[must_use]
pub fn trials_needed(p: f64, level: f64, power: f64, deviation: f64) -> f64 {
    /// Probability below which the law is that of Poisson with mean N p, to a relative error of this order.
    const RARE: f64 = 1e-6;
    if p < RARE {
        return if p > 0.0 { trials_needed(RARE, level, power, deviation) * RARE / p } else { f64::INFINITY };
    }
    let enough = |n: f64| {
        Binomial::new(n as u64, p)
            .ok()
            .and_then(|law| law.detectable_relative_deviation(level, power))
            .is_some_and(|d| d < deviation)
    };
    // The normal estimate starts the search; doubling and halving find a bracket, which is then narrowed.
    let reach = (two_sided_quantile(level) + upper_quantile(1.0 - power)) / deviation;
    let mut high = (reach * reach * (1.0 - p) / p).max(1.0);
    while !enough(high) {
        if high > 1e15 || p > 1.0 {
            return f64::INFINITY;
        }
        high *= 2.0;
    }
    let mut low = 0.5 * high;
    while low >= 1.0 && enough(low) {
        (low, high) = (0.5 * low, low);
    }
    halved((low, high), |high| (0.01 * high).max(1.0), enough).1.ceil()
}

/// The exact interval of Clopper and Pearson (1934) for the success probability after k successes in n trials: it
/// misses the true one with probability at most `level`. \[0, 1\] for no trials.
#[must_use]
pub fn clopper_pearson(k: u64, n: u64, level: f64) -> (f64, f64) {
    (lower_limit(k, n, 0.5 * level), upper_limit(k, n, 0.5 * level))
}

/// The p at which P(X >= k) = tail: below it so many successes are too surprising. Zero for k = 0.
fn lower_limit(k: u64, n: u64, tail: f64) -> f64 {
    debug_assert!(k <= n && tail > 0.0 && tail < 0.5, "{k} of {n} at {tail}");
    if k == 0 {
        return 0.0;
    }
    let surprising = |p| tail_at(n, p, |law| law.upper_tail(k)) <= tail;
    let mut high = k as f64 / n as f64;
    let mut low = 0.5 * high;
    while !surprising(low) {
        (low, high) = (0.5 * low, low);
    }
    bisect(low, high, surprising)
}

/// The p at which P(X <= k) = tail: above it so few successes are too surprising. One for k = n.
fn upper_limit(k: u64, n: u64, tail: f64) -> f64 {
    debug_assert!(k <= n && tail > 0.0 && tail < 0.5, "{k} of {n} at {tail}");
    if k == n {
        return 1.0;
    }
    if k == 0 {
        return -(tail.ln() / n as f64).exp_m1();
    }
    let plausible = |p| tail_at(n, p, |law| law.lower_tail(k)) > tail;
    let mut low = k as f64 / n as f64;
    let mut high = (2.0 * low).min(1.0);
    while plausible(high) {
        (low, high) = (high, (2.0 * high).min(1.0));
    }
    bisect(low, high, plausible)
}

fn tail_at(n: u64, p: f64, tail: impl Fn(&Binomial) -> f64) -> f64 {
    Binomial::new(n, p).map_or(f64::NAN, |law| tail(&law))
}

/// The boundary between `low`, where the predicate holds, and `high`, where it does not, to a relative 1e-14.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while high - low > 1e-14 * high {
        let middle = low + 0.5 * (high - low);
        if middle == low || middle == high {
            break; // neighbours among the subnormal numbers
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low + 0.5 * (high - low)
}

#[cfg(test)]
mod tests {
    use super::{clopper_pearson, trials_needed};
    use crate::binomial::Binomial;
    use approx::assert_relative_eq;

    fn law(trials: u64, p: f64) -> Binomial {
        Binomial::new(trials, p).unwrap()
    }

    #[test]
    fn p_values_by_hand() {
        // Ten fair trials: P(X <= 1) = 11/1024.
        let fair = law(10, 0.5);
        assert_relative_eq!(fair.two_sided_p_value(1), 22.0 / 1024.0, max_relative = 1e-13);
        assert_relative_eq!(fair.two_sided_p_value(9), 22.0 / 1024.0, max_relative = 1e-13);
        assert_eq!((fair.two_sided_p_value(5), fair.two_sided_p_value(11)), (1.0, 0.0));
        // One success of a rare event has z = 31.6 and is not even surprising at the level 1e-3.
        assert_relative_eq!(law(1_000_000, 1e-9).two_sided_p_value(1), 1.999_000_334e-3, max_relative = 1e-8);
        assert_eq!((law(10, 0.0).two_sided_p_value(0), law(10, 0.0).two_sided_p_value(1)), (1.0, 0.0));
        assert_eq!((law(10, 1.0).two_sided_p_value(10), law(10, 1.0).two_sided_p_value(9)), (1.0, 0.0));
        assert_eq!(law(0, 0.5).two_sided_p_value(0), 1.0);
    }

    #[test]
    fn false_alarm_is_at_most_the_level() {
        for (n, p) in [(30, 0.5), (100, 0.03), (1000, 1e-3), (50, 0.97)] {
            for level in [0.05, 1e-3, 1e-6] {
                let law = law(n, p);
                let alarm: f64 =
                    (0..=n).filter(|&k| law.two_sided_p_value(k) <= level).map(|k| law.pmf(k)).sum();
                assert!(alarm <= level, "{n} {p} {level}: {alarm}");
            }
        }
    }

    #[test]
    fn interval_inverts_the_tails() {
        for (k, n) in
            [(3, 10), (1, 1_000_000), (500_000, 1_000_000), (999_000, 1_000_000), (7, 1_000_000_000_000)]
        {
            for level in [0.05, 1e-6] {
                let (low, high) = clopper_pearson(k, n, level);
                assert_relative_eq!(law(n, low).upper_tail(k), 0.5 * level, max_relative = 1e-6);
                assert_relative_eq!(law(n, high).lower_tail(k), 0.5 * level, max_relative = 1e-6);
            }
        }
        // Published: 3 of 10 at 95 % is 0.0667 to 0.6525.
        let (low, high) = clopper_pearson(3, 10, 0.05);
        assert_relative_eq!(low, 0.066_739_5, max_relative = 1e-5);
        assert_relative_eq!(high, 0.652_452_9, max_relative = 1e-5);
    }

    #[test]
    fn interval_at_the_ends() {
        let (low, high) = clopper_pearson(0, 100, 0.05);
        assert_eq!(low, 0.0);
        assert_relative_eq!(high, 1.0 - 0.025f64.powf(0.01), max_relative = 1e-12);
        let (low, high) = clopper_pearson(100, 100, 0.05);
        assert_eq!(high, 1.0);
        assert_relative_eq!(low, 0.025f64.powf(0.01), max_relative = 1e-12);
        assert_eq!(clopper_pearson(0, 0, 0.05), (0.0, 1.0));
    }

    #[test]
    fn power_is_reached_at_the_detectable_deviation() {
        for (n, p) in [(1_000_000, 1e-3), (100_000, 0.5), (10_000, 0.9), (1_000_000_000_000, 1e-9)] {
            let exact = law(n, p);
            let d = exact.detectable_relative_deviation(1e-6, 0.99).unwrap();
            let high = exact.first_rejected_above(5e-7);
            let low = exact.last_rejected_below(5e-7).unwrap();
            assert!(exact.upper_tail(high) <= 5e-7 && exact.upper_tail(high - 1) > 5e-7);
            assert!(exact.lower_tail(low) <= 5e-7 && exact.lower_tail(low + 1) > 5e-7);
            let power_above = law(n, (p * (1.0 + d)).min(1.0)).upper_tail(high);
            let power_below = law(n, p * (1.0 - d)).lower_tail(low);
            assert!(power_above.min(power_below) >= 0.99 - 1e-6, "{power_above} {power_below}");
            assert!(power_above.min(power_below) <= 0.99 + 1e-2);
            // The normal estimate (z + 2.33)/sqrt(Np/q), within the skewness.
            let normal = (4.89 + 2.33) * ((1.0 - p) / (n as f64 * p)).sqrt();
            assert!((d / normal - 1.0).abs() < 0.25, "{d} {normal}");
        }
    }

    #[test]
    fn rare_events_have_no_power_and_certain_ones_leave_no_room() {
        // A mean of zero successes is no surprise at N p = 1e-3.
        assert!(law(1_000_000, 1e-9).detectable_relative_deviation(1e-6, 0.99).unwrap() > 1.0);
        assert!(law(1_000_000, 1e-300).detectable_relative_deviation(1e-6, 0.99).unwrap() > 1.0);
        assert!(law(0, 0.5).detectable_relative_deviation(1e-6, 0.99).unwrap() >= 1.0);
        assert_eq!(law(100, 0.0).detectable_relative_deviation(1e-6, 0.99), None);
        // p = 1: a single failure rejects, so that only p' above 0.01^(1/N) may escape.
        let d = law(1000, 1.0).detectable_relative_deviation(1e-6, 0.99).unwrap();
        assert_relative_eq!(d, 1.0 - 0.01f64.powf(1e-3), max_relative = 1e-9);
    }

    #[test]
    fn trials_needed_suffice_and_are_not_many_too_many() {
        for p in [1e-4, 0.1, 0.5, 0.9] {
            let n = trials_needed(p, 1e-6, 0.99, 0.3);
            let d = |n: f64| law(n as u64, p).detectable_relative_deviation(1e-6, 0.99).unwrap();
            assert!(d(1.02 * n) < 0.3 && d(0.9 * n) > 0.3, "{p}: {n}");
        }
        // In the Poisson limit only N p matters.
        let rare = 1e-300 * trials_needed(1e-300, 1e-6, 0.99, 0.5);
        assert_relative_eq!(rare, 1e-5 * trials_needed(1e-5, 1e-6, 0.99, 0.5), max_relative = 0.03);
        assert_eq!(trials_needed(0.0, 1e-6, 0.99, 0.5), f64::INFINITY);
        assert!(trials_needed(f64::NAN, 1e-6, 0.99, 0.5).is_infinite());
        assert!(trials_needed(1.0, 1e-6, 0.99, 0.5) < 20.0);
    }
}
