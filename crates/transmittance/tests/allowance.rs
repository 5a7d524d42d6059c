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
        if (s * 7.3).fract() < 0.37 { 1.0 } else { 0.0 }
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

fn comb(teeth: u32) -> Comb {
    Comb::new(teeth, CombShape::Uniform).unwrap()
}

/// The law, once it is seen that it took no more than the allowance, and that what it says of the look-ups is true.
#[track_caller]
fn theory(estimator: &impl for<'f> ClosedForm<Bounded<&'f Rough>>, others: f64) -> Theory {
    let rough = Rough::default();
    let field = Bounded::new(&rough, 1.0).unwrap();
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
    let telescoping = Telescoping::new(MANY, 0.8, CombShape::Uniform).unwrap();
    let found = theory(&telescoping, 1e4);
    let unreached = found.unreached.unwrap();
    assert_eq!((found.relative_mean, unreached.moment), (1.0, 2));
    assert!(unreached.lookups > 0.5 * MOST);
    assert!(found.log_relative_variance.is_nan() && found.lookups == telescoping.expected_lookups());
    assert!(
        unreached.to_string().starts_with("the variance in closed form was not reached with 6.3e7 look-ups")
    );
}

#[test]
fn what_cannot_be_affordable_is_not_begun() {
    let teeth = 2 * MANY;
    let segments = UnbiasedRayMarching::new(comb(1000), Roulette::KETTUNEN).in_segments(5000).unwrap();
    assert_eq!(theory(&segments, 1e4).unreached.unwrap().moment, 2);
    let telescoping = Telescoping::new(teeth, 0.8, CombShape::Uniform).unwrap();
    assert_eq!(theory(&telescoping, 1e4).unreached.unwrap().lookups, 0.0);
    // Memory for as many strata as there are would not do.
    assert_eq!(theory(&JitteredRatio::new(1e-10).unwrap(), 1e4).unreached.unwrap().moment, 2);
    let splits = LineIntegral::new(teeth).unwrap();
    assert_eq!(theory(&splits, 1e8).unreached.unwrap().moment, 2);
    // Of what is biased the mean is not known either.
    let steps = RayMarching::new(teeth, Offset::Jittered).unwrap();
    for found in [theory(&steps, 1e4), theory(&Jackknife::new(comb(teeth)), 1e4)] {
        assert_eq!((found.relative_mean.is_nan(), found.unreached.unwrap().moment), (true, 1));
    }
}

/// Humps of which nothing tells where they meet.
struct Humps;

impl Extinction for &Humps {
    fn sigma_t(&self, s: f64) -> f64 {
        (7.3 * s).sin().abs()
    }
    fn length(&self) -> f64 {
        3.0
    }
}

impl Breakpoints for &Humps {
    fn breakpoints(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// Whatever stops a quadrature, what it is off by is told.
#[test]
fn a_variance_that_was_cut_short_says_by_how_much_it_may_be_off() {
    let field = Bounded::new(&Humps, 1.0).unwrap();
    let mut quadrature = RayQuadrature::new(field, &[]);
    let tau = quadrature.integrate(Tolerance::TIGHT, |_, sigma_t| [sigma_t]).value[0];
    let theories = |most_panels: usize| {
        let tolerance = Tolerance { most_panels, ..Tolerance::to(1e-9) };
        let marching = UnbiasedRayMarching::new(comb(3), Roulette::new(0.5).unwrap());
        let nodes = || RayQuadrature::new(field, &[]);
        [
            marching.theory(&mut nodes(), tau, tolerance),
            marching.in_segments(2).unwrap().theory(&mut nodes(), tau, tolerance),
            Telescoping::new(3, 0.75, CombShape::Uniform).unwrap().theory(&mut nodes(), tau, tolerance),
            RayMarching::new(3, Offset::Jittered).unwrap().theory(&mut nodes(), tau, tolerance),
            Jackknife::new(comb(3)).theory(&mut nodes(), tau, tolerance),
        ]
    };
    let exact = theories(1 << 12);
    for most_panels in [2, 4, 8] {
        for (i, (found, exact)) in theories(most_panels).iter().zip(&exact).enumerate() {
            let [variance, right] = [found, exact].map(|theory| theory.relative_central[0]);
            if variance.is_nan() && found.unreached.is_some() {
                continue;
            }
            let allowed = found.relative_variance_error * variance + exact.relative_variance_error * right;
            assert!(
                (variance - right).abs() <= allowed,
                "{i}, {most_panels}: {variance} for {right}, {found:?}"
            );
        }
    }
}
