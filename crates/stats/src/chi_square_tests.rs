use super::*;
use crate::Binomial;
use crate::test_support::uniforms;
use approx::assert_relative_eq;

// Degrees of freedom, x and the tail: mpmath with 60 digits.
const TAILS: [(usize, f64, f64); 13] = [
    (1, 1.0, 0.3173105078629141),
    (1, 42.0, 9.127341799289194e-11),
    (2, 40.0, 2.061153622438558e-09),
    (5, 60.0, 1.215456977718304e-11),
    (15, 80.0, 6.984655416662433e-11),
    (19, 80.0, 1.8596255029858508e-09),
    (19, 19.0, 0.4568361255919624),
    (31, 110.0, 8.985486523911611e-11),
    (63, 160.0, 2.170304318877358e-10),
    (255, 420.0, 3.35288745214487e-10),
    (999, 1300.0, 3.3982174965154816e-10),
    (1, 0.01, 0.920344325445942),
    (4, 3.0, 0.5578254003710745),
];

fn counts(n: u64, probabilities: &[f64], seed: u64) -> Vec<u64> {
    let mut counts = vec![0; probabilities.len()];
    for mut u in uniforms(seed).take(n as usize) {
        let cell = probabilities.iter().position(|p| {
            u -= p;
            u < 0.0
        });
        counts[cell.unwrap_or(probabilities.len() - 1)] += 1;
    }
    counts
}

#[test]
fn tails_are_accurate_far_out() {
    for (degrees, x, expected) in TAILS {
        assert_relative_eq!(chi_square_upper_tail(degrees, x), expected, max_relative = 1e-12);
        if x > degrees as f64 {
            assert_relative_eq!(upper_quantile(degrees, expected), x, max_relative = 1e-11);
        }
    }
    // Two degrees are exponential.
    assert_relative_eq!(chi_square_upper_tail(2, 400.0), (-200.0_f64).exp(), max_relative = 1e-12);
    assert_eq!((chi_square_upper_tail(3, 0.0), chi_square_upper_tail(3, 1e9)), (1.0, 0.0));
}

#[test]
fn the_level_is_held_under_the_null() {
    const RUNS: u64 = 400;
    let alpha = 0.05;
    let probabilities = [0.05, 0.3, 0.02, 0.25, 0.2, 0.08, 0.1];
    let alarms = (0..RUNS)
        .filter(|&seed| {
            chi_square(&counts(4000, &probabilities, seed), &probabilities, alpha).sound == Some(false)
        })
        .count() as u64;
    // At most alpha; the safety factor makes it a quarter of that, and not nothing.
    let (promised, expected) =
        (Binomial::new(RUNS, alpha).unwrap(), Binomial::new(RUNS, alpha / SAFETY).unwrap());
    assert!(promised.upper_tail(alarms) > 1e-6, "{alarms} false alarms of {RUNS}");
    assert!(expected.two_sided_p_value(alarms) > 1e-6, "{alarms} false alarms of {RUNS}");
}

#[test]
fn the_exact_tail_of_two_cells_stays_below_the_bound() {
    // The rarest cell that is not pooled, at its critical count: the law of two cells is binomial, hence exact.
    for alpha in [1e-4, 1e-8, 1e-10] {
        let critical = upper_quantile(1, alpha / SAFETY);
        let least = critical.powi(3) / (6.0 * SKEWNESS.ln()).powi(2);
        for p in [1e-4, 0.1, 0.5] {
            let n = (least / p).ceil();
            let law = Binomial::new(n as u64, p).unwrap();
            let (mean, reach) = (n * p, (critical * n * p * (1.0 - p)).sqrt());
            let above = law.upper_tail((mean + reach).ceil() as u64);
            let below = law.lower_tail((mean - reach).floor() as u64);
            assert!(above + below <= alpha, "alpha {alpha:e}, p {p}: {:e}", above + below);
        }
    }
}

#[test]
fn the_detectable_deviation_is_detected() {
    let right = [0.25; 4];
    let alpha = 1e-6;
    let n = 20_000;
    let deviation = chi_square(&counts(n, &right, 1), &right, alpha).detectable.unwrap();
    assert!(deviation < 0.15, "{deviation}");
    let high = 0.25 * (1.0 + deviation);
    let low = (1.0 - high) / 3.0;
    let wrong = [low, high, low, low];
    let found = (0..200)
        .filter(|&seed| chi_square(&counts(n, &wrong, seed), &right, alpha).sound == Some(false))
        .count() as u64;
    assert!(Binomial::new(200, POWER).unwrap().lower_tail(found) > 1e-6, "{found} of 200");
}

#[test]
fn scarce_cells_are_pooled_and_scarce_samples_are_not_testable() {
    let probabilities = [0.001, 0.001, 0.498, 0.25, 0.25];
    let fit = chi_square(&counts(10_000, &probabilities, 3), &probabilities, 1e-6);
    assert_eq!(fit.sound, Some(true), "{}", fit.reason);
    assert!(fit.reason.contains("2 degrees of freedom"), "{}", fit.reason);
    assert_eq!(chi_square(&[5, 5], &[0.5, 0.5], 1e-6).sound, None);
    assert_eq!(chi_square(&[0, 0], &[0.5, 0.5], 1e-6).sound, None);
    assert_eq!(chi_square(&[500, 500], &[0.5, 0.6], 1e-6).sound, None);
    assert_eq!(chi_square(&[500, 500], &[0.5, f64::NAN], 1e-6).sound, None);
    assert_eq!(chi_square(&[1, 500], &[0.0, 1.0], 1e-6).sound, Some(false));
}

#[test]
fn a_statistic_by_hand() {
    // (10² + 10² + 100² + 100²)/2500.
    let fit = chi_square(&[2510, 2490, 2400, 2600], &[0.25; 4], 1e-3);
    assert_relative_eq!(fit.statistic, 8.08, max_relative = 1e-14);
    // Three degrees of freedom: erfc(√(x/2)) + √(2x/π) exp(−x/2), the former twice a normal tail.
    let x: f64 = 8.08;
    let tail =
        crate::normal::two_sided_tail(x.sqrt()) + (2.0 * x / std::f64::consts::PI).sqrt() * (-0.5 * x).exp();
    assert_relative_eq!(fit.p_value_bound.unwrap(), SAFETY * tail, max_relative = 1e-9);
    assert_eq!(fit.sound, Some(true));
}

#[test]
fn the_noncentrality_is_where_the_bound_of_its_lower_tail_meets_the_critical_value() {
    // birge-2001 lemma 8.1: P(X ≤ d + λ − 2 √((d + 2λ) t)) ≤ exp(−t).
    let t = -(1.0 - POWER).ln();
    for (degrees, critical) in [(1_usize, 30.0), (3, 40.0), (19, 90.0), (63, 160.0)] {
        let (d, lambda) = (degrees as f64, detectable_noncentrality(degrees, critical));
        let reached = d + lambda - 2.0 * ((d + 2.0 * lambda) * t).sqrt();
        assert_relative_eq!(reached, critical, max_relative = 1e-13);
    }
}
