//! Metropolis sampling and energy redistribution: what is rendered, told and refused.

use crate::bidirectional::{agree, drawn, mean, mixed};
use crate::common::harness;
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

#[test]
fn the_mean_is_that_of_independent_samples() {
    let expected = mean(&mixed(&json!({ "kind": "path_tracer" })), "3000");
    for (scene, samples) in [
        (metropolis("bidirectional", json!({})), "600"),
        (metropolis("bidirectional", json!({ "chains": 5, "large_step": 0.1, "first_order": 1 })), "600"),
        (metropolis("path_tracer", json!({ "rows": "flat", "bootstrap": 3000 })), "2000"),
        (metropolis("multiplexed", json!({ "step": [0.001, 0.1] })), "3000"),
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
    for kind in ["metropolis", "energy_redistribution"] {
        let scene = chains(kind, "bidirectional", json!({ "replicas": 3 }));
        let one = drawn(&scene, &["--samples-per-pixel", "4", "--threads", "1"]);
        assert!(one == drawn(&scene, &["--samples-per-pixel", "4", "--threads", "2"]), "{kind}");
    }
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
    // Fewer samples per pixel than replicas: one for each.
    let told = statistics(&metropolis("bidirectional", json!({})), &["--samples-per-pixel", "3"]);
    assert_eq!(told["chains"]["replicas"], 3);
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
    let limited =
        harness(&["render", "-", "--out", "none.pfm", "--time-limit", "5"], &over(json!({})).to_string());
    assert_eq!(limited.code, 2);
    assert!(limited.stderr.contains("chains come in replicas of the whole image"), "{}", limited.stderr);
}
