//! The committed test vectors: what another implementation made of given variates, replayed by the estimators.

mod case;
mod replay;
mod statistics;
mod twins;

use case::{numbers, put};
use fairflight_tests::repository;
use serde_json::Value;
use std::fs;

/// Replays a case; true if every bit is that of the case, else a fault, if there is one.
fn replayed(case: &Value) -> Result<bool, String> {
    let expect = &case["expect"];
    let is_exact = case["tolerance"]["exponentials_given"]["binary64"] == 0;
    let mut fault = None;
    let answer = put(
        case,
        |vector, source| replay::answer(case, vector, source),
        |answer, source, field| {
            let event = answer.collided.map(|collided| if collided { "collided" } else { "escaped" });
            if !source.is_used_up() {
                fault = Some(format!("{} variates, or others", source.drawn()));
            } else if event != expect["event"].as_str() {
                fault = Some(format!("{event:?}"));
            }
            let Some(field) = field else { return };
            let trace = case["trace"].as_array().unwrap().iter().map(|step| step[0].as_f64().unwrap());
            let granted = case["tolerance"]["binary64"]["s"].as_f64().filter(|_| !is_exact).unwrap_or(0.0);
            let found = field.lookups();
            let elsewhere = |(found, expected): (&f64, f64)| (found - expected).abs() > granted;
            if found.len() as u64 != expect["lookups"] || found.iter().zip(trace).any(elsewhere) {
                fault = Some(format!("looked up {found:?}"));
            }
        },
    );
    let (values, expected) = (answer.values, numbers(&expect["value"]));
    let granted = numbers(&case["tolerance"]["binary64"]["value"]);
    let granted = granted.iter().map(|granted| if is_exact { 0.0 } else { *granted });
    let mut pairs = values.iter().zip(&expected).zip(granted);
    if values.len() != expected.len()
        || pairs.any(|((found, expected), granted)| (found - expected).abs() > granted)
    {
        fault = Some(format!("{values:?} for {expected:?}"));
    }
    fault.map_or(Ok(values == expected), |fault| Err(format!("{}: {fault}", case["id"])))
}

/// Kinds of which fewer answers than 99 % have all bits: a tangent, an angle, a logarithm, a cosine or a root comes in that no library rounds correctly.
const FEWER_BITS: [(&str, f64); 6] = [
    ("equiangular", 0.95),
    ("deflection", 0.5),
    ("inversion_flight", 0.8),
    ("path_weights", 0.2),
    ("phase", 0.6),
    ("telescoping", 0.8),
];

/// Kinds and cases of all committed files.
fn lines() -> Vec<(String, Vec<Value>)> {
    let mut files = Vec::new();
    for path in fairflight_tests::files("tests/vectors") {
        if !fairflight_tests::has_extension(&path, &["jsonl"]) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let mut lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let header = lines.remove(0);
        assert_eq!(header["format"], "fairflight-vectors", "{}", path.display());
        files.push((header["kind"].as_str().unwrap().to_owned(), lines));
    }
    files
}

#[test]
fn estimators_replay_the_vectors() {
    let mut faults = Vec::new();
    let files = lines();
    for (kind, cases) in &files {
        let replays: Vec<_> = cases.iter().map(replayed).collect();
        let equal = replays.iter().filter(|replay| **replay == Ok(true)).count();
        println!("{kind}: {equal} of {} bit by bit", cases.len());
        let share = FEWER_BITS.iter().find(|(fewer, _)| kind == fewer).map_or(0.99, |(_, share)| *share);
        if (equal as f64) < share * cases.len() as f64 {
            faults.push(format!("{kind}: {equal} of {} bit by bit", cases.len()));
        }
        faults.extend(replays.into_iter().filter_map(Result::err));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert_eq!(files.len(), fairflight_vectors::KINDS.len());
}

/// Committed files are those that the generator writes.
#[test]
fn the_vectors_are_those_of_the_generator() {
    for kind in fairflight_vectors::KINDS {
        let path = repository().join(format!("tests/vectors/{}.jsonl", kind.name));
        let committed = fs::read_to_string(path).unwrap();
        let lines = kind.lines();
        assert_eq!(committed.lines().count(), lines.len(), "{}", kind.name);
        for (found, made) in committed.lines().zip(lines) {
            assert_eq!(found, made.to_string(), "{}: run `harness vectors --out tests/vectors`", kind.name);
        }
    }
}
