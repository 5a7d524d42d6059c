//! The estimators beyond the source papers as a user meets them: in experiments, in scenes, and by advice.

use crate::common::{estimate, fixture, harness};
use serde_json::{Value, json};

const SEED_RAY: &str = r#"{ "kind": "ray", "medium": { "kind": "analytic_cosine" }, "origin": [0, 0, 0], "direction": [0, 0, 3] }"#;
const STEPS: &str =
    r#"{ "kind": "piecewise_constant", "edges": [0, 1, 2.5, 4], "sigma_t": [0.8, 0.1, 0.5] }"#;

fn spec(profile: &str, estimator: &str, samples: u64) -> String {
    format!(r#"{{ "profile": {profile}, "estimator": {estimator}, "samples": {samples}, "seed": 7 }}"#)
}

fn number(value: &Value, pointer: &str) -> f64 {
    value
        .pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("no number at {pointer} in {value}"))
}

#[test]
fn every_unbiased_kind_is_sound() {
    for estimator in [
        r#"{ "kind": "next_flight", "majorant": 1, "version": "delta" }"#,
        r#"{ "kind": "next_flight", "majorant": 1, "version": "ratio" }"#,
        r#"{ "kind": "next_flight", "majorant": 1, "version": "unidirectional" }"#,
        r#"{ "kind": "next_flight", "majorant": 1, "version": "bidirectional" }"#,
        r#"{ "kind": "p_series", "version": "cmf" }"#,
        r#"{ "kind": "p_series", "version": "cumulative" }"#,
        r#"{ "kind": "p_series", "version": "ratio" }"#,
        r#"{ "kind": "p_series", "version": "next_flight", "pivot": 3 }"#,
        r#"{ "kind": "generalised_poisson", "pivot": 2.5, "rate": 1.5 }"#,
        r#"{ "kind": "unbiased_ray_marching" }"#,
        r#"{ "kind": "unbiased_ray_marching", "teeth": 6, "endpoint_matching": false, "roulette": 0.5 }"#,
        r#"{ "kind": "unbiased_ray_marching", "comb": "periodised", "roulette": "self_tuned" }"#,
        r#"{ "kind": "unbiased_ray_marching", "comb": "bernoulli", "order": 2, "pivot": 4 }"#,
        r#"{ "kind": "unbiased_ray_marching", "teeth": 1, "segments": 6, "roulette": "self_tuned" }"#,
        r#"{ "kind": "telescoping", "teeth": 4, "level_ratio": 0.65 }"#,
        r#"{ "kind": "jittered_ratio", "majorant": 1, "epsilon": 0.5 }"#,
        r#"{ "kind": "jittered_ratio", "epsilon": 0.5 }"#,
        r#"{ "kind": "jittered_ratio", "cells": 8, "epsilon": 0.5 }"#,
        r#"{ "kind": "residual_cells", "cells": { "edges": [0, 1, 4], "minorants": [0.5, 0.1], "majorants": [1, 0.5] } }"#,
        r#"{ "kind": "adaptive_ratio", "majorant": 1, "floor": 0.2 }"#,
        r#"{ "kind": "regular" }"#,
        r#"{ "kind": "hybrid", "majorant": 1 }"#,
        r#"{ "kind": "hybrid" }"#,
    ] {
        let result = estimate(&spec(STEPS, estimator, 40_000));
        assert_ne!(result["verdict"]["sound"], false, "{estimator}: {}", result["verdict"]["reason"]);
        // 1.7 of optical thickness; what is not testable is near all the same.
        let (mean, error) =
            (number(&result, "/estimate/mean"), number(&result, "/estimate/mean_standard_error"));
        assert!((mean - (-1.7_f64).exp()).abs() <= 6.0 * error + 1e-12, "{estimator}: {mean} +- {error}");
    }
}

#[test]
fn the_figures_of_the_seed_ray() {
    for (estimator, variance, lookups) in [
        (r#"{ "kind": "next_flight", "majorant": 1, "version": "ratio" }"#, 8.97, 20.0),
        (r#"{ "kind": "unbiased_ray_marching", "pivot": 20, "endpoint_matching": false }"#, 0.0271, 33.0),
        (r#"{ "kind": "unbiased_ray_marching", "pivot": 20 }"#, 3.59e-4, 35.0),
        (r#"{ "kind": "jittered_ratio", "majorant": 1, "epsilon": 0.5 }"#, 0.272, 51.9),
    ] {
        let result = estimate(&spec(SEED_RAY, estimator, 20_000));
        let transmittance = number(&result, "/reference/transmittance");
        let relative = number(&result, "/reference/variance") / (transmittance * transmittance);
        assert!((relative / variance - 1.0).abs() < 5e-3, "{estimator}: {relative}");
        assert!(
            (number(&result, "/reference/lookups_per_sample") / lookups - 1.0).abs() < 5e-3,
            "{estimator}"
        );
        assert!((number(&result, "/cost/lookups_per_sample") / lookups - 1.0).abs() < 0.05, "{estimator}");
    }
}

#[test]
fn biased_baselines_say_what_they_are_and_do_not_fail() {
    for (estimator, least, most) in [
        (r#"{ "kind": "naive", "teeth": 8 }"#, 1.40, 1.58),
        (r#"{ "kind": "jackknife", "teeth": 8 }"#, 1.01, 1.05),
        (r#"{ "kind": "progressive_majorant", "start": 0.1 }"#, 0.8, 1.4),
    ] {
        let result = estimate(&spec(SEED_RAY, estimator, 60_000));
        let ratio = number(&result, "/estimate/mean") / number(&result, "/reference/transmittance");
        assert!((least..most).contains(&ratio), "{estimator}: {ratio}");
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    for estimator in [
        r#"{ "kind": "hybrid" }"#,
        r#"{ "kind": "progressive_majorant", "start": 0.1 }"#,
        r#"{ "kind": "unbiased_ray_marching", "roulette": "self_tuned" }"#,
    ] {
        let spec = spec(SEED_RAY, estimator, 20_000);
        let bits = |threads: &str| {
            let run = harness(&["estimate", "-", "--threads", threads], &spec);
            let result: Value = serde_json::from_str(&run.stdout).unwrap();
            result["estimate"].clone()
        };
        assert_eq!(bits("1"), bits("2"), "{estimator}");
    }
}

#[test]
fn what_an_estimator_needs_to_know_is_said() {
    let expression = r#"{ "kind": "expression", "sigma_t": "0.3 + 0.1*s", "length": 2 }"#;
    for (profile, estimator, words) in [
        (
            expression,
            r#"{ "kind": "jittered_ratio", "epsilon": 0.5 }"#,
            "jittered_ratio needs a majorant; give `majorant`",
        ),
        (expression, r#"{ "kind": "hybrid" }"#, "hybrid needs a majorant; give `majorant`"),
        (expression, r#"{ "kind": "p_series", "version": "cmf" }"#, "p_series needs a pivot; give `pivot`"),
        (expression, r#"{ "kind": "unbiased_ray_marching" }"#, "give `teeth` or `pivot`"),
        (
            r#"{ "kind": "expression", "sigma_t": "1/s", "length": 2 }"#,
            r#"{ "kind": "residual_cells", "cells": 4 }"#,
            "no bounds of sigma_t are found between s = 0 and s = 0.5",
        ),
        (
            expression,
            r#"{ "kind": "regular" }"#,
            "regular needs a profile whose optical thickness has a closed form",
        ),
        (STEPS, r#"{ "kind": "jittered_ratio", "majorant": 0.7, "epsilon": 0.5 }"#, "0.7 is none"),
        (STEPS, r#"{ "kind": "next_flight", "majorant": 0.5, "version": "ratio" }"#, "0.5 is none"),
        (
            STEPS,
            r#"{ "kind": "jittered_ratio", "majorant": 1, "epsilon": 1.5 }"#,
            "epsilon must not exceed 1",
        ),
        (STEPS, r#"{ "kind": "telescoping", "teeth": 4, "level_ratio": 0.4 }"#, "estimator.level_ratio"),
        (STEPS, r#"{ "kind": "unbiased_ray_marching", "roulette": 1 }"#, "a probability of stopping below 1"),
        (STEPS, r#"{ "kind": "unbiased_ray_marching", "order": 2 }"#, "belongs to the comb bernoulli"),
        (STEPS, r#"{ "kind": "unbiased_ray_marching", "teeth": 0 }"#, "estimator.teeth"),
        (STEPS, r#"{ "kind": "unbiased_ray_marching", "teeth": 4, "pivot": 4 }"#, "give one of the two"),
        (
            STEPS,
            r#"{ "kind": "residual_cells", "cells": { "edges": [0, 4], "minorants": [0.5], "majorants": [1] } }"#,
            "residual_cells is not defined for sigma_t = 0.1",
        ),
        (
            STEPS,
            r#"{ "kind": "residual_cells", "cells": { "edges": [0, 3], "minorants": [0], "majorants": [1] } }"#,
            "must cover the whole profile",
        ),
        (STEPS, r#"{ "kind": "adaptive_ratio", "majorant": 1, "floor": 2 }"#, "floor must be at most 1"),
        (
            STEPS,
            r#"{ "kind": "next_flight", "majorant": 1, "version": "sideways" }"#,
            "must be delta, ratio, unidirectional or bidirectional",
        ),
        (STEPS, r#"{ "kind": "jackknife" }"#, "estimator.teeth: this key is missing"),
        (STEPS, r#"{ "kind": "hybrid", "budget": 3 }"#, "unknown key"),
    ] {
        let run = harness(&["estimate", "-"], &spec(profile, estimator, 1000));
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{estimator}: {}", run.stderr);
        assert!(run.stderr.contains(words) && run.stderr.lines().count() == 1, "{estimator}: {}", run.stderr);
    }
}

#[test]
fn advice_names_an_estimator_that_reads_back() {
    let run = harness(&["advise", "-", "--rays", "6", "--seed", "3"], r#"{ "kind": "analytic_cosine" }"#);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("gain per look-up"));
    let first = run.stderr.lines().next().unwrap();
    assert_eq!(first, "advice for transmittance along rays, not for pictures");
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    let measured = answer["measured"].as_array().unwrap();
    assert!(measured.iter().any(|advice| advice["estimator"] == "ratio tracking"));
    // In a smooth medium combs win by far.
    let best = &measured[0];
    assert_eq!(answer["recommended"], best["estimator"]);
    assert!(number(best, "/gain_per_lookup/value") > 100.0, "{best}");
    assert!(number(best, "/gain_per_lookup/interval/0") <= number(best, "/gain_per_lookup/value"));
    let result = estimate(&spec(SEED_RAY, &best["spec"].to_string(), 5000));
    assert_ne!(result["verdict"]["sound"], false);
    // The same question, the same answer, but for the seconds.
    let again = harness(
        &["advise", "-", "--rays", "6", "--seed", "3", "--threads", "1"],
        r#"{ "kind": "analytic_cosine" }"#,
    );
    let again: Value = serde_json::from_str(&again.stdout).unwrap();
    assert_eq!(again["expected"], answer["expected"]);
}

#[test]
fn advice_takes_volumes_and_scenes_and_refuses_the_rest() {
    let cloud = fixture("cloud.vdb");
    let run = harness(&["advise", "--vdb", &cloud, "--rays", "4"], "");
    assert_eq!(run.code, 0, "{}", run.stderr);
    let scene = json!({
        "camera": { "origin": [0, 0, -20], "look_at": [0, 0, 10], "up": [0, 1, 0], "vertical_fov_degrees": 40, "resolution": [16, 16] },
        "medium": { "kind": "analytic_cosine", "albedo": 0, "phase": { "kind": "rayleigh" } },
        "lights": [],
        "integrator": { "kind": "transmittance", "estimator": { "kind": "regular" } },
        "samples_per_pixel": 1, "seed": 1
    });
    let run = harness(&["advise", "-", "--rays", "4"], &scene.to_string());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let mut scattering = scene.clone();
    scattering["medium"]["albedo"] = json!([0, 0.1, 0]);
    let mut walking = scene.clone();
    walking["integrator"] = json!({ "kind": "particle_tracer", "version": "adaptive", "sigma_samp": 0.8 });
    for (scene, key) in [(scattering, "medium.albedo: "), (walking, "integrator.kind: ")] {
        let run = harness(&["advise", "-", "--rays", "4"], &scene.to_string());
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{key}: {}", run.stderr);
        for words in [key, "a picture", "--vdb FILE", "MEDIUM.json"] {
            assert!(run.stderr.contains(words) && run.stderr.lines().count() == 1, "{words}: {}", run.stderr);
        }
    }
    for (arguments, input, words) in [
        (&["advise", "-"][..], r#"{ "kind": "homogeneous" }"#, "sigma_t: this key is missing"),
        (
            &["advise", "-"],
            r#"{ "kind": "expression", "sigma_t": "0.1", "bounds": { "sphere": { "center": [0,0,0], "radius": 1 } } }"#,
            "declares no majorant",
        ),
        (
            &["advise", "-"],
            r#"{ "kind": "homogeneous", "sigma_t": 0, "bounds": { "sphere": { "center": [0,0,0], "radius": 1 } } }"#,
            "no ray meets anything",
        ),
        (&["advise", "-"], "nonsense", "not JSON"),
        (&["advise"], "", "MEDIUM.json"),
        (&["advise", "--vdb", "missing.vdb"], "", "missing.vdb"),
    ] {
        let run = harness(arguments, input);
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{input}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{input}: {}", run.stderr);
    }
}
