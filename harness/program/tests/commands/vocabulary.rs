//! `harness list`, `harness schema` and docs/SPEC.md hold what the reader takes.

use crate::common::harness;
use boon::{Compiler, Schemas};
use fairflight_catalogue::{Law, ROWS, SAMPLERS, catalogue, hard_cases, spared};
use fairflight_harness::estimator::EstimatorSpec;
use fairflight_harness::spec::IntegratorSpec;
use fairflight_harness::vocabulary::{schema, tables, things};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Validates values against the schema; the reason for each that does not keep it.
fn judge(values: &[(String, Value)]) -> Vec<(String, Result<(), String>)> {
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource("schema.json", schema()).expect("the schema is one");
    let index = compiler.compile("schema.json", &mut schemas).expect("the schema is one");
    values
        .iter()
        .map(|(name, value)| {
            (name.clone(), schemas.validate(value, index).map_err(|error| format!("{error:#}")))
        })
        .collect()
}

fn json_in(folder: &str) -> Vec<(String, Value)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(repository().join(folder)).expect(folder).flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path.display().to_string(), serde_json::from_str(&text).expect("JSON")));
        }
    }
    found
}

fn data(file: &str) -> Map<String, Value> {
    let text = fs::read_to_string(repository().join("tests/recordings").join(file)).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// All estimators on all profiles, and all integrators in a scene, that are refused for no key.
fn recorded() -> Vec<(String, Value)> {
    let (profiles, estimators) = (data("profiles.json"), data("estimators.json"));
    let mut found = Vec::new();
    for (name, estimator) in &estimators {
        let profile = &profiles["linear"];
        found.push((
            name.clone(),
            json!({ "profile": profile, "estimator": estimator, "samples": 1, "seed": 1 }),
        ));
    }
    for (name, profile) in &profiles {
        let estimator = &estimators["regular"];
        found.push((
            name.clone(),
            json!({ "profile": profile, "estimator": estimator, "samples": 1, "seed": 1 }),
        ));
    }
    let parts = data("scenes.json");
    let scene = |medium: &Value, lights: &Value, surfaces: &Value, integrator: &Value| {
        json!({ "camera": parts["camera"], "medium": medium, "lights": lights, "surfaces": surfaces,
            "integrator": integrator, "samples_per_pixel": 1, "seed": 1, "$schema": "./schema.json" })
    };
    let of = |thing: &str| parts[thing].as_object().unwrap();
    let [medium, lights, surfaces, integrator] = [
        &parts["media"]["ball"],
        &parts["lights"]["all"],
        &parts["surfaces"]["none"],
        &parts["integrators"]["paths"],
    ];
    for (name, other) in of("media") {
        found.push((name.clone(), scene(other, lights, surfaces, integrator)));
    }
    for (name, other) in of("lights") {
        found.push((name.clone(), scene(medium, other, surfaces, integrator)));
    }
    for (name, other) in of("surfaces") {
        found.push((name.clone(), scene(medium, lights, other, integrator)));
    }
    for (name, other) in of("integrators") {
        found.push((name.clone(), scene(medium, lights, surfaces, other)));
    }
    found
}

/// Parts of the list that the reader refuses for their form.
const MALFORMED: [&str; 4] = ["unknown", "unknown key", "clamp as a word", "unknown strategy"];

#[test]
fn the_schema_takes_every_example_and_every_recorded_input() {
    let mut values = json_in("docs/examples");
    values.extend(json_in("harness/scenes"));
    assert!(values.len() > 8);
    values.extend(recorded());
    for (name, verdict) in judge(&values) {
        let malformed = MALFORMED.contains(&name.as_str());
        assert_eq!(verdict.is_err(), malformed, "{name}: {verdict:?}");
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses() {
    let example: Value = json_in("docs/examples").swap_remove(0).1;
    let broken: Vec<(String, Value)> = [
        ("estimator", json!({ "kind": "ratio_tracking" })),
        ("estimator", json!({ "kind": "woodcock" })),
        ("estimator", json!({ "kind": "woodcock", "majorant": -1 })),
        ("estimator", json!({ "kind": "woodcock", "majorant": 1, "steps": 3 })),
        ("profile", json!({ "kind": "constant", "sigma_t": "much", "length": 1 })),
        ("unheard", json!(1)),
    ]
    .into_iter()
    .map(|(key, value)| {
        let mut spec = example.clone();
        spec[key] = value;
        (spec.to_string(), spec)
    })
    .collect();
    for (name, verdict) in judge(&broken) {
        assert!(verdict.is_err(), "{name}");
        assert_eq!(harness(&["estimate", "-"], &name).code, 2, "{name}");
    }
}

#[test]
fn a_scene_may_be_swept() {
    let mut scene: Value = serde_json::from_str(include_str!("../../../scenes/perlin.json")).unwrap();
    scene["sweep"] = json!({ "path": "integrator.sigma_samp", "values": [0.4, 0.8] });
    let mut broken = scene.clone();
    broken["sweep"]["paths"] = json!("");
    let verdicts = judge(&[(String::new(), scene), (String::new(), broken)]);
    assert!(verdicts[0].1.is_ok() && verdicts[1].1.is_err(), "{verdicts:?}");
}

#[test]
fn a_schema_may_be_named_in_the_file() {
    let mut spec: Value = json_in("docs/examples").swap_remove(0).1;
    spec["$schema"] = json!("https://example.org/schema.json");
    let outcome = harness(&["estimate", "-", "--samples", "100"], &spec.to_string());
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
}

#[test]
fn every_kind_is_listed_with_its_keys() {
    let list = harness(&["list"], "").stdout;
    for things in things() {
        assert!(list.lines().any(|line| line.starts_with(things.title)), "{}", things.title);
        for kind in things.kinds {
            assert!(list.contains(&format!(" {} ", kind.name)) || list.contains(kind.name), "{}", kind.name);
            assert!(kind.keys.iter().all(|key| list.contains(key.name)), "{}", kind.name);
            let ends = kind.about.ends_with('.') && kind.keys.iter().all(|key| key.about.ends_with('.'));
            assert!(ends, "{}: a sentence says what it is", kind.name);
        }
    }
}

#[test]
fn the_tables_of_the_documentation_are_those_of_the_program() {
    let text = fs::read_to_string(repository().join("docs/SPEC.md")).unwrap();
    let (begin, end) = ("<!-- harness schema --tables -->\n\n", "<!-- end -->");
    let found = text.split_once(begin).and_then(|(_, rest)| rest.split_once(end)).expect("both marks").0;
    assert!(found == tables(), "`harness schema --tables` prints other tables: put them between the marks");
}

/// Kinds of scenes and experiments, and samplers of distances.
fn registered() -> BTreeSet<&'static str> {
    EstimatorSpec::NAMES.iter().chain(IntegratorSpec::NAMES).copied().collect()
}

/// Samplers of free flights are no kind of a scene: they are those that the catalogue knows beside the registries, and a test over
/// their sources holds them to that.
fn checked() -> BTreeSet<&'static str> {
    catalogue().iter().flat_map(|check| check.kinds.iter().copied()).collect()
}

#[test]
fn every_kind_has_a_law_in_the_catalogue_and_every_name_there_is_a_kind() {
    let laws: BTreeSet<&str> = catalogue()
        .iter()
        .filter(|check| !matches!(check.law, Law::WrongTwin | Law::HardCase))
        .flat_map(|check| check.kinds.iter().copied())
        .collect();
    let without: Vec<&str> = registered().difference(&laws).copied().collect();
    assert!(without.is_empty(), "no law of {without:?}");
    let others: BTreeSet<&str> = checked().difference(&registered()).copied().collect();
    let samplers: BTreeSet<&str> = SAMPLERS.iter().copied().collect();
    assert_eq!(others, samplers, "names that are no kind, or samplers without a check");
}

#[test]
fn every_kind_is_put_through_every_hard_case_or_says_why_not() {
    let cases = hard_cases();
    for kind in registered().into_iter().chain(SAMPLERS.iter().copied()) {
        for (row, what) in ROWS {
            let is_run = cases.iter().any(|case| case.number == row && case.kinds.contains(&kind));
            let reason = spared(kind, row);
            assert!(is_run != reason.is_some(), "{kind}, row {row} ({what}): {is_run}, {reason:?}");
        }
    }
}
