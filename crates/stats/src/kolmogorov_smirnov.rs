//! Kolmogorov's test of samples against a continuous distribution function, with a bound that holds at every N.

use crate::goodness::GoodnessOfFit;
use crate::policy::POWER;

/// Tests independent `samples`, which it sorts, against the continuous distribution function `distribution`, with a false
/// alarm of at most `alpha`.
///
/// D is the greatest distance of the empirical distribution function from the stated one. P(D > d) ≤ 2 exp(−2 N d²) for
/// every N and every distribution (massart-1990 corollary 1): a bound of the p-value and no approximation, in the tail less
/// than a factor 2 above the limit law.
///
/// `detectable` is a distance of distribution functions \[1\]: if the true one is Δ away somewhere, D exceeds Δ less its
/// own fluctuation, which the same bound limits. Agreement needs a detectable distance below
/// [`MAX_DETECTABLE_RELATIVE_BIAS`](crate::MAX_DETECTABLE_RELATIVE_BIAS), half of all probability in a wrong place. A sample or a value of the function that is no
/// number, or a probability outside \[0, 1\]: unsound. No samples: not testable.
#[must_use]
pub fn kolmogorov_smirnov(
    samples: &mut [f64],
    distribution: impl Fn(f64) -> f64,
    alpha: f64,
) -> GoodnessOfFit {
    debug_assert!(alpha > 0.0 && alpha < 0.5, "a false alarm lies in (0, 1/2), found {alpha}");
    if samples.is_empty() {
        return GoodnessOfFit::not_testable("no samples");
    }
    samples.sort_by(f64::total_cmp);
    let n = samples.len() as f64;
    let mut distance = 0.0_f64;
    for (i, &sample) in samples.iter().enumerate() {
        let probability = distribution(sample);
        if sample.is_nan() || !(0.0..=1.0).contains(&probability) {
            return GoodnessOfFit::contradiction(format!("the distribution at {sample} is {probability}"));
        }
        // Just below and at the sample, where the empirical function jumps.
        let (below, at) = (i as f64 / n, (i + 1) as f64 / n);
        distance = distance.max(probability - below).max(at - probability);
    }
    let p_value = (2.0 * (-2.0 * n * distance * distance).exp()).min(1.0);
    let reach = |probability: f64| ((2.0 / probability).ln() / (2.0 * n)).sqrt();
    let detectable = reach(alpha) + reach(1.0 - POWER);
    GoodnessOfFit::decided(
        distance,
        (p_value, alpha),
        detectable,
        &format!("Kolmogorov distance {distance:.2e}, p < {p_value:.1e}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Binomial;
    use crate::test_support::uniforms;

    fn uniform(n: usize, seed: u64) -> Vec<f64> {
        uniforms(seed).take(n).collect()
    }

    fn identity(x: f64) -> f64 {
        x
    }

    #[test]
    fn the_distance_by_hand() {
        // The empirical function is 0.5 from 0.1 on and 1 from 0.6 on: farthest at 0.1 and at 0.6.
        let fit = kolmogorov_smirnov(&mut [0.6, 0.1], identity, 0.05);
        assert!((fit.statistic - 0.4).abs() < 1e-15);
        assert_eq!(fit.sound, None, "two samples have no power");
    }

    #[test]
    fn bounds_by_hand() {
        // All ten samples below 0.475: D = 0.525.
        let mut samples: Vec<f64> = (0..10).map(|i| (f64::from(i) + 0.5) / 20.0).collect();
        let fit = kolmogorov_smirnov(&mut samples, identity, 1e-3);
        let close = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-13, "{found}");
        close(fit.statistic, 0.525);
        close(fit.p_value_bound.unwrap(), 2.0 * (-20.0_f64 * 0.525 * 0.525).exp());
        // Twice the bound of a distance at N = 10: for the false alarm and for the power.
        close(fit.detectable.unwrap(), (2000.0_f64.ln() / 20.0).sqrt() + (200.0_f64.ln() / 20.0).sqrt());
    }

    #[test]
    fn the_level_is_held_under_the_null() {
        const RUNS: u64 = 400;
        let alpha = 0.05;
        let alarms = (0..RUNS)
            .filter(|&seed| {
                kolmogorov_smirnov(&mut uniform(1000, seed), identity, alpha).sound == Some(false)
            })
            .count() as u64;
        // The bound is tight at this N: the false alarm is alpha up to some percent, never above.
        assert!(Binomial::new(RUNS, alpha).unwrap().two_sided_p_value(alarms) > 1e-6, "{alarms} of {RUNS}");
    }

    #[test]
    fn the_detectable_distance_is_detected() {
        // The stated function is below that of the uniform variates, by `detectable` at x = `detectable`.
        let n = 4000;
        let detectable = kolmogorov_smirnov(&mut uniform(n, 1), identity, 1e-6).detectable.unwrap();
        let stated = |x: f64| ((x - detectable) / (1.0 - detectable)).max(0.0);
        let found = (0..200)
            .filter(|&seed| kolmogorov_smirnov(&mut uniform(n, seed), stated, 1e-6).sound == Some(false))
            .count() as u64;
        assert!(Binomial::new(200, POWER).unwrap().lower_tail(found) > 1e-6, "{found} of 200");
    }

    #[test]
    fn what_is_no_distribution_is_unsound() {
        assert_eq!(kolmogorov_smirnov(&mut [f64::NAN], identity, 0.01).sound, Some(false));
        assert_eq!(kolmogorov_smirnov(&mut [1.5], identity, 0.01).sound, Some(false));
        assert_eq!(kolmogorov_smirnov(&mut [], identity, 0.01).sound, None);
        // A wrong law: the square of a uniform variate is not uniform.
        let mut squares: Vec<f64> = uniform(1000, 5).into_iter().map(|x| x * x).collect();
        assert_eq!(kolmogorov_smirnov(&mut squares, identity, 1e-9).sound, Some(false));
        let root = |x: f64| x.sqrt();
        assert_eq!(kolmogorov_smirnov(&mut squares, root, 1e-9).sound, Some(true));
    }
}
