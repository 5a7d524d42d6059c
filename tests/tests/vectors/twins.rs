//! Wrong twins of the catalogue, put to the vectors of what they are twins of.

use crate::case::put;
use crate::lines;
use fairflight_catalogue::twins;
use fairflight_catalogue::vectors::Answer;
use fairflight_tests::repository;
use fairflight_vectors::{Precision, judge};
use serde_json::{Value, json};
use std::fs;

const CHAINS: &str = "a law of chains: a state depends on all mutations before it";
const PATHS: &str = "a law of paths through a scene; weights from densities are in path_weights";
const WALKS: &str = "a law of an integrator, of which each walk and each distance is right";
const CANDIDATES: &str = "a law of an integrator whose candidates come from a scene";
const FORMULA: &str =
    "the estimator is right, only the closed form of its variance is wrong: no estimate shows it";

/// Reasons why twins have no vectors, by what they are twins of or by their own name.
const UNSEEN: [(&str, &str); 18] = [
    ("variance_of_the_whole_extinction", FORMULA),
    ("variance_of_delta_without_ends", FORMULA),
    ("directions of an environment map", "a map is no part of a walk"),
    (
        "free flight by inversion, halton points",
        "a law of point sets over replicas, of which each flight is right",
    ),
    ("attenuation-driven sampling", WALKS),
    ("MIS of attenuation and source", WALKS),
    ("importons", WALKS),
    ("guided directions", CANDIDATES),
    ("resampled directions", CANDIDATES),
    ("resampled light points", CANDIDATES),
    (
        "compensation",
        "a law of an integrator; its distances and bounds are in truncated_exponential and bounded_connection",
    ),
    ("weights of strategies", PATHS),
    ("bidirectional path tracing", PATHS),
    ("pairs of strategies", PATHS),
    ("start of chains", CHAINS),
    ("noise-aware chains", CHAINS),
    ("population Monte Carlo", CHAINS),
    ("energy redistribution", CHAINS),
];

/// The answer of a twin to a case as a port prints it; `None` of cases that it has no parameters for.
fn answered(case: &Value, twin: &fairflight_catalogue::Twin) -> Option<Value> {
    let mut said = json!({ "id": case["id"] });
    let answer = put(
        case,
        |vector, source| twin.answer(vector, source),
        |_, source, field| {
            said["draws"] = json!(source.drawn());
            if let Some(field) = field {
                let lookups = field.lookups();
                said["lookups"] = json!(lookups.len());
                said["s"] = json!(lookups);
            }
        },
    );
    let Answer { values, collided } = answer?;
    said["value"] = json!(values);
    if let Some(collided) = collided {
        said["event"] = json!(if collided { "collided" } else { "escaped" });
    }
    Some(said)
}

/// The row of a twin: the kind that sees it most, its cases that fail, and if only ties do.
fn row(twin: &fairflight_catalogue::Twin, files: &[(String, Vec<Value>)]) -> String {
    let counted = files.iter().map(|(kind, cases)| {
        let answered = cases.iter().filter_map(|case| Some((case, answered(case, twin)?)));
        let (mut all, mut failed, mut drawn) = (0, 0, 0);
        for (case, said) in answered {
            all += 1;
            if judge(case, &said, Precision::Binary64).is_err() {
                failed += 1;
                let flags = case["flags"].as_array().unwrap();
                drawn += usize::from(!flags.iter().any(|flag| flag == "tie" || flag == "extreme"));
            }
        }
        (kind, all, failed, drawn)
    });
    let (kind, all, failed, drawn) = counted.max_by_key(|(_, _, failed, _)| *failed).unwrap();
    let by = if drawn == 0 { "ties only" } else { "drawn cases" };
    format!("| {} | {kind} | {failed} of {all} | {by} |", twin.id)
}

/// Every wrong twin of what has vectors fails them; docs/porting/mistakes.md says by how many cases, and why there are none for the others.
#[test]
fn every_twin_fails_the_vectors_of_its_estimator() {
    let page = fs::read_to_string(repository().join("docs/porting/mistakes.md")).unwrap();
    let files = lines();
    let (mut lacking, mut unreasoned) = (Vec::new(), Vec::new());
    for twin in twins() {
        let row = if twin.has_vectors() {
            row(&twin, &files)
        } else {
            let names = |&(name, _): &(&str, &str)| name == twin.of || name == twin.id;
            let Some((_, reason)) = UNSEEN.into_iter().find(names) else {
                unreasoned.push(twin.id);
                continue;
            };
            format!("| {} | {} | {reason} |", twin.id, twin.of)
        };
        if row.contains("| 0 of") || !page.contains(&row) {
            lacking.push(row);
        }
    }
    assert!(unreasoned.is_empty(), "no vectors, and no reason for it: {unreasoned:?}");
    assert!(lacking.is_empty(), "docs/porting/mistakes.md lacks\n{}", lacking.join("\n"));
}
