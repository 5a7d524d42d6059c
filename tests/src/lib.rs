//! Tests over the crates; see the files under `tests/`.
//!
//! Here is what they share: the family of all checks, and the files of the repository.

use fairflight_catalogue::{Check, Effort, catalogue, check_level};
use fairflight_laws::CheckResult;
use std::fs;
use std::path::{Path, PathBuf};

/// The seed of every statistical test. Never changed to make one pass.
pub const SEED: u64 = 1;

/// Runs the checks that `wanted` picks, at their share of the family's false alarm.
pub fn run_checks(wanted: impl Fn(&Check) -> bool) -> Vec<(Check, CheckResult)> {
    let run = |check: Check| {
        let result = check.run(Effort::Quick, SEED, check_level());
        (check, result)
    };
    catalogue().into_iter().filter(wanted).map(run).collect()
}

/// The root of the repository.
#[must_use]
pub fn repository() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), ".."].iter().collect()
}

/// All files below a folder of the repository, build outputs apart; none where it does not exist.
#[must_use]
pub fn files(folder: &str) -> Vec<PathBuf> {
    fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir() {
                if name != "target" && name != ".git" {
                    collect(&path, found);
                }
            } else {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    collect(&repository().join(folder), &mut found);
    found.sort();
    found
}

/// Manifests of the packages below a folder, those with a workspace of their own apart.
///
/// # Panics
/// If one cannot be read.
#[must_use]
pub fn members(folder: &str) -> Vec<PathBuf> {
    let is_alone =
        |path: &PathBuf| fs::read_to_string(path).unwrap().lines().any(|line| line == "[workspace]");
    let manifests = files(folder).into_iter().filter(|path| path.ends_with("Cargo.toml"));
    manifests.filter(|path| !is_alone(path)).collect()
}

/// True if the name of a file ends with one of these extensions.
#[must_use]
pub fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|found| extensions.iter().any(|extension| found == *extension))
}

/// The Rust files below a folder of the repository with their texts.
///
/// # Panics
/// If one cannot be read.
#[must_use]
pub fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let is_source = |path: &PathBuf| has_extension(path, &["rs"]);
    files(folder)
        .into_iter()
        .filter(is_source)
        .map(|path| (path.clone(), fs::read_to_string(&path).unwrap()))
        .collect()
}

/// The code of the README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
