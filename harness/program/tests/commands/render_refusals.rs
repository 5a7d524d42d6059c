//! Bad input of `harness render`: exit code 2, one line on standard error that names the key, nothing written.

use crate::common::harness;
use crate::render::{scene, with};
use serde_json::{Value, json};

/// A scene that must be refused with all of `words`, and leave nothing behind.
#[track_caller]
pub(crate) fn refused(scene: &str, words: &[&str]) {
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
    change_refused(|s| s["surfaces"] = json!({}), &["surfaces", "must be a list"]);
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
        &["integrator.estimator.kind", "must be woodcock"],
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
