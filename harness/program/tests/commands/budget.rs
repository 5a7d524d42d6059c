//! Work is bounded: what would take days is refused before anything is drawn.

use crate::common::{estimate, fixture, harness};
use crate::render::{scene, with};
use serde_json::{Value, json};
use std::time::Instant;

const EVEN: &str = r#"{ "kind": "constant", "sigma_t": 0.5, "length": 2 }"#;
const EMPTY: &str = r#"{ "kind": "constant", "sigma_t": 0, "length": 1e305 }"#;
const FLAT: &str = r#"{ "kind": "expression", "sigma_t": "0.5", "length": 2, "majorant": 1 }"#;

fn experiment(profile: &str, estimator: &str, samples: u64) -> String {
    format!(r#"{{ "profile": {profile}, "estimator": {estimator}, "samples": {samples}, "seed": 1 }}"#)
}

/// Refused at once, in one line with the key, the number and the budget.
#[track_caller]
fn refused(arguments: &[&str], input: &str, words: &[&str]) {
    let clock = Instant::now();
    let run = harness(arguments, input);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{input}: {}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    for words in words.iter().chain(&["look-ups are to be expected", "--budget"]) {
        assert!(run.stderr.contains(words), "{words} is missing: {}", run.stderr);
    }
    assert!(clock.elapsed().as_secs() < 60, "{input}");
}

#[test]
fn experiments_that_would_take_days_are_refused() {
    for (profile, kind, keys, samples, key) in [
        (EMPTY, "double_particle", r#""sigma_samp": 1"#, 10, "sigma_samp"),
        (EVEN, "double_particle", r#""sigma_samp": 1e9"#, 20_000, "sigma_samp"),
        (
            EVEN,
            "double_particle",
            r#""sigma_samp": { "edges": [0, 1, 2], "values": [1, 1e12] }"#,
            1000,
            "sigma_samp",
        ),
        (
            EVEN,
            "single_particle",
            r#""version": "non_terminating", "albedo": 0.5, "sigma_samp": 1e308"#,
            1,
            "sigma_samp",
        ),
        (EVEN, "woodcock", r#""majorant": 1e18"#, 10, "majorant"),
        (EVEN, "line_integral", r#""majorant": 1e6, "splits": 10000000"#, 100_000, "splits"),
        (EVEN, "ray_marching", r#""steps": 10000000, "jitter": true"#, 100_000, "steps"),
        (EVEN, "next_flight", r#""majorant": 1e15, "version": "ratio""#, 10, "majorant"),
        (EVEN, "next_flight", r#""majorant": 1e6, "version": "bidirectional""#, 10, "majorant"),
        (EVEN, "p_series", r#""version": "next_flight", "pivot": 1e17"#, 10, "pivot"),
        (EVEN, "p_series", r#""version": "cmf", "pivot": 1e300"#, 10, "pivot"),
        (EVEN, "p_series", r#""version": "cumulative", "pivot": 1e8"#, 10_000, "pivot"),
        (EVEN, "generalised_poisson", r#""pivot": 1, "rate": 1e100"#, 10, "rate"),
        (EVEN, "unbiased_ray_marching", r#""teeth": 1000000, "segments": 1000000"#, 10, "teeth"),
        (
            EVEN,
            "unbiased_ray_marching",
            r#""teeth": 1000000, "segments": 1000000, "roulette": "self_tuned""#,
            1,
            "teeth",
        ),
        (EVEN, "telescoping", r#""teeth": 1000000, "level_ratio": 0.500001"#, 10, "level_ratio"),
        (EVEN, "jittered_ratio", r#""majorant": 1e300, "epsilon": 0.5"#, 10, "majorant"),
        (EVEN, "jittered_ratio", r#""majorant": 1, "epsilon": 1e-300"#, 10, "majorant"),
        (
            EVEN,
            "residual_cells",
            r#""cells": { "edges": [0, 2], "minorants": [0], "majorants": [1e20] }"#,
            10,
            "cells",
        ),
        (EVEN, "adaptive_ratio", r#""majorant": 1e30, "floor": 0.1"#, 10, "majorant"),
        (FLAT, "hybrid", r#""majorant": 9e18"#, 1, "majorant"),
        (EVEN, "jackknife", r#""teeth": 1000000"#, 1_000_000, "teeth"),
        (EVEN, "naive", r#""teeth": 1000000"#, 1_000_000, "teeth"),
        (EVEN, "progressive_majorant", r#""start": 1e40"#, 10, "start"),
    ] {
        let estimator = format!(r#"{{ "kind": "{kind}", {keys} }}"#);
        let key = format!("estimator.{key}");
        refused(&["estimate", "-"], &experiment(profile, &estimator, samples), &[&key, "the budget of 1e11"]);
    }
    let exact = experiment(EVEN, r#"{ "kind": "regular" }"#, 1_000_000_000_000);
    refused(&["estimate", "-"], &exact, &["samples", "the budget of 1e11"]);
}

#[test]
fn a_budget_is_what_the_command_line_says_and_a_sweep_is_a_sum() {
    let spec = experiment(EVEN, r#"{ "kind": "double_particle", "sigma_samp": 5 }"#, 1000);
    let run = |budget: &str| harness(&["estimate", "-", "--budget", budget], &spec).code;
    assert_eq!((run("9999"), run("1e4")), (2, 0));
    refused(
        &["estimate", "-", "--budget", "9999"],
        &spec,
        &["estimator.sigma_samp", "1.000e4", "budget of 9.999e3"],
    );
    let mut sweep: Value = serde_json::from_str(&spec).unwrap();
    sweep["sweep"] = json!({ "path": "estimator.sigma_samp", "values": [5, 4, 1] });
    refused(
        &["estimate", "-", "--budget", "19999"],
        &sweep.to_string(),
        &["sweep.values", "2.000e4", "the sum over 3 points"],
    );
    assert_eq!(harness(&["estimate", "-", "--budget", "20000"], &sweep.to_string()).code, 0);
    sweep["sweep"]["values"] = json!([1, 1e12, 2]);
    refused(&["estimate", "-"], &sweep.to_string(), &["sweep value 1000000000000", "estimator.sigma_samp"]);
}

/// A walk that ends early costs what the closed form says, however far it could have gone.
#[test]
fn dense_media_are_not_refused_for_what_nobody_looks_up() {
    let dense = r#"{ "kind": "constant", "sigma_t": 1e6, "length": 1e6 }"#;
    for estimator in [
        r#"{ "kind": "woodcock", "majorant": 1e6 }"#,
        r#"{ "kind": "single_particle", "version": "terminating", "albedo": 0, "sigma_samp": 1e6 }"#,
        r#"{ "kind": "next_flight", "majorant": 1e6, "version": "delta" }"#,
    ] {
        let run = harness(&["estimate", "-"], &experiment(dense, estimator, 1000));
        assert_eq!(run.code, 0, "{estimator}: {}", run.stderr);
    }
}

/// Closed forms have an allowance of their own: what they do not reach, they name, and the verdict is null.
#[test]
fn references_say_what_they_did_not_reach() {
    let waves = r#"{ "kind": "expression", "sigma_t": "abs(sin(50*s))", "length": 2, "majorant": 1 }"#;
    let comb = r#"{ "kind": "unbiased_ray_marching", "teeth": 100, "segments": 30000 }"#;
    let spec = experiment(waves, comb, 2);
    let clock = Instant::now();
    let result = estimate(&spec);
    assert!(clock.elapsed().as_secs() < 60);
    let unreached = "the variance in closed form was not reached with 0.0e0 look-ups";
    for text in [&result["verdict"]["reason"], &result["reference"]["method"]] {
        assert!(text.as_str().unwrap().contains(unreached), "{text}");
    }
    assert_eq!((&result["verdict"]["sound"], &result["reference"]["variance"]), (&Value::Null, &Value::Null));
    let affordable = estimate(&spec.replace("30000", "3"));
    assert!(
        affordable["reference"]["variance"].is_f64() && !affordable.to_string().contains("was not reached")
    );
}

#[test]
fn images_that_would_take_days_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("image.pfm").display().to_string();
    let render = ["render", "-", "--out", &out];
    let estimator = |estimator: Value| {
        with(|scene| {
            scene["integrator"] = json!({ "kind": "transmittance", "estimator": estimator });
            scene["samples_per_pixel"] = json!(1000);
        })
    };
    for (scene, key) in [
        (with(|scene| scene["samples_per_pixel"] = json!(4_000_000_000_u32)), "samples_per_pixel"),
        (with(|scene| scene["integrator"]["sigma_samp"] = json!(1e9)), "integrator.sigma_samp"),
        (
            with(|scene| {
                scene["integrator"]["sigma_samp"] = json!(1e12);
                scene["integrator"]["particles"] = json!("photons");
            }),
            "integrator.sigma_samp",
        ),
        (estimator(json!({ "kind": "double_particle", "sigma_samp": 1e9 })), "integrator.estimator"),
        (
            estimator(json!({ "kind": "ray_marching", "steps": 10_000_000, "jitter": true })),
            "integrator.estimator",
        ),
        (estimator(json!({ "kind": "woodcock", "majorant": 1e15 })), "integrator.estimator"),
        (
            with(|scene| {
                scene["integrator"] = json!({ "kind": "single_scattering", "sampling": "source", "samples_per_ray": 1_000_000,
                    "estimator": { "kind": "double_particle", "sigma_samp": 1000 } });
                scene["lights"] = json!([{ "kind": "point", "position": [0, 0, 30], "power": 1 }]);
            }),
            "integrator.estimator",
        ),
        (
            with(|scene| {
                scene["integrator"] = json!({ "kind": "path_tracer", "estimator": { "kind": "double_particle", "sigma_samp": 1e12 } });
            }),
            "integrator.estimator",
        ),
        (
            with(|scene| {
                scene["integrator"] = json!({ "kind": "vpl", "light_paths": 10_000_000, "eye_samples": 10_000_000, "clamp": 1 });
                scene["samples_per_pixel"] = json!(64);
            }),
            "integrator.light_paths",
        ),
    ] {
        refused(&render, &scene.to_string(), &[key, "pixels"]);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // A time limit bounds what is drawn.
    let endless = with(|scene| scene["samples_per_pixel"] = json!(4_000_000_000_u32));
    let limited = harness(&["render", "-", "--out", &out, "--time-limit", "0.05"], &endless.to_string());
    assert_eq!(limited.code, 0, "{}", limited.stderr);
    assert_eq!(harness(&["render", "-", "--out", &out, "--budget", "100"], &scene().to_string()).code, 2);
}

/// What is looked up before the first pixel counts as well, and is known before it is done.
#[test]
fn local_means_are_counted_before_the_first_pixel() {
    let compensated = |placement: &str, cells: u32| {
        with(|scene| {
            scene["integrator"] = json!({ "kind": "vpl", "light_paths": 1, "clamp": 1, "local_mean_cells": cells,
                "compensation": { "strategy": "one_to_one", "placement": placement } });
            scene["camera"]["resolution"] = json!([2, 2]);
            scene["medium"]["bounds"] = json!({ "box": { "min": [-5, -5, 5], "max": [5, 5, 15] } });
            scene["samples_per_pixel"] = json!(1);
        })
        .to_string()
    };
    let folder = tempfile::tempdir().unwrap();
    let [image, statistics] = ["image.pfm", "statistics.json"].map(|name| folder.path().join(name));
    let render = |budget: &str, scene: &str| {
        let out = [&image, &statistics].map(|path| path.display().to_string());
        harness(&["render", "-", "--out", &out[0], "--out", &out[1], "--budget", budget], scene)
    };
    // 4³ look-ups in each of 256³ cells, not one of which is made.
    let clock = Instant::now();
    let found = render("1e9", &compensated("locally_homogeneous", 256));
    assert_eq!(found.code, 2);
    let words = "integrator.local_mean_cells: 1.074e9 look-ups are to be expected (256 x 256 x 256 cells of 4 x 4 x 4, before the \
        first pixel), more than the budget of 1e9; --budget allows more";
    assert!(found.stderr.contains(words), "{}", found.stderr);
    assert!(clock.elapsed().as_secs_f64() < 10.0);
    // What is within the budget alone is not with the pixels beside it, and is told.
    let found = render("2097153", &compensated("locally_homogeneous", 32));
    assert_eq!(found.code, 2);
    assert!(found.stderr.contains("and ") && found.stderr.contains(" before the first)"), "{}", found.stderr);
    let method = || {
        let text = std::fs::read_to_string(&statistics).unwrap();
        serde_json::from_str::<Value>(&text).unwrap()["method"].as_str().unwrap().to_owned()
    };
    assert_eq!(render("1e9", &compensated("locally_homogeneous", 4)).code, 0);
    assert!(
        method().contains(" before the first pixel, for local means of the extinction in 4 x 4 x 4 cells")
    );
    // Free flights need none.
    assert_eq!(render("1e9", &compensated("free_flight", 256)).code, 0);
    assert!(!method().contains("before the first pixel"), "{}", method());
}

#[test]
fn advice_that_would_take_days_is_refused() {
    let cloud = fixture("cloud.vdb");
    refused(&["advise", "--vdb", &cloud, "--scale", "2e6"], "", &["medium", "majorant 2e6"]);
    let haze = r#"{ "kind": "homogeneous", "sigma_t": 1e15, "bounds": { "sphere": { "center": [0, 0, 0], "radius": 1 } } }"#;
    refused(&["advise", "-"], haze, &["medium", "1e15"]);
    refused(&["advise", "--vdb", &cloud, "--budget", "1e5"], "", &["medium", "budget of 1e5"]);
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().join("report").display().to_string();
    let report = ["report", "estimators", "--quick", "--vdb", &cloud, "--scale", "2e6", "--out", &folder];
    refused(&report, "", &["majorant 2e6"]);
}
