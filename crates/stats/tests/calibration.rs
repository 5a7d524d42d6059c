//! False alarm and power of `judge`, measured: the share of replicas rejected with the right and with a biased reference.
//!
//! False alarm of each check of this file below 1e-6, with fixed seeds.

use fairflight_stats::{Binomial, ClosedMoments, Moments, Reference, Scores, judge};

#[path = "../src/test_support.rs"]
mod test_support;

const ALPHA: f64 = 0.02;
const REPLICAS: u64 = 500;

/// Number of replicas called unsound, and the number called sound.
fn rejections_and_passes(draw: impl Fn(f64) -> f64, n: usize, reference: &Reference) -> (u64, u64) {
    let mut tally = (0, 0);
    let mut uniforms = test_support::uniforms(20_240_601);
    for _ in 0..REPLICAS {
        let values: Vec<f64> = uniforms.by_ref().take(n).map(&draw).collect();
        match judge(&Moments::from_slice(&values), reference, ALPHA).sound {
            Some(true) => tally.1 += 1,
            Some(false) => tally.0 += 1,
            None => {}
        }
    }
    tally
}

/// Checks level and power of one law: the draw, and the reference of a given mean, at n values.
fn check(draw: impl Fn(f64) -> f64 + Copy, n: usize, reference: impl Fn(f64) -> Reference, mean: f64) {
    let expected_alarms = Binomial::new(REPLICAS, ALPHA).unwrap();
    let (alarms, passes) = rejections_and_passes(draw, n, &reference(mean));
    assert!(expected_alarms.upper_tail(alarms) > 1e-6, "{alarms} false alarms");
    assert_eq!(alarms + passes, REPLICAS, "testable at this N");
    let measured: Vec<f64> = test_support::uniforms(1).take(n).map(draw).collect();
    let moments = Moments::from_slice(&measured);
    let detectable = |mean: f64| judge(&moments, &reference(mean), ALPHA).detectable_relative_bias.unwrap();
    // The reference moves instead of the estimator: to where the true mean is just beyond what it can detect.
    for side in [1.02, -1.02] {
        let biased = (0..20).fold(mean, |biased, _| mean / (1.0 + side * detectable(biased)));
        let (rejected, _) = rejections_and_passes(draw, n, &reference(biased));
        let missed = Binomial::new(REPLICAS, 0.02).unwrap().upper_tail(REPLICAS - rejected);
        assert!(missed > 1e-6, "only {rejected} of {REPLICAS} rejected");
    }
}

#[test]
fn exponential_law_with_closed_moments() {
    let reference = |mean: f64| {
        let raw = [1.0, 2.0, 6.0, 24.0];
        let powers: Vec<f64> = raw.iter().zip(1..).map(|(moment, k)| moment * mean.powi(k)).collect();
        Reference { moments: Some(ClosedMoments::from_raw(&powers)), ..Reference::exact(mean) }
    };
    check(|u| -u.ln(), 2000, reference, 1.0);
}

#[test]
fn exponential_law_with_sample_moments() {
    check(|u| -u.ln(), 10_000, Reference::exact, 1.0);
}

#[test]
fn two_valued_law() {
    let scores = Scores::TwoValued { high: 2.0 };
    check(
        |u| if u < 0.05 { 2.0 } else { 0.0 },
        5000,
        |mean| Reference { scores, ..Reference::exact(mean) },
        0.1,
    );
}

#[test]
fn bounded_law_of_unknown_moments() {
    let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    check(|u| u * u * u, 2000, |mean| Reference { scores, ..Reference::exact(mean) }, 0.25);
}
