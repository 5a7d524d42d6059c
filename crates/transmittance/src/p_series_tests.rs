use super::*;
use crate::Tracking;
use crate::test_support::{Broken, agrees, mean, mean_and_square, seed_ray, theory_of};
use PSeriesVersion::{Cmf, Cumulative, NextFlight, Ratio};
use approx::assert_relative_eq;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Breakpoints, Constant, Counted, OpticalThickness, PiecewiseConstant, Vacuum};
use fairflight_sources::{Scripted, Seeded};

const VERSIONS: [PSeriesVersion; 4] = [Cmf, Cumulative, Ratio, NextFlight];

fn steps() -> PiecewiseConstant {
    PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, 0.1, 1.0]).unwrap()
}

/// Poisson probabilities.
fn mass(mean: f64, k: u32) -> f64 {
    (1..=k).fold((-mean).exp(), |p, i| p * mean / f64::from(i))
}

#[test]
fn terms_by_hand() {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 3.0], vec![0.5, -0.4]).unwrap();
    // X = 1.5 and −1.2; the pivot 0.2 gives Y = −1.3 and 1.4. P(N ≤ 1) = 0.982, P(N ≤ 2) = 0.9989: orders up to 3 are sure.
    let of = |version| PSeries::new(version, 0.2).unwrap();
    let t = (-0.2_f64).exp();
    let terms = |orders: &[f64]| t * orders.iter().sum::<f64>();
    let (y, z) = (-1.3, 1.4);
    let run = |version, variates: &[f64]| {
        let mut source = Scripted::new(variates.iter().copied());
        let estimate = of(version).estimate(&field, &mut source);
        assert_eq!(source.remaining(), 0, "{version:?}");
        estimate
    };
    // To order 4 with probability 0.05, to order 5 not.
    let found = run(Cmf, &[0.1, 0.5, 0.6, 0.04, 0.2, 0.05]);
    let cubic = y * z * z / 6.0;
    let exact = terms(&[1.0, y, y * z / 2.0, cubic, cubic * y / 4.0 / 0.05]);
    assert_relative_eq!(found, exact, max_relative = 1e-12);
    // |−1.3| > 1 goes on for sure; then y z/2 = −0.91 and is −1 if it does; then −0.4667.
    let found = run(Cumulative, &[0.1, 0.5, 0.9, 0.6, 0.47]);
    assert_relative_eq!(found, terms(&[1.0, y, -1.0]), max_relative = 1e-12);
    // K = 2: the Poisson steps 0.1 and 0.05 fit.
    let step = |depth: f64| 1.0 - (-depth).exp();
    let drawn = [step(0.1), step(0.05), step(0.3), 0.1, 0.5];
    assert_relative_eq!(run(Ratio, &drawn), y * z / 0.04, max_relative = 1e-12);
    let tail = |k| 1.0 - (0..k).map(|i| mass(0.2, i)).sum::<f64>();
    let exact = terms(&[1.0, y / tail(1), y * z / 2.0 / tail(2)]);
    // (The points come in the order of the nesting; here Y_2 first.)
    let drawn = [step(0.1), step(0.05), step(0.3), 0.5, 0.1];
    assert_relative_eq!(run(NextFlight, &drawn), exact, max_relative = 1e-9);
}

#[test]
fn a_perfect_pivot_leaves_no_variance() {
    let field = Constant::new(0.7, 3.0).unwrap();
    for version in [Cmf, Cumulative, NextFlight] {
        let exact = PSeries::with_majorant(version, &field).unwrap();
        for seed in 0..20 {
            let estimate = exact.estimate(&field, &mut Seeded::new(seed));
            assert_relative_eq!(estimate, (-2.1_f64).exp(), max_relative = 1e-12);
        }
        let variance = theory_of(field, &exact).relative_central[0];
        assert!(version == Cumulative || variance < 1e-25, "{version:?}: {variance}");
    }
}

/// The double sum of the second moment, as it is usually written.
fn double_sum(pivot: f64, tau: f64, square: f64, reached: &[f64]) -> f64 {
    let y = pivot - tau;
    let q = pivot * pivot - 2.0 * pivot * tau + square;
    let factorial = |k: usize| (1..=k).map(|i| i as f64).product::<f64>();
    let mut sum = 0.0;
    for j in 0..reached.len() {
        for k in 0..reached.len() {
            let least = j.min(k);
            sum += q.powi(least as i32) * y.powi(j.abs_diff(k) as i32)
                / (factorial(j) * factorial(k) * reached[least]);
        }
    }
    (-2.0 * pivot + 2.0 * tau).exp() * sum - 1.0
}

#[test]
fn the_variance_is_that_of_the_double_sum() {
    const ORDERS: u32 = 60;
    let (tau, square) = mean_and_square(&steps());
    for pivot in [0.3, 1.0, 2.5, 6.0] {
        let cmf = PSeries::new(Cmf, pivot).unwrap();
        let mut reached = vec![1.0];
        for k in 1..=ORDERS {
            let go_on = if k <= cmf.sure { 1.0 } else { f64::min(1.0, pivot / f64::from(k)) };
            reached.push(reached[k as usize - 1] * go_on);
        }
        let theory = theory_of(steps(), &cmf);
        let exact = double_sum(pivot, tau, square, &reached);
        assert_relative_eq!(theory.relative_central[0], exact, max_relative = 1e-8);
        assert_relative_eq!(theory.lookups, reached[1..].iter().sum::<f64>(), max_relative = 1e-12);
        let tails: Vec<f64> = (0..=ORDERS).map(|k| (k..k + 60).map(|i| mass(pivot, i)).sum()).collect();
        let theory = theory_of(steps(), &PSeries::new(NextFlight, pivot).unwrap());
        let exact = double_sum(pivot, tau, square, &tails);
        assert_relative_eq!(theory.relative_central[0], exact, max_relative = 1e-8);
        assert_relative_eq!(theory.lookups, pivot, max_relative = 1e-12);
    }
}

#[test]
fn remainders_follow_their_recursion_on_both_sides() {
    for y in [-40.0, -7.5, -0.3, 0.0, 0.3, 7.5, 40.0, 1500.0] {
        let n = 4000;
        let logs = log_remainders(y, n);
        // r_k = k ∫_0^1 (1 − t)^(k−1) exp(y t) dt, by its ends: 1 + y/(k + 1) …, and exp(y) − … for small k.
        let r_1 = if y == 0.0 {
            0.0
        } else if y > 0.0 {
            y - y.ln() + (-(-y).exp()).ln_1p()
        } else {
            (y.exp_m1() / y).ln()
        };
        assert_relative_eq!(logs[1], r_1, max_relative = 1e-12, epsilon = 1e-13);
        assert_relative_eq!(logs[0], y, max_relative = 1e-12, epsilon = 1e-13);
        for k in [0, 3, 39, 40, 900, 3000] {
            let (r, next) = (logs[k], logs[k + 1]);
            let rest = 1.0 - y / (k + 1) as f64 * (next - r).exp();
            assert_relative_eq!(rest, (-r).exp(), max_relative = 1e-9, epsilon = 1e-12);
        }
    }
}

#[test]
fn the_ratio_version_has_the_law_of_ratio_tracking() {
    let theory = theory_of(seed_ray(), &PSeries::with_majorant(Ratio, &seed_ray()).unwrap());
    let model = DoubleParticle { albedo: Albedo::default() };
    let tracking = Tracking::new(model, Vacuum::new(20.0), Constant::new(1.0, 20.0).unwrap());
    let other = theory_of(seed_ray(), &tracking);
    assert_relative_eq!(theory.lookups, other.lookups, max_relative = 1e-12);
    for (a, b) in theory.relative_central.into_iter().zip(other.relative_central) {
        assert_relative_eq!(a, b, max_relative = 1e-9);
    }
    assert_relative_eq!(theory.relative_central[0], 6.11, max_relative = 1e-3);
}

#[test]
fn the_measured_figures_of_the_seed_ray() {
    let theory = theory_of(seed_ray(), &PSeries::with_majorant(Cmf, &seed_ray()).unwrap());
    assert_relative_eq!(theory.relative_central[0], 3.10, max_relative = 2e-3);
    assert_relative_eq!(theory.lookups, 33.4, max_relative = 2e-3);
}

/// No closed form: measured on the seed ray, 3.09 and 39.0 look-ups in an independent program.
#[test]
fn the_cumulative_version_on_the_seed_ray() {
    let (field, n) = (Counted::new(seed_ray()), 100_000);
    let transmittance = (-field.optical_thickness(0.0, 20.0)).exp();
    let estimator = PSeries::with_majorant(Cumulative, &seed_ray()).unwrap();
    let mut source = Seeded::new(42);
    let (variance, error) =
        mean(n, || (estimator.estimate(&field, &mut source) / transmittance - 1.0).powi(2));
    assert!((variance - 3.09).abs() < 5.0 * error + 0.02, "{variance}, standard error {error}");
    // The order ends where terms fall below that of order 0: its standard deviation is of the size of √39.
    let lookups = field.lookups() as f64 / f64::from(n);
    assert!((lookups - 39.0).abs() < 5.0 * 39.0_f64.sqrt() / f64::from(n).sqrt() + 0.05, "{lookups}");
}

#[test]
fn unbiased_for_any_pivot_and_sign() {
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 2.5], vec![0.8, -0.1, 1.0]).unwrap();
    let mut source = Seeded::new(31);
    for version in VERSIONS {
        agrees(&steps(), &PSeries::with_majorant(version, &steps()).unwrap(), 200_000, &mut source);
        agrees(&signed, &PSeries::new(version, 1.7).unwrap(), 200_000, &mut source);
        // Below the optical thickness: alternating signs.
        agrees(&steps(), &PSeries::new(version, 0.9).unwrap(), 200_000, &mut source);
    }
}

#[test]
fn nothing_overflows_where_the_first_term_does() {
    // exp(−900) is 0; the sum of the series about it is not.
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![3.0, 3.1]).unwrap();
    let transmittance = (-field.optical_thickness(0.0, 2.0)).exp();
    let theory = theory_of(&field, &PSeries::new(Cmf, 900.0).unwrap());
    assert!(theory.relative_central[0] < 1e-4 && theory.lookups > 900.0, "{theory:?}");
    for version in [Cmf, Cumulative] {
        let estimator = PSeries::new(version, 900.0).unwrap();
        let mut source = Seeded::new(32);
        let (found, error) = mean(400, || estimator.estimate(&field, &mut source) / transmittance);
        assert!((found - 1.0).abs() < 5.0 * error, "{version:?}: {found}, standard error {error}");
        assert!(error < 1e-3, "{version:?}: standard error {error}");
    }
}

#[test]
fn a_vacuum_and_what_is_no_pivot() {
    let vacuum = Constant::new(0.0, 2.0).unwrap();
    for version in VERSIONS {
        let estimator = PSeries::with_majorant(version, &vacuum).unwrap();
        agrees(&vacuum, &estimator, 100, &mut Seeded::new(1));
        assert_eq!(estimator.admits(&vacuum, 0.0, 0.1), version == Cumulative);
        assert_eq!(PSeries::new(version, 1.25).unwrap().pivot(), 1.25);
        assert_eq!(PSeries::new(version, -1.0), Err(PivotError::Negative(-1.0)));
        assert_eq!(PSeries::new(version, f64::INFINITY), Err(PivotError::NotFinite(f64::INFINITY)));
    }
}

#[test]
fn the_variance_of_the_cumulative_version_is_below_its_bound_and_not_far() {
    fn check<F: Breakpoints + OpticalThickness + Copy>(field: F, pivots: &[f64], seed: u64) {
        let transmittance = (-field.optical_thickness(0.0, field.length())).exp();
        for &pivot in pivots {
            let estimator = PSeries::new(Cumulative, pivot).unwrap();
            let bound = theory_of(field, &estimator).relative_variance_bound;
            let mut source = Seeded::new(seed);
            let (variance, error) =
                mean(100_000, || (estimator.estimate(&field, &mut source) / transmittance - 1.0).powi(2));
            assert!(variance - 5.0 * error < bound, "{pivot}: {variance} above {bound}");
            assert!(bound < 3.0 * variance, "{pivot}: {variance} far below {bound}");
        }
    }
    check(&steps(), &[0.3, 1.4, 2.5, 4.0], 31);
    check(seed_ray(), &[3.0, 6.0], 32);
    // A perfect pivot: nothing varies.
    let constant = Constant::new(0.7, 3.0).unwrap();
    let theory = theory_of(constant, &PSeries::new(Cumulative, 0.7 * 3.0).unwrap());
    assert!(theory.relative_variance_bound < 1e-12);
    // A spike of which 10^4 points see less than one: no bound that would help.
    let spike = PiecewiseConstant::new(vec![0.0, 1.0, 1.000_01, 2.0], vec![0.1, 4e4, 0.1]).unwrap();
    let theory = theory_of(&spike, &PSeries::new(Cumulative, 1.0).unwrap());
    assert!(theory.relative_variance_bound > 1e100);
}

#[test]
fn a_value_that_is_none_ends_the_series_and_shows() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let estimate = PSeries::new(Cumulative, 1.0).unwrap().estimate(&Broken(value), &mut Seeded::new(1));
        assert!(estimate.is_nan(), "{value}: {estimate}");
    }
}

#[test]
fn a_profile_without_length_is_admitted_whatever_stands_there() {
    let field = Constant::new(0.5, 0.0).unwrap();
    for version in VERSIONS {
        let series = PSeries::new(version, 0.0).unwrap();
        assert!(series.admits(&field, 0.0, 0.5), "{version:?}");
        assert_eq!(series.estimate(&field, &mut Seeded::new(1)), 1.0, "{version:?}");
    }
}
