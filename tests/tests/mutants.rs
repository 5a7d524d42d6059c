//! The scale faults of `tests/mutants` still meet the code: each names one line, and changes it.

use fairflight_tests::repository;
use std::collections::BTreeSet;
use std::fs;

/// The literal string of a key in one block of the list.
fn value<'t>(block: &'t str, key: &str) -> Option<&'t str> {
    let line = block.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = '"))?;
    line.strip_suffix('\'')
}

#[test]
fn every_scale_fault_changes_one_line() {
    let list = fs::read_to_string(repository().join("tests/mutants/scale-faults.toml")).unwrap();
    let mut names = BTreeSet::new();
    for block in list.split("[[fault]]").skip(1) {
        let [name, file, line, with, _breaks] =
            ["name", "file", "line", "with", "breaks"].map(|key| value(block, key).expect(block));
        let code = fs::read_to_string(repository().join(file)).expect(file);
        let places = code.lines().filter(|found| found.contains(line)).count();
        assert_eq!(places, 1, "{name}: `{line}` in {file}");
        assert!(line != with && names.insert(name), "{name}");
    }
    assert!(names.len() >= 60, "{}", names.len());
}
