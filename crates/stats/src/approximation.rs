//! Conditions under which the mean of N values may be taken as normal out to the z at which a test decides.
//!
//! **Exact standard error.** For a law with skewness gamma and excess kurtosis kappa, Cramér's theorem (Petrov, "Sums of
//! Independent Random Variables" (1975), chapter VIII) multiplies the normal tail beyond z by
//! exp(z^3/sqrt(N) lambda(z/sqrt(N))) (1 + O(z/sqrt(N))), lambda(t) = gamma/6 + (kappa - 3 gamma^2) t/24 + ..., that is by
//! about exp(gamma z^3/(6 sqrt(N))) and, as gamma^2 only lowers the next term, at most exp(kappa z^4/(24 N)). At the
//! critical z each factor may be at most 2:
//! gamma^2/N <= (6 ln 2/z^3)^2 and |kappa|/N <= 24 ln 2/z^4; at z = 5 that is 1.1e-3 and 2.7e-2.
//! Both together are at most [`TAIL_INFLATION`] = 4, so a test decides at a quarter of its level, and its stated level holds:
//! the critical z of the level alpha is the two-sided quantile of alpha/4. The factor missing here, exp(z h/(2 s)) for
//! values on a lattice of step h and a sum with standard deviation s, is below 1.1 at these bounds; one tail is only
//! inflated while the other is deflated, and the exact binomial tails in the tests below keep to the promise.
//!
//! Moments bound rare values on average only: one that shifts z by D alone may have the probability kappa/(N D^4), 3e-5 a run at
//! D = 5 where the kurtosis is as large as allowed. A z-test rejects therefore only where no sample shifts z by more than
//! [`MOST_OF_ONE`]. Up to there a compensated Poisson sum of such values beside a normal law has at most 2.5 times the normal tail at
//! z = 5.3, by its Chernoff bound with as many values as the skewness allows. Of its level such a test takes 5/8: a skewness that inflates
//! one tail by 2 deflates the other as much, and together with the kurtosis both are 2 (2 + 1/2)/2 = 2.5 times a quarter. What it leaves,
//! [`LEFT_OF_LEVEL`], is for the test of samples that it does not judge.
//!
//! **Standard error from the sample.** Studentising turns the corrections into exp(-gamma z^3/(3 sqrt(N))) and
//! exp((3 - kappa) z^4/(12 N)) (Hall, "The Bootstrap and Edgeworth Expansion" (1992), chapter 2): a mean that is low for
//! lack of rare large values comes with a standard error that is too small. The same demands then read
//! gamma^2/N <= (3 ln 2/z^3)^2 and (|kappa| + 3)/N <= 12 ln 2/z^4. As skewness and kurtosis are then the sample's own,
//! and those of a sample are too small rather than too large, both are doubled first ([`SAMPLE_SHAPE_FACTOR`]). No factor
//! helps against values so rare that the sample has none: only closed forms do.

use crate::normal::{two_sided_quantile, two_sided_tail};
use std::f64::consts::LN_2;

/// Greatest factor by which an adequate approximation understates a tail: 2 for the skewness times 2 for the kurtosis.
pub const TAIL_INFLATION: f64 = 4.0;

/// The most by which a single value may shift z where a z-test rejects.
pub const MOST_OF_ONE: f64 = 0.25;

/// The part of its level that a z-test leaves to another test, of the samples in which one value shifts z by more.
pub const LEFT_OF_LEVEL: f64 = 0.375;

/// Factor of the skewness and the excess kurtosis of a sample before they are believed.
pub const SAMPLE_SHAPE_FACTOR: f64 = 2.0;

/// A two-sided normal test of the mean of N values, with the conditions under which its level holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalApproximation {
    /// The |z| from which on the test rejects.
    pub critical_z: f64,
}

impl NormalApproximation {
    /// The test with a false alarm of at most `level` where the approximation is adequate: it decides at level/4.
    #[must_use]
    pub fn for_level(level: f64) -> Self {
        Self { critical_z: two_sided_quantile(level / TAIL_INFLATION) }
    }

    /// The p-value of z, 4 P(|Z| > |z|) and at most 1: at most the level exactly where |z| is at least critical.
    #[must_use]
    pub fn p_value(z: f64) -> f64 {
        (TAIL_INFLATION * two_sided_tail(z)).min(1.0)
    }

    /// Greatest skewness^2/N allowed with an exact standard error.
    #[must_use]
    pub fn skewness_limit(&self) -> f64 {
        (6.0 * LN_2 / self.critical_z.powi(3)).powi(2)
    }

    /// Greatest |excess kurtosis|/N allowed with an exact standard error.
    #[must_use]
    pub fn excess_kurtosis_limit(&self) -> f64 {
        24.0 * LN_2 / self.critical_z.powi(4)
    }

    /// True if n values of this shape suffice, for a z with the exact standard error.
    #[must_use]
    pub fn is_adequate(&self, skewness: f64, excess_kurtosis: f64, n: f64) -> bool {
        n >= self.samples_needed(skewness, excess_kurtosis)
    }

    /// Number of values from which on the approximation is adequate, for a z with the exact standard error.
    ///
    /// Infinite for an infinite or unknown (NaN) shape.
    #[must_use]
    pub fn samples_needed(&self, skewness: f64, excess_kurtosis: f64) -> f64 {
        or_infinite(skewness * skewness / self.skewness_limit())
            .max(or_infinite(excess_kurtosis.abs() / self.excess_kurtosis_limit()))
    }

    /// Number of samples as [`Self::samples_needed`] for a z with the sample's own standard error, from the shape of the sample.
    #[must_use]
    pub fn studentised_samples_needed(&self, sample_skewness: f64, sample_excess_kurtosis: f64) -> f64 {
        let skewness = SAMPLE_SHAPE_FACTOR * sample_skewness;
        let excess_kurtosis = SAMPLE_SHAPE_FACTOR * sample_excess_kurtosis.abs();
        // Half the exponent allowed per unit of shape: a quarter of the limit for the square.
        or_infinite(4.0 * skewness * skewness / self.skewness_limit())
            .max(or_infinite(2.0 * (excess_kurtosis + 3.0) / self.excess_kurtosis_limit()))
    }
}

fn or_infinite(n: f64) -> f64 {
    if n.is_nan() { f64::INFINITY } else { n }
}

#[cfg(test)]
mod tests {
    use super::{NormalApproximation, TAIL_INFLATION};
    use crate::binomial::Binomial;
    use crate::normal::{two_sided_tail, upper_tail};
    use approx::assert_relative_eq;

    /// Success probabilities from rare (skewed) over even (flat) to nearly certain.
    const PROBABILITIES: [f64; 9] = [1e-8, 1e-5, 1e-3, 0.05, 0.3, 0.5, 0.9, 0.999, 0.999_99];
    const LEVELS: [f64; 4] = [1e-3, 5e-7, 1e-9, 1e-12];

    fn shape(p: f64) -> (f64, f64) {
        let variance = p * (1.0 - p);
        ((1.0 - 2.0 * p) / variance.sqrt(), (1.0 - 6.0 * variance) / variance)
    }

    #[test]
    fn limits_at_five_standard_errors() {
        let test = NormalApproximation { critical_z: 5.0 };
        assert_relative_eq!(test.skewness_limit(), 1.107e-3, max_relative = 1e-3);
        assert_relative_eq!(test.excess_kurtosis_limit(), 2.662e-2, max_relative = 1e-3);
        assert_relative_eq!(test.samples_needed(2.0, 6.0), 4.0 / 1.107e-3, max_relative = 1e-3);
        assert!(test.is_adequate(2.0, 6.0, 3700.0) && !test.is_adequate(2.0, 6.0, 3600.0));
        assert!(!test.is_adequate(f64::NAN, 0.0, 1e300) && !test.is_adequate(0.0, f64::INFINITY, 1e300));
    }

    #[test]
    fn p_value_meets_the_level_at_the_critical_z() {
        for level in LEVELS {
            let test = NormalApproximation::for_level(level);
            assert_relative_eq!(NormalApproximation::p_value(test.critical_z), level, max_relative = 1e-9);
        }
        assert_eq!(NormalApproximation::p_value(0.0), 1.0);
    }

    #[test]
    fn exact_binomial_tails_keep_the_level_at_the_bound() {
        for (level, p) in LEVELS.into_iter().flat_map(|level| PROBABILITIES.map(|p| (level, p))) {
            let test = NormalApproximation::for_level(level);
            let (skewness, excess_kurtosis) = shape(p);
            let n = test.samples_needed(skewness, excess_kurtosis).ceil();
            let law = Binomial::new(n as u64, p).unwrap();
            let reach = test.critical_z * (n * p * (1.0 - p)).sqrt();
            let high = law.upper_tail((n * p + reach).ceil() as u64);
            let low = if n * p < reach { 0.0 } else { law.lower_tail((n * p - reach).floor() as u64) };
            let normal = upper_tail(test.critical_z);
            // Each tail: the 2 of the skewness, a lattice factor below 1.1.
            assert!(high <= 2.2 * normal && low <= 2.2 * normal, "{p}: {} {}", high / normal, low / normal);
            assert!(high + low <= level);
        }
    }

    #[test]
    fn a_tenth_of_the_samples_would_break_the_promise() {
        let test = NormalApproximation::for_level(5e-7);
        let (p, (skewness, excess_kurtosis)) = (1e-5, shape(1e-5));
        let n = (0.1 * test.samples_needed(skewness, excess_kurtosis)).ceil();
        let reach = test.critical_z * (n * p * (1.0 - p)).sqrt();
        let high = Binomial::new(n as u64, p).unwrap().upper_tail((n * p + reach).ceil() as u64);
        assert!(high > TAIL_INFLATION * upper_tail(test.critical_z));
    }

    #[test]
    fn exact_studentised_tails_keep_the_level_at_the_bound() {
        for (level, p) in LEVELS.into_iter().flat_map(|level| PROBABILITIES.map(|p| (level, p))) {
            let test = NormalApproximation::for_level(level);
            // Half the shape undoes the doubling, so that the bound itself is what is tried.
            let (skewness, excess_kurtosis) = shape(p);
            let n = test.studentised_samples_needed(0.5 * skewness, 0.5 * excess_kurtosis).ceil();
            let law = Binomial::new(n as u64, p).unwrap();
            // (x - p) sqrt(N/(x(1-x))) = +-z, solved for the fraction x of successes.
            let z2 = test.critical_z * test.critical_z / n;
            let root = (z2 * z2 / 4.0 + z2 * p * (1.0 - p)).sqrt();
            let (x_low, x_high) = ((p + z2 / 2.0 - root) / (1.0 + z2), (p + z2 / 2.0 + root) / (1.0 + z2));
            assert!(x_low > p * p, "the roots lie on both sides of {p}: {x_low}, {x_high}");
            let (high, low) =
                (law.upper_tail((n * x_high).ceil() as u64), law.lower_tail((n * x_low) as u64));
            assert!(high + low <= level, "{p}: {} of {}", high + low, two_sided_tail(test.critical_z));
        }
    }
}
