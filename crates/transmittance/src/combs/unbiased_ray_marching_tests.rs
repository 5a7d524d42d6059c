//! Variances, laws and the allowance of unbiased ray marching.

use super::*;
use crate::combs::CombShape;
use crate::test_support::{agrees, seed_ray, tent, theory_of};
use approx::assert_relative_eq;
use fairflight_media::{Constant, PiecewiseConstant, PiecewiseLinear};
use fairflight_sources::{Scripted, Seeded};

fn comb(teeth: u32, shape: CombShape) -> Comb {
    Comb::new(teeth, shape).unwrap()
}

#[test]
fn exact_variances_on_the_seed_ray() {
    // Teeth, roulette, variance and look-ups as measured with 10^6 samples by the prototype of these estimators.
    let ray = seed_ray();
    let tuned =
        |teeth, shape| Roulette::tuned(comb(teeth, shape).cumulants(&ray, 0.0, 20.0, Tolerance::TIGHT).k2);
    let kettunen = Roulette::KETTUNEN;
    for (teeth, shape, roulette, variance, lookups) in [
        (8, CombShape::Uniform, kettunen, 6.7, 10.6),
        (15, CombShape::Uniform, kettunen, 0.589, 19.8),
        (20, CombShape::Uniform, kettunen, 0.0497, 26.4),
        (25, CombShape::Uniform, kettunen, 0.0271, 33.0),
        (25, CombShape::EndpointMatched, kettunen, 3.59e-4, 35.0),
        (25, CombShape::Bernoulli3, tuned(25, CombShape::Bernoulli3), 3.51e-4, 31.7),
    ] {
        let theory = theory_of(ray, &UnbiasedRayMarching::new(comb(teeth, shape), roulette));
        assert_relative_eq!(theory.relative_central[0], variance, max_relative = 0.006);
        assert_relative_eq!(theory.lookups, lookups, max_relative = 0.005);
        assert!(theory.relative_variance_error < 1e-9);
    }
}

#[test]
fn segments_on_the_seed_ray() {
    // Five combs of five teeth with endpoint matching, the stop probability of each its own: 1.49e-3 at 31.5.
    // With one for all:
    let ray = seed_ray();
    let comb = comb(5, CombShape::EndpointMatched);
    let k2: f64 = (0..5)
        .map(|g| comb.cumulants(&ray, 4.0 * f64::from(g), 4.0 * f64::from(g + 1), Tolerance::TIGHT).k2)
        .sum();
    let estimator = UnbiasedRayMarching::new(comb, Roulette::tuned(k2 / 5.0)).in_segments(5).unwrap();
    let theory = theory_of(ray, &estimator);
    assert_relative_eq!(theory.relative_central[0], 1.49e-3, max_relative = 0.02);
    assert_relative_eq!(theory.lookups, 31.5, max_relative = 0.02);
}

/// Segments of which each is affordable and all are not: humps that no breakpoint tells of.
#[test]
fn all_segments_share_the_allowance() {
    struct Humps {
        length: f64,
        lookups: std::cell::Cell<f64>,
    }
    impl Extinction for Humps {
        fn sigma_t(&self, s: f64) -> f64 {
            self.lookups.set(self.lookups.get() + 1.0);
            (7.3 * s).sin().abs()
        }
        fn length(&self) -> f64 {
            self.length
        }
    }
    impl Breakpoints for Humps {
        fn breakpoints(&self) -> Vec<f64> {
            Vec::new()
        }
    }
    let estimator = UnbiasedRayMarching::new(comb(3, CombShape::Uniform), Roulette::KETTUNEN);
    let within = |most: f64, segments: u32| {
        let humps = Humps { length: 10.0 * f64::from(segments), lookups: std::cell::Cell::new(0.0) };
        let estimator = estimator.in_segments(segments).unwrap();
        let theory = estimator.theory_within(&Allowance::of(most), &humps, Tolerance::to(1e-6));
        (theory.is_some(), humps.lookups.get())
    };
    let (known, one) = within(1e6, 1);
    assert!(known);
    let (known, taken) = within(10.0 * one, 30);
    assert!(!known && taken > one && taken <= 10.0 * one, "{taken} of {}", 10.0 * one);
}

/// Periods of a saw, one to a segment: where each variance v is off by a share e, ln Π (1 + v) is off by n e v/(1 + v).
#[test]
fn the_error_of_many_factors_is_that_of_their_logarithms() {
    let saw = |periods: u32| {
        let nodes = (0..=2 * periods).map(|i| f64::from(4 * (i / 2) + i % 2)).collect();
        let values = (0..=2 * periods).map(|i| if i % 2 == 0 { 0.0 } else { 6.0 }).collect();
        PiecewiseLinear::new(nodes, values).unwrap()
    };
    let estimator = UnbiasedRayMarching::new(comb(2, CombShape::Uniform), Roulette::new(0.5).unwrap());
    let loose = Tolerance { most_panels: 2, ..Tolerance::to(1e-9) };
    let theory = |periods: u32| {
        let estimator = estimator.in_segments(periods).unwrap();
        estimator.theory(&mut RayQuadrature::new(saw(periods), &[]), f64::NAN, loose)
    };
    let one = theory(1);
    let (v, e) = (one.relative_central[0], one.relative_variance_error);
    assert!(v > 1.0 && e > 1e-12, "{one:?}");
    for n in [2_u32, 5] {
        let found = theory(n);
        let variance = (1.0 + v).powi(n as i32) - 1.0;
        assert_relative_eq!(found.relative_central[0], variance, max_relative = 1e-9);
        let exact = f64::from(n) * e * v / (1.0 + v) * (1.0 + variance) / variance;
        assert_relative_eq!(found.relative_variance_error, exact, max_relative = 1e-2);
    }
}

#[test]
fn mean_variance_and_look_ups_are_those_of_samples() {
    let (field, mut source) = (tent(), Seeded::new(13));
    let cases = CombShape::ALL.map(|shape| (shape, 1)).into_iter().chain([(CombShape::Bernoulli2, 2)]);
    for (shape, segments) in cases {
        let estimator = UnbiasedRayMarching::new(comb(2, shape), Roulette::new(0.6).unwrap());
        agrees(&field, &estimator.in_segments(segments).unwrap(), 200_000, &mut source);
    }
}

#[test]
fn the_variance_has_its_digits_however_small_it_is() {
    // A line has uniform deviations; k2 falls by eight orders with each case. To leading order V = k2 (1 − P (1 −
    // E[1/(N + 1) | N ≥ 2])).
    let average: f64 = (2..40)
        .map(|k| {
            let all = Roulette::new(0.0).unwrap();
            (all.reached(k) - all.reached(k + 1)) / f64::from(k + 1)
        })
        .sum();
    assert_relative_eq!(1.0 - average, 0.7447, max_relative = 1e-3);
    for rise in [1e-4, 1e-8, 1e-12] {
        let line = PiecewiseLinear::new(vec![0.0, 2.0], vec![1.0, 1.0 + rise]).unwrap();
        // D = h (2 u − 1) rise/2, h = 2/3.
        let k2 = rise * rise / 27.0;
        for p in [0.1, 1e-3] {
            let roulette = Roulette::new(1.0 - p).unwrap();
            let estimator = UnbiasedRayMarching::new(comb(3, CombShape::Uniform), roulette);
            let theory = theory_of(&line, &estimator);
            let exact = k2 * (1.0 - p * (1.0 - average));
            // The quadratic term is of the relative size k2/P; D has its own rounding.
            let error = 2.0 * k2 / p + 1e-13 + 1e-15 / rise;
            assert_relative_eq!(theory.relative_central[0], exact, max_relative = error);
        }
    }
}

#[test]
fn a_constant_profile_has_no_variance() {
    let field = Constant::new(0.7, 3.0).unwrap();
    let mut source = Seeded::new(3);
    for shape in [CombShape::Uniform, CombShape::EndpointMatched, CombShape::Bernoulli3] {
        let estimator = UnbiasedRayMarching::new(comb(4, shape), Roulette::new(0.2).unwrap());
        let estimator = estimator.in_segments(3).unwrap();
        assert_eq!(theory_of(field, &estimator).relative_central, [0.0; HIGHEST_MOMENT - 1]);
        for _ in 0..100 {
            let found = estimator.estimate(&field, &mut source);
            assert_relative_eq!(found, (-2.1_f64).exp(), max_relative = 1e-14);
        }
    }
    // Nothing to look up is an exact answer too.
    let empty = Constant::new(0.7, 0.0).unwrap();
    let estimator = UnbiasedRayMarching::new(comb(4, CombShape::Bernoulli3), Roulette::KETTUNEN);
    assert_eq!(estimator.estimate(&empty, &mut source), 1.0);
    assert_eq!(theory_of(empty, &estimator).relative_central[0], 0.0);
}

#[test]
fn an_estimate_of_order_two_by_hand() {
    // σ_t = 2 s on [0, 1], one tooth: X = 2 u.
    let line = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
    let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::new(0.75).unwrap());
    // One variate for the first order, one that refuses the third, three combs.
    let mut source = Scripted::new([0.2, 0.7, 0.25, 0.5, 0.125]);
    let x: [f64; 3] = [0.5, 1.0, 0.25];
    let exact: f64 = (0..3)
        .map(|j| {
            let [y1, y2] = [x[j] - x[(j + 1) % 3], x[j] - x[(j + 2) % 3]];
            (-x[j]).exp() * (1.0 + 4.0 * 0.5 * (y1 + y2) + 2.0 * y1 * y2)
        })
        .sum();
    let mut seen = RunningCumulant::new();
    let found = estimator.estimate_and_observe(&line, &mut source, &mut seen);
    assert_relative_eq!(found, exact / 3.0, max_relative = 1e-14);
    // Mean 7/12, squares of −1/12, 5/12, −4/12 over 2.
    assert_relative_eq!(seen.value().unwrap(), 42.0 / 288.0, max_relative = 1e-14);
    assert_eq!(source.remaining(), 0);
    // Order 0 is exp(−X) and observes nothing.
    let found = estimator.estimate_and_observe(&line, &mut Scripted::new([0.25, 0.5]), &mut seen);
    assert_eq!((found, seen.count()), ((-1.0_f64).exp(), 1));
}

#[test]
fn dense_steps_are_what_logarithms_say() {
    // X is 0.2 at a tooth in the thin part and 80 000 in the dense one, or both: the estimate by hand, term by term in logarithms.
    let step = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.1, 4e4]).unwrap();
    let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::new(0.5).unwrap());
    let (thin, dense) = (0.2_f64, 8e4_f64);
    for (combs, x) in [([0.7, 0.1, 0.9], [dense, thin, dense]), ([0.1, 0.2, 0.9], [thin, thin, dense])] {
        let exact: f64 = (0..3)
            .map(|j| {
                let [y1, y2] = [x[j] - x[(j + 1) % 3], x[j] - x[(j + 2) % 3]];
                (-x[j]).exp() * (1.0 + 2.0 * 0.5 * (y1 + y2) + y1 * y2)
            })
            .sum::<f64>()
            / 3.0;
        let mut source = Scripted::new([0.2, 0.7].into_iter().chain(combs));
        let found = estimator.estimate(&step, &mut source);
        assert_relative_eq!(found, exact, max_relative = 1e-10);
    }
}

#[test]
fn orders_have_no_cap() {
    let line = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap();
    let estimator = UnbiasedRayMarching::new(comb(1, CombShape::Uniform), Roulette::KETTUNEN);
    // Variates of 0 go on to order 50; the combs that follow are equidistant.
    let order = 50;
    let going = [0.0; 49].into_iter().chain([0.99]);
    let combs = (0..=order).map(|i| f64::from(i) / f64::from(order + 1));
    let mut source = Scripted::new(going.chain(combs));
    assert!(estimator.estimate(&line, &mut source).is_finite());
    assert_eq!(source.remaining(), 0);
    assert_eq!(estimator.in_segments(0), Err(NoSegments));
}
