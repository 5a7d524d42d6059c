//! Certificates of formulas against closed forms.

use crate::{Certificate, ExpressionProfile, Tolerance};

fn certificate(formula: &str, length: f64) -> Certificate {
    let profile = ExpressionProfile::new(formula, length, None).unwrap();
    Certificate::of(&profile, Tolerance::TIGHT)
}

fn check(formula: &str, length: f64, exact: f64, most: f64) {
    let found = certificate(formula, length);
    let off = (found.thickness - exact).abs();
    assert_eq!(found.doubt(), None, "{formula}");
    assert!(
        off <= found.error + 4.0 * f64::EPSILON * exact.abs(),
        "{formula}: {} is not {exact}: {found:?}",
        found.thickness
    );
    assert!(found.error <= most, "{formula}: {:e}", found.error);
}

#[test]
fn what_lies_between_nodes_is_found() {
    let root_pi = std::f64::consts::PI.sqrt();
    check("0.2 + 3e2*exp(-((s-1.2345678)/1e-3)^2)", 3.0, 0.6 + 0.3 * root_pi, 1e-11);
    check("0.2 + 3e2*exp(-((s-1.2345678)/1e-6)^2)", 3.0, 0.6 + 3e-4 * root_pi, 1e-11);
    check("0.2 + 3e8*exp(-((s-1.2345678)/1e-9)^2)", 3.0, 0.6 + 0.3 * root_pi, 1e-11);
    // 4986 whole periods and a part that holds no spike beyond 0.5
    let (rate, width, length) = (997.3_f64, 0.001_f64, 5.0_f64);
    let whole = (rate * length).floor();
    let exact = whole * width / rate + ((rate * length - whole).min(width)) / rate;
    check("floor(s*997.3)-floor(s*997.3-0.001)", 5.0, exact, 1e-10);
}

#[test]
fn usual_formulas() {
    check("2", 3.0, 6.0, 1e-13);
    check("0.3*s", 2.0, 0.6, 1e-14);
    check("s^2*(3 - s)", 3.0, 27.0 - 81.0 / 4.0, 1e-12);
    check("abs(s - 1)", 3.0, 2.5, 1e-11);
    check("abs(s - 0.7)", 3.0, 0.5 * (0.49 + 2.3 * 2.3), 1e-11);
    check("max(0, sin(7*s))", 9.0 * std::f64::consts::TAU / 7.0, 18.0 / 7.0, 1e-11);
    check("sqrt(s)", 4.0, 16.0 / 3.0, 1e-11);
    check("s^1.5", 4.0, 64.0 / 5.0, 1e-11);
    check("sqrt(1 - s^2)", 1.0, std::f64::consts::FRAC_PI_4, 1e-11);
    check("1/(1 + s^2)", 1.0, std::f64::consts::FRAC_PI_4, 1e-12);
    check("exp(-s)", 5.0, 1.0 - (-5.0_f64).exp(), 1e-12);
    check("ln(1 + s)", 1.0, 2.0 * 2.0_f64.ln() - 1.0, 1e-12);
    check("tan(s)", 1.0, -(1.0_f64.cos().ln()), 1e-12);
    check("2^s", 3.0, 7.0 / 2.0_f64.ln(), 1e-11);
    check("min(s, 1)*max(s, 2)", 3.0, 1.0 + 2.0 + 2.5, 1e-11);
    check("floor(3*s) + ceil(3*s)", 2.0, 12.0, 1e-11);
    check("sin(1000*s)^2", 3.0, 1.5 - 6000.0_f64.sin() / 4000.0, 1e-11);
}

#[test]
fn what_is_not_proved_is_told() {
    for (formula, reason) in [
        ("1/s", "no bound"),
        ("ln(s)", "no bound"),
        ("sin(1/s)", "budget"),
        ("sqrt(s - 1)", "no bound"),
        ("1/0", ""),
    ] {
        let found = certificate(formula, 2.0);
        let doubt = found.doubt().expect(formula).to_string();
        assert!(doubt.contains(reason), "{formula}: {doubt}");
    }
    let found = certificate("1/s", 2.0);
    // The logarithm of the finest stretch that is cut.
    assert!(
        found.bounds.0 > 25.0
            && found.bounds.1 == f64::INFINITY
            && found.range == (found.range.0, f64::INFINITY)
    );
}
