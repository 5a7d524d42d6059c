//! Every sampler of distances on every medium, by the law that `harness verify` checks too.

use crate::parallel::in_parallel;
use crate::report::run::{Part, Run};
use fairflight_catalogue::{Check, Effort, catalogue};
use fairflight_document::{Cell, Section, Table};
use fairflight_laws::CheckResult;
use fairflight_stats::sidak_level;

/// False alarm of all checks together.
const FAMILY_LEVEL: f64 = 1e-6;

fn checks() -> Vec<Check> {
    catalogue().into_iter().filter(|check| check.id.starts_with("freeflight/")).collect()
}

pub(super) fn steps() -> u64 {
    checks().len() as u64
}

/// What the laws came to.
pub(super) struct Laws {
    pub(super) results: Vec<(String, CheckResult)>,
    pub(super) part: Part,
}

pub(super) fn study(run: &Run<'_>) -> Laws {
    let checks = checks();
    let alpha = sidak_level(FAMILY_LEVEL, checks.len());
    let effort = if run.options.quick { Effort::Quick } else { Effort::Full };
    let results = in_parallel(checks.len(), &|i| {
        let result = checks[i].run(effort, run.seed("laws"), alpha);
        run.advance();
        (checks[i].id.clone(), result)
    });
    let unsound = results
        .iter()
        .filter(|(_, result)| result.holds == Some(false))
        .map(|(id, result)| format!("{id}: {}", result.reason))
        .collect();
    let part = Part { section: section(&results), unsound };
    Laws { results, part }
}

fn section(results: &[(String, CheckResult)]) -> Section {
    let text = "Weighted flights integrate any test function against σ_t T, and those that escape weigh T on average. Four test functions and \
         the escaped weight are judged against quadrature, their variances against the closed form, the number of look-ups against its \
         law, and the distances of samplers without weights against their distribution (Kolmogorov and Smirnov). \"Detectable\" is the \
         smallest relative bias that the run would have found with probability 0.99; the false alarm of the whole table is below 10⁻⁶.";
    let table = Table::of(
        ["laws-table", "Laws of free flight", ""],
        results,
        &[
            ("medium and sampler", "", &|(id, _)| Cell::text(id.trim_start_matches("freeflight/"))),
            ("verdict", "", &|(_, result)| {
                Cell::text(match result.holds {
                    Some(true) => "holds",
                    Some(false) => "does not hold",
                    None => "not testable",
                })
            }),
            ("flights", "1", &|(_, result)| Cell::Count(result.samples)),
            ("largest z of a mean", "1", &|(_, result)| Cell::maybe(result.mean_z)),
            ("z of the look-ups", "1", &|(_, result)| Cell::maybe(result.lookups_z)),
            ("detectable", "1", &|(_, result)| Cell::maybe(result.detectable_relative_bias)),
        ],
    );
    Section::new("laws", "The law of every sampler").with(text).with(table)
}
