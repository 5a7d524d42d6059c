//! Verdicts on what a sample has not seen: runs that were called unsound for lack of rare events, and lawful runs at random.

use crate::common::harness;
use crate::lawful_runs::{lawful_run, outcome};
use serde_json::{Value, json};

/// The verdict of a run that is answered, whatever the answer; null of one that is refused, of which nothing is asked here.
fn verdict(spec: &Value) -> Value {
    let answer = harness(&["estimate", "-"], &spec.to_string());
    if answer.code == 2 {
        return Value::Null;
    }
    let result: Value = serde_json::from_str(&answer.stdout).expect("the result is JSON");
    assert_eq!(answer.code == 1, result["verdict"]["sound"] == false, "{result}");
    result["verdict"].clone()
}

/// σ_t of 0.1 with a spike in the middle whose optical thickness is `thickness`, on a ray of the length 2.
fn spike(kind: &str, width: f64, thickness: f64) -> Value {
    let height = thickness / width;
    match kind {
        "piecewise_linear" => json!({
            "kind": kind, "positions": [0, 1, 1.0 + width, 1.0 + 2.0 * width, 2],
            "sigma_t": [0.1, 0.1, 0.1 + height, 0.1, 0.1],
        }),
        _ => json!({ "kind": kind, "edges": [0, 1, 1.0 + width, 2], "sigma_t": [0.1, height, 0.1] }),
    }
}

fn spec(profile: &Value, estimator: &Value, samples: u64, seed: u64) -> Value {
    json!({ "profile": profile, "estimator": estimator, "samples": samples, "seed": seed })
}

#[test]
fn a_power_series_that_missed_a_spike_is_not_unsound() {
    let profile =
        json!({ "kind": "piecewise_constant", "edges": [0, 1, 1.00001, 2], "sigma_t": [0.1, 4e4, 0.1] });
    let estimator = json!({ "kind": "p_series", "version": "cumulative", "pivot": 1 });
    let verdict = verdict(&spec(&profile, &estimator, 20_000, 11));
    assert_eq!(verdict["sound"], Value::Null, "{verdict}");
    let reason = verdict["reason"].as_str().unwrap();
    assert!(reason.contains("not testable") && reason.contains("by the variance of the law"), "{reason}");
}

#[test]
fn a_comb_that_missed_a_spike_is_not_unsound() {
    let estimator = json!({ "kind": "unbiased_ray_marching", "teeth": 12 });
    for (seed, thickness) in [(1, 0.1), (2, 1.0), (3, 3.0)] {
        let verdict = verdict(&spec(&spike("piecewise_linear", 1e-6, thickness), &estimator, 20_000, seed));
        assert_eq!(verdict["sound"], Value::Null, "{thickness}: {verdict}");
    }
}

/// Every estimator that needs look-ups only, or a majorant that is cheap, on spikes that twenty thousand of its estimates hardly ever see.
#[test]
fn no_estimator_is_unsound_for_lack_of_rare_events() {
    for kind in ["piecewise_constant", "piecewise_linear"] {
        for (width, thickness) in [(1e-3, 1.0), (1e-5, 0.4), (1e-6, 2.0), (1e-8, 5.0)] {
            let majorant = thickness / width + 0.1;
            let mut estimators = vec![
                json!({ "kind": "p_series", "version": "cmf", "pivot": 1 }),
                json!({ "kind": "p_series", "version": "cumulative", "pivot": 0.2 }),
                json!({ "kind": "p_series", "version": "ratio", "pivot": 2 }),
                json!({ "kind": "p_series", "version": "next_flight", "pivot": 1 }),
                json!({ "kind": "generalised_poisson", "pivot": 2, "rate": 1 }),
                json!({ "kind": "double_particle", "sigma_samp": 1 }),
                json!({ "kind": "unbiased_ray_marching", "teeth": 3, "endpoint_matching": false }),
                json!({ "kind": "unbiased_ray_marching", "teeth": 5, "roulette": "self_tuned", "segments": 2 }),
                json!({ "kind": "unbiased_ray_marching", "comb": "bernoulli", "order": 3, "teeth": 8 }),
                json!({ "kind": "unbiased_ray_marching", "comb": "periodised", "teeth": 8, "roulette": 0.3 }),
            ];
            // Its closed form sums levels for seconds.
            if width == 1e-6 {
                estimators.push(json!({ "kind": "telescoping", "teeth": 4, "level_ratio": 0.9 }));
            }
            if majorant < 1e4 {
                estimators.extend([
                    json!({ "kind": "next_flight", "version": "unidirectional", "majorant": majorant }),
                    json!({ "kind": "adaptive_ratio", "majorant": majorant, "floor": 0.1 }),
                    json!({ "kind": "jittered_ratio", "cells": 16, "epsilon": 1 }),
                ]);
            }
            for (seed, estimator) in estimators.into_iter().enumerate() {
                let samples = if estimator.get("majorant").is_some() { 2_000 } else { 20_000 };
                let run = spec(&spike(kind, width, thickness), &estimator, samples, seed as u64);
                let verdict = verdict(&run);
                assert_ne!(verdict["sound"], false, "{run}: {verdict}");
            }
        }
    }
}

/// The first of the runs that `cargo bench --bench verdicts` counts: no false alarm, and a bias of one percent shows where the closed
/// variance says that it should.
#[test]
fn lawful_runs_are_never_unsound_and_a_bias_shows() {
    let (mut sound, mut rejected, mut refused) = (0, 0, 0);
    // The closed forms of those left out take many seconds each; the bench has them.
    for index in (0..24).chain(31..74) {
        let run = lawful_run(index);
        // Its closed form sums levels for seconds; the spikes above have it.
        if run.spec["estimator"]["kind"] == "telescoping" {
            continue;
        }
        let Ok(outcome) = outcome(&run, 1.01) else {
            refused += 1;
            continue;
        };
        if outcome.is_biased {
            continue;
        }
        assert_ne!(outcome.right.sound, Some(false), "{} {}: {}", run.family, run.spec, outcome.right.reason);
        sound += u32::from(outcome.right.sound == Some(true));
        rejected += u32::from(outcome.wrong.sound == Some(false));
        // What shows far beyond its closed standard error is found.
        if let Some(z) = outcome.wrong_z
            && z > 7.0
            && outcome.right.sound == Some(true)
        {
            assert_eq!(outcome.wrong.sound, Some(false), "{}: {}", run.spec, outcome.wrong.reason);
        }
    }
    // A closed form asked of a formula, an estimate out of the range of numbers: a few are refused.
    assert!(
        refused < 8 && sound > 20 && rejected > 15,
        "{refused} refused, {sound} sound, {rejected} rejected"
    );
}
