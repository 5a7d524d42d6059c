//! Results state the spec that they come from: every recorded command can be run again.

use crate::common::{fixture, harness};
use crate::render::scene;
use serde_json::{Value, json};
use std::path::Path;

const EXPERIMENT: &str = r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1.5e0 },
    "estimator": { "kind": "double_particle", "sigma_samp": 2 }, "samples": 3000, "seed": 1 }"#;
/// `printf '%s' EXPERIMENT | sha256sum`
const DIGEST: &str = "ef2d050548b2223aaa094994147cac2c5cf88565d07e54d94504cde1a1ac0f42";

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Runs the command of a result again, with the spec of the result on standard input.
fn again(provenance: &Value) -> Value {
    let command = provenance["command"].as_str().expect("a command");
    let words: Vec<&str> = command.split(' ').skip(1).collect();
    let outcome = harness(&words, &provenance["spec"].to_string());
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    parsed(&outcome.stdout)
}

#[test]
fn an_experiment_from_standard_input_can_be_run_again() {
    let outcome = harness(&["estimate", "-", "--samples", "2000"], EXPERIMENT);
    let result = parsed(&outcome.stdout);
    let provenance = &result["provenance"];
    let keys: Vec<&String> = provenance.as_object().expect("an object").keys().collect();
    assert_eq!(keys, ["seed", "revision", "command", "spec", "spec_sha256"]);
    // As it was given: the samples of the command line stand in the command.
    assert_eq!(provenance["spec"], parsed(EXPERIMENT));
    assert_eq!(provenance["spec_sha256"], DIGEST);
    assert_eq!(again(provenance)["estimate"], result["estimate"]);
}

#[test]
fn every_point_of_a_sweep_states_the_whole() {
    let mut spec = parsed(EXPERIMENT);
    spec["sweep"] = json!({ "path": "estimator.sigma_samp", "values": [1.5, 2.5] });
    let outcome = harness(&["estimate", "-"], &spec.to_string());
    let result = parsed(&outcome.stdout);
    for point in 0..2 {
        let provenance = &result["points"][point]["provenance"];
        assert_eq!(provenance["spec"], spec);
        assert_eq!(again(provenance)["points"][point]["estimate"], result["points"][point]["estimate"]);
    }
}

#[test]
fn images_and_advice_state_what_they_were_made_from() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("image.json");
    let read = |path: &Path| parsed(&std::fs::read_to_string(path).unwrap());
    let path = out.to_str().unwrap();
    assert_eq!(harness(&["render", "-", "--out", path], &scene().to_string()).code, 0);
    let first = read(&out);
    assert_eq!(first["provenance"]["spec"], scene());
    let words: Vec<&str> = first["provenance"]["command"].as_str().unwrap().split(' ').skip(1).collect();
    assert_eq!(harness(&words, &first["provenance"]["spec"].to_string()).code, 0);
    assert_eq!(read(&out)["radiance"], first["radiance"]);

    let medium = r#"{ "kind": "homogeneous", "sigma_t": 2, "bounds": { "sphere": { "center": [0, 0, 0], "radius": 1 } } }"#;
    let advice = parsed(&harness(&["advise", "-", "--rays", "4"], medium).stdout);
    assert_eq!(advice["provenance"]["spec"], parsed(medium));
    // Without a spec the command says all.
    let volume = harness(&["advise", "--vdb", &fixture("eq21_64.vdb"), "--rays", "4"], "");
    let provenance = &parsed(&volume.stdout)["provenance"];
    assert!(provenance.is_object() && provenance.get("spec").is_none(), "{provenance}");
}
