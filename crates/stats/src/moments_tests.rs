//! Tests of the streaming moments: against two passes, merges, degenerate streams.

use super::Moments;
use crate::test_support::uniforms;
use approx::assert_relative_eq;
use proptest::prelude::*;

/// Mean and central sums by two passes, on the differences from the first value so that a large mean costs no digits.
fn two_pass(values: &[f64]) -> [f64; 4] {
    let n = values.len() as f64;
    let shift = values.iter().map(|x| x - values[0]).sum::<f64>() / n;
    let sum = |k| values.iter().map(|x| (x - values[0] - shift).powi(k)).sum::<f64>();
    [values[0] + shift, sum(2), sum(3), sum(4)]
}

fn assert_close(moments: &Moments, expected: [f64; 4], tolerance: f64) {
    let [mean, m2, m3, m4] = expected;
    assert_relative_eq!(moments.mean, mean, max_relative = 1e-14);
    assert_relative_eq!(moments.m2, m2, max_relative = tolerance);
    // M3 may vanish by symmetry: its scale is M2 times a deviation.
    let scale = m2 * (m2 / moments.count as f64).sqrt();
    assert!((moments.m3 - m3).abs() <= tolerance * scale.max(m3.abs()), "{} against {m3}", moments.m3);
    assert_relative_eq!(moments.m4, m4, max_relative = tolerance);
}

#[test]
fn small_sample_by_hand() {
    let moments: Moments = [1.0, 2.0, 3.0, 10.0].into_iter().collect();
    assert_eq!((moments.count(), moments.mean()), (4, Some(4.0)));
    // Deviations -3, -2, -1, 6: M2 = 50, M3 = 180, M4 = 1394.
    assert_eq!(moments.population_variance(), Some(12.5));
    assert_relative_eq!(moments.sample_variance().unwrap(), 50.0 / 3.0, max_relative = 1e-15);
    assert_relative_eq!(moments.variance_of_mean().unwrap(), 50.0 / 12.0, max_relative = 1e-15);
    assert_relative_eq!(moments.standard_error().unwrap(), (50.0f64 / 12.0).sqrt(), max_relative = 1e-15);
    assert_relative_eq!(moments.skewness().unwrap(), 45.0 / 12.5f64.powf(1.5), max_relative = 1e-14);
    assert_relative_eq!(moments.excess_kurtosis().unwrap(), 348.5 / 156.25 - 3.0, max_relative = 1e-14);
    let variance_of_variance = (348.5 - 156.25 / 3.0) / 4.0f64;
    assert_relative_eq!(
        moments.variance_standard_error().unwrap(),
        variance_of_variance.sqrt(),
        max_relative = 1e-14
    );
    assert_eq!((moments.minimum(), moments.maximum()), (Some(1.0), Some(10.0)));
}

#[test]
fn no_value_and_one_value() {
    let empty = Moments::default();
    assert_eq!((empty.count(), empty.mean(), empty.minimum(), empty.maximum()), (0, None, None, None));
    assert_eq!((empty.population_variance(), empty.sample_variance(), empty.skewness()), (None, None, None));
    assert_eq!(Moments::from_slice(&[]), empty);
    let one: Moments = std::iter::once(1e300).collect();
    assert_eq!(
        (one.mean(), one.population_variance(), one.sample_variance()),
        (Some(1e300), Some(0.0), None)
    );
    assert_eq!(
        (one.standard_error(), one.variance_standard_error(), one.excess_kurtosis()),
        (None, None, None)
    );
    assert_eq!(Moments::from_slice(&[1e300]), one);
}

#[test]
fn constant_streams_have_exactly_zero_variance() {
    let value = 0.1 + 0.2;
    let mut pushed: Moments = std::iter::repeat_n(value, 1001).collect();
    let block = Moments::from_slice(&[value; 1001]);
    assert_eq!(pushed, block);
    pushed.merge(&block);
    assert_eq!((pushed.mean(), pushed.sample_variance()), (Some(value), Some(0.0)));
    assert_eq!((pushed.variance_standard_error(), pushed.skewness()), (Some(0.0), None));
}

#[test]
fn shifted_data_keep_their_variance() {
    // Mean 1e6, variance 1e-3: uniform on a width sqrt(12e-3).
    let values: Vec<f64> = uniforms(1).take(20_000).map(|u| 1e6 + 0.012f64.sqrt() * (u * u - 0.3)).collect();
    let expected = two_pass(&values);
    assert_close(&Moments::from_slice(&values), expected, 1e-9);
    assert_close(&values.iter().copied().collect(), expected, 1e-7);
    let mut merged = Moments::new();
    for block in values.chunks(777) {
        merged.merge(&Moments::from_slice(block));
    }
    assert_close(&merged, expected, 1e-7);
}

#[test]
fn underflown_fourth_powers_give_no_shape() {
    let moments: Moments = [1e-100, 2e-100, 5e-100].into_iter().collect();
    assert!(moments.sample_variance().unwrap() > 0.0);
    assert_eq!((moments.skewness(), moments.excess_kurtosis()), (None, None));
}

proptest! {
    #[test]
    fn merging_equals_pushing(values in prop::collection::vec(-1e3f64..1e3, 2..200), cut in 0usize..200) {
        let cut = cut.min(values.len());
        let (mut left, right): (Moments, Moments) =
            (values[..cut].iter().copied().collect(), Moments::from_slice(&values[cut..]));
        left.merge(&right);
        prop_assert_eq!(left.count() as usize, values.len());
        let [mean, m2, m3, m4] = two_pass(&values);
        prop_assert!((left.mean - mean).abs() <= 1e-11);
        prop_assert!((left.m2 - m2).abs() <= 1e-11 * m2.max(1.0));
        prop_assert!((left.m3 - m3).abs() <= 1e-10 * (m2 * m4).sqrt().max(1.0));
        prop_assert!((left.m4 - m4).abs() <= 1e-10 * m4.max(1.0));
    }

    #[test]
    fn merging_with_nothing_is_the_identity(values in prop::collection::vec(-1e3f64..1e3, 0..20)) {
        let moments: Moments = values.iter().copied().collect();
        let (mut left, mut right) = (moments, Moments::new());
        left.merge(&Moments::new());
        right.merge(&moments);
        let bits = |m: &Moments| [m.mean, m.m2, m.m3, m.m4, m.minimum, m.maximum].map(f64::to_bits);
        prop_assert_eq!(bits(&left), bits(&moments));
        prop_assert_eq!(bits(&right), bits(&moments));
    }
}

#[test]
fn sums_about_any_point() {
    let values = [0.3, -1.2, 4.0, 2.5, 0.0];
    let moments = Moments::from_slice(&values);
    for c in [-2.0, 0.0, 1.12, 7.5] {
        let found = moments.sums_about(c).unwrap();
        for (k, found) in (2..).zip(found) {
            let exact: f64 = values.iter().map(|x| (x - c).powi(k)).sum();
            assert_relative_eq!(found, exact, max_relative = 1e-13);
        }
    }
    assert_eq!(Moments::new().sums_about(1.0), None);
}

#[test]
fn a_block_knows_its_least_and_its_greatest_value() {
    // Wherever they stand: first, last, in any lane.
    for length in [1, 2, 7, 8, 9, 40] {
        for place in 0..length {
            let with = |x: f64| {
                let values: Vec<f64> = (0..length).map(|i| if i == place { x } else { 1.0 }).collect();
                let moments = Moments::from_slice(&values);
                (moments.minimum(), moments.maximum())
            };
            let others: [f64; 2] = if length == 1 { [5.0, -5.0] } else { [1.0, 1.0] };
            assert_eq!(with(5.0), (Some(others[0].min(5.0)), Some(5.0)), "{length} {place}");
            assert_eq!(with(-5.0), (Some(-5.0), Some(others[1].max(-5.0))), "{length} {place}");
        }
    }
}

#[test]
fn zeros_are_values_too() {
    let scores = [3.0, 1.5, 2.25];
    let all: Vec<f64> = scores.into_iter().chain([0.0; 5]).collect();
    let (found, exact) = (Moments::from_slice(&scores).with_zeros(5), Moments::from_slice(&all));
    assert_eq!((found.count(), found.minimum(), found.maximum()), (8, Some(0.0), Some(3.0)));
    for of in [Moments::mean, Moments::sample_variance, Moments::excess_kurtosis] {
        assert_relative_eq!(of(&found).unwrap(), of(&exact).unwrap(), max_relative = 1e-14);
    }
    assert_eq!(Moments::from_slice(&scores).with_zeros(0), Moments::from_slice(&scores));
}
