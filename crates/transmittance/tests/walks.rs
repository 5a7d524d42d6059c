//! Walks with scripted variates: exact algebra and draw counts.

use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_media::{Bounded, Constant, Counted, PiecewiseConstant, Vacuum};
use fairflight_sources::{Counting, LARGEST_VARIATE, Scripted};
use fairflight_transmittance::{
    Explorers, Interaction, LineIntegral, Offset, RayMarching, Tracking, TransmittanceEstimator,
    TransmittanceFunction, Woodcock,
};

/// The variate whose exponential is `depth`.
fn depth(depth: f64) -> f64 {
    -(-depth).exp_m1()
}

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::new(0.5).unwrap() }
}

#[test]
fn the_double_particle_multiplies_one_minus_r() {
    let field = Constant::new(1.0, 2.0).unwrap();
    let estimator = Tracking::new(double_particle(), Vacuum::new(2.0), Constant::new(0.5, 2.0).unwrap());
    // Two collisions at s = 0.5 and 1.5, then out: r = 2, so that T = (1 − 2)^2.
    let mut source = Scripted::new([depth(0.25), depth(0.5), depth(1.0)]);
    assert_eq!(estimator.estimate(&field, &mut source), 1.0);
    assert_eq!(source.remaining(), 0);
}

#[test]
fn the_control_enters_once_and_is_subtracted_at_each_collision() {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![1.0, 0.25]).unwrap();
    let control = Constant::new(0.5, 2.0).unwrap();
    let estimator = Tracking::new(double_particle(), control, Constant::new(2.0, 2.0).unwrap());
    let mut source = Scripted::new([depth(1.0), depth(2.0), depth(5.0)]);
    let expected = (-1.0_f64).exp() * (1.0 - 0.5 / 2.0) * (1.0 + 0.25 / 2.0);
    assert!((estimator.estimate(&field, &mut source) - expected).abs() < 1e-15);
}

#[test]
fn a_traced_walk_is_the_estimated_walk() {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![1.0, 0.25]).unwrap();
    let estimator =
        Tracking::new(double_particle(), Constant::new(0.5, 2.0).unwrap(), Constant::new(2.0, 2.0).unwrap());
    let script = [depth(1.0), depth(2.0), depth(5.0)];
    let mut walk = Vec::new();
    estimator.trace(&field, &mut Scripted::new(script), &mut walk);
    let Interaction { distance, weight, sigma_t } = walk[1];
    assert!((distance - 1.5).abs() < 1e-12);
    assert_eq!((sigma_t, walk[0].sigma_t), (0.25, 1.0));
    assert_eq!([0.2, 0.7, 1.9].map(|s| Interaction::weight_at(&walk, s)), [1.0, walk[0].weight, weight]);
    let whole: f64 = TransmittanceFunction::<PiecewiseConstant>::main_transmittance(&estimator, 2.0) * weight;
    assert!((whole - estimator.estimate(&field, &mut Scripted::new(script))).abs() < 1e-15);
}

#[test]
fn a_walk_through_nothing_draws_one_variate_and_is_exact() {
    // Hard case 1: sigma_t = 0 on a very long ray; a sampling extinction and a majorant of 0.
    let field = Constant::new(0.0, 1e300).unwrap();
    for u in [0.0, 0.5, LARGEST_VARIATE] {
        let tracking = Tracking::new(double_particle(), Vacuum::new(1e300), field);
        let mut source = Counting::new(Scripted::new([u]));
        assert_eq!(tracking.estimate(&field, &mut source), 1.0);
        assert_eq!(source.drawn(), 1);
        let bounded = Bounded::new(field, 0.0).unwrap();
        assert_eq!(Woodcock.estimate(&bounded, &mut Scripted::new([u])), 1.0);
        let line = LineIntegral::new(4).unwrap();
        assert_eq!(line.estimate(&bounded, &mut Scripted::new([])), 1.0);
    }
}

#[test]
fn beside_a_dense_region_transmittance_is_one() {
    // Hard case 2: the majorant's optical thickness is 2000, the ray meets nothing.
    let field = Bounded::new(Constant::new(0.0, 2.0).unwrap(), 1000.0).unwrap();
    let mut source = fairflight_sources::Seeded::new(1);
    for _ in 0..10 {
        assert_eq!(Woodcock.estimate(&field, &mut source), 1.0);
        assert_eq!(LineIntegral::new(8).unwrap().estimate(&field, &mut source), 1.0);
    }
}

#[test]
fn every_estimator_is_finite_at_both_ends_of_the_lattice() {
    // Hard case 14.
    let field = Constant::new(0.7, 3.0).unwrap();
    let bounded = Bounded::new(field, 1.0).unwrap();
    for u in [0.0, LARGEST_VARIATE] {
        // After a few variates from the end of the lattice, leave.
        let script = || Scripted::new([u, u, u, u, LARGEST_VARIATE, LARGEST_VARIATE, LARGEST_VARIATE]);
        let single = SingleParticle { version: Version::NonTerminating, albedo: Albedo::new(0.5).unwrap() };
        let sampling = Constant::new(0.5, 3.0).unwrap();
        for value in [
            Tracking::new(double_particle(), Vacuum::new(3.0), sampling).estimate(&field, &mut script()),
            Tracking::new(single, Vacuum::new(3.0), sampling).estimate(&field, &mut script()),
            Woodcock.estimate(&bounded, &mut script()),
            LineIntegral::new(1).unwrap().estimate(&bounded, &mut script()),
            RayMarching::new(4, Offset::Jittered).unwrap().estimate(&field, &mut script()),
        ] {
            assert!(value.is_finite(), "u = {u}: {value}");
        }
    }
}

#[test]
fn the_first_collision_of_a_line_integral_lies_on_the_profile() {
    // The majorant alone: every flight collides inside, whatever the shift, and sigma_t = majorant stops it there.
    let field = Bounded::new(Constant::new(1.0, 0.01).unwrap(), 1.0).unwrap();
    let line = LineIntegral::new(2).unwrap();
    for shift in [0.0, 0.5, 0.999] {
        let value = line.estimate(&field, &mut Scripted::new([shift, 0.5, 0.5]));
        assert!((value - (-0.01_f64).exp()).abs() < 1e-15);
    }
}

#[test]
fn explorers_make_the_walk_exact_where_they_fit() {
    let field = Constant::new(0.8, 5.0).unwrap();
    let counted = Counted::new(field);
    let control = Explorers::through(&counted, 3).unwrap();
    let estimator = Tracking::new(double_particle(), control, Constant::new(1.0, 5.0).unwrap());
    let value = estimator.estimate(&counted, &mut Scripted::new([depth(2.0), depth(4.0)]));
    assert!((value - (-4.0_f64).exp()).abs() < 1e-15);
    assert_eq!(counted.lookups(), 3 + 1);
}

#[test]
fn an_empty_segment_has_transmittance_one() {
    // Hard case 12.
    let field = Constant::new(3.0, 0.0).unwrap();
    let bounded = Bounded::new(field, 3.0).unwrap();
    let tracking = Tracking::new(double_particle(), Vacuum::new(0.0), Constant::new(1.0, 0.0).unwrap());
    assert_eq!(tracking.estimate(&field, &mut Scripted::new([0.5])), 1.0);
    assert_eq!(Woodcock.estimate(&bounded, &mut Scripted::new([0.5])), 1.0);
    assert_eq!(LineIntegral::new(3).unwrap().estimate(&bounded, &mut Scripted::new([])), 1.0);
    assert_eq!(RayMarching::new(3, Offset::Fixed).unwrap().estimate(&field, &mut Scripted::new([])), 1.0);
}
