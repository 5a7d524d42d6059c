//! Closed variances where their density along the ray has kinks.

use fairflight_collision::{Albedo, SingleParticle, Version};
use fairflight_media::{
    Breakpoints, Constant, ExpressionProfile, PiecewiseLinear, RayQuadrature, Tolerance, Vacuum,
    adaptive_integral,
};
use fairflight_transmittance::{ClosedForm, Tracking};
use std::f64::consts::{PI, TAU};

const ALBEDO: f64 = 0.7;

/// ln(Var/T²) of the non-terminating single particle model at σ_samp = 1.
fn log_variance(profile: &dyn Breakpoints) -> f64 {
    let model = SingleParticle { version: Version::NonTerminating, albedo: Albedo::new(ALBEDO).unwrap() };
    let length = profile.length();
    let tracking = Tracking::new(model, Vacuum::new(length), Constant::new(1.0, length).unwrap());
    tracking.theory(&mut RayQuadrature::new(profile, &[]), f64::NAN, Tolerance::TIGHT).log_relative_variance
}

/// E\[(W − 1)²\] = |1 − r| (a |r| + |1 − r|) − 2 (1 − r) + 1
fn density(r: f64) -> f64 {
    (1.0 - r).abs() * (ALBEDO * r.abs() + (1.0 - r).abs()) - 2.0 * (1.0 - r) + 1.0
}

fn check(profile: &dyn Breakpoints, exponent: f64) {
    let off = log_variance(profile) - exponent.exp_m1().ln();
    assert!(off.abs() < 1e-12, "{off:e}");
}

/// Tents of any height above 1: for some of them the two rules of a panel agree on a wrong value.
#[test]
fn tents_through_one() {
    for i in 1..=2000 {
        let h = 1.0 + 4.0 * f64::from(i) / 2000.0;
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 2.0], vec![0.0, h, 0.0]).unwrap();
        // r = h s and back: 2/h ∫_0^h of the density over r.
        let crossed = 1.0 / 6.0 + (h.powi(3) - 1.0) / 3.0 - (h * h - 1.0) / 2.0;
        let square = (1.0 + (h - 1.0).powi(3)) / 3.0;
        check(&tent, 2.0 / h * (ALBEDO * crossed + square - 2.0 * h + h * h + h));
    }
}

#[test]
fn a_smooth_profile_through_one() {
    // r = 1 + sin s over a period.
    let wave = ExpressionProfile::new("1 + sin(s)", TAU, None).unwrap();
    check(&wave, 4.0 * ALBEDO + 3.0 * PI);
}

#[test]
fn a_profile_of_both_signs() {
    // r = 3/2 sin s passes 1 twice and 0 once.
    let signed = ExpressionProfile::new("1.5*sin(s)", TAU, None).unwrap();
    let crossing = (1.0_f64 / 1.5).asin();
    let breaks = [crossing, PI - crossing, PI];
    let exact = adaptive_integral(TAU, &breaks, Tolerance::TIGHT, |s| [density(1.5 * s.sin())]).value[0];
    check(&signed, exact);
}
