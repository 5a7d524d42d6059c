//! The N of a test before anything is drawn: from the moments of the law alone, so that no seed makes it too small.

use crate::approximation::NormalApproximation;
use crate::bernstein::Bernstein;
use crate::binomial_inference::trials_needed;
use crate::halving::halved;
use crate::normal::upper_quantile;
use crate::policy::POWER;
use crate::reference::{Certainty, Reference, Scores};

/// The N from which on [`judge`](crate::judge()) at the level `alpha` tests the mean and finds a relative bias of `bias` with
/// probability [`POWER`].
///
/// Two-valued samples are judged by the exact binomial test; others by the z-test, adequate for the shape of the law, or by
/// Bernstein's inequality, whichever is possible first. 1 for a law without variance, infinite where no N suffices (moments
/// that are infinite, an error of the reference as large as the bias). `None` where variance, skewness or kurtosis are not
/// known and nothing bounds the samples: then only samples tell.
#[must_use]
pub fn samples_needed(reference: &Reference, alpha: f64, bias: f64) -> Option<f64> {
    debug_assert!(alpha > 0.0 && alpha < 0.5, "a false alarm lies in (0, 1/2), found {alpha}");
    if let (Scores::TwoValued { high }, Some(p)) = (reference.scores, reference.success_probability()) {
        let room = bias - 2.0 * reference.error / (high.abs() * p);
        return Some(if room > 0.0 { trials_needed(p, alpha, POWER, room) } else { f64::INFINITY });
    }
    let level = 0.5 * alpha;
    let moments = reference.closed_moments();
    let variance = moments.and_then(|moments| moments.variance());
    if variance.is_some_and(|variance| reference.is_rounding(variance)) {
        return Some(1.0);
    }
    let test = NormalApproximation::for_level(level);
    let shape = moments.and_then(|moments| moments.skewness().zip(moments.excess_kurtosis()));
    let normal = variance.zip(shape).map(|(variance, (skewness, kurtosis))| {
        test.samples_needed(skewness, kurtosis).max(for_power(&test, reference, variance, bias))
    });
    match (normal, bounded(reference, level, bias)) {
        (Some(normal), Some(bounded)) => Some(normal.min(bounded)),
        (one, other) => one.or(other),
    }
}

/// N for the power of a z-test: (critical z + z of the power) sqrt(variance/N) + 2 allowance = bias · mean; 0 for a mean of 0.
pub(crate) fn for_power(test: &NormalApproximation, reference: &Reference, variance: f64, bias: f64) -> f64 {
    let reach = test.critical_z + upper_quantile(1.0 - POWER);
    let room = bias * reference.mean.abs() - 2.0 * reference.allowance();
    if reference.mean == 0.0 {
        0.0
    } else if room > 0.0 {
        reach * reach * variance / room / room
    } else {
        f64::INFINITY
    }
}

/// Facts about bounded samples that Bernstein's inequality needs; `None` for samples without bounds.
///
/// An unknown variance is at most (maximum - mean)(mean - minimum) (Bhatia and Davis 2000), and a quarter of the square
/// of their distance whatever the mean.
pub(crate) fn bernstein_law(reference: &Reference) -> Option<Bernstein> {
    let Scores::Bounded { minimum, maximum } = reference.scores else { return None };
    let range = maximum - minimum;
    if !range.is_finite() {
        return None;
    }
    if matches!(reference.certainty, Certainty::Estimated { .. }) {
        return Some(Bernstein { variance: 0.25 * range * range, bound: range });
    }
    let (below, above) = ((reference.mean - minimum).max(0.0), (maximum - reference.mean).max(0.0));
    let greatest = below * above;
    let variance = reference.greatest_variance().map_or(greatest, |v| v.min(greatest));
    Some(Bernstein { variance, bound: below.max(above) })
}

/// The bias that Bernstein's inequality finds in n samples: one that exceeds the critical deviation by what the mean deviates
/// with probability 1 - POWER only (one-sided, hence twice that as a two-sided level), at the same variance.
pub(crate) fn bernstein_reach(law: &Bernstein, reference: &Reference, level: f64, n: f64) -> f64 {
    law.deviation(level, n) + law.deviation(2.0 * (1.0 - POWER), n) + 2.0 * reference.allowance()
}

fn bounded(reference: &Reference, level: f64, bias: f64) -> Option<f64> {
    let law = bernstein_law(reference)?;
    let size = bias * reference.mean.abs();
    Some(least_sufficient(|n| bernstein_reach(&law, reference, level, n) < size))
}

/// The least N, to a percent, from which on the monotone condition holds; infinite if it does not up to 1e300.
pub(crate) fn least_sufficient(enough: impl Fn(f64) -> bool) -> f64 {
    let mut high = 1.0;
    while !enough(high) {
        high *= 2.0;
        if high > 1e300 {
            return f64::INFINITY;
        }
    }
    halved((0.5 * high, high), |high| 0.01 * high, enough).1.ceil()
}

#[cfg(test)]
mod tests {
    use super::samples_needed;
    use crate::judge::judge;
    use crate::test_support::uniforms;
    use crate::{ClosedMoments, Moments, Reference, Scores};

    /// A sample of a law from a uniform variate.
    type Inverse = fn(f64) -> f64;

    /// A skewed law with a closed form, a bounded one without moments, and a coin.
    fn laws() -> [(Reference, Inverse); 3] {
        let raw = [1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0];
        let exponential = Reference { moments: Some(ClosedMoments::from_raw(&raw)), ..Reference::exact(1.0) };
        let bounded = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
        let coin = Scores::TwoValued { high: 2.0 };
        [
            (exponential, |u| -(-u).ln_1p()),
            (Reference { scores: bounded, ..Reference::exact(0.25) }, |u| u.powi(3)),
            (Reference { scores: coin, ..Reference::exact(0.2) }, |u| if u < 0.1 { 2.0 } else { 0.0 }),
        ]
    }

    #[test]
    fn so_many_samples_are_tested_on_any_seed_and_a_tenth_is_not() {
        const ALPHA: f64 = 1e-9;
        for (index, (reference, law)) in laws().into_iter().enumerate() {
            let needed = samples_needed(&reference, ALPHA, 0.05).unwrap();
            assert!(needed > 1e4 && needed < 1e6, "{needed}");
            for seed in 0..20 {
                let draw = |n: f64| -> Moments { uniforms(seed).take(n as usize).map(law).collect() };
                let verdict = judge(&draw(1.02 * needed), &reference, ALPHA);
                assert_eq!(verdict.sound, Some(true), "{index}, {seed}: {verdict:?}");
                assert!(verdict.detectable_relative_bias.unwrap() <= 0.05, "{index}, {seed}: {verdict:?}");
                let fewer = judge(&draw(0.1 * needed), &reference, ALPHA);
                // A bounded law is mild enough for the sample's shape, which the formula does not know of.
                assert!(index == 1 || fewer.detectable_relative_bias.is_none_or(|bias| bias > 0.1));
            }
        }
    }

    #[test]
    fn what_no_number_of_samples_tells() {
        assert_eq!(samples_needed(&Reference::exact(1.0), 1e-9, 0.05), None);
        let heavy = ClosedMoments::from_raw(&[1.0, f64::INFINITY]);
        let heavy = Reference { moments: Some(heavy), ..Reference::exact(1.0) };
        assert!(samples_needed(&heavy, 1e-9, 0.05).is_none_or(f64::is_infinite));
        let coin = Scores::TwoValued { high: 1.0 };
        let vague = Reference { error: 0.02, scores: coin, ..Reference::exact(0.5) };
        assert_eq!(samples_needed(&vague, 1e-9, 0.05), Some(f64::INFINITY));
        let constant = ClosedMoments::from_central(1.0, &[Some(0.0); 7]);
        let constant = Reference { moments: Some(constant), ..Reference::exact(1.0) };
        assert_eq!(samples_needed(&constant, 1e-9, 0.05), Some(1.0));
    }
}
