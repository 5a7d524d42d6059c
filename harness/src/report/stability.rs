//! The stability table: the hard cases, run.

use super::result::StabilityRow;
use fairflight_catalogue::hard_cases;
use fairflight_laws::Run;
use fairflight_sources::derive_seed;
use fairflight_stats::sidak_level;
use rayon::prelude::*;

/// False alarm of the whole table.
const FAMILY_LEVEL: f64 = 1e-6;

/// Runs every hard case that concerns transmittance.
#[must_use]
pub(super) fn stability(seed: u64) -> Vec<StabilityRow> {
    let cases = hard_cases();
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
