//! References: what they find between nodes, and what they say where they cannot prove it.

use crate::common::{Outcome, harness};
use serde_json::{Value, json};

/// Runs an experiment with a formula as its profile; the exit code is left to the test.
fn run(formula: &str, length: f64, majorant: Option<f64>, estimator: &Value) -> (Outcome, Value) {
    run_with(200, formula, length, majorant, estimator)
}

fn run_with(
    samples: u32,
    formula: &str,
    length: f64,
    majorant: Option<f64>,
    estimator: &Value,
) -> (Outcome, Value) {
    let mut profile = json!({ "kind": "expression", "sigma_t": formula, "length": length });
    if let Some(majorant) = majorant {
        profile["majorant"] = json!(majorant);
    }
    let spec = json!({ "profile": profile, "estimator": estimator, "samples": samples, "seed": 7 });
    let outcome = harness(&["estimate", "-"], &spec.to_string());
    let result = serde_json::from_str(&outcome.stdout).unwrap_or(Value::Null);
    (outcome, result)
}

fn ratio_tracking(sigma_samp: f64) -> Value {
    json!({ "kind": "double_particle", "sigma_samp": sigma_samp })
}

fn thickness(result: &Value) -> f64 {
    result["reference"]["optical_thickness"].as_f64().expect("a number")
}

fn method(result: &Value) -> &str {
    result["reference"]["method"].as_str().expect("words")
}

fn assert_certified(formula: &str, length: f64, sigma_samp: f64) -> Value {
    let (outcome, result) = run(formula, length, None, &ratio_tracking(sigma_samp));
    assert_eq!(outcome.code, 0, "{formula}: {}", outcome.stderr);
    assert!(method(&result).contains("certified") && !method(&result).contains("not certified"), "{formula}");
    assert_eq!(outcome.stderr, "", "{formula}");
    let error = result["reference"]["error"].as_f64().unwrap();
    assert!(error < 1e-9, "{formula}: {error}");
    result
}

#[test]
fn features_between_the_nodes_are_found() {
    let root_pi = std::f64::consts::PI.sqrt();
    for (formula, length, sigma_samp, exact) in [
        ("0.2 + 3e2*exp(-((s-1.2345678)/1e-3)^2)", 3.0, 5.0, 0.6 + 0.3 * root_pi),
        ("0.2 + 3e2*exp(-((s-1.2345678)/1e-6)^2)", 3.0, 5.0, 0.6 + 3e-4 * root_pi),
        // 4987 steps of 0.001/997.3
        ("floor(s*997.3)-floor(s*997.3-0.001)", 5.0, 1.0, 4.987 / 997.3),
        ("0.1 + 5*max(0, 1 - abs(s - 1.2345)*1e4)", 2.0, 6.0, 0.2 + 5e-4),
    ] {
        let result = assert_certified(formula, length, sigma_samp);
        let off = (thickness(&result) - exact).abs();
        let transmittance = result["reference"]["transmittance"].as_f64().unwrap();
        let error = result["reference"]["error"].as_f64().unwrap();
        assert!(off <= error / transmittance + 1e-15, "{formula}: {off:e}");
    }
}

/// Whatever is usual: the formulas of the documentation and of the reports, and every function with scales above a thousandth of the length.
#[test]
fn usual_formulas_are_certified() {
    for formula in [
        "0.3 + 0.25*sin(7*s)*exp(-0.2*s)",
        "1.2*(0.5*cos(1.5*(s+2)) + 0.5)^5",
        "1.7*(0.5*cos(1.5*(s+2)) + 0.5)^40",
        "1",
        "0.1*s + 0.02*s^2",
        "exp(-(s-2)^2)",
        "1/(1 + s^2)",
        "sqrt(s)",
        "s^1.5*exp(-s)",
        "2^-s",
        "ln(2 + s)/2",
        "abs(sin(3*s))",
        "max(0, min(1, 2 - abs(s - 2)))",
        "floor(2*s)/8",
        "ceil(s) - s",
        "tan(0.3*s)",
        "0.5 + 0.5*sin(6283*s/4)",
        "exp(-((s-1)/0.004)^2)",
        "sqrt(abs(s-1))",
        "(s+1)^-2.5",
        "pi/e*cos(s)^2",
        "(s+1)^sin(s)",
    ] {
        assert_certified(formula, 4.0, 2.0);
    }
}

#[test]
fn what_is_not_proved_is_said_and_a_far_majorant_named() {
    // Infinitely many waves before s = 0: no bisection ends there.
    let formula = "0.2 + 0.1*sin(1/s)";
    let (outcome, result) = run(formula, 3.0, Some(301.0), &ratio_tracking(1.0));
    assert_ne!(result["verdict"]["sound"], false, "{}", outcome.stderr);
    assert!(method(&result).contains("not certified: "), "{}", method(&result));
    assert!(
        method(&result).contains("3e7 operations was spent with the optical thickness proved between 0.7530"),
        "{}",
        method(&result)
    );
    assert!(
        outcome.stderr.contains("warning") && outcome.stderr.contains("majorant 301"),
        "{}",
        outcome.stderr
    );
    // Neither near what was met, nor where the reference is certified.
    assert_eq!(run(formula, 3.0, Some(0.5), &ratio_tracking(1.0)).0.stderr, "");
    assert_eq!(run("0.2", 3.0, Some(301.0), &ratio_tracking(1.0)).0.stderr, "");
}

#[test]
fn rays_through_formulas_and_noise_are_certified() {
    for medium in [
        json!({ "kind": "expression", "sigma_t": "4*max(0, 1 - 0.4*(x^2 + 2*y^2 + z^2))*(1 + 0.5*sin(9*x)*sin(9*z))" }),
        json!({ "kind": "expression", "sigma_t": "1e3*exp(-((x - 0.1234567)/1e-6)^2)" }),
        json!({ "kind": "perlin", "octaves": 5, "scale": 2.0 }),
        json!({ "kind": "perlin", "octaves": 8, "offset": 0.3 }),
    ] {
        let mut medium = medium;
        medium["bounds"] = json!({ "sphere": { "center": [0, 0, 0], "radius": 2 } });
        let spec = json!({
            "profile": { "kind": "ray", "medium": medium, "origin": [-5, 0.2, 0.1], "direction": [1, 0.05, 0.02] },
            "estimator": ratio_tracking(5.0), "samples": 100, "seed": 1 });
        let outcome = harness(&["estimate", "-"], &spec.to_string());
        let result: Value = serde_json::from_str(&outcome.stdout).expect("a result");
        assert!(method(&result).contains("(certified)"), "{medium}: {}", method(&result));
    }
}

/// The estimators that need bounds in cells take formulas; where there is no bound, the cell is named.
#[test]
fn formulas_have_bounds_in_cells() {
    for estimator in [
        json!({ "kind": "jittered_ratio", "cells": 12, "epsilon": 0.5 }),
        json!({ "kind": "residual_cells", "cells": 12 }),
    ] {
        let formula = "0.3 + 0.25*sin(7*s)*exp(-0.2*s) + 40*exp(-((s - 2.2)/1e-2)^2)";
        let (outcome, result) = run_with(20_000, formula, 4.0, None, &estimator);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert_eq!(result["verdict"]["sound"], true, "{estimator} {}", result["verdict"]["reason"]);
        let (outcome, _) = run("1/(s - 1.1)^2", 4.0, None, &estimator);
        assert_eq!(outcome.code, 2);
        let named = "no bounds of sigma_t are found between s = 1 and s = 1.3333333333333333";
        assert!(outcome.stderr.contains(named), "{}", outcome.stderr);
    }
}
