//! Scenarios of judging where the sample may lack what matters: no closed variance, ends of the law, estimated references.

use fairflight_stats::{Certainty, ClosedMoments, MeanTest, Moments, Reference, Scores, judge};

mod samples;
use samples::{ALPHA, counts, exponential, stratified, two_valued, unit_exponential};

const NEVER_NEGATIVE: Scores = Scores::Bounded { minimum: 0.0, maximum: f64::INFINITY };

#[test]
fn a_sample_alone_rejects_nothing() {
    for mean in [0.9, 1.1] {
        let measured = exponential(1_000_000, mean);
        let verdict = judge(&measured, &Reference::exact(1.0), ALPHA);
        assert_eq!((verdict.sound, verdict.mean_test), (None, MeanTest::NotTestable), "{}", verdict.reason);
        assert!(verdict.reason.contains("no bound of the second moment"), "{}", verdict.reason);
        assert!(verdict.mean_z.unwrap().abs() > 90.0 && verdict.mean_p.is_none());
        // An upper bound of the variance tells how much the events can carry that were not seen.
        let bounded = |bound| Reference { variance_bound: Some(bound), ..Reference::exact(1.0) };
        for (bound, sound) in [(1.2, Some(false)), (100.0, Some(false)), (1e3, None), (f64::INFINITY, None)] {
            let verdict = judge(&measured, &bounded(bound), ALPHA);
            assert_eq!(verdict.sound, sound, "{bound}: {}", verdict.reason);
        }
        // What is never negative cannot be too large for lack of large values.
        let verdict = judge(&measured, &Reference { scores: NEVER_NEGATIVE, ..Reference::exact(1.0) }, ALPHA);
        assert_eq!(verdict.sound, if mean > 1.0 { Some(false) } else { None }, "{}", verdict.reason);
        let below = Scores::Bounded { minimum: f64::NEG_INFINITY, maximum: 20.0 };
        let verdict = judge(&measured, &Reference { scores: below, ..Reference::exact(1.0) }, ALPHA);
        assert_eq!(verdict.sound, if mean < 1.0 { Some(false) } else { None }, "{}", verdict.reason);
    }
}

/// A law whose moments allow a normal approximation may still have a value so rare and so large that it decides alone.
#[test]
fn one_rare_value_is_no_rejection() {
    // Uniform of variance 1, and 1000 with probability 2e-9: skewness²/N = 4e-7, kurtosis/N = 0.02.
    let n = 100_000_u32;
    let central = [1.002, 2.0, 1.8 + 2000.0].map(Some);
    let reference =
        Reference { moments: Some(ClosedMoments::from_central(1.0, &central)), ..Reference::exact(1.0) };
    let usual = |shift: f64| stratified(n, |u| 1.0 + shift + 3f64.sqrt() * (2.0 * u - 1.0));
    assert_eq!(judge(&usual(0.0), &reference, ALPHA).sound, Some(true));
    assert_eq!(judge(&usual(0.018), &reference, ALPHA).sound, Some(false), "a bias of 5.7 standard errors");
    let mut lucky = usual(0.0);
    lucky.push(2000.0);
    let verdict = judge(&lucky, &reference, ALPHA);
    assert!(verdict.mean_z.unwrap() > 6.0 && verdict.sound.is_none(), "{}", verdict.reason);
}

#[test]
fn a_lower_bound_alone_is_a_bound() {
    let reference = Reference { scores: NEVER_NEGATIVE, ..Reference::exact(1.0) };
    let verdict = judge(&exponential(100_000, 1.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (Some(true), MeanTest::Normal), "{}", verdict.reason);
    let mut measured = exponential(100_000, 1.0);
    measured.push(-0.1);
    let verdict = judge(&measured, &reference, ALPHA);
    assert_eq!(verdict.mean_test, MeanTest::Contradiction, "{}", verdict.reason);
}

#[test]
fn equal_samples_below_an_end_of_the_law() {
    let mut measured = Moments::new();
    (0..100).for_each(|_| measured.push(0.5));
    let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    for (mean, sound) in [(0.5, Some(true)), (0.1, Some(false)), (0.9, Some(false)), (0.51, None)] {
        let verdict = judge(&measured, &Reference { scores, ..Reference::exact(mean) }, ALPHA);
        assert_eq!(verdict.sound, sound, "{mean}: {}", verdict.reason);
    }
}

#[test]
fn an_estimated_reference_decides_nothing_but_by_its_bounds() {
    let estimated = |low, high| Reference {
        certainty: Certainty::Estimated { low, high },
        error: 1e-15,
        scores: NEVER_NEGATIVE,
        ..unit_exponential()
    };
    let (right, high) = (exponential(400_000, 1.0), exponential(400_000, 1.3));
    for (measured, bounds, sound) in [
        (&right, (0.0, f64::INFINITY), None),
        (&high, (0.0, f64::INFINITY), None),
        (&right, (0.95, 1.1), Some(true)),
        (&right, (0.0, 1.1), None),
        (&high, (0.0, 1.1), Some(false)),
        (&high, (0.0, 1.35), None),
        // Nothing is known above: what the sample lacks may be there.
        (&right, (1.2, 1.4), None),
    ] {
        let verdict = judge(measured, &estimated(bounds.0, bounds.1), ALPHA);
        assert_eq!(verdict.sound, sound, "{bounds:?}: {}", verdict.reason);
        assert!(
            verdict.reason.contains("not certified") && verdict.variance_p.is_none(),
            "{}",
            verdict.reason
        );
    }
    // Counts: against every probability within the bounds.
    for (low, high, sound) in
        [(0.0, 1.0, None), (0.0, 0.09, Some(false)), (0.12, 1.0, Some(false)), (0.09, 0.11, Some(true))]
    {
        let reference = Reference { certainty: Certainty::Estimated { low, high }, ..two_valued(0.1) };
        let verdict = judge(&counts(1_000_000, 100_000, 1.0), &reference, ALPHA);
        assert_eq!(verdict.sound, sound, "[{low}, {high}]: {}", verdict.reason);
    }
    // Both ends of the law known: Bernstein's inequality at the worst mean.
    let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    for (low, high, sound) in [(0.0, 1.0, None), (0.0, 0.09, Some(false)), (0.095, 0.105, Some(true))] {
        let certainty = Certainty::Estimated { low, high };
        let reference = Reference { certainty, scores, ..Reference::exact(0.1) };
        let verdict = judge(&counts(10_000_000, 1_000_000, 1.0), &reference, ALPHA);
        assert_eq!(verdict.sound, sound, "[{low}, {high}]: {}", verdict.reason);
    }
}

#[test]
fn the_bounds_of_an_estimated_mean_are_told_as_shares_of_it() {
    let certainty = Certainty::Estimated { low: 0.5, high: 3.0 };
    let reference = Reference { certainty, ..Reference::exact(2.0) };
    let verdict = judge(&exponential(1000, 2.0), &reference, ALPHA);
    assert!(verdict.reason.contains("between 2.500e-1 and 1.500e0 of it"), "{}", verdict.reason);
}
