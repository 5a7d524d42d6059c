//! Test vectors, and programs that are held to them.

use crate::common::harness;
use boon::{Compiler, Schemas};
use serde_json::Value;
use std::path::PathBuf;

#[test]
fn vectors_are_written_for_the_kinds_that_are_asked_for() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("vectors");
    let outcome = harness(&["vectors", "woodcock", "--out", folder.to_str().unwrap()], "");
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    let written = std::fs::read_to_string(folder.join("woodcock.jsonl")).unwrap();
    assert_eq!(written, include_str!("../../../../tests/vectors/woodcock.jsonl"));
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn kinds_without_vectors_are_refused() {
    let outcome = harness(&["vectors", "woodcok", "--out", "nowhere"], "");
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("found woodcok (did you mean woodcock?)"), "{}", outcome.stderr);
    assert!(!std::path::Path::new("nowhere").exists());
    assert_eq!(harness(&["check-port", "--kinds", "hybrid", "true"], "").code, 2);
}

#[test]
fn every_committed_line_keeps_the_schema() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/vectors");
    let text = std::fs::read_to_string(folder.join("schema.json")).unwrap();
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource("schema.json", serde_json::from_str(&text).unwrap()).unwrap();
    let [header, case] = ["header", "case"]
        .map(|name| compiler.compile(&format!("schema.json#/$defs/{name}"), &mut schemas).unwrap());
    let mut files = 0;
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.extension().is_none_or(|extension| extension != "jsonl") {
            continue;
        }
        files += 1;
        for (number, line) in std::fs::read_to_string(&path).unwrap().lines().enumerate() {
            let value: Value = serde_json::from_str(line).unwrap();
            let kept = schemas.validate(&value, if number == 0 { header } else { case });
            assert!(kept.is_ok(), "{}, line {}: {:#}", path.display(), number + 1, kept.unwrap_err());
        }
    }
    assert_eq!(files, fairflight_vectors::KINDS.len());
}

#[cfg(unix)]
#[test]
fn statistics_that_are_wrong_are_told() {
    let says = r#"s/.*"id":"\([^"]*\)".*/{"id":"\1","mean":1,"variance":1,"lookups":1}/"#;
    let asked = ["check-port", "--kinds", "generalised_poisson", "--statistics", "10000", "sed", "-u", says];
    let outcome = harness(&asked, "");
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    assert!(outcome.stdout.contains("2 sets of 10000 estimates, 2 WRONG"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("8-4/statistics: the mean is 1, expected 0.0125"), "{}", outcome.stdout);
}

#[cfg(unix)]
#[test]
fn programs_that_do_not_answer_are_told_apart_from_wrong_ones() {
    let said = |command: &[&str]| {
        let arguments = [&["check-port", "--kinds", "woodcock"], command].concat();
        let outcome = harness(&arguments, "");
        (outcome.code, outcome.stdout + &outcome.stderr)
    };
    for (command, code, word) in [
        (&["/nowhere/at-all"][..], 2, "cannot start"),
        // Ends before it is asked, or before it has read.
        (&["true"], 2, "asked woodcock/smoke/0000"),
        (&["sh", "-c", "while read -r line; do echo no; done"], 2, "is no JSON"),
        (&["sh", "-c", "while read -r line; do echo '{\"id\":\"x\"}'; done"], 2, "another id"),
        // Hands the case back, which has no values.
        (&["cat"], 1, "no readable `lookups`"),
    ] {
        let (found, text) = said(command);
        assert_eq!(found, code, "{command:?}: {text}");
        assert!(text.contains(word), "{command:?}: {text}");
    }
}
