//! `harness render --time-limit`: images that are drawn pass by pass, and may end early.

use crate::bidirectional::mixed;
use crate::common::{Outcome, harness, timeless};
use crate::render::{scene, with};
use serde_json::{Value, json};
use std::path::Path;

/// Renders into a folder: what the program said, the bytes of the image, the statistics without what the clock says.
fn render(scene: &Value, folder: &Path, more: &[&str]) -> (Outcome, Vec<u8>, Value) {
    let [image, statistics] =
        ["a.pfm", "b.json"].map(|name| folder.join(name).to_str().expect("a path").to_owned());
    let mut arguments = vec!["render", "-", "--out", &image, "--out", &statistics];
    arguments.extend(more);
    let outcome = harness(&arguments, &scene.to_string());
    assert_eq!((outcome.code, outcome.stdout.as_str()), (0, ""), "{}", outcome.stderr);
    let read = |path| std::fs::read(path).expect("a file");
    let mut statistics = timeless(serde_json::from_slice(&read(&statistics)).expect("JSON"));
    // Of virtual point lights only.
    if let Some(seconds) = statistics.pointer_mut("/virtual_point_lights/light_path_seconds") {
        *seconds = Value::Null;
    }
    (outcome, read(&image), statistics)
}

#[test]
fn passes_give_the_bits_of_one_pass() {
    let coloured = with(|scene| {
        scene["medium"]["albedo"] = json!([0.9, 0.5, 0.2]);
        scene["lights"][0]["radiance"] = json!([1, 2, 3]);
    });
    let mut separate = coloured.clone();
    separate["integrator"]["colour"] = json!("separate");
    let single = with(|scene| {
        scene["lights"] = json!([{ "kind": "point", "position": [4, 11, 6], "power": 1000 }]);
        scene["integrator"] = json!({ "kind": "single_scattering", "sampling": "attenuation", "samples_per_ray": 2,
            "estimator": { "kind": "double_particle", "sigma_samp": 0.8 } });
    });
    let empty = with(|scene| drop(scene.as_object_mut().unwrap().remove("medium")));
    let folder = tempfile::tempdir().unwrap();
    let mut paths = coloured.clone();
    paths["surfaces"] = json!([{ "kind": "rectangle", "corner": [-9, -9, 16], "edge_u": [18, 0, 0],
        "edge_v": [0, 18, 0], "material": { "kind": "diffuse", "reflectance": [0.1, 0.5, 0.9] }, "emission": 0.5 }]);
    paths["integrator"] = json!({ "kind": "path_tracer" });
    // Always in passes, each with a batch of its own.
    let mut lights = paths.clone();
    lights["integrator"] = json!({ "kind": "vpl", "light_paths": 8, "eye_samples": 2, "clamp": 1 });
    for scene in [scene(), coloured, separate, single, empty, paths, lights] {
        let samples = ["--samples-per-pixel", "5", "--threads", "2"];
        let (_, image, statistics) = render(&scene, folder.path(), &samples);
        let in_passes: Vec<&str> = samples.into_iter().chain(["--time-limit", "100000"]).collect();
        let (_, again, other) = render(&scene, folder.path(), &in_passes);
        assert!(again == image, "another image");
        assert_eq!(other, statistics);
    }
}

#[test]
fn the_time_limit_ends_an_image_after_a_whole_pass() {
    let folder = tempfile::tempdir().unwrap();
    let many = ["--samples-per-pixel", "4000000000", "--time-limit"];
    for limit in ["1e-9", "0.2"] {
        let more: Vec<&str> = many.into_iter().chain([limit]).collect();
        let (outcome, image, statistics) = render(&scene(), folder.path(), &more);
        let drawn = statistics["image"]["samples_per_pixel"].as_u64().unwrap();
        // At least one pass, and no more than one where no time is.
        assert!(drawn >= 1 && (limit == "0.2" || drawn == 1), "{drawn}");
        let seconds: f64 = limit.parse().unwrap();
        let warning = format!(
            "the time limit of {seconds} s ended the image after {drawn} of 4000000000 samples per pixel"
        );
        assert_eq!(statistics["warnings"], json!([warning]));
        assert_eq!(outcome.stderr, format!("warning: {warning}\n"));
        assert_eq!(statistics["cost"]["rays"], 20 * 18 * drawn);
        // The image is that of as many samples.
        let (_, same, mut statistics_of_same) =
            render(&scene(), folder.path(), &["--samples-per-pixel", &drawn.to_string()]);
        assert!(same == image, "another image");
        statistics_of_same["warnings"] = statistics["warnings"].clone();
        assert_eq!(statistics_of_same, statistics);
    }
}

#[test]
fn the_time_limit_ends_whatever_light_paths_share_after_a_whole_pass() {
    let folder = tempfile::tempdir().unwrap();
    for integrator in [
        json!({ "kind": "bidirectional", "connection_roulette": 0.3 }),
        json!({ "kind": "path_tracer", "extension": { "kind": "guided", "photons": 300, "nearest": 8 } }),
        json!({ "kind": "path_tracer", "reuse": { "tile": 2 } }),
        json!({ "kind": "beam_radiance", "photons": 300, "radius": 0.1 }),
    ] {
        let scene = mixed(&integrator);
        let limited = ["--samples-per-pixel", "4000000000", "--time-limit", "0.1"];
        let (_, image, statistics) = render(&scene, folder.path(), &limited);
        let drawn = statistics["image"]["samples_per_pixel"].as_u64().unwrap();
        let warning =
            format!("the time limit of 0.1 s ended the image after {drawn} of 4000000000 samples per pixel");
        assert!(statistics["warnings"].to_string().contains(&warning), "{integrator}");
        let (_, same, _) = render(&scene, folder.path(), &["--samples-per-pixel", &drawn.to_string()]);
        assert!(same == image, "{integrator}: another image after {drawn}");
    }
}

#[test]
fn time_limits_that_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.pfm").to_str().unwrap().to_owned();
    let refused = |scene: &Value, limit: &str, words: &[&str]| {
        let limit = format!("--time-limit={limit}");
        let outcome = harness(&["render", "-", "--out", &out, &limit], &scene.to_string());
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{limit}: {}", outcome.stderr);
        for word in words {
            assert!(outcome.stderr.contains(word), "no {word:?} in: {}", outcome.stderr);
        }
    };
    for limit in ["0", "-1", "nan", "inf", "1e999", "soon", ""] {
        refused(&scene(), limit, &["--time-limit"]);
    }
    refused(&scene(), "0", &["must be a number above 0"]);
    let photons = with(|scene| scene["integrator"]["particles"] = json!("photons"));
    refused(&photons, "1", &["--time-limit", "photons"]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "something was written");
}
