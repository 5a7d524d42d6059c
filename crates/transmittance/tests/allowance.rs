//! Closed forms of many teeth, steps, splits, segments, levels or strata spend no more look-ups than the one allowance of all, and say
//! what they did not reach.

use fairflight_media::{Bounded, Breakpoints, Extinction, RayQuadrature, Tolerance};
use fairflight_transmittance::{
    ClosedForm, Comb, CombShape, Jackknife, JitteredRatio, LineIntegral, Offset, RayMarching, Roulette,
    Telescoping, Theory, UnbiasedRayMarching,
};
use std::cell::Cell;

/// Steps that no breakpoint tells of, on a ray of length 1; counts its look-ups.
#[derive(Default)]
struct Rough(Cell<u64>);

impl Extinction for &Rough {
    fn sigma_t(&self, s: f64) -> f64 {
        self.0.set(self.0.get() + 1);
        if (s * 7919.3).fract() < 0.37 { 1.0 } else { 0.0 }
    }
    fn length(&self) -> f64 {
        1.0
    }
}

impl Breakpoints for &Rough {
    fn breakpoints(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// The allowance of one closed form.
const MOST: f64 = 1e8;
/// More than this many teeth have no second panel.
const MANY: u32 = 3_000_000;

/// The law, once it is seen that it took no more than the allowance, and that what it says of the look-ups is true.
#[track_caller]
fn theory<'f>(rough: &'f Rough, estimator: &impl ClosedForm<Bounded<&'f Rough>>, others: f64) -> Theory {
    let field = Bounded::new(rough, 1.0).unwrap();
    let theory = estimator.theory(&mut RayQuadrature::new(field, &[]), 0.37, Tolerance::TIGHT);
    let unreached = theory.unreached.expect("too many look-ups");
    let found = rough.0.get() as f64;
    assert!(found <= MOST + others, "{found} look-ups");
    // Look-ups at nodes of the profile itself, and evaluations that are none, are the difference.
    assert!((found - unreached.lookups).abs() <= others, "{found} for {unreached}");
    theory
}

#[test]
fn the_first_moment_that_is_not_affordable_is_named() {
    let rough = Rough::default;
    let comb = Comb::new(MANY, CombShape::Uniform).unwrap();
    let marching = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN);
    let found = theory(&rough(), &marching, 1e4);
    assert_eq!((found.relative_mean, found.unreached.unwrap().moment), (1.0, 2));
    assert!(found.log_relative_variance.is_nan() && found.lookups == marching.expected_lookups());
    assert!(
        found.unreached.unwrap().to_string().starts_with("the variance in closed form was not reached with ")
    );

    let telescoping = Telescoping::new(MANY, 0.8, CombShape::Uniform).unwrap();
    assert_eq!(theory(&rough(), &telescoping, 1e4).unreached.unwrap().moment, 2);
    let steps = RayMarching::new(MANY, Offset::Jittered).unwrap();
    // So many steps agree wherever they begin: the mean is known to a digit.
    let found = theory(&rough(), &steps, 1e4);
    assert_eq!((found.relative_mean.is_nan(), found.unreached.unwrap().moment), (false, 2));
    let found = theory(&rough(), &Jackknife::new(comb), 1e4);
    assert_eq!((found.relative_mean.is_nan(), found.unreached.unwrap().moment), (true, 1));
}

#[test]
fn what_cannot_be_affordable_is_not_begun() {
    let rough = Rough::default;
    let comb = Comb::new(1000, CombShape::Uniform).unwrap();
    let segments = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN).in_segments(5000).unwrap();
    assert_eq!(theory(&rough(), &segments, 1e4).unreached.unwrap().lookups, 0.0);
    // Memory for as many strata as there are would not do.
    let strata = JitteredRatio::new(1e-10).unwrap();
    assert_eq!(theory(&rough(), &strata, 1e4).unreached.unwrap().moment, 2);
    let splits = LineIntegral::new(10 * MANY).unwrap();
    assert_eq!(theory(&rough(), &splits, 1e8).unreached.unwrap().moment, 2);
}

/// Segments of which each is affordable and all are not.
#[test]
fn all_segments_share_the_allowance() {
    let rough = Rough::default();
    let comb = Comb::new(40, CombShape::Uniform).unwrap();
    let segments = UnbiasedRayMarching::new(comb, Roulette::KETTUNEN).in_segments(400).unwrap();
    let found = theory(&rough, &segments, 0.5 * MOST);
    assert!(rough.0.get() as f64 > 0.1 * MOST, "{found:?}");
}
