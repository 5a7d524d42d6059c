//! Extensions of the path tracer and the beam radiance estimate: what is rendered, told and refused.

use crate::bidirectional::{agree, drawn, mean, mixed};
use crate::common::in_noise;
use crate::render::{number, statistics};
use crate::render_refusals::refused;
use serde_json::{Value, json};

fn path_tracer(mut keys: Value) -> Value {
    keys["kind"] = json!("path_tracer");
    mixed(&keys)
}

fn beam_radiance(mut keys: Value) -> Value {
    keys["kind"] = json!("beam_radiance");
    mixed(&keys)
}

#[test]
fn no_extension_moves_the_mean() {
    let expected = mean(&path_tracer(json!({})), "4000");
    for (keys, samples) in [
        (json!({ "extension": { "kind": "guided", "photons": 2000, "nearest": 20, "cells": 16 } }), "1000"),
        // A map of five light paths is of noise.
        (json!({ "extension": { "kind": "guided", "photons": 5 } }), "2000"),
        (json!({ "extension": { "kind": "resampled", "candidates": 4, "own_share": 0.5 } }), "2000"),
        (json!({ "light_candidates": 6 }), "2000"),
        (json!({ "reuse": { "tile": 2 } }), "1200"),
        (json!({ "reuse": { "tile": 8, "spacing": 1 }, "heuristic": "power" }), "1200"),
    ] {
        agree(mean(&path_tracer(keys), samples), expected, 0.04);
    }
}

#[test]
fn the_beam_radiance_estimate_nears_the_mean_as_its_radius_shrinks() {
    let expected = mean(&path_tracer(json!({})), "4000");
    let near = mean(&beam_radiance(json!({ "photons": 2000, "radius": 0.05 })), "300");
    agree(near, expected, 0.04);
    // Near the lamp and the borders of the medium light is smeared out to where it counts less.
    let far = mean(&beam_radiance(json!({ "photons": 2000, "radius": 1.2 })), "300");
    assert!(far[0] < expected[0] - 5.0 * far[1].hypot(expected[1]), "{far:?} of {expected:?}");
}

/// With as many columns and rows that several tiles share the work.
fn large(mut scene: Value) -> Value {
    scene["camera"]["resolution"] = json!([41, 37]);
    scene
}

#[test]
fn the_bits_do_not_depend_on_threads_or_passes() {
    for scene in [
        path_tracer(json!({ "extension": { "kind": "guided", "photons": 1000 } })),
        path_tracer(json!({ "reuse": { "tile": 3, "spacing": 4 } })),
        beam_radiance(json!({ "photons": 1000, "radius": 0.2, "surfaces": "map" })),
    ] {
        let scene = large(scene);
        let one = drawn(&scene, &["--samples-per-pixel", "2", "--threads", "1"]);
        assert!(one == drawn(&scene, &["--samples-per-pixel", "2", "--threads", "3"]));
        assert!(one == drawn(&scene, &["--samples-per-pixel", "2", "--time-limit", "1e5"]));
    }
}

#[test]
fn what_is_shared_is_told() {
    let told = |scene: &Value| statistics(scene, &["--samples-per-pixel", "3"]);
    let guided = told(&path_tracer(json!({ "extension": { "kind": "guided", "photons": 500 } })));
    assert_eq!(guided["photon_maps"]["maps"], 1);
    assert!(number(&guided["photon_maps"]["photons_per_map"]) > 100.0);
    let reuse = told(&path_tracer(json!({ "reuse": { "tile": 2 } })));
    assert!(reuse["method"].to_string().contains("means of passes") && reuse["photon_maps"].is_null());
    let beam = told(&beam_radiance(json!({ "photons": 500, "radius": 0.2 })));
    assert_eq!(beam["photon_maps"]["maps"], 3);
    assert!(beam["method"].to_string().contains("a map of its own"));
    assert!(beam["warnings"].to_string().contains("biased"));
    let plain = told(&path_tracer(json!({})));
    assert!(plain["photon_maps"].is_null() && !plain["method"].to_string().contains("passes"));
    // One pass tells nothing of what its pixels share.
    let one = statistics(&path_tracer(json!({ "reuse": { "tile": 2 } })), &["--samples-per-pixel", "1"]);
    assert!(one["radiance"]["standard_error"].is_null());
}

#[test]
fn what_is_not_finite_names_its_pixel_and_sample() {
    for mut scene in [
        path_tracer(json!({ "reuse": { "tile": 2 } })),
        beam_radiance(json!({ "photons": 2000, "radius": 0.001 })),
    ] {
        scene["surfaces"][1]["emission"] = json!(1.7e308);
        refused(&scene.to_string(), &["pixel (column ", "sample ", "seed 1"]);
    }
}

#[test]
fn keys_that_are_refused() {
    let refuses = |keys: Value, words: &[&str]| refused(&path_tracer(keys).to_string(), words);
    refuses(json!({ "extension": { "kind": "guided" } }), &["integrator.extension.photons", "missing"]);
    refuses(
        json!({ "extension": { "kind": "lead", "photons": 3 } }),
        &["extension.kind", "guided or resampled"],
    );
    refuses(json!({ "extension": { "kind": "resampled", "candidates": 0 } }), &["extension.candidates"]);
    for share in [0.0, -1.0, 1.5] {
        let extension = json!({ "kind": "guided", "photons": 9, "own_share": share });
        refuses(json!({ "extension": extension }), &["integrator.extension.own_share", "at most 1"]);
    }
    refuses(json!({ "light_candidates": 0 }), &["integrator.light_candidates"]);
    for tile in [1, 9] {
        refuses(json!({ "reuse": { "tile": tile } }), &["integrator.reuse.tile", "from 2 to 8"]);
    }
    refuses(json!({ "reuse": { "tile": 2, "spacing": 0 } }), &["integrator.reuse.spacing"]);
    for beside in [
        json!({ "extension": { "kind": "resampled", "candidates": 2 } }),
        json!({ "light_candidates": 2 }),
        json!({ "max_vertices": 1 }),
    ] {
        let mut keys = beside.clone();
        keys["reuse"] = json!({ "tile": 2 });
        let key = beside.as_object().unwrap().keys().next().unwrap().clone();
        refuses(keys, &["integrator.reuse: needs ", &key]);
    }
    // A rate below the extinction: of the whole medium, and of cells that no look-up foresaw.
    refuses(json!({ "reuse": { "tile": 2 }, "sigma_samp": 0.5 }), &["integrator.sigma_samp", "reuse", "0.6"]);
    let cells = json!({ "cells": [2, 2, 2], "factor": 0.5, "floor": 0.1 });
    let below = json!({ "reuse": { "tile": 2 }, "sigma_samp": cells, "allow_supercritical": true });
    refuses(below, &["integrator.sigma_samp", "met more"]);
    let noise = in_noise(path_tracer(json!({ "reuse": { "tile": 2 } })));
    refused(&noise.to_string(), &["integrator.reuse", "closed form"]);
    let mut dark = path_tracer(json!({ "extension": { "kind": "guided", "photons": 100 } }));
    dark["surfaces"][1]["emission"] = json!(0);
    refused(&dark.to_string(), &["integrator.extension", "needs a light"]);
    let beam = |keys: Value, words: &[&str]| refused(&beam_radiance(keys).to_string(), words);
    beam(json!({ "photons": 10 }), &["integrator.radius", "missing"]);
    beam(json!({ "radius": 0.1 }), &["integrator.photons", "missing"]);
    beam(json!({ "photons": 10, "radius": 0 }), &["integrator.radius", "above 0"]);
    beam(json!({ "photons": 10, "radius": 1, "surfaces": "none" }), &["integrator.surfaces", "path or map"]);
}
