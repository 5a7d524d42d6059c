//! Scenarios of judging: agreement, bias, rare events, heavy tails, bounds, vanishing variance.

use approx::assert_relative_eq;
use fairflight_stats::{
    ClosedMoments, MeanTest, Moments, NormalApproximation, Reference, Scores, StandardErrorSource, judge,
    samples_needed,
};

mod samples;
use samples::{ALPHA, counts, exponential, stratified, two_valued, unit_exponential};

#[test]
fn agreement_with_closed_moments_is_sound() {
    let verdict = judge(&exponential(400_000, 1.0), &unit_exponential(), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (Some(true), MeanTest::Normal), "{}", verdict.reason);
    assert_eq!(verdict.standard_error_source, StandardErrorSource::ClosedForm);
    assert!(verdict.mean_z.unwrap().abs() < 0.1 && verdict.variance_z.unwrap().abs() < 0.1);
    assert_eq!((verdict.mean_p, verdict.variance_p, verdict.samples_needed), (Some(1.0), Some(1.0), None));
    // (critical z + 2.33)/sqrt(N) for a relative standard deviation of one.
    let critical = NormalApproximation::for_level(0.5 * ALPHA).critical_z;
    assert_relative_eq!(
        verdict.detectable_relative_bias.unwrap(),
        (critical + 2.326) / 400_000f64.sqrt(),
        max_relative = 1e-3
    );
}

#[test]
fn wrong_mean_is_unsound_and_z_is_exact() {
    let measured = exponential(40_000, 1.05);
    let verdict = judge(&measured, &unit_exponential(), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (Some(false), MeanTest::Normal), "{}", verdict.reason);
    let z = (measured.mean().unwrap() - 1.0) * 200.0;
    assert_relative_eq!(verdict.mean_z.unwrap(), z, max_relative = 1e-12);
    assert!(verdict.mean_p.unwrap() <= 0.5 * ALPHA);
}

#[test]
fn wrong_variance_alone_is_unsound() {
    // Uniform on 1 +- sqrt(3) has the mean and variance of the exponential; stretched, only its mean.
    let stretched = stratified(1_000_000, |u| 1.0 + 1.05 * 12f64.sqrt() * (u - 0.5));
    let verdict = judge(&stretched, &unit_exponential(), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_p), (Some(false), Some(1.0)), "{}", verdict.reason);
    assert!(verdict.variance_p.unwrap() < 0.5 * ALPHA && verdict.variance_z.unwrap() > 30.0);
}

#[test]
fn variance_without_its_own_moments_leaves_the_mean_to_decide() {
    let moments = ClosedMoments::from_raw(&[1.0, 2.0, 6.0, 24.0]);
    let reference = Reference { moments: Some(moments), ..Reference::exact(1.0) };
    let verdict = judge(&exponential(40_000, 1.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.variance_p), (Some(true), None));
    assert!(verdict.variance_z.is_some() && verdict.reason.contains("eighth"), "{}", verdict.reason);
    // Enough for the mean, too few for the shape of the squares.
    let verdict = judge(&exponential(20_000, 1.0), &unit_exponential(), ALPHA);
    assert_eq!((verdict.sound, verdict.variance_p), (Some(true), None));
    assert!(verdict.reason.contains("its own shape needs"), "{}", verdict.reason);
}

#[test]
fn error_of_the_reference_is_granted() {
    let reference = Reference { error: 0.05, ..unit_exponential() };
    let verdict = judge(&exponential(40_000, 1.05), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_p), (Some(true), Some(1.0)), "{}", verdict.reason);
    assert!(verdict.mean_z.unwrap() > 9.0, "the z-score itself grants nothing");
    assert!(verdict.detectable_relative_bias.unwrap() > 0.1);
    // Counts: 0.11 and 0.10 +- 0.01 agree, 0.12 does not.
    let reference = Reference { error: 0.01, ..two_valued(0.1) };
    assert_eq!(judge(&counts(1_000_000, 110_000, 1.0), &reference, ALPHA).sound, Some(true));
    assert_eq!(judge(&counts(1_000_000, 120_000, 1.0), &reference, ALPHA).sound, Some(false));
}

#[test]
fn heavy_tails_are_not_testable() {
    // Mean 1, skewness 1e5: a z near zero would pass at any N in reach.
    let central = [1.0, 1e5, 2e10].map(Some);
    let reference =
        Reference { moments: Some(ClosedMoments::from_central(1.0, &central)), ..Reference::exact(1.0) };
    let verdict = judge(&exponential(100_000, 1.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test, verdict.mean_p), (None, MeanTest::NotTestable, None));
    assert!(verdict.mean_z.is_some() && verdict.reason.contains("skewness^2/N"), "{}", verdict.reason);
    let needed = verdict.samples_needed.unwrap();
    assert!((1e13..1e14).contains(&needed), "{needed}");
}

#[test]
fn infinite_moments_are_not_testable() {
    for raw in [vec![1.0, f64::INFINITY], vec![1.0, 2.0, f64::INFINITY, f64::INFINITY]] {
        let reference = Reference { moments: Some(ClosedMoments::from_raw(&raw)), ..Reference::exact(1.0) };
        let verdict = judge(&exponential(10_000, 1.0), &reference, ALPHA);
        assert_eq!(
            (verdict.sound, verdict.samples_needed),
            (None, Some(f64::INFINITY)),
            "{}",
            verdict.reason
        );
    }
}

#[test]
fn single_success_of_a_rare_event_is_neither_alarm_nor_pass() {
    let verdict = judge(&counts(1_000_000, 1, 1.0), &two_valued(1e-9), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (None, MeanTest::Binomial), "{}", verdict.reason);
    assert_relative_eq!(verdict.mean_z.unwrap(), 31.59, max_relative = 1e-3);
    assert_relative_eq!(verdict.mean_p.unwrap(), 1.999e-3, max_relative = 1e-3);
    let needed = verdict.samples_needed.unwrap();
    assert!((1e11..1e12).contains(&needed), "N p must be a few hundred: {needed}");
    // No success is as little evidence; three are a rejection whatever the power.
    assert_eq!(judge(&counts(1_000_000, 0, 1.0), &two_valued(1e-9), ALPHA).sound, None);
    assert_eq!(judge(&counts(1_000_000, 3, 1.0), &two_valued(1e-9), ALPHA).sound, Some(false));
    assert_eq!(judge(&counts(1000, 0, 1.0), &two_valued(1e-300), ALPHA).sound, None);
    // With the N asked for, it can be judged.
    let n = needed as u64;
    assert_eq!(judge(&counts(n, n / 1_000_000_000, 1.0), &two_valued(1e-9), ALPHA).sound, Some(true));
}

#[test]
fn two_valued_samples_at_the_ends_of_the_range() {
    // Certain success: one failure in a million is one too many.
    let verdict = judge(&counts(1_000_000, 1_000_000, 1.0), &two_valued(1.0), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_z, verdict.variance_z), (Some(true), None, None));
    assert_eq!(judge(&counts(1_000_000, 999_999, 1.0), &two_valued(1.0), ALPHA).sound, Some(false));
    // A reference of zero: any success is too many, none says nothing of a relative bias.
    let verdict = judge(&counts(1000, 0, 1.0), &two_valued(0.0), ALPHA);
    assert_eq!((verdict.sound, verdict.detectable_relative_bias), (None, None));
    assert_eq!(verdict.samples_needed, Some(f64::INFINITY));
    assert_eq!(judge(&counts(1000, 1, 1.0), &two_valued(0.0), ALPHA).sound, Some(false));
    // The variance is a function of the mean: its z is printed, not judged.
    let reference = Reference { scores: Scores::TwoValued { high: 3.0 }, ..Reference::exact(0.3) };
    let verdict = judge(&counts(1_000_000_000_000, 100_000_000_000, 3.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.variance_p), (Some(true), None), "{}", verdict.reason);
    assert!(verdict.variance_z.unwrap().abs() < 0.1);
    // A rounding error of p near 1 or in the mean is no contradiction.
    assert_ne!(
        judge(&counts(10_000_000_000, 9_999_999_990, 1.0), &two_valued(1.0 - 1e-9), ALPHA).sound,
        Some(false)
    );
}

#[test]
fn excluded_samples_are_unsound() {
    let mut measured = counts(1000, 500, 1.0);
    measured.push(0.5);
    measured.push(0.5);
    let verdict = judge(&measured, &two_valued(0.5), ALPHA);
    assert_eq!(
        (verdict.sound, verdict.mean_test),
        (Some(false), MeanTest::Contradiction),
        "{}",
        verdict.reason
    );
    measured.push(1.5);
    assert!(judge(&measured, &two_valued(0.5), ALPHA).reason.contains("neither"));
    let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
    let verdict = judge(&measured, &Reference { scores, ..Reference::exact(0.5) }, ALPHA);
    assert_eq!(verdict.mean_test, MeanTest::Contradiction, "{}", verdict.reason);
}

#[test]
fn bounded_samples_fall_back_to_bernstein() {
    // Skewed like a rare event, but bounded: mean 1e-3, nearly all of it from values near 1.
    let central = [1e-3, 1e-3, 1e-3].map(Some);
    let reference = Reference {
        moments: Some(ClosedMoments::from_central(1e-3, &central)),
        scores: Scores::Bounded { minimum: 0.0, maximum: 1.0 },
        ..Reference::exact(1e-3)
    };
    let verdict = judge(&counts(400_000, 400, 1.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (Some(true), MeanTest::Bernstein), "{}", verdict.reason);
    assert!(verdict.detectable_relative_bias.unwrap() < 0.5);
    assert_eq!(judge(&counts(400_000, 700, 1.0), &reference, ALPHA).sound, Some(false));
    // A tenth of it has no power to accept, and says how many would have.
    let verdict = judge(&counts(40_000, 40, 1.0), &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (None, MeanTest::Bernstein), "{}", verdict.reason);
    assert!((40_000.0..400_000.0).contains(&verdict.samples_needed.unwrap()));
    // Without moments the variance is at most (1 - mean) mean, which holds for any law.
    let verdict = judge(&counts(40_000, 200, 1.0), &Reference { moments: None, ..reference }, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (Some(false), MeanTest::Inequality), "{}", verdict.reason);
}

#[test]
fn sample_moments_are_used_with_more_care_and_said_so() {
    let verdict = judge(&exponential(100_000, 1.0), &Reference::exact(1.0), ALPHA);
    assert_eq!((verdict.sound, verdict.standard_error_source), (Some(true), StandardErrorSource::Sample));
    assert!(verdict.reason.contains("blind") && verdict.variance_z.is_none(), "{}", verdict.reason);
    // Enough with the law known, too few for the sample's own word.
    let few = exponential(20_000, 1.0);
    assert_eq!(judge(&few, &unit_exponential(), ALPHA).sound, Some(true));
    let verdict = judge(&few, &Reference::exact(1.0), ALPHA);
    assert_eq!((verdict.sound, verdict.samples_needed), (None, None), "{}", verdict.reason);
}

#[test]
fn weak_tests_do_not_accept() {
    // Relative standard deviation 100: a normal law, but N = 1e4 would miss a bias of the size of the mean.
    let central = [1e4, 0.0, 3e8].map(Some);
    let reference =
        Reference { moments: Some(ClosedMoments::from_central(1.0, &central)), ..Reference::exact(1.0) };
    let measured = stratified(10_000, |u| 1.0 + 100.0 * 12f64.sqrt() * (u - 0.5));
    let verdict = judge(&measured, &reference, ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (None, MeanTest::Normal), "{}", verdict.reason);
    assert!(verdict.detectable_relative_bias.unwrap() > 7.0);
    assert!((2e6..3e6).contains(&verdict.samples_needed.unwrap()));
    // About a mean of zero there is no relative bias; the test of the difference stands.
    let zero = Reference { mean: 0.0, ..reference };
    let measured = stratified(10_000, |u| 100.0 * 12f64.sqrt() * (u - 0.5));
    let verdict = judge(&measured, &zero, ALPHA);
    assert_eq!((verdict.sound, verdict.detectable_relative_bias), (Some(true), None), "{}", verdict.reason);
    assert_eq!(judge(&stratified(10_000, |u| 300.0 * u), &zero, ALPHA).sound, Some(false));
}

#[test]
fn vanishing_variance_is_judged_to_rounding() {
    let central = [Some(0.0); 7];
    let tau = 300.0f64;
    let mean = (-tau).exp();
    let exact =
        Reference { moments: Some(ClosedMoments::from_central(mean, &central)), ..Reference::exact(mean) };
    // Both with the law known and with the sample alone.
    for reference in [exact, Reference::exact(mean)] {
        let measured = Moments::from_slice(&[mean * (1.0 + 1e-11); 100]);
        let verdict = judge(&measured, &reference, ALPHA);
        assert_eq!(
            (verdict.sound, verdict.mean_test),
            (Some(true), MeanTest::Rounding),
            "{}",
            verdict.reason
        );
        assert_eq!((verdict.mean_z, verdict.variance_z, verdict.mean_p), (None, None, None));
        assert!(verdict.detectable_relative_bias.unwrap() < 1e-9);
    }
    let off = Moments::from_slice(&[mean * (1.0 + 1e-8); 100]);
    assert_eq!(judge(&off, &exact, ALPHA).sound, Some(false));
    assert_eq!(judge(&off, &Reference { error: 1e-7 * mean, ..exact }, ALPHA).sound, Some(true));
    // An error as large as the mean hides everything.
    assert_eq!(judge(&off, &Reference { error: mean, ..exact }, ALPHA).sound, None);
    // Equal samples of an unknown law may merely lack the rare large one.
    let verdict = judge(&off, &Reference::exact(mean), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_test), (None, MeanTest::NotTestable), "{}", verdict.reason);
    // A variance where none should be.
    let measured: Moments = [mean, mean * (1.0 + 1e-6), mean * (1.0 - 1e-6)].into_iter().collect();
    let verdict = judge(&measured, &exact, ALPHA);
    assert_eq!(verdict.sound, Some(false), "{}", verdict.reason);
    assert!(verdict.reason.contains("should vanish"));
}

#[test]
fn few_samples_are_not_testable() {
    let verdict = judge(&Moments::new(), &unit_exponential(), ALPHA);
    assert_eq!((verdict.sound, verdict.mean_z), (None, None));
    assert!(verdict.reason.contains("no samples"));
    for values in [&[1.3][..], &[1.3, 0.2]] {
        let measured = Moments::from_slice(values);
        for reference in [unit_exponential(), Reference::exact(1.0), two_valued(0.5)] {
            let measured = match reference.scores {
                Scores::TwoValued { .. } => counts(values.len() as u64, 1, 1.0),
                _ => measured,
            };
            let verdict = judge(&measured, &reference, ALPHA);
            assert_eq!((verdict.sound, verdict.variance_p), (None, None), "{}", verdict.reason);
        }
    }
    let verdict = judge(&exponential(10, 1.0), &Reference::exact(f64::NAN), ALPHA);
    assert_eq!(verdict.sound, None);
}

#[test]
fn mild_tails_let_a_sample_reject_by_its_own_error() {
    // Ten values, equally often: the mean is 0.45.
    let measured: Moments = (0..100_000).map(|i| f64::from(i % 10) / 10.0).collect();
    let right = Reference::exact(0.45);
    let wrong = Reference::exact(0.47);
    assert_eq!(judge(&measured, &right, 1e-6).sound, Some(true));
    assert_eq!(judge(&measured, &wrong, 1e-6).sound, None);
    assert_eq!(judge(&measured, &right.with_mild_tails(), 1e-6).sound, Some(true));
    assert_eq!(judge(&measured, &wrong.with_mild_tails(), 1e-6).sound, Some(false));
}

/// 26 % of a million are far from 30 %, but within an error of five percent; 24 % are not.
#[test]
fn the_error_of_a_probability_is_granted_on_both_sides() {
    let reference = Reference { error: 0.05, ..two_valued(0.3) };
    for (share, agrees) in [(0.24, false), (0.26, true), (0.34, true), (0.36, false)] {
        let verdict = judge(&counts(1_000_000, (1e6 * share) as u64, 1.0), &reference, ALPHA);
        assert_eq!(verdict.sound != Some(false), agrees, "{share}: {}", verdict.reason);
    }
}

/// Where one sample is too large for a z-test of the law, an inequality has what that test leaves of the level: 3/8.
#[test]
fn a_test_that_hangs_on_the_sample_shares_the_level() {
    let mut measured = exponential(40_000, 1.04);
    measured.push(100.0);
    let shared = judge(&measured, &unit_exponential(), ALPHA);
    let variance_alone = Reference { variance_bound: Some(1.0), ..Reference::exact(1.0) };
    let alone = judge(&measured, &variance_alone, ALPHA);
    for verdict in [&shared, &alone] {
        assert_eq!(
            (verdict.sound, verdict.mean_test),
            (Some(false), MeanTest::Inequality),
            "{}",
            verdict.reason
        );
    }
    assert_relative_eq!(shared.mean_p.unwrap(), alone.mean_p.unwrap() / 0.375, max_relative = 1e-9);
}

/// A closed variance that is off by a tenth makes no z-score of the law.
#[test]
fn a_variance_with_an_error_rejects_by_its_bound() {
    let verdict = |bound: f64| {
        let reference = Reference { variance_bound: Some(bound), ..unit_exponential() };
        judge(&exponential(40_000, 1.05), &reference, ALPHA)
    };
    assert_eq!(verdict(1.0005).mean_test, MeanTest::Normal);
    let rough = verdict(1.1);
    assert_eq!((rough.sound, rough.mean_test), (Some(false), MeanTest::Inequality), "{}", rough.reason);
    // Bernstein's inequality holds with a bound of the variance, not with less.
    let bounded = |variance: f64, variance_bound: Option<f64>| {
        let moments = Some(ClosedMoments::from_central(0.5, &[Some(variance)]));
        let scores = Scores::Bounded { minimum: 0.0, maximum: 1.0 };
        let reference = Reference { moments, variance_bound, scores, ..Reference::exact(0.5) };
        samples_needed(&reference, ALPHA, 0.05).unwrap()
    };
    assert_eq!(bounded(0.01, Some(0.02)), bounded(0.02, None));
    assert!(bounded(0.01, None) < bounded(0.02, None));
}
