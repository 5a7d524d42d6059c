//! Points in the place of independent samples: what is rendered, told and refused.

use crate::bidirectional::{agree, drawn, mean, mixed};
use crate::render::{number, statistics, with};
use crate::render_refusals::refused;
use fairflight_stats::Moments;
use serde_json::{Value, json};

/// Light that scatters once, in closed form.
fn single_scattering() -> Value {
    with(|scene| {
        scene["lights"] = json!([{ "kind": "point", "position": [0, 0, 10], "power": 600 }]);
        scene["integrator"] = json!({ "kind": "single_scattering", "sampling": "source",
            "estimator": { "kind": "regular" }, "samples_per_ray": 1 });
    })
}

/// The background through the medium.
fn transmittance() -> Value {
    let estimator = json!({ "kind": "double_particle", "sigma_samp": 1 });
    with(|scene| scene["integrator"] = json!({ "kind": "transmittance", "estimator": estimator }))
}

fn beam_radiance() -> Value {
    mixed(&json!({ "kind": "beam_radiance", "photons": 300, "radius": 0.2 }))
}

fn all() -> [Value; 3] {
    [single_scattering(), transmittance(), beam_radiance()]
}

fn by(mut scene: Value, keys: &Value) -> Value {
    scene["integrator"].as_object_mut().unwrap().extend(keys.as_object().unwrap().clone());
    scene
}

#[test]
fn points_do_not_move_the_mean() {
    for scene in all() {
        let expected = mean(&scene, "256");
        for sampler in ["sobol", "halton"] {
            agree(
                mean(&by(scene.clone(), &json!({ "sampler": sampler, "replicas": 64 })), "256"),
                expected,
                0.04,
            );
        }
    }
}

/// Over seeds, the squares of the standard errors are the variance of the means: that of 200 normal numbers is known to 10 %, and half as much or as much again
/// is five of these. A twin that takes the points for independent samples tells their scatter, that of independent ones, and is refused.
#[test]
fn the_error_is_told_by_replicas() {
    let estimator = json!({ "kind": "regular" });
    let mut scene =
        with(|scene| scene["integrator"] = json!({ "kind": "transmittance", "estimator": estimator }));
    scene["camera"]["resolution"] = json!([5, 4]);
    let mut found = |sampler: &str| {
        scene["integrator"]["sampler"] = json!(sampler);
        let (mut means, mut told) = (Moments::new(), Moments::new());
        for seed in 0..200 {
            scene["seed"] = json!(seed);
            let radiance = &statistics(&scene, &["--samples-per-pixel", "64"])["radiance"];
            means.push(number(&radiance["mean"]));
            told.push(number(&radiance["standard_error"]).powi(2));
        }
        [means.sample_variance().unwrap(), told.mean().unwrap()]
    };
    let is_told = |variance: f64, told: f64| (variance / told - 1.0).abs() < 0.5;
    let [independent, scatter] = found("independent");
    assert!(is_told(independent, scatter), "{independent} where {scatter} is told");
    for sampler in ["sobol", "halton"] {
        let [variance, told] = found(sampler);
        assert!(is_told(variance, told), "{sampler}: {variance} where {told} is told");
        assert!(!is_told(variance, scatter), "{sampler}: points taken for independent samples");
        assert!(variance < 0.4 * independent, "{sampler}: {variance}, independent samples {independent}");
    }
}

#[test]
fn the_bits_do_not_depend_on_threads_or_passes() {
    for scene in all() {
        let mut scene = by(scene, &json!({ "sampler": "sobol", "replicas": 2 }));
        scene["camera"]["resolution"] = json!([37, 18]);
        let one = drawn(&scene, &["--samples-per-pixel", "8", "--threads", "1"]);
        assert!(one == drawn(&scene, &["--samples-per-pixel", "8", "--threads", "3"]));
        assert!(one == drawn(&scene, &["--samples-per-pixel", "8", "--time-limit", "1e5"]));
    }
}

#[test]
fn the_time_limit_ends_an_image_after_whole_point_sets() {
    let scene = by(single_scattering(), &json!({ "sampler": "halton", "replicas": 1000 }));
    let limited = statistics(&scene, &["--samples-per-pixel", "32000", "--time-limit", "1e-9"]);
    assert_eq!(limited["image"]["samples_per_pixel"], 32);
    assert!(limited["warnings"].to_string().contains("after 32 of 32000 samples"));
    assert!(limited["radiance"]["standard_error"].is_null(), "one set tells no error");
}

#[test]
fn samplers_that_are_refused() {
    for kind in ["path_tracer", "bidirectional", "particle_tracer"] {
        let scene = mixed(&json!({ "kind": kind, "sampler": "sobol" }));
        refused(
            &scene.to_string(),
            &["integrator.sampler: ", kind, "transmittance, single_scattering, beam_radiance"],
        );
    }
    let refuses = |keys: Value, words: &[&str]| refused(&by(single_scattering(), &keys).to_string(), words);
    refuses(json!({ "sampler": "random" }), &["integrator.sampler", "independent, sobol or halton"]);
    refuses(json!({ "replicas": 4 }), &["integrator.replicas", "sampler"]);
    refuses(json!({ "sampler": "independent", "replicas": 4 }), &["integrator.replicas", "sampler"]);
    refuses(json!({ "sampler": "sobol", "replicas": 1 }), &["integrator.replicas", "from 2"]);
    refuses(
        json!({ "sampler": "sobol", "replicas": 3 }),
        &["integrator.replicas", "evenly", "samples_per_pixel 4"],
    );
}
