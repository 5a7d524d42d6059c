//! `harness info`: what a volume holds, and a scene that can be pasted.

use crate::common::{fixture, harness};
use serde_json::Value;

#[test]
fn a_volume_is_described_and_its_scene_renders() {
    let outcome = harness(&["info", &fixture("eq21_64.vdb")], "");
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for word in ["box", "voxel", "active voxels", "mean free paths"] {
        assert!(outcome.stdout.contains(word), "{}", outcome.stdout);
    }
    let scene = &outcome.stdout[outcome.stdout.find('{').expect("a scene")..];
    let mut scene: Value = serde_json::from_str(scene).expect("the scene is JSON");
    scene["camera"]["resolution"] = serde_json::json!([4, 3]);
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("image.json");
    let arguments = ["render", "-", "--out", image.to_str().unwrap(), "--samples-per-pixel", "2"];
    let rendered = harness(&arguments, &scene.to_string());
    assert_eq!(rendered.code, 0, "{}", rendered.stderr);
    let statistics: Value = serde_json::from_str(&std::fs::read_to_string(image).unwrap()).unwrap();
    assert!(statistics.to_string().contains("look"), "{statistics}");
}

#[test]
fn numbers_are_those_of_the_medium() {
    let outcome = harness(&["info", "--json", &fixture("eq21_64.vdb")], "");
    let info: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let grid = &info["grids"][0];
    let number = |key: &str| grid[key].as_f64().unwrap();
    assert!(number("least") <= number("mean") && number("mean") <= number("greatest"), "{grid}");
    for axis in 0..3 {
        let extent = grid["max"][axis].as_f64().unwrap() - grid["min"][axis].as_f64().unwrap();
        let paths = grid["mean_free_paths"][axis].as_f64().unwrap();
        assert!((paths - extent * number("mean")).abs() < 1e-9 * paths, "{grid}");
    }
}

#[test]
fn what_is_no_volume_is_told() {
    let vectors = harness(&["info", &fixture("vec_only.vdb")], "");
    assert!(vectors.code == 0 && vectors.stdout.contains("no medium"), "{}", vectors.stdout);
    let damaged = harness(&["info", &fixture("truncated.vdb")], "");
    assert!(damaged.code == 2 || damaged.stdout.contains("no medium"), "{}", damaged.stdout);
    let text = harness(&["info", &fixture("README.md")], "");
    assert_eq!((text.code, text.stderr.lines().count()), (2, 1), "{}", text.stderr);
    assert_eq!(harness(&["info", "nowhere.vdb"], "").code, 2);
}
