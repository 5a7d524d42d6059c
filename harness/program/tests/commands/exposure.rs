//! The exposure of tone-mapped files.

use crate::common::harness;
use crate::render::scene;
use serde_json::{Value, json};

/// Statistics and standard error of a small image with these arguments.
fn render(name: &str, more: &[&str]) -> (Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let [image, statistics] =
        [name, "a.json"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let arguments = ["render", "-", "--out", &image, "--out", &statistics];
    let arguments: Vec<&str> = arguments.into_iter().chain(more.iter().copied()).collect();
    let outcome = harness(&arguments, &scene().to_string());
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    (serde_json::from_slice(&std::fs::read(&statistics).unwrap()).unwrap(), outcome.stderr)
}

#[test]
fn exposure_is_given_in_stops_and_stated() {
    let (statistics, stderr) = render("a.png", &["--exposure", "-2"]);
    assert_eq!(statistics["exposure"], json!({ "stops": -2.0, "from": "--exposure" }));
    assert!(stderr.contains("a.png: sRGB of 0.25 times linear radiance"), "{stderr}");
    let (statistics, stderr) = render("a.png", &[]);
    assert_eq!(statistics["exposure"], json!({ "stops": 0.0, "from": "a pilot image" }));
    assert!(stderr.contains("sRGB of 1 times"), "{stderr}");
    assert_eq!(render("a.png", &["--quiet"]).1, "");
    assert_eq!(render("a.pfm", &[]).0["exposure"], Value::Null);
}

#[test]
fn an_exposure_that_shows_nowhere_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("a.exr");
    for (stops, words) in [("1", "no --out is one"), ("bright", "must be a number from -100 to 100")] {
        let arguments = ["render", "-", "--out", image.to_str().unwrap(), "--exposure", stops];
        let outcome = harness(&arguments, &scene().to_string());
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    }
}
