//! Virtual point lights: what is rendered, and what is refused.

use crate::common::harness;
use crate::render::with;
use crate::render_refusals::refused;
use serde_json::{Value, json};

/// A closed room that glows: emission 1, reflectance 1/2, haze that absorbs nothing. Every ray sees 2.
fn furnace(integrator: &Value) -> Value {
    with(|scene| {
        scene["camera"]["origin"] = json!([0.1, 0.2, -0.3]);
        scene["camera"]["look_at"] = json!([0, 0, 1]);
        scene["camera"]["resolution"] = json!([4, 4]);
        scene["medium"] = json!({ "kind": "homogeneous", "sigma_t": 1.5, "albedo": 1, "phase": { "kind": "isotropic" },
            "bounds": { "sphere": { "center": [0, 0, 0], "radius": 1 } } });
        scene["lights"] = json!([]);
        scene["surfaces"] = json!([{ "kind": "sphere", "center": [0, 0, 0], "radius": 1, "emission": 1,
            "material": { "kind": "diffuse", "reflectance": 0.5 } }]);
        scene["integrator"] = integrator.clone();
    })
}

fn lights(compensation: &Value) -> Value {
    json!({ "kind": "vpl", "light_paths": 20, "eye_samples": 2, "clamp": 2, "compensation": compensation })
}

/// The statistics of a scene.
fn rendered(scene: &Value, arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("image.json");
    let arguments: Vec<&str> = ["render", "-", "--out", out.to_str().unwrap()]
        .into_iter()
        .chain(arguments.iter().copied())
        .collect();
    let outcome = harness(&arguments, &scene.to_string());
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    serde_json::from_str(&std::fs::read_to_string(out).unwrap()).unwrap()
}

fn integrator_refused(change: impl FnOnce(&mut Value), words: &[&str]) {
    let mut integrator = lights(&json!({ "strategy": "one_to_one" }));
    change(&mut integrator);
    refused(&furnace(&integrator).to_string(), words);
}

#[test]
fn all_strategies_and_path_tracing_find_the_furnace() {
    let strategies = ["one_to_many", "many_to_one", "one_to_one"];
    let compensated = strategies.map(|strategy| {
        lights(&json!({ "strategy": strategy, "placement": "locally_homogeneous", "visibility": "local" }))
    });
    for integrator in
        compensated.into_iter().chain([json!({ "kind": "path_tracer", "heuristic": "maximum" })])
    {
        let statistics = rendered(&furnace(&integrator), &["--samples-per-pixel", "64"]);
        let [mean, error] =
            ["mean", "standard_error"].map(|key| statistics["radiance"][key].as_f64().unwrap());
        // Five standard errors: a false alarm in two million.
        assert!((mean - 2.0).abs() < 5.0 * error && error < 0.1, "{integrator}: {mean} ± {error}");
    }
}

#[test]
fn what_is_clamped_and_not_compensated_is_missing_and_said() {
    let statistics = rendered(&furnace(&lights(&Value::Null)), &["--samples-per-pixel", "32"]);
    assert!(statistics["radiance"]["mean"].as_f64().unwrap() < 1.8);
    assert!(statistics["warnings"].to_string().contains("clamped"), "{}", statistics["warnings"]);
    let mut parts = lights(&json!({ "strategy": "one_to_one" }));
    let mut sum = 0.0;
    for component in ["connections", "lost"] {
        parts["component"] = json!(component);
        sum +=
            rendered(&furnace(&parts), &["--samples-per-pixel", "32"])["radiance"]["mean"].as_f64().unwrap();
    }
    parts["component"] = json!("connections");
    parts["clamp"] = Value::Null;
    let whole =
        rendered(&furnace(&parts), &["--samples-per-pixel", "32"])["radiance"]["mean"].as_f64().unwrap();
    // The same variates: what is left and what is lost are the whole.
    assert!((sum / whole - 1.0).abs() < 1e-12, "{sum} of {whole}");
}

#[test]
fn the_bits_do_not_depend_on_threads_and_the_statistics_tell_of_the_lights() {
    let scene = furnace(&lights(&json!({ "strategy": "many_to_one", "steps": 2 })));
    let [one, three] =
        ["1", "3"].map(|threads| rendered(&scene, &["--samples-per-pixel", "3", "--threads", threads]));
    assert_eq!(one["radiance"], three["radiance"]);
    let told = &one["virtual_point_lights"];
    assert_eq!(told["sets"], 3);
    assert!(told["lights_per_set"].as_f64().unwrap() > 20.0);
    let inside = told["compensation_share_inside"].as_f64().unwrap();
    assert!(inside > 0.0 && inside < 1.0, "{inside}");
}

#[test]
fn a_bound_from_the_scene_and_lights_kept_near() {
    let mut integrator = lights(&json!({ "strategy": "one_to_one" }));
    integrator["clamp"] = json!("scene");
    integrator["keep_near"] = json!(0.5);
    let statistics = rendered(&furnace(&integrator), &["--samples-per-pixel", "64"]);
    let [mean, error] = ["mean", "standard_error"].map(|key| statistics["radiance"][key].as_f64().unwrap());
    assert!((mean - 2.0).abs() < 5.0 * error, "{mean} ± {error}");
    let scene = with(|scene| {
        scene["lights"] = json!([{ "kind": "point", "position": [0, 9, 0], "power": 1 }]);
        scene["integrator"] = integrator;
    });
    refused(&scene.to_string(), &["integrator.clamp", "radiance"]);
}

#[test]
fn nothing_to_gather_is_said_and_darkness_is_black() {
    let mut scene = furnace(&lights(&Value::Null));
    scene.as_object_mut().unwrap().remove("medium");
    scene["surfaces"][0]["material"] = json!({ "kind": "mirror" });
    scene["surfaces"][0]["emission"] = json!(0);
    scene["lights"] = json!([{ "kind": "point", "position": [0, 0, 0.5], "power": 1 }]);
    refused(&scene.to_string(), &["integrator.light_paths", "left a virtual point light"]);
    let mut scene = furnace(&lights(&Value::Null));
    scene["surfaces"][0]["emission"] = json!(0);
    let statistics = rendered(&scene, &["--samples-per-pixel", "2"]);
    assert_eq!(statistics["radiance"]["mean"], 0.0);
    assert!(statistics["warnings"].to_string().contains("there is no light"), "{}", statistics["warnings"]);
}

#[test]
fn bad_virtual_lights_are_refused() {
    integrator_refused(|i| i["light_paths"] = json!(0), &["integrator.light_paths", "0"]);
    integrator_refused(|i| i["eye_samples"] = json!(-1), &["integrator.eye_samples", "-1"]);
    integrator_refused(|i| i["clamp"] = json!(-2), &["integrator.clamp", "-2", "scene"]);
    integrator_refused(|i| i["clamp"] = json!("much"), &["integrator.clamp", "much"]);
    integrator_refused(|i| i["heuristic"] = json!("best"), &["integrator.heuristic", "maximum"]);
    integrator_refused(
        |i| i["compensation"]["strategy"] = json!("all"),
        &["compensation.strategy", "one_to_one"],
    );
    integrator_refused(|i| i["compensation"]["steps"] = json!(1.5), &["compensation.steps", "1.5"]);
    integrator_refused(|i| i["compensation"]["bias"] = json!(1), &["compensation.bias"]);
    integrator_refused(
        |i| i["compensation"]["transmittance"] = json!("approximate"),
        &["compensation", "locally_homogeneous"],
    );
    integrator_refused(
        |i| {
            i["component"] = json!("correction");
            i["compensation"] = Value::Null;
        },
        &["integrator.component", "compensation"],
    );
    integrator_refused(|i| i["keep_near"] = json!(0), &["integrator.keep_near"]);
    integrator_refused(|i| i["estimator"] = json!({ "kind": "best" }), &["integrator.estimator.kind"]);
}

#[test]
fn a_medium_of_unknown_greatest_extinction_needs_a_sampling_extinction() {
    let mut scene = furnace(&json!({ "kind": "path_tracer" }));
    scene["medium"] = json!({ "kind": "expression", "sigma_t": "1 + x", "albedo": 1, "phase": { "kind": "isotropic" },
        "bounds": { "sphere": { "center": [0, 0, 0], "radius": 1 } } });
    refused(&scene.to_string(), &["integrator.sigma_samp", "majorant"]);
    scene["integrator"] = json!({ "kind": "path_tracer", "sigma_samp": 2,
        "estimator": { "kind": "double_particle", "sigma_samp": 2 } });
    let statistics = rendered(&scene, &["--samples-per-pixel", "64"]);
    let [mean, error] = ["mean", "standard_error"].map(|key| statistics["radiance"][key].as_f64().unwrap());
    assert!((mean - 2.0).abs() < 5.0 * error, "{mean} ± {error}");
}
