//! Metropolis sampling and energy redistribution: what is rendered, told and refused.

use crate::bidirectional::{agree, drawn, mean, mixed};
use crate::render::{number, statistics};
use crate::render_refusals::refused;
use serde_json::{Value, json};

fn chains(kind: &str, over: &str, mut keys: Value) -> Value {
    for (key, value) in [("kind", kind), ("space", "primary"), ("over", over)] {
        keys[key] = json!(value);
    }
    mixed(&keys)
}

fn metropolis(over: &str, keys: Value) -> Value {
    chains("metropolis", over, keys)
}

/// Chains of paths.
fn paths(mut keys: Value) -> Value {
    (keys["kind"], keys["space"]) = (json!("metropolis"), json!("path"));
    mixed(&keys)
}

#[test]
fn the_mean_is_that_of_independent_samples() {
    let expected = mean(&mixed(&json!({ "kind": "path_tracer" })), "3000");
    for (scene, samples) in [
        (metropolis("bidirectional", json!({})), "600"),
        (metropolis("bidirectional", json!({ "chains": 5, "large_step": 0.1, "first_order": 1 })), "600"),
        (metropolis("path_tracer", json!({ "rows": "flat", "bootstrap": 3000 })), "2000"),
        (metropolis("multiplexed", json!({ "step": [0.001, 0.1] })), "3000"),
        (metropolis("bidirectional", json!({ "importance": { "stages": 4 } })), "800"),
        (metropolis("path_tracer", json!({ "adaptation": "crosswise", "importance": {} })), "3000"),
        (
            paths(json!({ "importance": { "floor": 0.5 }, "mutations": { "lens": 2, "bidirectional": 1 } })),
            "3000",
        ),
        (chains("energy_redistribution", "bidirectional", json!({ "chain_length": 20 })), "100"),
        (chains("energy_redistribution", "path_tracer", json!({ "large_step": 0, "most_chains": 2 })), "100"),
    ] {
        agree(mean(&scene, samples), expected, 0.08);
    }
}

#[test]
fn light_seen_directly_is_drawn_pixel_by_pixel() {
    // No medium, black surfaces: there are no longer paths.
    let mut scene = metropolis("bidirectional", json!({}));
    let lit = json!({ "kind": "rectangle", "corner": [-1, -1, 3], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0],
        "material": { "kind": "diffuse", "reflectance": 0 }, "emission": 2 });
    scene["surfaces"] = json!([lit]);
    scene["lights"] = json!([{ "kind": "environment", "radiance": 0.25 }]);
    scene.as_object_mut().unwrap().remove("medium");
    // One sample: the first variates of a pixel are those of the film.
    let (image, told) = drawn(&scene, &["--samples-per-pixel", "1"]);
    scene["integrator"] = json!({ "kind": "path_tracer" });
    assert!(image == drawn(&scene, &["--samples-per-pixel", "1"]).0);
    assert_eq!(told["chains"]["bootstrap"]["black_replicas"], 1);
    assert_eq!(told["chains"]["bootstrap"]["b"], 0.0);
}

#[test]
fn the_bits_do_not_depend_on_threads() {
    let learning = json!({ "replicas": 4, "importance": { "stages": 2 }, "adaptation": "crosswise" });
    for (kind, keys) in [
        ("metropolis", json!({ "replicas": 3 })),
        ("metropolis", learning),
        ("energy_redistribution", json!({ "replicas": 3 })),
    ] {
        let scene = chains(kind, "bidirectional", keys);
        let one = drawn(&scene, &["--samples-per-pixel", "4", "--threads", "1"]);
        assert!(one == drawn(&scene, &["--samples-per-pixel", "4", "--threads", "2"]), "{kind}");
    }
}

fn chains_of_energy() -> Value {
    chains("energy_redistribution", "bidirectional", json!({}))
}

#[test]
fn chains_are_told() {
    let told = statistics(&metropolis("bidirectional", json!({})), &["--samples-per-pixel", "64"]);
    let chains = &told["chains"];
    assert_eq!(chains["replicas"], 16);
    assert_eq!(chains["bootstrap"]["black_replicas"], 0);
    let (b, error) = (number(&chains["bootstrap"]["b"]), number(&chains["bootstrap"]["standard_error"]));
    assert!(0.0 < error && error < 0.5 * b, "{b} ± {error}");
    let [large, small] = ["large_step", "small_step"].map(|kind| number(&chains["acceptance"][kind]));
    assert!(0.0 < large && large < small && small < 1.0, "{large} and {small}");
    // Of 360 steps each it is not known.
    assert_eq!(chains["autocorrelation_time"], Value::Null);
    let long =
        statistics(&metropolis("bidirectional", json!({ "replicas": 4 })), &["--samples-per-pixel", "1000"]);
    let time = number(&long["chains"]["autocorrelation_time"]);
    assert!((1.0..500.0).contains(&time), "{time} steps");
    // Fewer samples per pixel than replicas: one for each.
    let told = statistics(&metropolis("bidirectional", json!({})), &["--samples-per-pixel", "3"]);
    assert_eq!(told["chains"]["replicas"], 3);
    // Sizes of steps in the names of kinds; ends of short chains.
    let keys = json!({ "adaptation": "crosswise", "importance": { "stages": 3 } });
    let learnt = statistics(&metropolis("bidirectional", keys), &["--samples-per-pixel", "16"]);
    assert!(learnt["chains"]["acceptance"]["small_step_3"].is_f64());
    let redistributed = chains_of_energy();
    assert_eq!(
        statistics(&redistributed, &["--samples-per-pixel", "2"])["chains"]["autocorrelation_time"],
        Value::Null
    );
    assert!(told.get("unseen_power").is_none());
    let told = statistics(&mixed(&json!({ "kind": "path_tracer" })), &["--samples-per-pixel", "1"]);
    assert!(told.get("chains").is_none());
}

#[test]
fn unlawful_keys_are_refused() {
    let over = |keys| metropolis("bidirectional", keys);
    for (scene, wanted) in [
        (over(json!({ "replicas": 100 })), "integrator.replicas: 100 of them need at least as many samples"),
        (over(json!({ "chains": 1000 })), "integrator.chains"),
        (over(json!({ "large_step": 1.5 })), "integrator.large_step"),
        (over(json!({ "step": [0.1, 0.01] })), "2^-53 <= least <= largest <= 1/2"),
        (over(json!({ "step": [0.1] })), "a list of two steps"),
        (over(json!({ "bootstrap": 0 })), "integrator.bootstrap"),
        (over(json!({ "colour": "separate" })), "integrator.colour: separate would be three targets"),
        (metropolis("path_tracer", json!({ "first_order": 2 })), "2 needs paths from both ends"),
        (metropolis("photon_tracer", json!({})), "bidirectional, path_tracer or multiplexed"),
        (
            chains("energy_redistribution", "bidirectional", json!({ "chains_per_sample": 0 })),
            "chains_per_sample",
        ),
        (chains("energy_redistribution", "bidirectional", json!({ "bootstrap": 5 })), "bootstrap"),
    ] {
        refused(&scene.to_string(), &[wanted]);
    }
}

#[test]
fn what_chains_learn_is_refused_where_they_cannot() {
    let over = |keys| metropolis("bidirectional", keys);
    for (scene, wanted) in [
        (
            over(json!({ "importance": { "stages": 9 } })),
            "integrator.importance.stages: 9 stages need two replicas",
        ),
        (over(json!({ "importance": { "floor": 0 } })), "integrator.importance.floor"),
        (over(json!({ "importance": "brightness" })), "integrator.importance"),
        (over(json!({ "adaptation": "own" })), "none or crosswise"),
        (
            over(json!({ "adaptation": "crosswise", "replicas": 3 })),
            "integrator.adaptation: 2 stages need two replicas",
        ),
        (paths(json!({ "adaptation": "crosswise" })), "crosswise needs space: primary"),
        (paths(json!({ "mutations": { "lens": 0 } })), "integrator.mutations.lens"),
        (paths(json!({ "mutations": { "lense": 1 } })), "integrator.mutations.lense: unknown key"),
        (paths(json!({ "mutations": {} })), "at least one mutation"),
        (over(json!({ "mutations": { "lens": 1 } })), "primary has no mutations"),
        (
            chains("energy_redistribution", "bidirectional", json!({ "importance": { "stages": 2 } })),
            "integrator.importance: unknown key",
        ),
    ] {
        refused(&scene.to_string(), &[wanted]);
    }
}

#[test]
fn the_time_limit_ends_an_image_after_whole_replicas() {
    for kind in ["metropolis", "energy_redistribution"] {
        let of = |replicas: u32| chains(kind, "bidirectional", json!({ "replicas": replicas }));
        let no_time = ["--samples-per-pixel", "64", "--time-limit", "1e-9", "--threads", "1"];
        let (image, told) = drawn(&of(16), &no_time);
        assert_eq!(
            (&told["chains"]["replicas"], &told["image"]["samples_per_pixel"]),
            (&json!(1), &json!(4))
        );
        assert!(
            told["warnings"].to_string().contains("after 4 of 64 samples per pixel"),
            "{}",
            told["warnings"]
        );
        assert_eq!(told["radiance"]["standard_error"], Value::Null);
        // The first replica, and as many samples of what is drawn pixel by pixel.
        assert!(image == drawn(&of(1), &["--samples-per-pixel", "4"]).0, "{kind}");
        let samples = ["--samples-per-pixel", "7"];
        let limited = [&samples[..], &["--time-limit", "1e5"]].concat();
        assert!(drawn(&of(3), &limited) == drawn(&of(3), &samples), "{kind}");
    }
}
