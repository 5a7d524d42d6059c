//! Every sampler of distances on every medium, by the law that `harness verify` checks too.

use crate::report::document::{Cell, Section, Table};
use crate::report::run::Run;
use fairflight_catalogue::{Check, Effort, catalogue};
use fairflight_laws::CheckResult;
use fairflight_stats::sidak_level;
use rayon::prelude::*;

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
    pub(super) section: Section,
    pub(super) unsound: Vec<String>,
}

pub(super) fn study(run: &Run<'_>) -> Laws {
    let checks = checks();
    let alpha = sidak_level(FAMILY_LEVEL, checks.len());
    let effort = if run.options.quick { Effort::Quick } else { Effort::Full };
    let results: Vec<(String, CheckResult)> = checks
        .par_iter()
        // One check a task: some take a hundred times as long as others.
        .with_max_len(1)
        .map(|check| {
            let result = check.run(effort, run.seed(1, 0), alpha);
            run.advance();
            (check.id.clone(), result)
        })
        .collect();
    let unsound = results
        .iter()
        .filter(|(_, result)| result.holds == Some(false))
        .map(|(id, result)| format!("{id}: {}", result.reason))
        .collect();
    let section = section(&results);
    Laws { results, section, unsound }
}

fn section(results: &[(String, CheckResult)]) -> Section {
    let mut section = Section::new("laws", "The law of every sampler");
    section.text = vec![
        "Weighted flights integrate any test function against σ_t T, and those that escape weigh T on average. Four test functions and \
         the escaped weight are judged against quadrature, their variances against the closed form, the number of look-ups against its \
         law, and the distances of samplers without weights against their distribution (Kolmogorov and Smirnov). \"Detectable\" is the \
         smallest relative bias that the run would have found with probability 0.99; the false alarm of the whole table is below 10⁻⁶."
            .to_owned(),
    ];
    let mut table = Table::new(
        "laws-table",
        "Laws of free flight",
        "",
        &[
            ("medium and sampler", ""),
            ("verdict", ""),
            ("flights", "1"),
            ("largest z of a mean", "1"),
            ("z of the look-ups", "1"),
            ("detectable", "1"),
        ],
    );
    for (id, result) in results {
        table.rows.push(vec![
            Cell::text(id.trim_start_matches("freeflight/")),
            Cell::text(match result.holds {
                Some(true) => "holds",
                Some(false) => "does not hold",
                None => "not testable",
            }),
            Cell::Count(result.samples),
            Cell::maybe(result.mean_z),
            Cell::maybe(result.lookups_z),
            Cell::maybe(result.detectable_relative_bias),
        ]);
    }
    section.tables = vec![table];
    section
}
