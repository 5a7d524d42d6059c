//! Sweeps of scenes: an image and statistics for each value.

use crate::common::{Outcome, harness};
use crate::render::scene;
use serde_json::{Value, json};
use std::path::Path;

fn render(scene: &Value, folder: &Path, names: &[&str], more: &[&str]) -> Outcome {
    let paths: Vec<String> =
        names.iter().map(|name| folder.join(name).to_str().expect("a path").to_owned()).collect();
    let outs = paths.iter().flat_map(|path| ["--out", path]);
    let arguments: Vec<&str> = ["render", "-"].into_iter().chain(outs).chain(more.iter().copied()).collect();
    harness(&arguments, &scene.to_string())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("Unicode")).collect();
    names.sort();
    names
}

fn swept(path: &str, values: &Value) -> Value {
    let mut scene = scene();
    scene["sweep"] = json!({ "path": path, "values": values });
    scene
}

#[test]
fn a_sweep_of_scenes_equals_its_points() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let sweep = swept("integrator.sigma_samp", &json!([0.8, 1.2]));
    let outcome = render(&sweep, root.path(), &["a.pfm", "a.png", "all.json"], &[]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (0, ""), "{}", outcome.stderr);
    assert_eq!(names(root.path()), ["a-0.pfm", "a-0.png", "a-1.pfm", "a-1.png", "all.json"]);
    let read = |name: &str| std::fs::read(root.path().join(name)).expect("a file");
    let all: Value = serde_json::from_slice(&read("all.json")).expect("JSON");
    assert_eq!(all["points"].as_array().map(Vec::len), Some(2));

    let mut single = scene();
    for (point, value) in [0.8, 1.2].into_iter().enumerate() {
        single["integrator"]["sigma_samp"] = json!(value);
        assert_eq!(render(&single, root.path(), &["single.pfm", "single.json"], &[]).code, 0);
        assert_eq!(read("single.pfm"), read(&format!("a-{point}.pfm")));
        let statistics: Value = serde_json::from_slice(&read("single.json")).expect("JSON");
        let found = &all["points"][point];
        assert_eq!((&found["value"], &found["radiance"]), (&json!(value), &statistics["radiance"]));
        assert_eq!(found["cost"]["lookups"], statistics["cost"]["lookups"]);
        assert_eq!(found["provenance"]["spec"], sweep);
    }
    assert_ne!(read("a-0.pfm"), read("a-1.pfm"));
}

#[test]
fn whole_parts_may_be_swept_and_passes_too() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let integrators = json!([
        { "kind": "particle_tracer", "version": "adaptive", "sigma_samp": 1 },
        { "kind": "vpl", "light_paths": 4, "eye_samples": 1, "clamp": 1 },
    ]);
    let outcome = render(&swept("integrator", &integrators), root.path(), &["a.pfm", "a.json"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let all: Value =
        serde_json::from_slice(&std::fs::read(root.path().join("a.json")).expect("a file")).expect("JSON");
    assert_eq!(all["points"][0]["virtual_point_lights"], Value::Null);
    assert!(all["points"][1]["virtual_point_lights"].is_object());
}

#[test]
fn a_sweep_that_is_none_is_refused_before_anything_is_drawn() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let budget: &[&str] = &["--budget", "20000"];
    for (scene, more, words) in [
        (swept("samples_per_pixel", &json!([1])), &[][..], "sweep.path: must name a key of camera, medium,"),
        (swept("integrator.sigma_samp", &json!([])), &[], "sweep.values: must be a list"),
        (swept("integrator.sigma_samp", &json!([1, -1])), &[], "integrator.sigma_samp"),
        (swept("integrator.sigma_samp", &json!([1, 2, 3])), budget, "sweep.values: "),
    ] {
        let outcome = render(&scene, root.path(), &["a.pfm"], more);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{words}");
        assert!(outcome.stderr.contains(words) && outcome.stderr.lines().count() == 1, "{}", outcome.stderr);
        assert!(names(root.path()).is_empty(), "{words}");
    }
    let advice = harness(&["advise", "-"], &swept("integrator.sigma_samp", &json!([1])).to_string());
    assert!(
        advice.code == 2 && advice.stderr.contains("sweep: one scene is needed here"),
        "{}",
        advice.stderr
    );
}
