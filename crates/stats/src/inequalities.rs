//! Rejections that no normal approximation stands behind: exponential inequalities that hold for every N and every shape.
//!
//! A sample says nothing of values that it lacks, however many it has. A deviation of its mean is evidence only together with
//! a fact about the law: its variance or a bound of it, or a value beyond which no sample lies. Either makes of the sample a
//! random variable of expectation at most 1 under the hypothesis E\[X\] <= c (for E\[X\] >= c: the law of -X), and by Markov
//! it exceeds 1/p with probability p at most.
//!
//! **By the variance.** (1) Let g(x) = x - ln(1 + x + x^2/2), whose argument is positive for every x. With Z = X - c and
//! V >= E\[Z^2\], for every t > 0, E\[exp(t Z - g(t Z))\] = 1 + t E\[Z\] + t^2 E\[Z^2\]/2 <= 1 + t^2 V/2. (2) Of N independent
//! samples E\[exp(sum (t Z - g(t Z)) - N ln(1 + t^2 V/2))\] <= 1. (3) g' = (x^2/2)/(1 + x + x^2/2), whose denominator is
//! at least 1 for x >= 0 and x <= -2 and at most 1 between. Hence g(x) <= x^3/6 for x >= -2, and everywhere
//! g(x) <= x^3/6 + x^4/[`FOURTH`]: the sums of Z, Z^3 and Z^4 of the sample are all that is needed. At t = sqrt(2 L/(N V)), L = ln(1/p), it
//! rejects from z = sqrt(2 L) on, as a Gaussian bound, less what the sample's own skewness takes.
//!
//! **By an end of the law.** (4) If X >= a then xi = (X - c)/(c - a) >= -1, and as (x - ln(1 + x))/x^2 falls in x > -1,
//! for 0 <= l < 1, exp(l xi - psi(l) xi^2) <= 1 + l xi, psi(l) = -ln(1 - l) - l (fan-2015 lemma 4.1; the empirical Bernstein
//! inequality of waudby-smith-2024 section 3.2 is made of it). No variance is
//! asked for: large values that the sample lacks could only make the mean larger, and the sum of squares is the sample's.
//!
//! (5) A mean over several t or l is as good as one (the expectation of a mean), and fits samples of any variance. Two tests of one
//! side are both made at half of the level, and both sides share it: p = 2 * tests * the smallest.

use crate::moments::Moments;
use crate::reference::{Reference, Scores};

/// The c of g(x) <= x^3/6 + x^4/c: the greatest (g(x) - x^3/6)/x^4 is 0.0220, at x = -5.1.
const FOURTH: f64 = 45.0;

/// The t of the test by the variance: the one that is best at the level, with this weight, and halves of it, 2^-k with weights in
/// proportion to 1/k^2. Where every sample is off by many standard deviations t Z must not be far from 1 for its cube to be small.
const WEIGHT_OF_BEST: f64 = 0.7;
const HALVINGS: i32 = 60;

/// The l of the test by an end: RATIO^k times the best one for samples whose xi has the variance 1, with weights in proportion to
/// 1/(1 + |k|), as most variances are not far from there. Far below, it is for samples that are many times too large.
const RATIO: f64 = 1.5;
const POWERS: std::ops::RangeInclusive<i32> = -60..=24;

/// The greatest l.
const MOST: f64 = 0.95;

/// The strongest evidence against the mean of a reference that needs no shape of the law.
#[derive(Clone, Copy)]
pub(crate) struct Inequality {
    /// Upper bound of the two-sided p-value.
    pub(crate) p: f64,
    /// Names the inequality in reasons of a verdict.
    pub(crate) name: &'static str,
}

/// One side of a hypothesis, turned so that it reads E\[X\] <= c: the sums of X - c, its least value, and what is known.
struct Side {
    n: f64,
    /// Sums of (X - c)^k, k = 1 to 4.
    sums: [f64; 4],
    /// The least X - c of the sample.
    least: f64,
    /// c - a, a a value that no sample falls below; infinite without one.
    room: f64,
}

/// Tests the hypothesis that E\[X\] lies between the bounds of the reference; `None` if nothing is known of the law.
pub(crate) fn evidence(measured: &Moments, reference: &Reference, level: f64) -> Option<Inequality> {
    let (low, high) = reference.interval();
    let (minimum, maximum) = match reference.scores {
        Scores::TwoValued { high } => (high.min(0.0), high.max(0.0)),
        Scores::Bounded { minimum, maximum } => (minimum, maximum),
        Scores::Unbounded => (f64::NEG_INFINITY, f64::INFINITY),
    };
    // About c instead of E[X], which lies at most the width of the interval away.
    let width = high - low;
    let variance = reference.greatest_variance().map(|variance| variance + width * width);
    let above = Side::new(measured, high, 1.0, minimum)?;
    let below = Side::new(measured, low, -1.0, maximum)?;
    let tested = [above, below].into_iter().filter_map(|side| side.smallest(variance, level));
    let strongest = tested.min_by(|a, b| a.p.total_cmp(&b.p))?;
    Some(Inequality { p: (2.0 * strongest.p).min(1.0), ..strongest })
}

impl Side {
    /// The side on which `sign` (X - c) is too great, `end` the bound of X on the other one; `None` without samples.
    fn new(measured: &Moments, c: f64, sign: f64, end: f64) -> Option<Self> {
        let n = measured.count() as f64;
        let [second, third, fourth] = measured.sums_about(c)?;
        let extreme = if sign > 0.0 { measured.minimum()? } else { measured.maximum()? };
        Some(Self {
            n,
            sums: [sign * n * (measured.mean()? - c), second, sign * third, fourth],
            least: sign * (extreme - c),
            room: sign * (c - end),
        })
    }

    /// The smallest one-sided p-value of the tests that are possible, times their number.
    fn smallest(&self, variance: Option<f64>, level: f64) -> Option<Inequality> {
        // 2 sides, 2 tests.
        let log = (4.0 / level).ln();
        let by_variance = variance.filter(|v| *v > 0.0 && v.is_finite()).map(|v| Inequality {
            p: self.by_variance(v, log),
            name: "exponential inequality by the variance of the law",
        });
        let by_end = self.room.is_finite().then(|| Inequality {
            p: self.by_end(log),
            name: "empirical Bernstein inequality by an end of the law",
        });
        let tests = f64::from(u8::from(by_variance.is_some()) + u8::from(by_end.is_some()));
        let strongest = by_variance.into_iter().chain(by_end).min_by(|a, b| a.p.total_cmp(&b.p))?;
        Some(Inequality { p: (tests * strongest.p).min(1.0), ..strongest })
    }

    /// (2) and (3).
    fn by_variance(&self, variance: f64, log: f64) -> f64 {
        let Self { n, sums: [first, second, third, fourth], least, .. } = *self;
        // Powers that underflowed are no evidence: sum Z^4 >= (sum Z^2)^2/N.
        if !(first > 0.0 && fourth * (1.0 + 1e-6) >= second * (second / n) && fourth > 0.0) {
            return 1.0;
        }
        let best = (2.0 * log / (n * variance)).sqrt();
        let of_halves: f64 = (1..=HALVINGS).map(|k| f64::from(k).powi(-2)).sum();
        one_over_mean((0..=HALVINGS).map(|k| {
            let t = best * 0.5_f64.powi(k);
            let weight = match k {
                0 => WEIGHT_OF_BEST,
                _ => (1.0 - WEIGHT_OF_BEST) * f64::from(k).powi(-2) / of_halves,
            };
            let of_fourth = if t * least >= -2.0 { 0.0 } else { t * t * t * t * fourth / FOURTH };
            let exponent = t * first - t * t * t * third / 6.0 - of_fourth;
            (exponent - n * (0.5 * t * t * variance).ln_1p(), weight)
        }))
    }

    /// (4).
    fn by_end(&self, log: f64) -> f64 {
        let Self { n, sums: [first, second, ..], room, .. } = *self;
        if !(first > 0.0 && second * (1.0 + 1e-6) >= first * (first / n)) {
            return 1.0;
        }
        if room <= 0.0 {
            return 0.0; // the mean is the end itself, which every sample then is
        }
        let (xi, squares) = (first / room, second / room / room);
        let best = (2.0 * log / n).sqrt();
        let weight = |k: i32| 1.0 / f64::from(1 + k.abs());
        let all: f64 = POWERS.map(weight).sum();
        one_over_mean(POWERS.map(|k| {
            let l = (best * RATIO.powi(k)).min(MOST);
            (l * xi + (l + (-l).ln_1p()) * squares, weight(k) / all)
        }))
    }
}

/// 1 over the mean of exp(x) with these weights, at most 1; an exponent that is no number counts as no evidence.
fn one_over_mean(exponents: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let lawful = exponents.filter(|(x, _)| !x.is_nan());
    let greatest = lawful.clone().map(|(x, _)| x).fold(f64::NEG_INFINITY, f64::max);
    if greatest <= 0.0 {
        return 1.0;
    }
    let sum: f64 = lawful.map(|(x, weight)| weight * (x - greatest).exp()).sum();
    ((-greatest).exp() / sum).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::{FOURTH, evidence};
    use crate::closed_moments::ClosedMoments;
    use crate::moments::Moments;
    use crate::reference::{Reference, Scores};
    use crate::test_support::uniforms;

    const LEVEL: f64 = 5e-7;

    #[test]
    fn the_remainder_of_the_exponential_is_bounded() {
        let g = |x: f64| x - (1.0 + x + 0.5 * x * x).ln();
        for i in -400_000..400_000 {
            let x = f64::from(i) * 1e-3;
            let cube = x * x * x / 6.0;
            let rounding = 1e-13 * (1.0 + x.abs());
            assert!(x < -2.0 || g(x) <= cube + rounding, "{x}");
            assert!(g(x) <= cube + x * x * x * x / FOURTH + rounding, "{x}");
        }
        // No smaller bound would do.
        assert!(g(-5.1) > -5.1_f64.powi(3) / 6.0 + 5.1_f64.powi(4) / (FOURTH + 1.0));
    }

    #[test]
    fn the_lemma_of_an_end() {
        for l in [1e-3, 0.1, 0.5, 0.95] {
            for i in -999..20_000 {
                let xi = f64::from(i) * 1e-3;
                let psi = -f64::ln_1p(-l) - l;
                assert!((l * xi - psi * xi * xi).exp() <= (1.0 + l * xi) * (1.0 + 1e-14), "{l}, {xi}");
            }
        }
    }

    /// Mean 1, variance 1: 1 + sqrt(3) (2u - 1).
    fn uniform(mean: f64, n: usize, seed: u64) -> Moments {
        uniforms(seed).take(n).map(|u| mean + 3f64.sqrt() * (2.0 * u - 1.0)).collect()
    }

    fn known(variance: f64) -> Reference {
        Reference { variance_bound: Some(variance), ..Reference::exact(1.0) }
    }

    fn p_of(measured: &Moments, reference: &Reference) -> f64 {
        evidence(measured, reference, LEVEL).map_or(1.0, |found| found.p)
    }

    /// The z from which on a mean of 10^4 uniform samples is rejected, by bisection.
    fn critical_z(reference: &Reference, sign: f64) -> f64 {
        let n = 10_000;
        let base = uniform(1.0, n, 3);
        let (mut low, mut high) = (0.0, 1000.0);
        while high - low > 1e-3 {
            let z = 0.5 * (low + high);
            let shift = sign * z / 100.0 - (base.mean().unwrap() - 1.0);
            let moved: Moments =
                uniforms(3).take(n).map(|u| 1.0 + shift + 3f64.sqrt() * (2.0 * u - 1.0)).collect();
            if p_of(&moved, reference) <= LEVEL { high = z } else { low = z }
        }
        high
    }

    #[test]
    fn rejects_a_little_later_than_a_normal_test() {
        // 5.29 would be critical for a normal law at a quarter of the level; sqrt(2 ln(2/level)) = 5.51.
        for sign in [1.0, -1.0] {
            let z = critical_z(&known(1.0), sign);
            assert!((5.5..6.0).contains(&z), "{z}");
            // A bound of four times the variance: twice the z.
            let z = critical_z(&known(4.0), sign);
            assert!((11.0..12.0).contains(&z), "{z}");
        }
        let end = Scores::Bounded { minimum: 1.0 - 3f64.sqrt() - 1.0, maximum: f64::INFINITY };
        let bounded = Reference { scores: end, ..Reference::exact(1.0) };
        let z = critical_z(&bounded, 1.0);
        assert!((5.5..6.5).contains(&z), "{z}");
        // Nothing is known above: a mean that is too low is no evidence.
        assert!(critical_z(&bounded, -1.0) > 999.0);
    }

    #[test]
    fn a_deviation_of_any_size_is_rejected() {
        for z in [6.0, 100.0, 1e4, 1e7, 1e12] {
            for (n, spread) in [(1000_usize, 1.0), (8000, 1e-6)] {
                // Less varied than the law, as samples are that lack its rare values.
                let shift = z / (n as f64).sqrt();
                for sign in [1.0, -1.0] {
                    let moved: Moments = uniforms(9)
                        .take(n)
                        .map(|u| 1.0 + sign * shift + spread * 3f64.sqrt() * (2.0 * u - 1.0))
                        .collect();
                    let p = p_of(&moved, &known(1.0));
                    assert!(p <= LEVEL, "{sign} {z}: {p}");
                    let end = Scores::Bounded { minimum: 0.0, maximum: f64::INFINITY };
                    let p = p_of(&moved, &Reference { scores: end, ..Reference::exact(1.0) });
                    assert!(p <= LEVEL || sign < 0.0 || z < 10.0, "{z}: {p}");
                }
            }
        }
    }

    #[test]
    fn nothing_known_is_no_evidence() {
        let measured = uniform(2.0, 1000, 1);
        assert!(evidence(&measured, &Reference::exact(1.0), LEVEL).is_none());
        let closed = ClosedMoments::from_central(1.0, &[Some(f64::INFINITY)]);
        let infinite = Reference { moments: Some(closed), ..Reference::exact(1.0) };
        assert!(evidence(&measured, &infinite, LEVEL).is_none());
    }

    /// X = 1/p with probability p, else 0: as long as no success is seen the mean is 0, and the variance 1/p - 1.
    #[test]
    fn rare_events_that_were_not_seen_and_one_that_was() {
        let n = 100_000;
        for p in [1e-3, 1e-4, 1e-5, 1e-6, 1e-8] {
            let variance = 1.0 / p - 1.0;
            let scores = Scores::Bounded { minimum: 0.0, maximum: f64::INFINITY };
            let reference = Reference { scores, ..known(variance) };
            // P(no success) = (1 - p)^N, P(at least one) = 1 - that, P(one at most): no rejection may claim less.
            let p_of_none = (n as f64 * (-p).ln_1p()).exp();
            let none: Moments = std::iter::repeat_n(0.0, n).collect();
            let p_none = p_of(&none, &reference);
            assert!(p_none >= p_of_none, "{p}: {p_none}");
            let one: Moments = std::iter::repeat_n(0.0, n - 1).chain([1.0 / p]).collect();
            let p_one = p_of(&one, &reference);
            let extreme = if n as f64 * p <= 1.0 { 1.0 - p_of_none } else { p_of_none };
            assert!(p_one >= extreme, "{p}: {p_one}");
        }
    }

    /// The level holds where the sample is blindest: a share of uniform noise, the rest in rare events.
    #[test]
    fn the_share_of_rejections_is_below_the_level() {
        let (level, replicas, n) = (0.05, 2000, 200);
        for (rare, share) in [(0.5_f64 / 200.0, 0.9_f64), (3.0 / 200.0, 0.5), (0.1, 0.9)] {
            // X = 1 + a (u - 1/2) + b ([v < rare] - rare), variance a^2/12 + b^2 rare (1 - rare) = 1.
            let (a, b) = ((12.0 * (1.0 - share)).sqrt(), (share / (rare * (1.0 - rare))).sqrt());
            let mut source = uniforms(77);
            let rejected = (0..replicas)
                .filter(|_| {
                    let mut draw = || {
                        let (u, v) = (source.next().unwrap(), source.next().unwrap());
                        1.0 + a * (u - 0.5) + b * (f64::from(v < rare) - rare)
                    };
                    let sample: Moments = (0..n).map(|_| draw()).collect();
                    let minimum = 1.0 - 0.5 * a - b * rare;
                    let scores = Scores::Bounded { minimum, maximum: f64::INFINITY };
                    let reference = Reference { scores, ..known(1.0) };
                    evidence(&sample, &reference, level).is_some_and(|found| found.p <= level)
                })
                .count();
            assert!((rejected as f64) < level * f64::from(replicas), "{rare}: {rejected}");
        }
    }

    /// Nothing depends on the unit of the estimates.
    #[test]
    fn it_is_the_same_in_every_unit() {
        let sample: Vec<f64> = uniforms(5).take(2000).map(|u| 1.2 + 3f64.sqrt() * (2.0 * u - 1.0)).collect();
        let of = |unit: f64| {
            let moments: Moments = sample.iter().map(|x| unit * x).collect();
            let reference = Reference { variance_bound: Some(unit * unit), ..Reference::exact(unit) };
            p_of(&moments, &reference)
        };
        let usual = of(1.0);
        assert!(usual > 0.0 && usual < 1e-3, "{usual}");
        for unit in [2f64.powi(-30), 2f64.powi(-3), 2f64.powi(20)] {
            assert!((of(unit) / usual - 1.0).abs() < 1e-6, "{unit}: {} and {usual}", of(unit));
        }
    }
}
