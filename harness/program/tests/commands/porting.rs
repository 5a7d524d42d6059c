//! Test vectors, and programs that are held to them.

use crate::common::harness;

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
