//! False alarm and power of `judge`, measured: the share of replicas rejected with the right reference, and called sound with a
//! biased one.
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
    // A sample's own word may disagree as often as a test of this level, and leave the call without a verdict.
    assert!(expected_alarms.upper_tail(REPLICAS - passes) > 1e-6, "{passes} of {REPLICAS} pass");
    let measured: Vec<f64> = test_support::uniforms(1).take(n).map(draw).collect();
    let moments = Moments::from_slice(&measured);
    let detectable = |mean: f64| judge(&moments, &reference(mean), ALPHA).detectable_relative_bias.unwrap();
    // The reference moves instead of the estimator: to where the true mean is just beyond what it can detect.
    for side in [1.02, -1.02] {
        let biased = (0..20).fold(mean, |biased, _| mean / (1.0 + side * detectable(biased)));
        let (_, passed) = rejections_and_passes(draw, n, &reference(biased));
        let missed = Binomial::new(REPLICAS, 0.02).unwrap().upper_tail(passed);
        assert!(missed > 1e-6, "{passed} of {REPLICAS} called sound");
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

/// The inequality's side: a bias upwards is rejected, and no closed moment is known.
#[test]
fn law_of_a_known_lower_end() {
    let scores = Scores::Bounded { minimum: 0.0, maximum: f64::INFINITY };
    let reference = |mean| Reference { scores, ..Reference::exact(mean) };
    let (alarms, _) = rejections_and_passes(|u| -u.ln(), 3000, &reference(1.0));
    assert!(Binomial::new(REPLICAS, ALPHA).unwrap().upper_tail(alarms) > 1e-6, "{alarms} false alarms");
    let (rejected, _) = rejections_and_passes(|u| -u.ln(), 3000, &reference(0.9));
    assert!(rejected > REPLICAS * 9 / 10, "{rejected} of {REPLICAS} rejected at 5.5 standard errors");
}
