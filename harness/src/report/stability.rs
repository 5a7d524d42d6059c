//! The stability table: the hard cases, run.

use super::result::StabilityRow;
use fairflight_catalogue::{HardCase, hard_cases};
use fairflight_laws::Run;
use fairflight_sources::derive_seed;
use fairflight_stats::sidak_level;
use rayon::prelude::*;

/// False alarm of the whole table.
const FAMILY_LEVEL: f64 = 1e-6;

/// Runs every hard case that concerns transmittance.
#[must_use]
pub(super) fn stability(seed: u64) -> Vec<StabilityRow> {
    // Those of the table of kinds are for `verify`: a row each would be a report of its own.
    let cases: Vec<HardCase> = hard_cases().into_iter().filter(|case| !case.of_table).collect();
    let alpha = sidak_level(FAMILY_LEVEL, cases.len());
    cases
        .par_iter()
        .enumerate()
        .map(|(index, case)| {
            let run = Run { samples: case.samples, seed: derive_seed(seed, index as u64), alpha };
            let outcome = case.run(run);
            StabilityRow {
                number: case.number,
                case: format!("{} ({})", case.title, case.estimator),
                exact: case.exact.clone(),
                ours: outcome.ours,
                passes: outcome.passes,
            }
        })
        .collect()
}
