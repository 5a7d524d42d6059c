//! Tests of the binomial law: exact sums, an independent implementation, limits, 60-digit values.

use super::{Binomial, BinomialError};
use approx::assert_relative_eq;
use proptest::prelude::*;
use statrs::function::beta::beta_reg;
use statrs::function::gamma::gamma_lr;

fn law(trials: u64, p: f64) -> Binomial {
    Binomial::new(trials, p).unwrap()
}

/// P(X = j) for j = 0..=n by Pascal's recurrence on the number of trials: sums of positive terms only.
fn pascal(n: usize, p: f64) -> Vec<f64> {
    let mut row = vec![1.0];
    for _ in 0..n {
        let mut next = vec![0.0; row.len() + 1];
        for (j, value) in row.iter().enumerate() {
            next[j] += value * (1.0 - p);
            next[j + 1] += value * p;
        }
        row = next;
    }
    row
}

#[test]
fn equals_exact_sums_for_few_trials() {
    for n in [1usize, 2, 5, 17, 40, 200] {
        for p in [1e-9, 0.03, 0.25, 0.5, 0.9, 0.999] {
            let (row, law) = (pascal(n, p), law(n as u64, p));
            for k in 0..=n {
                let (below, above) = (row[..=k].iter().sum::<f64>(), row[k..].iter().rev().sum::<f64>());
                assert_relative_eq!(law.pmf(k as u64), row[k], max_relative = 1e-12);
                assert_relative_eq!(law.lower_tail(k as u64), below, max_relative = 1e-12);
                assert_relative_eq!(law.upper_tail(k as u64), above, max_relative = 1e-12);
            }
        }
    }
}

#[test]
fn agrees_with_the_incomplete_beta_of_statrs_where_that_is_accurate() {
    for (n, p) in [(10u64, 0.3), (60, 0.5), (100, 0.07)] {
        for k in 1..n {
            let (a, b) = (k as f64, (n - k + 1) as f64);
            assert_relative_eq!(
                law(n, p).upper_tail(k),
                beta_reg(a, b, p),
                epsilon = 1e-13,
                max_relative = 1e-11
            );
        }
    }
}

#[test]
fn the_incomplete_beta_of_statrs_fails_at_many_trials() {
    // The reason for this file: should this test fail, statrs has become good enough to replace it.
    let (n, k, p) = (1e12f64, 1_005_000.0, 1e-6);
    let theirs = beta_reg(k, n - k + 1.0, p);
    assert!((theirs / 2.933_996_012_626_346e-7 - 1.0).abs() > 1e-4, "{theirs}");
}

#[test]
fn agrees_with_sixty_digit_sums() {
    // mpmath 1.3, 60 digits, the terms summed outwards from k.
    for (k, n, p, expected) in [
        (1, 1_000_000, 1e-9, 9.995_001_671_245_086e-4),
        (1060, 1_000_000, 1e-3, 0.030_776_140_000_278_12),
        (1200, 1_000_000, 1e-3, 4.589_638_606_100_770_3e-10),
        (60, 100, 0.5, 0.028_443_966_820_490_396),
        (502_500, 1_000_000, 0.5, 2.881_270_818_870_302e-7),
        (1_000_100, 1_000_000_000_000, 1e-6, 0.460_305_118_863_715_7),
        (1_005_000, 1_000_000_000_000, 1e-6, 2.933_996_012_626_346e-7),
        (7, 1_000_000_000_000, 1e-12, 8.324_114_928_674_574e-5),
    ] {
        assert_relative_eq!(law(n, p).upper_tail(k), expected, max_relative = 2e-12);
    }
    for (k, n, p, expected) in [
        (940, 1_000_000, 1e-3, 0.028_959_701_832_482_292),
        (800, 1_000_000, 1e-3, 3.164_663_925_794_725e-11),
        (40, 100, 0.5, 0.028_443_966_820_490_396),
        (995_000, 1_000_000_000_000, 1e-6, 2.814_783_892_995_423_5e-7),
        (0, 1_000_000_000_000, 1e-12, 0.367_879_441_171_258_4),
        (20, 1_000_000_000_000, 1e-10, 1.905_558_735_913_728_8e-22),
        (998_800, 1_000_000, 0.999, 4.589_638_606_101_586_2e-10),
    ] {
        assert_relative_eq!(law(n, p).lower_tail(k), expected, max_relative = 2e-12);
    }
}

#[test]
fn tends_to_the_poisson_law_for_rare_events() {
    // P(Poisson(mu) >= k) is the regularised lower incomplete gamma function at (k, mu).
    let (n, p) = (1_000_000_000_000, 3e-12);
    for k in 1..20u32 {
        let poisson = gamma_lr(f64::from(k), 3.0);
        assert_relative_eq!(law(n, p).upper_tail(k.into()), poisson, max_relative = 1e-10);
    }
    let hopeless = law(1_000_000_000_000, 1e-300);
    assert_relative_eq!(hopeless.upper_tail(1), 1e-288, max_relative = 1e-12);
    assert_eq!((hopeless.lower_tail(0), hopeless.upper_tail(3)), (1.0, 0.0));
    assert_eq!(law(1_000_000_000_000, 5e-324).pmf(1), 1_000_000_000_000.0 * 5e-324);
}

#[test]
fn certain_and_impossible_events() {
    let never = law(10, 0.0);
    assert_eq!((never.pmf(0), never.pmf(1), never.lower_tail(0), never.upper_tail(1)), (1.0, 0.0, 1.0, 0.0));
    let always = law(10, 1.0);
    assert_eq!(
        (always.pmf(10), always.pmf(9), always.lower_tail(9), always.upper_tail(10)),
        (1.0, 0.0, 0.0, 1.0)
    );
    let nothing = law(0, 0.3);
    assert_eq!(
        (nothing.pmf(0), nothing.pmf(1), nothing.lower_tail(0), nothing.upper_tail(1)),
        (1.0, 0.0, 1.0, 0.0)
    );
}

#[test]
fn refuses_what_is_no_probability() {
    assert_eq!(Binomial::new(1, -0.1), Err(BinomialError::ProbabilityNotAtLeastZero));
    assert_eq!(Binomial::new(1, f64::NAN), Err(BinomialError::ProbabilityNotAtLeastZero));
    assert_eq!(Binomial::new(1, 1.1), Err(BinomialError::ProbabilityAboveOne));
}

proptest! {
    #[test]
    fn the_tails_complement_each_other(n in 1u64..1_000_000_000, fraction in 0.0f64..1.0, z in -6.0f64..6.0) {
        let p = fraction;
        let spread = (n as f64 * p * (1.0 - p)).sqrt();
        let k = (n as f64 * p + z * spread).clamp(1.0, n as f64) as u64;
        let law = law(n, p);
        let (above, below) = (law.upper_tail(k), law.lower_tail(k - 1));
        prop_assert!((above + below - 1.0).abs() < 1e-12);
        // One step of the tail is the probability of k.
        let step = above - law.upper_tail(k + 1);
        prop_assert!((step - law.pmf(k)).abs() <= 1e-11 * above.max(1e-300));
    }
}
