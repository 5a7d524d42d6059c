//! `harness render`: scenes in, images and statistics out.

use crate::common::{Outcome, harness};
use fairflight_harness::image::Image;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EQ21: &str = include_str!("../../scenes/eq21-environment.json");

/// The example of the spec, small.
fn scene() -> Value {
    let mut scene: Value = serde_json::from_str(EQ21).unwrap();
    scene["camera"]["resolution"] = json!([20, 18]);
    scene["samples_per_pixel"] = json!(4);
    scene
}

fn with(change: impl FnOnce(&mut Value)) -> Value {
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
fn statistics(scene: &Value, more: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let paths = rendered(scene, folder.path(), &["statistics.json"], more);
    serde_json::from_slice(&std::fs::read(&paths[0]).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let point_light: Value =
        serde_json::from_str(include_str!("../../scenes/eq21-point-light.json")).unwrap();
    let shared = with(|scene| {
        scene["lights"] = point_light["lights"].clone();
        scene["integrator"] = point_light["integrator"].clone();
        scene["integrator"]["shared_explorers"] = json!(8);
    });
    let mut coloured: Value = serde_json::from_str(include_str!("../../scenes/coloured.json")).unwrap();
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
            let mut statistics: Value = serde_json::from_slice(&std::fs::read(&paths[1]).unwrap()).unwrap();
            for (part, key) in [
                ("cost", "seconds"),
                ("cost", "cpu_seconds"),
                ("efficiency", "per_second"),
                ("provenance", "command"),
            ] {
                statistics[part][key] = Value::Null;
            }
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
    // Above and below the extinction: without and with variance.
    for sigma_samp in [2.0, 0.7] {
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
fn all_scenes_of_the_repository_render() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let mut scene: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        scene["camera"]["resolution"] = json!([8, 8]);
        let statistics = statistics(&scene, &["--samples-per-pixel", "1"]);
        assert!(number(&statistics["radiance"]["mean"]).is_finite(), "{}", path.display());
        assert_eq!(statistics["radiance"]["standard_error"], Value::Null);
        count += 1;
    }
    assert!(count >= 4);
}

/// A scene that must be refused with all of `words`, and leave nothing behind.
#[track_caller]
fn refused(scene: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["a.pfm", "b.json"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let outcome = harness(&["render", "-", "--out", &paths[0], "--out", &paths[1]], scene);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{scene}\n{}", outcome.stderr);
    assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{}", outcome.stderr);
    for word in words {
        assert!(outcome.stderr.contains(word), "no {word:?} in: {}", outcome.stderr);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "something was written");
}

#[track_caller]
fn change_refused(change: impl FnOnce(&mut Value), words: &[&str]) {
    refused(&with(change).to_string(), words);
}

#[test]
fn cameras_and_numbers_that_are_refused() {
    refused("{", &["standard input", "not JSON"]);
    refused(&scene().to_string().replace("60", "1e999"), &["number out of range"]);
    change_refused(|s| s["camera"]["up"] = json!([0, 0, 0]), &["camera.up", "length 0", "[0,0,0]"]);
    change_refused(|s| s["camera"]["up"] = json!([0, 0, 2]), &["camera.up", "parallel to the view"]);
    change_refused(|s| s["camera"]["look_at"] = json!([0, 0, -20]), &["camera.look_at", "origin"]);
    change_refused(
        |s| s["camera"]["resolution"] = json!([0, 4]),
        &["camera.resolution.0", "from 1 to 16384"],
    );
    change_refused(|s| s["camera"]["resolution"] = json!([4]), &["camera.resolution", "2 whole numbers"]);
    change_refused(
        |s| s["camera"]["vertical_fov_degrees"] = json!(180),
        &["camera.vertical_fov_degrees", "between 0 and 180", "found 180"],
    );
    change_refused(|s| s["camera"]["lens"] = json!(1), &["camera.lens", "unknown key", "look_at"]);
    change_refused(|s| s["samples_per_pixel"] = json!(0), &["samples_per_pixel", "found 0"]);
    change_refused(|s| s["samples_per_pixel"] = json!(4_294_967_296_u64), &["samples_per_pixel"]);
    change_refused(|s| s["surfaces"] = json!([{}]), &["surfaces", "later version"]);
    change_refused(|s| s["fog"] = json!(1), &["fog", "unknown key", "integrator"]);
    change_refused(|s| drop(s.as_object_mut().unwrap().remove("lights")), &["lights", "missing"]);
}

#[test]
fn media_and_lights_that_are_refused() {
    change_refused(|s| s["medium"]["albedo"] = json!(1.5), &["medium.albedo", "from 0 to 1", "1.5"]);
    change_refused(|s| s["medium"]["albedo"] = json!([0.5, -0.1, 0.5]), &["medium.albedo.1", "from 0 to 1"]);
    change_refused(|s| s["medium"]["albedo"] = json!([0.5]), &["medium.albedo", "list of three"]);
    change_refused(
        |s| {
            s["medium"]["albedo"] = json!(-1);
            s["allow_gain"] = json!(true);
        },
        &["medium.albedo", "at least 0"],
    );
    change_refused(
        |s| drop(s["medium"].as_object_mut().unwrap().remove("phase")),
        &["medium.phase", "missing"],
    );
    change_refused(|s| s["medium"]["phase"] = json!({ "kind": "mie" }), &["medium.phase.kind", "hazy_mie"]);
    change_refused(
        |s| s["medium"]["phase"] = json!({ "kind": "henyey_greenstein", "g": 1 }),
        &["medium.phase", "g must be below 1", "found 1"],
    );
    change_refused(
        |s| s["medium"]["phase"] = json!({ "kind": "tabulated", "cosines": [-1, 1], "values": [0, 0] }),
        &["medium.phase", "all be zero"],
    );
    change_refused(|s| s["medium"]["kind"] = json!("vdb"), &["medium.file", "missing"]);
    change_refused(
        |s| {
            s["medium"]["kind"] = json!("vdb");
            s["medium"]["file"] = json!("no/such.vdb");
        },
        &["standard input: medium.file", "no/such.vdb"],
    );
    change_refused(
        |s| {
            s["medium"] = json!({ "kind": "expression", "sigma_t": "1/(x - 100)", "majorant": 0.001,
                "bounds": { "box": { "min": [-200, -200, 0], "max": [200, 200, 20] } },
                "albedo": 0.5, "phase": { "kind": "isotropic" } });
        },
        &["medium", "exceeds the declared majorant 0.001"],
    );
    change_refused(
        |s| {
            s["medium"] = json!({ "kind": "expression", "sigma_t": "ln(x)",
                "bounds": { "box": { "min": [-1, -1, 0], "max": [1, 1, 20] } },
                "albedo": 0.5, "phase": { "kind": "isotropic" } });
        },
        &["medium", "not finite"],
    );
    change_refused(|s| s["lights"][0]["radiance"] = json!(-1), &["lights.0.radiance", "at least 0"]);
    change_refused(
        |s| s["lights"] = json!([{ "kind": "environment_map", "file": "no/such.pfm" }]),
        &["lights.0.file", "no/such.pfm"],
    );
    change_refused(
        |s| s["lights"] = json!([{ "kind": "environment_map", "file": "map.jpg" }]),
        &["lights.0.file", "map.jpg", ".pfm or .exr"],
    );
    change_refused(
        |s| s["lights"] = json!([{ "kind": "directional", "direction": [0, 0, 0], "irradiance": 1 }]),
        &["lights.0.direction", "must not be zero"],
    );
    change_refused(|s| s["lights"][0]["kind"] = json!("laser"), &["lights.0.kind", "directional"]);
}

#[test]
fn integrators_that_are_refused() {
    let estimator = |estimator: Value| json!({ "kind": "transmittance", "estimator": estimator });
    change_refused(|s| s["integrator"]["kind"] = json!("magic"), &["integrator.kind", "single_scattering"]);
    change_refused(|s| s["integrator"]["sigma_samp"] = json!(0), &["integrator.sigma_samp", "above 0"]);
    change_refused(
        |s| {
            s["integrator"]["version"] = json!("terminating");
            s["integrator"]["sigma_samp"] = json!(0.1);
        },
        &["integrator.version", "terminating needs"],
    );
    change_refused(
        |s| s["integrator"]["sigma_samp"] = json!(0.03),
        &["integrator.sigma_samp", "no second moment", "allow_supercritical"],
    );
    change_refused(
        |s| s["integrator"]["sigma_samp"] = json!({ "cells": [0, 1, 1], "factor": 1, "floor": 1 }),
        &["integrator.sigma_samp.cells.0", "from 1"],
    );
    change_refused(
        |s| {
            s["integrator"]["kind"] = json!("line_splitting");
            s["integrator"]["majorant"] = json!(0.01);
            s["integrator"]["splits"] = json!(2);
        },
        &["integrator.majorant", "0.01 is none"],
    );
    change_refused(
        |s| s["integrator"] = estimator(json!({ "kind": "woodcock", "majorant": 0.01 })),
        &["integrator.estimator.majorant", "0.01 is none", "sigma_t = "],
    );
    change_refused(
        |s| s["integrator"] = estimator(json!({ "kind": "unheard" })),
        &["integrator.estimator.kind", "must be regular, woodcock"],
    );
    let edges = json!({ "edges": [0, 1], "values": [1] });
    change_refused(
        |s| s["integrator"] = estimator(json!({ "kind": "double_particle", "sigma_samp": edges })),
        &["integrator.estimator.sigma_samp", "a number is allowed"],
    );
    change_refused(
        |s| s["integrator"] = estimator(json!({ "kind": "double_particle", "sigma_samp": 0 })),
        &["integrator.estimator.sigma_samp", "above 0"],
    );
    let perlin = |s: &mut Value| {
        s["medium"] = json!({ "kind": "perlin", "bounds": { "sphere": { "center": [0, 0, 10], "radius": 10 } },
            "albedo": 0.5, "phase": { "kind": "isotropic" } });
    };
    change_refused(
        |s| {
            perlin(s);
            s["integrator"] = estimator(json!({ "kind": "regular" }));
        },
        &["standard input: integrator.estimator.kind", "closed form", "analytic_cosine"],
    );
    let scattering = |sampling: &str, kind: &str| {
        json!({ "kind": "single_scattering", "sampling": sampling, "samples_per_ray": 1,
            "estimator": { "kind": kind, "sigma_samp": 1, "majorant": 1, "splits": 1 } })
    };
    change_refused(
        |s| s["integrator"] = scattering("sideways", "regular"),
        &["integrator.sampling", "attenuation_and_source"],
    );
    change_refused(
        |s| {
            s["integrator"] = scattering("attenuation", "regular");
            s["integrator"]["estimator"] = json!({ "kind": "regular" });
        },
        &["standard input: integrator.sampling", "walks"],
    );
    change_refused(
        |s| {
            s["integrator"] = scattering("source", "woodcock");
            s["integrator"]["estimator"] = json!({ "kind": "woodcock", "majorant": 1 });
        },
        &["integrator.estimator.kind", "every distance"],
    );
}

#[test]
fn command_lines_that_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene().to_string();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let outcome = harness(arguments, &scene);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (code, ""), "{}", outcome.stderr);
        for word in words {
            assert!(outcome.stderr.contains(word), "no {word:?} in: {}", outcome.stderr);
        }
    };
    refused(&["render", "-"], 2, &["--out"]);
    refused(
        &["render", "-", "--out", &at("a.pfm"), "--out", &at("b.jpg")],
        2,
        &["b.jpg", ".pfm, .exr, .png or .json"],
    );
    refused(&["render", "no/such.json", "--out", &at("a.pfm")], 2, &["no/such.json"]);
    refused(&["render", "-", "--out", &at("a.pfm"), "--samples-per-pixel", "0"], 2, &["0"]);
    refused(&["render", "-", "--out", &at("a.pfm"), "--threads", "0"], 2, &["0"]);
    refused(
        &["render", "-", "--out", &at("a.pfm"), "--reference", "no/such.exr"],
        2,
        &["--reference", "no/such.exr"],
    );
    std::fs::write(at("cut.pfm"), "PF\n20 18\n-1\n").unwrap();
    refused(
        &["render", "-", "--out", &at("a.pfm"), "--reference", &at("cut.pfm")],
        2,
        &["cut.pfm", "4320 bytes"],
    );
    refused(&["render", "-", "--out", &at("no/such/a.pfm")], 3, &["cannot write"]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "something was written");
}
