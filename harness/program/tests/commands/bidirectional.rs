//! Bidirectional path tracing: what is rendered, told and refused.

use crate::common::{harness, in_noise, timeless};
use crate::render::{number, statistics};
use crate::render_refusals::refused;
use serde_json::{Value, json};

/// Haze over a floor, a lamp that reflects, a mirror.
pub(crate) fn mixed(integrator: &Value) -> Value {
    small(include_str!("../../../scenes/mixed.json"), integrator)
}

/// A lamp in a globe of glass, in a room of colours.
fn bulb(integrator: &Value) -> Value {
    small(include_str!("../../../scenes/bulb.json"), integrator)
}

fn small(scene: &str, integrator: &Value) -> Value {
    let mut scene: Value = serde_json::from_str(scene).unwrap();
    scene["camera"]["resolution"] = json!([10, 9]);
    scene["integrator"] = integrator.clone();
    scene
}

/// With these keys beside its kind.
fn bidirectional(mut keys: Value) -> Value {
    keys["kind"] = json!("bidirectional");
    keys
}

/// The mean of an image, and its standard error.
pub(crate) fn mean(scene: &Value, samples: &str) -> [f64; 2] {
    let radiance = &statistics(scene, &["--samples-per-pixel", samples])["radiance"];
    ["mean", "standard_error"].map(|key| number(&radiance[key]))
}

/// Image means agree within five standard errors of both, a false alarm in two million, that are no more than a share of either.
#[track_caller]
pub(crate) fn agree([one, error]: [f64; 2], [other, its_error]: [f64; 2], share: f64) {
    let both = error.hypot(its_error);
    assert!((one - other).abs() < 5.0 * both, "{one} ± {error}, {other} ± {its_error}");
    assert!(both < share * other, "{one} ± {error}, {other} ± {its_error}");
}

#[test]
fn the_mean_is_that_of_path_tracing() {
    let paths = json!({ "kind": "path_tracer" });
    let expected = mean(&mixed(&paths), "2000");
    for keys in [
        json!({}),
        json!({ "light_paths_per_pixel": 3, "heuristic": "power" }),
        json!({ "light_image": false, "thickness": { "nodes": 2 }, "heuristic": "maximum" }),
        json!({ "connection_roulette": 0.5, "thickness": "neglected" }),
    ] {
        agree(mean(&mixed(&bidirectional(keys)), "600"), expected, 0.02);
    }
    agree(mean(&bulb(&bidirectional(json!({}))), "400"), mean(&bulb(&paths), "20000"), 0.03);
}

/// The bytes of the image and the statistics.
pub(crate) fn drawn(scene: &Value, more: &[&str]) -> (Vec<u8>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["a.pfm", "b.json"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let arguments = ["render", "-", "--out", &paths[0], "--out", &paths[1]];
    let outcome = harness(&[&arguments[..], more].concat(), &scene.to_string());
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let [image, statistics] = paths.map(|path| std::fs::read(path).unwrap());
    (image, timeless(serde_json::from_slice(&statistics).unwrap()))
}

#[test]
fn the_bits_do_not_depend_on_threads_or_passes() {
    // More tiles than light waits for, in colour; one light path more, and one canvas for each channel.
    let mut large = bulb(&bidirectional(json!({ "connection_roulette": 0.2 })));
    large["camera"]["resolution"] = json!([140, 150]);
    let separate = bulb(&bidirectional(json!({ "colour": "separate", "light_paths_per_pixel": 2 })));
    for scene in [large, separate] {
        let one = drawn(&scene, &["--samples-per-pixel", "2", "--threads", "1"]);
        assert!(one == drawn(&scene, &["--samples-per-pixel", "2", "--threads", "3"]));
        assert!(one == drawn(&scene, &["--samples-per-pixel", "2", "--time-limit", "1e5"]));
    }
}

#[test]
fn strategies_are_told_and_their_parts_are_the_whole() {
    let all = (0..=3).flat_map(|s| (1..=4).map(move |t| [s, t]));
    let exist = all.filter(|&[s, t]| s + t >= 2 && [s, t] != [1, 1]);
    let (image, rest): (Vec<[u32; 2]>, Vec<[u32; 2]>) = exist.partition(|&[_, t]| t == 1);
    let of = |strategies: Value| {
        let scene = mixed(&bidirectional(json!({ "max_vertices": 2, "strategies": strategies })));
        statistics(&scene, &["--samples-per-pixel", "8"])
    };
    let [whole, image, rest] = [json!("all"), json!(image), json!(rest)].map(of);
    let radiance = |statistics: &Value| number(&statistics["radiance"]["mean"]);
    // The same variates: what is left out and what is left are the whole.
    let sum = radiance(&image) + radiance(&rest);
    assert!(radiance(&image) > 0.0 && (sum / radiance(&whole) - 1.0).abs() < 1e-12, "{sum}");
    assert!(image["warnings"].to_string().contains("strategies: a part of the light"));
    assert!(!whole["warnings"].to_string().contains("strategies"));
    let told = whole["strategies"].as_array().unwrap();
    let shares: f64 = told.iter().map(|told| number(&told["share"])).sum();
    assert!((shares - 1.0).abs() < 1e-12, "{shares}");
    let share = |s: u32, t: u32| {
        told.iter().find(|told| told["s"] == s && told["t"] == t).map(|told| number(&told["share"]))
    };
    // The share of t = 1 is that of the light image.
    let of_image = [2, 3].map(|s| share(s, 1).unwrap()).iter().sum::<f64>();
    assert!((of_image * radiance(&whole) / radiance(&image) - 1.0).abs() < 1e-12, "{of_image}");
    // The lamp is not seen from where the camera stands by light paths, but it is lit by all the others.
    assert_eq!(share(1, 1), None);
    assert!(told.iter().all(|told| number(&told["variance"]) > 0.0), "{told:?}");
    let sum: f64 = told.iter().map(|told| number(&told["variance"])).sum();
    let variance = number(&whole["variance"]["mean_per_pixel"]);
    // Strategies of one sample are correlated, but not that much.
    assert!(sum / variance > 0.3 && sum / variance < 3.0, "{sum} of {variance}");
}

#[test]
fn strategies_without_weights_find_the_same_light_alone() {
    let of = |strategy: [u32; 2], weighted: bool| {
        let keys = json!({ "strategies": [strategy], "weighted": weighted });
        let mut scene = mixed(&bidirectional(keys));
        // Without the mirror there is no path that only chance finds.
        scene["surfaces"].as_array_mut().unwrap().truncate(2);
        scene
    };
    // All light of three edges: on the image alone, and by four strategies that share it.
    let parts = [[0, 4], [1, 3], [2, 2], [3, 1]].map(|strategy| mean(&of(strategy, true), "1000"));
    let error = parts.iter().map(|[_, error]| error * error).sum::<f64>().sqrt();
    let sum: f64 = parts.iter().map(|[mean, _]| mean).sum();
    agree(mean(&of([3, 1], false), "4000"), [sum, error], 0.02);
    assert!(parts[3][0] < 0.9 * sum, "{parts:?}");
    let told = statistics(&of([1, 3], false), &["--samples-per-pixel", "2"]);
    assert!(told["warnings"].to_string().contains("strategies would find it alone"));
}

#[test]
fn light_straight_into_glass_is_followed_if_that_is_asked_for() {
    let lit = |point_caustics: bool| {
        let mut scene = bulb(&bidirectional(json!({ "point_caustics": point_caustics })));
        let surfaces = scene["surfaces"].as_array_mut().unwrap();
        surfaces.truncate(6);
        scene["lights"] = json!([{ "kind": "point", "position": [0, 0.5, 0], "power": 10 }]);
        statistics(&scene, &["--samples-per-pixel", "60"])
    };
    let [without, with] = [false, true].map(lit);
    // The ball is seen under the cosine √3/2 from its double radius: (1 − cosine)/2 of the power.
    let seen = 5.0 * (1.0 - 0.75_f64.sqrt());
    let unseen = number(&without["unseen_power"]);
    assert!((unseen / seen - 1.0).abs() < 0.1, "{unseen} of {seen}");
    assert_eq!(with["unseen_power"], 0.0);
    let [dark, bright] = [without, with].map(|statistics| number(&statistics["radiance"]["mean"]));
    assert!(bright > 1.005 * dark, "{bright} {dark}");
}

#[test]
fn a_contribution_that_is_not_finite_names_its_pixel_sample_and_strategy() {
    let mut scene = mixed(&bidirectional(json!({})));
    // Of the power that four square units emit, over the area of a pixel.
    scene["surfaces"][1]["emission"] = json!(5e307);
    refused(&scene.to_string(), &["pixel (column ", "sample 0, seed 1", "strategy [s, t] = ["]);
}

#[test]
fn keys_that_are_refused() {
    let refuses = |keys: Value, words: &[&str]| refused(&mixed(&bidirectional(keys)).to_string(), words);
    refuses(json!({ "light_paths_per_pixel": 0 }), &["integrator.light_paths_per_pixel", "found 0"]);
    refuses(json!({ "light_paths_per_pixel": 1.5 }), &["integrator.light_paths_per_pixel"]);
    refuses(json!({ "thickness": "random" }), &["integrator.thickness", "exact", "neglected", "nodes"]);
    refuses(json!({ "thickness": { "nodes": 0 } }), &["integrator.thickness.nodes", "found 0"]);
    refuses(json!({ "thickness": { "steps": 4 } }), &["integrator.thickness.nodes", "missing"]);
    for share in [json!(0), json!(1.5), json!("low")] {
        refuses(json!({ "connection_roulette": share }), &["integrator.connection_roulette", "at most 1"]);
    }
    refuses(json!({ "strategies": [] }), &["integrator.strategies", "all"]);
    refuses(json!({ "strategies": [[0, 2], [1, 1]] }), &["integrator.strategies.1", "[0, 2] alone"]);
    refuses(json!({ "weighted": false }), &["integrator.weighted", "needs a list of strategies"]);
    refuses(json!({ "strategies": [[2, 0]] }), &["integrator.strategies.0", "t of at least 1"]);
    refuses(json!({ "strategies": [[0, 1]] }), &["integrator.strategies.0", "at least 2"]);
    refuses(
        json!({ "strategies": [[2, 1]], "light_image": false }),
        &["integrator.strategies", "light_image"],
    );
    refuses(
        json!({ "point_caustics": true, "light_image": false }),
        &["integrator.point_caustics", "light_image: true"],
    );
    refuses(json!({ "max_vertices": 0 }), &["integrator.max_vertices"]);
    refuses(json!({ "light_paths": 5 }), &["integrator.light_paths", "unknown key"]);
    let noise = in_noise(mixed(&bidirectional(json!({ "thickness": "exact" }))));
    refused(&noise.to_string(), &["integrator.thickness: exact", "closed form"]);
}
