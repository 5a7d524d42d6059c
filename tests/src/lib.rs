//! Tests over the crates; see the files under `tests/`.
//!
//! Here is what they share: the family of all checks, and where the repository is.

use fairflight_catalogue::{Check, Effort, catalogue, check_level};
use fairflight_laws::CheckResult;
use std::path::PathBuf;

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

/// The code of the README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
