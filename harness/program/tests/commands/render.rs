//! `harness render`: scenes in, images and statistics out.

use crate::common::{Outcome, harness, timeless};
use fairflight_harness::image::Image;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EQ21: &str = include_str!("../../../scenes/eq21-environment.json");

/// The example of the spec, small.
pub(crate) fn scene() -> Value {
    let mut scene: Value = serde_json::from_str(EQ21).unwrap();
    scene["camera"]["resolution"] = json!([20, 18]);
    scene["samples_per_pixel"] = json!(4);
    scene
}

pub(crate) fn with(change: impl FnOnce(&mut Value)) -> Value {
    let mut scene = scene();
    change(&mut scene);
    scene
}

/// Renders into a folder; returns the paths of the files.
fn render(scene: &Value, folder: &Path, names: &[&str], more: &[&str]) -> (Outcome, Vec<PathBuf>) {
    let paths: Vec<PathBuf> = names.iter().map(|name| folder.join(name)).collect();
    let mut arguments = vec!["render", "-"];
    for path in &paths {
        arguments.extend(["--out", path.to_str().unwrap()]);
    }
    arguments.extend(more);
    (harness(&arguments, &scene.to_string()), paths)
}

#[track_caller]
fn rendered(scene: &Value, folder: &Path, names: &[&str], more: &[&str]) -> Vec<PathBuf> {
    let (outcome, paths) = render(scene, folder, names, more);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (0, ""), "{}", outcome.stderr);
    paths
}

#[track_caller]
pub(crate) fn statistics(scene: &Value, more: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let paths = rendered(scene, folder.path(), &["statistics.json"], more);
    serde_json::from_slice(&std::fs::read(&paths[0]).unwrap()).unwrap()
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let point_light: Value =
        serde_json::from_str(include_str!("../../../scenes/eq21-point-light.json")).unwrap();
    let shared = with(|scene| {
        scene["lights"] = point_light["lights"].clone();
        scene["integrator"] = point_light["integrator"].clone();
        scene["integrator"]["shared_explorers"] = json!(8);
    });
    let mut coloured: Value = serde_json::from_str(include_str!("../../../scenes/coloured.json")).unwrap();
    coloured["camera"]["resolution"] = json!([33, 17]);
    let mut photons = coloured.clone();
    photons["integrator"]["particles"] = json!("photons");
    let mut separate = photons.clone();
    separate["integrator"]["colour"] = json!("separate");
    for scene in [scene(), shared, coloured, photons, separate] {
        let folder = tempfile::tempdir().unwrap();
        let draw = |threads: &str| {
            let more = ["--threads", threads, "--samples-per-pixel", "3"];
            let paths = rendered(&scene, folder.path(), &["image.pfm", "statistics.json"], &more);
            let statistics = timeless(serde_json::from_slice(&std::fs::read(&paths[1]).unwrap()).unwrap());
            (std::fs::read(&paths[0]).unwrap(), statistics)
        };
        let one = draw("1");
        assert_eq!(draw("2"), one);
        assert_eq!(draw("3"), one);
    }
}

#[test]
fn each_format_is_written_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["image.pfm", "image.exr", "image.PNG", "image.json"];
    let (outcome, paths) = render(&scene(), folder.path(), &names, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("image.PNG: sRGB of "), "{}", outcome.stderr);
    let image = Image::read(&paths[0]).unwrap();
    assert_eq!((image.width(), image.height()), (20, 18));
    assert_eq!(Image::read(&paths[1]).unwrap(), image);
    let bytes = std::fs::read(&paths[2]).unwrap();
    let reader = png::Decoder::new(bytes.as_slice()).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (20, 18));
    assert_eq!(reader.info().uncompressed_latin1_text[0].keyword, "Comment");
    let statistics: Value = serde_json::from_slice(&std::fs::read(&paths[3]).unwrap()).unwrap();
    let mean = image.pixels().as_flattened().iter().map(|&value| f64::from(value)).sum::<f64>() / 1080.0;
    assert!((number(&statistics["radiance"]["mean"]) - mean).abs() < 1e-6);
    assert_eq!(statistics["cost"]["rays"], 20 * 18 * 4);
    assert_eq!(statistics["provenance"]["seed"], 1);
    assert_eq!(statistics["reference"], Value::Null);
    // 1/(MSE · look-ups), with the MSE of the mean of four samples.
    let variance = number(&statistics["variance"]["mean_per_pixel"]);
    let lookups = number(&statistics["cost"]["lookups"]);
    let efficiency = number(&statistics["efficiency"]["per_lookup"]);
    assert!((efficiency * variance / 4.0 * lookups - 1.0).abs() < 1e-12);
}

/// The picture, and how it was mapped.
fn png(path: &Path) -> (Vec<u8>, String) {
    let bytes = std::fs::read(path).unwrap();
    let mut reader = png::Decoder::new(bytes.as_slice()).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    reader.next_frame(&mut pixels).unwrap();
    (pixels, reader.info().uncompressed_latin1_text[0].text.clone())
}

#[test]
fn the_exposure_is_that_of_the_scene() {
    let room: Value = serde_json::from_str(include_str!("../../../scenes/smoke-room.json")).unwrap();
    let mut lit: Value = serde_json::from_str(include_str!("../../../scenes/lit-cloud.json")).unwrap();
    lit["integrator"] = json!({ "kind": "path_tracer" });
    let coloured: Value = serde_json::from_str(include_str!("../../../scenes/coloured.json")).unwrap();
    let mut photons = coloured.clone();
    photons["integrator"]["particles"] = json!("photons");
    for mut scene in [scene(), room, lit, coloured, photons] {
        let folder = tempfile::tempdir().unwrap();
        let mut mapped = |resolution: [u32; 2], more: &[&str]| {
            scene["camera"]["resolution"] = json!(resolution);
            let name = format!("{}{}.png", resolution[0], more.concat());
            png(&rendered(&scene, folder.path(), &[&name], more)[0]).1
        };
        let once = mapped([12, 12], &["--samples-per-pixel", "1"]);
        assert_eq!(mapped([12, 12], &["--samples-per-pixel", "16", "--seed", "7"]), once);
        assert_eq!(mapped([24, 24], &["--samples-per-pixel", "2", "--threads", "1"]), once);
    }
    // In passes, of which some are not drawn.
    let folder = tempfile::tempdir().unwrap();
    let whole = png(&rendered(&scene(), folder.path(), &["whole.png"], &[])[0]).1;
    let limit = ["--time-limit", "0.001", "--samples-per-pixel", "4000"];
    assert_eq!(png(&rendered(&scene(), folder.path(), &["part.png"], &limit)[0]).1, whole);
}

#[test]
fn a_lamp_in_view_leaves_the_room_visible() {
    let mut room: Value = serde_json::from_str(include_str!("../../../scenes/smoke-room.json")).unwrap();
    room["camera"]["resolution"] = json!([16, 16]);
    room["samples_per_pixel"] = json!(4);
    let mut stronger = room.clone();
    // The same lamp, a quarter of the picture: it is looked at from below.
    stronger["camera"]["origin"] = json!([0, -0.9, 0]);
    stronger["camera"]["look_at"] = json!([0, 0.95, 0.1]);
    stronger["surfaces"][5]["emission"] = json!(500);
    for scene in [room, stronger] {
        let folder = tempfile::tempdir().unwrap();
        let mut levels = png(&rendered(&scene, folder.path(), &["room.png"], &[])[0]).0;
        levels.sort_unstable();
        let median = levels[levels.len() / 2];
        assert!((70..250).contains(&median), "the median of the picture is {median} of 255");
    }
}

#[test]
fn the_error_against_a_reference_is_the_distance_of_the_images() {
    let folder = tempfile::tempdir().unwrap();
    let exact = with(|scene| {
        scene["integrator"] = json!({ "kind": "transmittance", "estimator": { "kind": "regular" } });
    });
    let reference = rendered(&exact, folder.path(), &["exact.exr"], &["--samples-per-pixel", "400"]);
    let noisy = with(|scene| {
        let estimator = json!({ "kind": "double_particle", "sigma_samp": 1.0 });
        scene["integrator"] = json!({ "kind": "transmittance", "estimator": estimator });
    });
    let names = ["noisy.pfm", "noisy.json"];
    let file = reference[0].to_str().unwrap();
    let paths = rendered(&noisy, folder.path(), &names, &["--reference", file]);
    let (exact, noisy) = (Image::read(&reference[0]).unwrap(), Image::read(&paths[0]).unwrap());
    let pairs = exact.pixels().as_flattened().iter().zip(noisy.pixels().as_flattened());
    let squared: f64 = pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    let statistics: Value = serde_json::from_slice(&std::fs::read(&paths[1]).unwrap()).unwrap();
    let rmse = number(&statistics["reference"]["rmse"]);
    assert!((rmse - (squared / 1080.0).sqrt()).abs() < 1e-6 && rmse > 1e-3, "{rmse}");
    let per_lookup = number(&statistics["efficiency"]["per_lookup"]);
    assert!((per_lookup * rmse * rmse * number(&statistics["cost"]["lookups"]) - 1.0).abs() < 1e-12);
    let other = with(|scene| scene["camera"]["resolution"] = json!([20, 17]));
    let (outcome, _) = render(&other, folder.path(), &["other.pfm"], &["--reference", file]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("must have 20 x 17 pixels"), "{}", outcome.stderr);
}

/// 5 standard errors: a false alarm of 6e-7 per comparison, if the mean of a few thousand pixels is normal.
#[track_caller]
fn assert_mean(scene: &Value, expected: f64) {
    let statistics = statistics(scene, &["--samples-per-pixel", "64"]);
    let (mean, error) =
        (number(&statistics["radiance"]["mean"]), number(&statistics["radiance"]["standard_error"]));
    assert!((mean - expected).abs() <= 5.0 * error + 1e-12, "{mean} +- {error}, expected {expected}");
}

#[test]
fn a_white_medium_in_a_white_room_is_invisible() {
    let furnace = |integrator: Value, albedo: f64| {
        with(|scene| {
            scene["medium"]["albedo"] = json!(albedo);
            scene["integrator"] = integrator;
        })
    };
    // Above and below the greatest extinction: without and with variance. From 0.7 down there would be no second moment.
    for sigma_samp in [2.0, 0.9] {
        for version in ["adaptive", "non_terminating"] {
            let tracer = json!({ "kind": "particle_tracer", "version": version, "sigma_samp": sigma_samp });
            assert_mean(&furnace(tracer.clone(), 1.0), 1.0);
            let gray = statistics(&furnace(tracer, 0.5), &["--samples-per-pixel", "64"]);
            assert!(number(&gray["radiance"]["mean"]) < 0.95);
        }
    }
    let terminating = json!({ "kind": "particle_tracer", "version": "terminating", "sigma_samp": 2.0 });
    assert_mean(&furnace(terminating, 1.0), 1.0);
}

/// Two ways to one mean; 5 standard errors of the difference.
#[track_caller]
fn assert_same_mean(one: &Value, other: &Value) {
    let [(a, da), (b, db)] = [one, other].map(|scene| {
        let statistics = statistics(scene, &["--samples-per-pixel", "64"]);
        assert_eq!(statistics["warnings"], json!([]));
        (number(&statistics["radiance"]["mean"]), number(&statistics["radiance"]["standard_error"]))
    });
    assert!((a - b).abs() <= 5.0 * da.hypot(db), "{a} +- {da}, {b} +- {db}");
}

#[test]
fn walks_of_all_kinds_see_the_same_light() {
    let sun = |scene: &mut Value| {
        scene["lights"] = json!([{ "kind": "environment", "radiance": 0.5 },
            { "kind": "directional", "direction": [0, -1, 1], "irradiance": 4 }]);
    };
    let tracer = with(sun);
    let grid = with(|scene| {
        sun(scene);
        scene["integrator"]["sigma_samp"] = json!({ "cells": [12, 12, 12], "factor": 1.1, "floor": 0.1 });
    });
    assert_same_mean(&tracer, &grid);
    for starts in ["equidistant", "independent"] {
        let splitting = with(|scene| {
            sun(scene);
            scene["integrator"]["kind"] = json!("line_splitting");
            scene["integrator"]["majorant"] = json!(1.5);
            scene["integrator"]["splits"] = json!(4);
            scene["integrator"]["starts"] = json!(starts);
        });
        assert_same_mean(&tracer, &splitting);
    }
    // The error of photons comes from 16 replicas: 5 of it are exceeded once in 6000 times.
    let photons = with(|scene| {
        sun(scene);
        scene["integrator"]["particles"] = json!("photons");
    });
    assert_same_mean(&tracer, &photons);
    let coloured = |colour: &str| {
        with(|scene| {
            scene["medium"]["albedo"] = json!([0.9, 0.5, 0.2]);
            scene["lights"][0]["radiance"] = json!([1, 2, 3]);
            scene["integrator"]["colour"] = json!(colour);
        })
    };
    assert_same_mean(&coloured("shared"), &coloured("separate"));
}

#[test]
fn single_scattering_of_all_kinds_sees_the_same_light() {
    let scene = |sampling: &str, estimator: Value| {
        with(|scene| {
            scene["lights"] = json!([{ "kind": "point", "position": [4, 11, 6], "power": 1000 },
                { "kind": "environment", "radiance": 0.1 }]);
            scene["integrator"] = json!({ "kind": "single_scattering", "sampling": sampling, "samples_per_ray": 3,
                "estimator": estimator, "shadow": { "kind": "regular" } });
        })
    };
    let regular = scene("source", json!({ "kind": "regular" }));
    let walk = json!({ "kind": "double_particle", "sigma_samp": 0.8 });
    let explored = json!({ "kind": "double_particle", "sigma_samp": 0.4, "control": { "kind": "explorers", "count": 12 } });
    for sampling in [
        "attenuation",
        "attenuation_resampled",
        "source",
        "scattering",
        "source_and_scattering",
        "attenuation_and_source",
        "attenuation_and_scattering",
    ] {
        assert_same_mean(&regular, &scene(sampling, walk.clone()));
        assert_same_mean(&regular, &scene(sampling, explored.clone()));
    }
    assert_same_mean(
        &regular,
        &scene("attenuation", json!({ "kind": "line_integral", "majorant": 1.5, "splits": 4 })),
    );
    let marching = json!({ "kind": "ray_marching", "steps": 64, "jitter": true });
    let mut marching = scene("attenuation", marching);
    marching["integrator"].as_object_mut().unwrap().remove("shadow");
    let statistics = statistics(&marching, &[]);
    assert!(statistics["warnings"][0].as_str().unwrap().contains("biased baseline"));
}

#[test]
fn a_camera_inside_and_a_light_outside() {
    let inside = with(|scene| {
        scene["camera"]["origin"] = json!([0, 0, 8]);
        scene["medium"]["albedo"] = json!(1.0);
    });
    assert_mean(&inside, 1.0);
    let outside = with(|scene| {
        scene["lights"] = json!([{ "kind": "point", "position": [15, 10, -5], "power": 1000 }]);
    });
    let far = statistics(&outside, &[]);
    assert!(number(&far["radiance"]["mean"]) > 0.0);
    assert_eq!(far["warnings"], json!([]));
    let within = with(|scene| {
        scene["lights"] = json!([{ "kind": "point", "position": [0, 0, 10], "power": 1000 }]);
    });
    assert!(statistics(&within, &[])["warnings"][0].as_str().unwrap().contains("no second moment"));
    let photons = with(|scene| {
        scene["camera"]["origin"] = json!([0, 0, 8]);
        scene["integrator"]["particles"] = json!("photons");
    });
    assert!(statistics(&photons, &[])["warnings"][0].as_str().unwrap().contains("the camera stands in"));
}

#[test]
fn a_scene_without_a_medium_shows_the_environment() {
    let folder = tempfile::tempdir().unwrap();
    let pixels = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0], [4.0, 4.0, 4.0]];
    let map = folder.path().join("map.pfm");
    let bytes = Image::new(4, 1, pixels.to_vec()).encode(fairflight_harness::image::Format::Pfm).unwrap();
    std::fs::write(&map, bytes).unwrap();
    let scene = with(|scene| {
        scene.as_object_mut().unwrap().remove("medium");
        scene["lights"] = json!([{ "kind": "environment_map", "file": map.to_str().unwrap() }]);
    });
    let paths = rendered(&scene, folder.path(), &["image.pfm"], &[]);
    let image = Image::read(&paths[0]).unwrap();
    // Column 0 of the map begins at +z and turns over +x, which is on the left of a camera that looks along +z.
    assert_eq!(image.pixels()[0], [1.0, 0.0, 0.0]);
    assert_eq!(image.pixels()[19], [4.0; 3]);
}

#[test]
fn without_light_it_is_dark() {
    let folder = tempfile::tempdir().unwrap();
    let dark = with(|scene| scene["lights"] = json!([]));
    let mut empty = dark.clone();
    empty.as_object_mut().unwrap().remove("medium");
    for scene in [dark, empty] {
        let (outcome, paths) = render(&scene, folder.path(), &["image.pfm", "statistics.json"], &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert_eq!(outcome.stderr, "warning: there is no light, the image is black\n");
        assert!(Image::read(&paths[0]).unwrap().pixels().iter().all(|pixel| *pixel == [0.0; 3]));
        let statistics: Value = serde_json::from_slice(&std::fs::read(&paths[1]).unwrap()).unwrap();
        assert_eq!(statistics["warnings"], json!(["there is no light, the image is black"]));
    }
}

#[test]
fn all_scenes_of_the_repository_render() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let mut scene: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        scene["camera"]["resolution"] = json!([8, 8]);
        // From standard input paths are relative to the working directory.
        if let Some(file) = scene["medium"]["file"].as_str().map(|file| folder.join(file)) {
            scene["medium"]["file"] = json!(file);
        }
        let statistics = statistics(&scene, &["--samples-per-pixel", "1"]);
        assert!(number(&statistics["radiance"]["mean"]).is_finite(), "{}", path.display());
        assert_eq!(statistics["radiance"]["standard_error"], Value::Null);
        count += 1;
    }
    assert!(count >= 4);
}
