//! The stability table: the hard cases, run.

use super::standard::StabilityRow;
use fairflight_catalogue::{HardCase, hard_cases};
use fairflight_harness::parallel::in_parallel;
use fairflight_laws::Run;
use fairflight_sources::named_seed;
use fairflight_stats::sidak_level;

/// False alarm of the whole table.
const FAMILY_LEVEL: f64 = 1e-6;

/// Runs every hard case that concerns transmittance.
#[must_use]
pub(super) fn stability(seed: u64) -> Vec<StabilityRow> {
    // Those of the table of kinds are for `verify`: a row each would be a report of its own.
    let cases: Vec<HardCase> = hard_cases().into_iter().filter(|case| !case.of_table).collect();
    let alpha = sidak_level(FAMILY_LEVEL, cases.len());
    in_parallel(cases.len(), &|i| {
        let case = &cases[i];
        let name = format!("{} ({})", case.title, case.estimator);
        let seed = named_seed(seed, &format!("report/standard/stability/{name}"));
        let outcome = case.run(Run { samples: case.samples, seed, alpha });
        StabilityRow {
            number: case.number,
            case: name,
            exact: case.exact.clone(),
            ours: outcome.ours,
            passes: outcome.passes,
        }
    })
}
