//! Certificates as a field remembers them, ranges of stretches, budgets.

use super::*;
use crate::{Breakpoints, ExpressionMedium, ExpressionProfile, IntervalBounds, RayQuadrature, Tolerance};
use glam::DVec3;

fn formula(text: &str, length: f64) -> ExpressionProfile {
    ExpressionProfile::new(text, length, None).unwrap()
}

#[test]
fn a_certified_field_has_the_features_as_its_breakpoints() {
    let field = Certified::new(formula("1 + floor(s - 0.3) + 1e3*exp(-((s - 1.7)/1e-4)^2)", 2.0));
    let breakpoints = field.breakpoints();
    for (place, within) in [(0.3, 1e-12), (1.3, 1e-12), (1.7, 3e-4)] {
        assert!(breakpoints.iter().any(|s| (s - place).abs() < within), "{place} {breakpoints:?}");
    }
    // With them quadrature sees the peak, and its square.
    let mut quadrature = RayQuadrature::new(&field, &[]);
    let found = quadrature.integrate(Tolerance::TIGHT, |_, sigma| [sigma]);
    assert!((found.value[0] - field.certificate().thickness).abs() < 1e-11);
    assert_eq!(field.clone().certificate(), field.certificate());
}

#[test]
fn ranges_hold_and_are_hardly_wider_than_what_is_met() {
    let field = Certified::new(formula("0.3 + 0.25*sin(7*s)*exp(-0.2*s) + max(0, s - 3.3)*floor(2*s)", 9.0));
    let (mut proved, mut met) = (0.0, 0.0);
    let mut from = 0.0;
    for cell in field.equal_cells(40) {
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..=200 {
            let value = field.sigma_t(from + (cell.to - from) * f64::from(i) / 200.0);
            assert!(cell.minorant <= value && value <= cell.majorant, "{cell:?} {value}");
            (least, greatest) = (least.min(value), greatest.max(value));
        }
        proved += cell.majorant - cell.minorant;
        met += greatest - least;
        from = cell.to;
    }
    assert!(proved < 1.05 * met, "{}", proved / met);
    assert_eq!(formula("1/(s - 1)", 2.0).range_between(0.5, 1.5), (f64::NEG_INFINITY, f64::INFINITY));
    assert_eq!(formula("0.7", 2.0).range_between(0.5, 1.5), (0.7, 0.7));
}

#[test]
fn a_spent_budget_leaves_bounds_that_hold() {
    let field = formula("0.2 + 3e2*exp(-((s-1.2345678)/1e-3)^2)", 3.0);
    let exact = 0.6 + 0.3 * std::f64::consts::PI.sqrt();
    let mut widths = Vec::new();
    for budget in [0, 3_000, 10_000, 1_000_000] {
        let found = Certificate::within(&field, Tolerance::TIGHT, budget);
        assert!(found.bounds.0 <= exact && exact <= found.bounds.1, "{found:?}");
        assert_eq!(found.doubt().is_none(), found.error < 1e-6);
        widths.push(found.bounds.1 - found.bounds.0);
    }
    assert!(widths.is_sorted_by(|a, b| a >= b) && widths[0] > 1.0 && widths[3] < 1e-10, "{widths:?}");
}

#[test]
fn a_ray_through_a_formula_is_its_formula_of_the_distance() {
    let medium = ExpressionMedium::new("2 + x*y - floor(z)", None).unwrap();
    let line = Line { origin: DVec3::new(0.1, 0.2, 0.3), direction: DVec3::new(0.6, 0.0, 0.8) };
    // 2 + 0.2 (0.1 + 0.6 s) - floor(0.3 + 0.8 s): steps at s = 0.875 and 2.125.
    let stretch = medium.enclose_line(&line, 0.0, 0.5);
    let exact = 0.5 * 2.02 + 0.06 * 0.25;
    assert!((stretch.integral - exact).abs() <= stretch.truncation + stretch.rounding);
    assert!(stretch.truncation + stretch.rounding < 1e-13);
    let across = medium.enclose_line(&line, 0.5, 1.0);
    assert!(across.kink.is_some_and(|s| (s - 0.875).abs() < 1e-12), "{across:?}");
}

#[test]
fn an_empty_profile_is_certified() {
    let found = Certificate::of(&formula("1/s", 0.0), Tolerance::TIGHT);
    assert_eq!((found.thickness, found.doubt(), found.range), (0.0, None, (0.0, 0.0)));
}
