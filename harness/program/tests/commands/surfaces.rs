//! The surfaces of a scene: what is seen, and what is refused.

use crate::common::harness;
use crate::render::with;
use crate::render_refusals::refused;
use fairflight_harness::image::Image;
use serde_json::{Value, json};

fn ball(radius: f64, material: &Value) -> Value {
    json!({ "kind": "sphere", "center": [0, 0, 10], "radius": radius, "material": material })
}

fn square(material: &Value) -> Value {
    json!({ "kind": "rectangle", "corner": [0, 0, 10], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0],
        "material": material })
}

fn gray() -> Value {
    json!({ "kind": "diffuse", "reflectance": 0.5 })
}

/// The scene with these surfaces, and perhaps more.
#[track_caller]
fn surfaces_refused(surfaces: Value, change: impl FnOnce(&mut Value), words: &[&str]) {
    let scene = with(|scene| {
        scene["surfaces"] = surfaces;
        change(scene);
    });
    refused(&scene.to_string(), words);
}

/// A good square, and a second surface that differs from a good one in this key.
#[track_caller]
fn key_refused(mut surface: Value, key: &str, value: Value, words: &[&str]) {
    surface[key] = value;
    surfaces_refused(json!([square(&gray()), surface]), |_| (), words);
}

#[test]
fn an_emitter_without_other_lights_is_seen_as_bright_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("image.pfm");
    let scene = with(|scene| {
        scene.as_object_mut().unwrap().remove("medium");
        scene["lights"] = json!([]);
        scene["integrator"] = json!({ "kind": "path_tracer" });
        scene["surfaces"] = json!([{ "kind": "rectangle", "corner": [-50, -50, 10], "edge_u": [100, 0, 0],
            "edge_v": [0, 100, 0], "material": { "kind": "diffuse", "reflectance": 0 }, "emission": [1, 2, 3] }]);
    });
    let outcome = harness(&["render", "-", "--out", out.to_str().unwrap()], &scene.to_string());
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    let image = Image::read(&out).unwrap();
    assert!(image.pixels().iter().all(|pixel| *pixel == [1.0, 2.0, 3.0]), "{:?}", image.pixels()[0]);
}

#[test]
fn shapes_that_are_refused() {
    let (square, ball) = (square(&gray()), ball(1.0, &gray()));
    key_refused(square.clone(), "edge_u", json!([0, 0, 0]), &["surfaces.1.edge_u", "length 0", "[0,0,0]"]);
    key_refused(square.clone(), "edge_v", json!([0, 0, 0]), &["surfaces.1.edge_v", "length 0"]);
    key_refused(square.clone(), "edge_v", json!([-2, 0, 0]), &["surfaces.1.edge_v", "parallel to edge_u"]);
    key_refused(square.clone(), "corner", json!([0, 0]), &["surfaces.1.corner", "three numbers"]);
    key_refused(square.clone(), "corner", json!([1e308, 1e308, "x"]), &["surfaces.1.corner.2", "number"]);
    key_refused(square.clone(), "radius", json!(1), &["surfaces.1.radius", "unknown key", "edge_v"]);
    key_refused(ball.clone(), "radius", json!(0), &["surfaces.1.radius", "above 0", "found 0"]);
    key_refused(ball.clone(), "radius", json!(-1), &["surfaces.1.radius", "above 0"]);
    key_refused(ball.clone(), "kind", json!("torus"), &["surfaces.1.kind", "rectangle or sphere", "torus"]);
    key_refused(ball.clone(), "emission", json!(-1), &["surfaces.1.emission", "at least 0", "-1"]);
    key_refused(ball, "emission", json!([1, 1]), &["surfaces.1.emission", "list of three"]);
    surfaces_refused(json!([{}]), |_| (), &["surfaces.0.kind", "missing"]);
}

#[test]
fn materials_that_are_refused() {
    let material =
        |material: Value, words: &[&str]| key_refused(square(&gray()), "material", material, words);
    let diffuse = |reflectance: Value| json!({ "kind": "diffuse", "reflectance": reflectance });
    material(diffuse(json!(1.5)), &["surfaces.1.material.reflectance", "from 0 to 1", "found 1.5"]);
    material(diffuse(json!(-0.5)), &["surfaces.1.material.reflectance", "from 0 to 1", "found -0.5"]);
    material(diffuse(json!([0.5, 0.5, 1.1])), &["surfaces.1.material.reflectance.2", "found 1.1"]);
    material(json!({ "kind": "diffuse" }), &["surfaces.1.material.reflectance", "missing"]);
    material(json!({ "kind": "mirror", "ior": 2 }), &["surfaces.1.material.ior", "unknown key"]);
    material(json!({ "kind": "dielectric", "ior": 0 }), &["surfaces.1.material.ior", "above 0"]);
    material(json!({ "kind": "velvet" }), &["surfaces.1.material.kind", "diffuse, mirror or dielectric"]);
    // A gain may be allowed, nothing negative may.
    let allow = |scene: &mut Value| scene["allow_gain"] = json!(true);
    let bright = |reflectance: f64| json!([square(&diffuse(json!(reflectance)))]);
    surfaces_refused(bright(-0.5), allow, &["surfaces.0.material.reflectance", "at least 0"]);
    surfaces_refused(bright(1.5), allow, &["knows no surfaces"]);
}

#[test]
fn integrators_that_know_no_surfaces_are_refused() {
    let list = || json!([square(&gray())]);
    let blind = |kind: &str| format!("integrator.kind: {kind} knows no surfaces; allowed with surfaces are");
    surfaces_refused(
        list(),
        |_| (),
        &[&blind("particle_tracer"), "path_tracer, vpl, bidirectional and beam_radiance"],
    );
    let transmittance = json!({ "kind": "transmittance", "estimator": { "kind": "regular" } });
    surfaces_refused(list(), |s| s["integrator"] = transmittance, &[&blind("transmittance")]);
}

#[test]
fn light_that_cannot_get_out_is_refused() {
    let (mirror, glass) = (json!({ "kind": "mirror" }), json!({ "kind": "dielectric", "ior": 1.5 }));
    let lamp = |position: [f64; 3]| {
        move |scene: &mut Value| {
            scene["lights"] = json!([{ "kind": "environment", "radiance": 1 },
                { "kind": "point", "position": position, "power": 1 }]);
        }
    };
    let inside = [0.0, 0.5, 10.0];
    for material in [&gray(), &mirror] {
        let list = || json!([square(&gray()), ball(1.0, material)]);
        let words = ["lights.1.position: lies inside the solid surfaces.1, nothing of its light gets out"];
        surfaces_refused(list(), lamp(inside), &words);
        // On it and outside: only the integrator is refused.
        surfaces_refused(list(), lamp([0.0, 1.0, 10.0]), &["knows no surfaces"]);
    }
    let words = ["lights.1.position: lies inside the dielectric surfaces.0: no connection passes a smooth"];
    surfaces_refused(json!([ball(1.0, &glass)]), lamp(inside), &words);
    // Who sits in the same ball sees the light, but not through glass.
    let camera_too = |scene: &mut Value| {
        lamp(inside)(scene);
        scene["camera"]["origin"] = json!([0, 0, 9.5]);
    };
    surfaces_refused(json!([ball(1.0, &gray())]), camera_too, &["knows no surfaces"]);
    surfaces_refused(
        json!([ball(1.0, &glass)]),
        camera_too,
        &["lights.1.position: lies inside the dielectric"],
    );
}

#[test]
fn emitters_that_cannot_be_seen_are_refused() {
    let shining = |mut surface: Value| {
        surface["emission"] = json!([0, 0, 3]);
        surface
    };
    let words = ["surfaces.1: lies inside the solid surfaces.0, nothing of its light gets out"];
    surfaces_refused(json!([ball(2.0, &gray()), shining(ball(1.0, &gray()))]), |_| (), &words);
    surfaces_refused(json!([ball(2.0, &gray()), shining(square(&gray()))]), |_| (), &words);
    // A ball that shines itself, one that reaches out of the other, and one that is dark.
    let other = &["knows no surfaces"];
    surfaces_refused(json!([shining(ball(2.0, &gray()))]), |_| (), other);
    surfaces_refused(json!([ball(1.2, &gray()), shining(square(&gray()))]), |_| (), other);
    surfaces_refused(json!([ball(2.0, &gray()), ball(1.0, &gray())]), |_| (), other);
    let glass = json!({ "kind": "dielectric", "ior": 1.5 });
    surfaces_refused(json!([ball(2.0, &glass), shining(square(&gray()))]), |_| (), other);
}
