//! Estimators of transmittance in scenes: each kind in each place that takes one is decided, either by agreement with regular tracking or
//! by a refusal.

mod decisions;

use self::decisions::Decision::{self, Agrees, Refused};
use self::decisions::decisions;
use crate::common::{Outcome, fixture, harness};
use fairflight_harness::estimator::EstimatorSpec;
use fairflight_harness::spec::IntegratorSpec;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// A key of an integrator that takes an estimator.
#[derive(Clone, Copy, Debug)]
struct Place {
    integrator: &'static str,
    key: &'static str,
}

const PLACES: [Place; 9] = [
    Place { integrator: "transmittance", key: "estimator" },
    Place { integrator: "single_scattering", key: "estimator" },
    Place { integrator: "single_scattering", key: "shadow" },
    Place { integrator: "path_tracer", key: "estimator" },
    Place { integrator: "vpl", key: "estimator" },
    Place { integrator: "bidirectional", key: "estimator" },
    Place { integrator: "beam_radiance", key: "estimator" },
    Place { integrator: "metropolis", key: "estimator" },
    Place { integrator: "energy_redistribution", key: "estimator" },
];

impl Place {
    /// The decision here, which the camera's ray of single scattering alone makes for itself.
    fn decides(self, estimator: &Value, usual: Decision) -> Decision {
        const EVERY_DISTANCE: &str = "must be regular, double_particle, single_particle, line_integral or ray_marching for \
            single_scattering, which asks for transmittance at every distance";
        let takes = ["regular", "double_particle", "single_particle", "line_integral", "ray_marching"];
        match usual {
            Agrees if (self.integrator, self.key) != ("single_scattering", "estimator") => Agrees,
            Agrees if !takes.contains(&estimator["kind"].as_str().unwrap()) => {
                Refused("kind", EVERY_DISTANCE)
            }
            Agrees if estimator["control"]["kind"] == "constant" => {
                Refused("control.kind", "must be none or explorers for single_scattering")
            }
            usual => usual,
        }
    }

    /// Samples per pixel that tell half of the extinction from all of it: the light of four light paths is noisy, and so is that which one
    /// light path brings to a few pixels.
    fn samples(self) -> u32 {
        match self.integrator {
            "vpl" => 2000,
            "bidirectional" => 600,
            "beam_radiance" => 1200,
            "metropolis" => 6000,
            "energy_redistribution" => 800,
            _ => 120,
        }
    }

    fn integrator(self, estimator: &Value) -> Value {
        let mut integrator = match self.integrator {
            "transmittance" => json!({}),
            "single_scattering" => {
                json!({ "sampling": "attenuation", "samples_per_ray": 1, "estimator": { "kind": "double_particle", "sigma_samp": 1 } })
            }
            "path_tracer" | "bidirectional" => json!({ "max_vertices": 3 }),
            "vpl" => json!({ "light_paths": 4, "clamp": 1 }),
            // So many replicas that their mean is next to normal.
            "metropolis" => json!({ "space": "primary", "over": "path_tracer", "replicas": 100 }),
            "energy_redistribution" => {
                json!({ "space": "primary", "over": "path_tracer", "replicas": 100, "chain_length": 3 })
            }
            "beam_radiance" => json!({ "photons": 100, "radius": 0.5, "max_vertices": 3 }),
            other => panic!("{other}"),
        };
        if self.key == "estimator" && self.integrator == "single_scattering" && estimator["kind"] == "regular"
        {
            integrator["sampling"] = json!("source");
        }
        integrator["kind"] = json!(self.integrator);
        integrator[self.key] = estimator.clone();
        integrator
    }
}

/// Voxels of which some boxes are dense, all in colour where paths meet them.
fn scene(integrator: &Value, samples: u32, seed: u32) -> Value {
    let albedo = if integrator["kind"] == "path_tracer" { json!([0.9, 0.6, 0.3]) } else { json!(0.8) };
    json!({
        "camera": { "origin": [0.5, 0.4, -3], "look_at": [0, 0, 7], "up": [0, 1, 0], "vertical_fov_degrees": 16, "resolution": [5, 4] },
        "medium": { "kind": "vdb", "file": fixture("eq21_64.vdb"), "scale": 0.5, "albedo": albedo, "phase": { "kind": "isotropic" },
            "bounds": { "box": { "min": [-1, -1, 5], "max": [1, 1, 9] } } },
        "lights": [{ "kind": "environment", "radiance": 1 }, { "kind": "point", "position": [3, 2, 4], "power": 60 }],
        "integrator": integrator, "samples_per_pixel": samples, "seed": seed
    })
}

fn render(scene: &Value, arguments: &[&str]) -> (Outcome, Option<Value>) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("image.json");
    let mut words = vec!["render", "-", "--out", out.to_str().unwrap()];
    words.extend(arguments);
    let outcome = harness(&words, &scene.to_string());
    let statistics = std::fs::read_to_string(&out).ok().map(|text| serde_json::from_str(&text).unwrap());
    (outcome, statistics)
}

#[track_caller]
fn rendered(scene: &Value) -> Value {
    let (outcome, statistics) = render(scene, &[]);
    assert_eq!(outcome.code, 0, "{scene}\n{}", outcome.stderr);
    statistics.expect("statistics are written")
}

/// The reason of a refusal.
#[track_caller]
fn refusal(scene: &Value) -> String {
    let (outcome, statistics) = render(scene, &[]);
    assert_eq!((outcome.code, statistics), (2, None), "{scene}\n{}", outcome.stderr);
    outcome.stderr.trim_end().strip_prefix("refused: standard input: ").expect("a refusal").to_owned()
}

fn mean(statistics: &Value) -> (f64, f64) {
    let number = |key: &str| statistics["radiance"][key].as_f64().expect(key);
    (number("mean"), number("standard_error"))
}

/// Standard errors by which means may differ: a false alarm in 10⁷ for each of about 400 pictures, by the normal law.
const LEVEL: f64 = 5.3;

#[test]
fn every_kind_is_decided_in_every_place_that_takes_one() {
    let kinds: BTreeSet<String> =
        decisions().iter().map(|(estimator, _)| estimator["kind"].as_str().unwrap().to_owned()).collect();
    assert_eq!(kinds, EstimatorSpec::NAMES.iter().map(|name| (*name).to_owned()).collect());
    let listed: Vec<(&str, &str)> = IntegratorSpec::listed()
        .iter()
        .flat_map(|kind| kind.keys.iter().map(|key| (kind.name, key.name)))
        .filter(|(_, key)| ["estimator", "shadow"].contains(key))
        .collect();
    let known: BTreeSet<_> = PLACES.iter().map(|place| (place.integrator, place.key)).collect();
    assert_eq!(listed.into_iter().collect::<BTreeSet<_>>(), known);
}

/// The wrong twin of the agreement below: the same number of samples in a medium of half the extinction is rejected in every place.
#[test]
fn pictures_of_another_medium_do_not_agree() {
    for place in PLACES {
        let takes_cells = (place.integrator, place.key) != ("single_scattering", "estimator");
        let estimator = if takes_cells {
            json!({ "kind": "residual_cells", "cells": 8 })
        } else {
            json!({ "kind": "double_particle", "sigma_samp": 1 })
        };
        let regular =
            scene(&place.integrator(&json!({ "kind": "regular" })), 1000.max(2 * place.samples()), 77);
        let (expected, error_of_expected) = mean(&rendered(&regular));
        let mut thinner = scene(&place.integrator(&estimator), place.samples(), 1);
        thinner["medium"]["scale"] = json!(0.25);
        let (found, error) = mean(&rendered(&thinner));
        let z = (found - expected) / error.hypot(error_of_expected);
        assert!(z.abs() > LEVEL, "{place:?}: {found} +- {error} agrees with {expected}, z = {z}");
    }
}

#[test]
fn pictures_agree_with_regular_tracking_or_the_refusal_says_why() {
    for place in PLACES {
        let regular = rendered(&scene(
            &place.integrator(&json!({ "kind": "regular" })),
            1000.max(2 * place.samples()),
            77,
        ));
        let (expected, error_of_expected) = mean(&regular);
        for (estimator, usual) in decisions() {
            let integrator = place.integrator(&estimator);
            match place.decides(&estimator, usual) {
                Refused(key, reason) => {
                    let found = refusal(&scene(&integrator, 1, 1));
                    assert_eq!(found, format!("integrator.{}.{key}: {reason}", place.key));
                }
                Agrees => {
                    for seed in 1..=2 {
                        let statistics = rendered(&scene(&integrator, place.samples(), seed));
                        let (found, error) = mean(&statistics);
                        let z = (found - expected) / error.hypot(error_of_expected);
                        assert!(
                            z.abs() < LEVEL && error > 0.0,
                            "{integrator}, seed {seed}: {found} +- {error}, {expected} expected, z = {z}"
                        );
                        let baseline = ["ray_marching", "jackknife", "naive"]
                            .iter()
                            .any(|kind| estimator["kind"] == *kind);
                        let warned = statistics["warnings"].to_string().contains("a biased baseline");
                        assert_eq!(warned, baseline, "{integrator}: {}", statistics["warnings"]);
                    }
                }
            }
        }
    }
}

/// Estimators that learn from rays of the scene, and those that are bounded by a grid.
fn prepared() -> [Value; 4] {
    [
        json!({ "kind": "hybrid" }),
        json!({ "kind": "unbiased_ray_marching", "roulette": "self_tuned" }),
        json!({ "kind": "residual_cells", "cells": 8 }),
        json!({ "kind": "jittered_ratio", "cells": 8, "epsilon": 0.5 }),
    ]
}

#[test]
fn what_is_prepared_for_a_scene_does_not_depend_on_threads_and_is_stated() {
    for (estimator, purpose) in prepared().iter().zip([
        "for the choice, by pilots on 16 rays of the scene",
        "from 32 draws on 16 rays of the scene",
        "for bounds of the medium in 4 x 4 x 8 boxes",
        "for bounds of the medium in 4 x 4 x 8 boxes",
    ]) {
        let integrator = json!({ "kind": "path_tracer", "estimator": estimator });
        let [(_, one), (_, three)] =
            ["1", "3"].map(|threads| render(&scene(&integrator, 2, 1), &["--threads", threads]));
        let [one, three] = [one, three].map(Option::unwrap);
        assert_eq!(one["radiance"], three["radiance"], "{estimator}");
        let method = one["method"].as_str().unwrap();
        assert!(method.contains(purpose) && method.contains("before the first pixel"), "{method}");
        // The seed of the image has no part in it.
        let other = rendered(&scene(&integrator, 2, 2));
        assert_eq!(other["method"], one["method"]);
    }
    let plain = rendered(&scene(&json!({ "kind": "path_tracer" }), 1, 1));
    assert!(!plain["method"].as_str().unwrap().contains("before the first pixel"));
}

#[test]
fn a_majorant_is_taken_from_the_medium_and_one_that_is_given_is_honoured() {
    let with = |majorant: Option<f64>| {
        let mut estimator = json!({ "kind": "jittered_ratio", "epsilon": 0.5 });
        if let Some(majorant) = majorant {
            estimator["majorant"] = json!(majorant);
        }
        let mut scene = scene(&json!({ "kind": "transmittance", "estimator": estimator }), 4, 1);
        scene["medium"] = json!({ "kind": "expression", "sigma_t": "0.3 + 0.1*x", "majorant": 0.4, "albedo": 0.8,
            "phase": { "kind": "isotropic" }, "bounds": { "box": { "min": [-1, -1, 5], "max": [1, 1, 9] } } });
        scene
    };
    let [from_medium, same, twice] = [None, Some(0.4), Some(0.8)].map(|majorant| rendered(&with(majorant)));
    assert_eq!(
        (&from_medium["radiance"], &from_medium["cost"]["lookups"]),
        (&same["radiance"], &same["cost"]["lookups"])
    );
    let lookups = |statistics: &Value| statistics["cost"]["lookups"].as_u64().unwrap();
    assert!(lookups(&twice) > lookups(&same) * 3 / 2);
    assert!(refusal(&with(Some(0.2))).contains(": integrator.estimator: not defined for sigma_t = 0."));
    for (key, estimator) in [
        ("majorant", json!({ "kind": "jittered_ratio", "epsilon": 0.5 })),
        ("majorant", json!({ "kind": "hybrid" })),
        ("pivot", json!({ "kind": "p_series", "version": "cmf" })),
        ("teeth", json!({ "kind": "unbiased_ray_marching" })),
    ] {
        let mut scene = with(None);
        scene["medium"].as_object_mut().unwrap().remove("majorant");
        scene["integrator"]["estimator"] = estimator;
        assert_eq!(
            refusal(&scene),
            format!(
                "integrator.estimator.{key}: this key is missing, and the medium declares no majorant that could stand for it"
            )
        );
    }
}

#[test]
fn media_without_bounds_in_boxes_and_slips_of_the_keyboard_are_refused() {
    let instead = "use jittered_ratio with a majorant, or unbiased_ray_marching with teeth";
    let bounds = json!({ "box": { "min": [-1, -1, 5], "max": [1, 1, 9] } });
    let cells = |cells: u32| json!({ "kind": "residual_cells", "cells": cells });
    let with = |medium: Value, estimator: Value| {
        let mut scene = scene(&json!({ "kind": "transmittance", "estimator": estimator }), 1, 1);
        scene["medium"] = medium;
        scene["medium"]["bounds"] = bounds.clone();
        scene["medium"]["albedo"] = json!(0.5);
        scene["medium"]["phase"] = json!({ "kind": "isotropic" });
        refusal(&scene)
    };
    let voxels = json!({ "kind": "vdb", "file": fixture("eq21_64.vdb") });
    assert_eq!(
        with(json!({ "kind": "perlin" }), cells(4)),
        format!("integrator.estimator.cells: Perlin noise does not know its bounds in boxes; {instead}")
    );
    assert_eq!(
        with(json!({ "kind": "expression", "sigma_t": "1/x^2" }), cells(4)),
        format!("integrator.estimator.cells: no bounds of sigma_t are found in some of the boxes; {instead}")
    );
    assert_eq!(
        with(voxels.clone(), cells(257)),
        "integrator.estimator.cells: must be at most 256 boxes along an edge, found 257"
    );
    assert_eq!(
        with(json!({ "kind": "expression", "sigma_t": "x^2" }), cells(33)),
        "integrator.estimator.cells: must be at most 32 boxes along an edge, found 33"
    );
    for (key, estimator) in [
        ("integrator.estimator.majorant", json!({ "kind": "hybrid", "majorant": 1e12 })),
        (
            "integrator.estimator",
            json!({ "kind": "unbiased_ray_marching", "teeth": 1_000_000, "segments": 1000, "roulette": "self_tuned" }),
        ),
    ] {
        let found = with(voxels.clone(), estimator);
        assert!(
            found.starts_with(&format!("{key}: takes ")) && found.contains("before the first pixel"),
            "{found}"
        );
    }
}

#[test]
fn scenes_without_a_medium_and_rays_that_miss_it_see_all_of_the_light() {
    let accepted = decisions().into_iter().filter(|(_, decision)| matches!(decision, Agrees));
    let vacuum = |estimator: &Value| {
        let mut scene = scene(&json!({ "kind": "path_tracer", "estimator": estimator }), 2, 1);
        scene.as_object_mut().unwrap().remove("medium");
        scene["surfaces"] = json!([{ "kind": "rectangle", "corner": [-3, -1.6, 4], "edge_u": [6, 0, 0], "edge_v": [0, 0, 6],
            "material": { "kind": "diffuse", "reflectance": 0.6 } }]);
        rendered(&scene)
    };
    let regular = vacuum(&json!({ "kind": "regular" }));
    for (estimator, _) in accepted {
        assert_eq!(vacuum(&estimator)["radiance"], regular["radiance"], "{estimator}");
        let mut away = scene(&json!({ "kind": "transmittance", "estimator": estimator }), 2, 1);
        away["camera"]["look_at"] = json!([0, 0, -50]);
        let statistics = rendered(&away);
        assert_eq!((mean(&statistics).0, &statistics["cost"]["lookups"]), (1.0, &json!(0)), "{estimator}");
    }
}
