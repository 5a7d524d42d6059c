//! `estimate`: results against closed forms, the meaning of the spec, and the same bits on any number of threads.

use crate::common::{estimate, fixture, harness};
use serde_json::Value;

fn number(value: &Value, pointer: &str) -> f64 {
    value
        .pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("no number at {pointer} in {value}"))
}

fn spec(profile: &str, estimator: &str, samples: u64) -> String {
    format!(r#"{{ "profile": {profile}, "estimator": {estimator}, "samples": {samples}, "seed": 7 }}"#)
}

const SEED_RAY: &str = r#"{ "kind": "ray", "medium": { "kind": "analytic_cosine" }, "origin": [0, 0, 0], "direction": [0, 0, 3] }"#;

#[test]
fn the_example_of_the_documentation_is_sound() {
    let result = estimate(
        r#"{ "profile": { "kind": "expression", "sigma_t": "0.3 + 0.25*sin(7*s)*exp(-0.2*s)", "length": 9.0, "majorant": 0.6 },
             "estimator": { "kind": "double_particle", "sigma_samp": 0.35, "control": { "kind": "constant", "sigma_main": 0.3 } },
             "samples": 100000, "seed": 7 }"#,
    );
    assert_eq!(result["verdict"]["sound"], true);
    // By the primitive of exp(-0.2 s) sin(7 s).
    let primitive =
        |s: f64| (-0.2 * s).exp() * (-0.2 * (7.0 * s).sin() - 7.0 * (7.0 * s).cos()) / (0.04 + 49.0);
    let thickness = 2.7 + 0.25 * (primitive(9.0) - primitive(0.0));
    assert!((number(&result, "/reference/optical_thickness") - thickness).abs() < 1e-12);
    assert!((number(&result, "/reference/lookups_per_sample") - 0.35 * 9.0).abs() < 1e-12);
    assert!((number(&result, "/cost/lookups_per_sample") - 3.15).abs() < 0.03);
}

#[test]
fn the_figures_of_the_seed_ray() {
    let result = estimate(&spec(SEED_RAY, r#"{ "kind": "double_particle", "sigma_samp": 1 }"#, 50_000));
    let transmittance = number(&result, "/reference/transmittance");
    assert!((transmittance - 0.032_853_9).abs() < 1e-7);
    let relative = number(&result, "/reference/variance") / (transmittance * transmittance);
    assert!((relative - 6.105).abs() < 0.01, "{relative}");
    assert_eq!(result["verdict"]["sound"], true);
}

#[test]
fn every_estimator_answers_on_a_ray() {
    for estimator in [
        r#"{ "kind": "woodcock", "majorant": 1 }"#,
        r#"{ "kind": "double_particle", "sigma_samp": 0.4, "control": { "kind": "explorers", "count": 25 } }"#,
        r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 7, 30], "values": [0.8, 1.1] } }"#,
        r#"{ "kind": "double_particle", "sigma_samp": 1, "control": { "kind": "piecewise_linear", "positions": [-1, 10, 21], "sigma_main": [0.3, 0.1, 0.2] } }"#,
        r#"{ "kind": "single_particle", "version": "terminating", "albedo": 0.5, "sigma_samp": 0.8 }"#,
        r#"{ "kind": "single_particle", "version": "non_terminating", "albedo": 0.5, "sigma_samp": 0.8 }"#,
        r#"{ "kind": "single_particle", "version": "adaptive", "albedo": 0.5, "sigma_samp": 0.8 }"#,
        r#"{ "kind": "line_integral", "majorant": 1, "splits": 4 }"#,
    ] {
        let result = estimate(&spec(SEED_RAY, estimator, 40_000));
        assert_ne!(result["verdict"]["sound"], false, "{estimator}: {}", result["verdict"]["reason"]);
        let measured = number(&result, "/cost/lookups_per_sample");
        let expected = number(&result, "/reference/lookups_per_sample");
        assert!((measured / expected - 1.0).abs() < 0.05, "{estimator}: {measured} for {expected}");
    }
}

#[test]
fn a_biased_baseline_is_measured_and_not_punished() {
    let outcome = harness(
        &["estimate", "-"],
        &spec(SEED_RAY, r#"{ "kind": "ray_marching", "steps": 8, "jitter": true }"#, 20_000),
    );
    let result: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!((outcome.code, &result["verdict"]["sound"]), (0, &Value::Bool(false)));
}

#[test]
fn zero_variance_has_no_z_scores_and_no_efficiency() {
    let profile = r#"{ "kind": "constant", "sigma_t": 0.5, "length": 4 }"#;
    let estimator = r#"{ "kind": "double_particle", "sigma_samp": 1, "control": { "kind": "constant", "sigma_main": 0.5 } }"#;
    let result = estimate(&spec(profile, estimator, 1000));
    for pointer in [
        "/verdict/mean_z",
        "/verdict/variance_z",
        "/reference/log_variance",
        "/efficiency/per_lookup",
        "/efficiency/per_second",
    ] {
        assert_eq!(result.pointer(pointer), Some(&Value::Null), "{pointer}");
    }
    assert_eq!(result["verdict"]["sound"], true);
    assert_eq!(number(&result, "/reference/variance"), 0.0);
}

#[test]
fn a_heavy_tail_is_not_testable_and_says_what_it_would_take() {
    let profile = r#"{ "kind": "constant", "sigma_t": 1, "length": 10 }"#;
    let result = estimate(&spec(profile, r#"{ "kind": "double_particle", "sigma_samp": 0.1 }"#, 10_000));
    assert_eq!(result["verdict"]["sound"], Value::Null, "{result}");
    assert!(result["verdict"]["reason"].as_str().unwrap().contains("not testable"));
    assert!((number(&result, "/reference/log_variance") - (100.0 - 20.0)).abs() < 1e-9);
}

#[test]
fn an_infinite_variance_is_a_word() {
    let profile = r#"{ "kind": "constant", "sigma_t": 10, "length": 10 }"#;
    let result = estimate(&spec(profile, r#"{ "kind": "double_particle", "sigma_samp": 1 }"#, 1000));
    assert_eq!(result["reference"]["variance"], "infinity", "{}", result["reference"]);
    assert!((number(&result, "/reference/log_variance") - (1000.0 - 200.0)).abs() < 1e-9);
}

#[test]
fn a_ray_that_misses_sees_everything() {
    let miss = SEED_RAY.replace("[0, 0, 0]", "[50, 0, 0]");
    let woodcock = r#"{ "kind": "woodcock", "majorant": 1 }"#;
    let outcome = harness(&["estimate", "-"], &spec(&miss, woodcock, 100));
    let result: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(number(&result, "/reference/transmittance"), 1.0);
    assert_eq!(number(&result, "/estimate/mean"), 1.0);
    // Not silently: it is hardly what was meant.
    let method = |result: &Value| result["reference"]["method"].as_str().unwrap().to_owned();
    assert!(method(&result).ends_with("the ray misses the medium: T = 1"), "{}", method(&result));
    assert_eq!(outcome.stderr, "warning: profile: the ray misses the medium: T = 1\n");
    let hit = harness(&["estimate", "-"], &spec(SEED_RAY, woodcock, 100));
    assert!(hit.stderr.is_empty() && !hit.stdout.contains("misses"), "{}", hit.stderr);
}

#[test]
fn distances_count_from_the_origin_of_the_ray() {
    // The same ray from 30 further back: edges move with it.
    let near = estimate(&spec(
        SEED_RAY,
        r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 7, 20], "values": [0.8, 1.1] } }"#,
        5000,
    ));
    let far = estimate(&spec(
        &SEED_RAY.replace("[0, 0, 0]", "[0, 0, -30]"),
        r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 37, 50], "values": [0.8, 1.1] } }"#,
        5000,
    ));
    assert_eq!(near["estimate"], far["estimate"]);
}

#[test]
fn volumes_of_other_software_are_read() {
    for (file, exact) in [("eq21_64.vdb", 0.033), ("eq21_64_half.vdb", 0.033)] {
        let profile = format!(
            r#"{{ "kind": "ray", "medium": {{ "kind": "vdb", "file": "{}" }}, "origin": [0.1, 0.1, -5], "direction": [0, 0, 1] }}"#,
            fixture(file)
        );
        let result = estimate(&spec(&profile, r#"{ "kind": "double_particle", "sigma_samp": 1 }"#, 20_000));
        assert_eq!(result["verdict"]["sound"], true, "{}", result["verdict"]["reason"]);
        assert!((number(&result, "/reference/transmittance") / exact - 1.0).abs() < 0.25);
    }
}

#[test]
fn a_sweep_equals_its_points() {
    let single = spec(SEED_RAY, r#"{ "kind": "double_particle", "sigma_samp": 0.5 }"#, 6000);
    let swept = single.replace(
        r#""seed": 7"#,
        r#""seed": 7, "sweep": { "path": "estimator.sigma_samp", "values": [0.4, 0.5] }"#,
    );
    let (single, swept) = (estimate(&single), estimate(&swept));
    assert_eq!(swept["points"][1]["value"], 0.5);
    assert_eq!(swept["points"][1]["estimate"], single["estimate"]);
    assert_ne!(swept["points"][0]["estimate"], single["estimate"]);
}

#[test]
fn results_are_the_same_bits_on_any_number_of_threads() {
    let spec = spec(SEED_RAY, r#"{ "kind": "double_particle", "sigma_samp": 0.7 }"#, 30_000);
    let on = |threads: &str| {
        let outcome = harness(&["estimate", "-", "--threads", threads], &spec);
        let mut result: Value = serde_json::from_str(&outcome.stdout).unwrap();
        // What a clock or a command line says is not promised.
        for key in ["/cost/seconds", "/efficiency/per_second", "/provenance/command"] {
            *result.pointer_mut(key).unwrap() = Value::Null;
        }
        result
    };
    assert_eq!(on("1"), on("2"));
    assert_eq!(on("1"), on("3"));
}

#[test]
fn overrides_replace_the_spec() {
    let spec = spec(SEED_RAY, r#"{ "kind": "woodcock", "majorant": 1 }"#, 10);
    let outcome = harness(&["estimate", "-", "--samples", "500", "--seed", "9"], &spec);
    let result: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(
        (&result["cost"]["samples"], &result["provenance"]["seed"]),
        (&Value::from(500), &Value::from(9))
    );
}

#[test]
fn a_result_that_cannot_be_written_has_a_code_of_its_own() {
    struct Closed;
    impl std::io::Write for Closed {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("closed"))
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let spec = spec(SEED_RAY, r#"{ "kind": "woodcock", "majorant": 1 }"#, 10);
    let mut stderr = Vec::new();
    let code = fairflight_program::run(
        ["harness", "estimate", "-"],
        &mut spec.as_bytes(),
        &mut Closed,
        &mut stderr,
        fairflight_harness::Host::default(),
    );
    assert_eq!(code, 3);
}

/// Between 0.7 and 0.7 nothing is interpolated to 0.7000000000000001.
#[test]
fn equal_nodes_exceed_no_majorant() {
    let profile = r#"{ "kind": "piecewise_linear", "positions": [0, 0.7, 3], "sigma_t": [0.7, 0.7, 0.7] }"#;
    for estimator in [
        r#"{ "kind": "woodcock", "majorant": 0.7 }"#,
        r#"{ "kind": "jittered_ratio", "cells": 13, "epsilon": 0.5 }"#,
        r#"{ "kind": "residual_cells", "cells": 13 }"#,
        r#"{ "kind": "double_particle", "sigma_samp": 0.7 }"#,
    ] {
        let result = estimate(&spec(profile, estimator, 2000));
        assert_ne!(result["verdict"]["sound"], false, "{estimator}: {}", result["verdict"]["reason"]);
    }
}

#[test]
fn dense_media_are_answered_with_numbers() {
    let half = r#"{ "kind": "piecewise_constant", "edges": [0, 1, 2], "sigma_t": [0.1, 4e4] }"#;
    let layer =
        r#"{ "kind": "piecewise_constant", "edges": [0, 1, 1.00001, 2], "sigma_t": [0.1, 4e4, 0.1] }"#;
    let eq21 = r#"{ "kind": "ray", "medium": { "kind": "analytic_cosine", "scale": 2000 }, "origin": [0, 0, 0], "direction": [0, 0, 3] }"#;
    let telescoping = r#"{ "kind": "telescoping", "teeth": 5, "level_ratio": 0.8 }"#;
    let marching = r#"{ "kind": "unbiased_ray_marching", "teeth": 3, "segments": 8 }"#;
    for (profile, estimator) in
        [(half, telescoping), (eq21, telescoping), (layer, marching), (half, marching), (layer, telescoping)]
    {
        // What a sample so small says of estimates so wild is not asked here.
        let outcome = harness(&["estimate", "-"], &spec(profile, estimator, 4000));
        assert!(outcome.code < 2, "{estimator}: {}", outcome.stderr);
        let result: Value = serde_json::from_str(&outcome.stdout).unwrap();
        assert!(number(&result, "/estimate/mean").is_finite(), "{estimator}: {result}");
    }
}

#[test]
fn paths_in_a_spec_are_relative_to_it() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(fixture("eq21_64.vdb"), folder.path().join("cloud.vdb")).unwrap();
    let spec = r#"{ "profile": { "kind": "ray", "medium": { "kind": "vdb", "file": "cloud.vdb" }, "origin": [0, 0, 0], "direction": [0, 0, 1] },
                    "estimator": { "kind": "regular" }, "samples": 2, "seed": 1 }"#;
    let path = folder.path().join("spec.json");
    std::fs::write(&path, spec).unwrap();
    let beside = harness(&["estimate", path.to_str().unwrap()], "");
    assert_eq!(beside.code, 0, "{}", beside.stderr);
    let elsewhere = harness(&["estimate", "-"], spec);
    assert!(elsewhere.code == 2 && elsewhere.stderr.contains("cloud.vdb"), "{}", elsewhere.stderr);
}
