//! A part of the catalogue, run in a report.

use super::run::Run;
use fairflight_catalogue::{Check, Effort, catalogue};
use fairflight_harness::parallel::in_parallel;
use fairflight_laws::CheckResult;
use fairflight_stats::sidak_level;

/// False alarm of all checks together.
const FAMILY_LEVEL: f64 = 1e-6;

/// Results of the checks whose names begin alike, by their names.
pub(super) struct Laws(pub(super) Vec<(String, CheckResult)>);

impl Laws {
    fn checks(prefix: &str) -> Vec<Check> {
        catalogue().into_iter().filter(|check| check.id.starts_with(prefix)).collect()
    }

    /// Number of the checks.
    pub(super) fn steps(prefix: &str) -> u64 {
        Self::checks(prefix).len() as u64
    }

    /// Runs them.
    pub(super) fn study(run: &Run<'_>, prefix: &str) -> Self {
        let checks = Self::checks(prefix);
        let alpha = sidak_level(FAMILY_LEVEL, checks.len());
        let effort = run.quick_or(Effort::Quick, Effort::Full);
        Self(in_parallel(checks.len(), &|i| {
            let result = checks[i].run(effort, run.seed("laws"), alpha);
            run.advance();
            (checks[i].id.trim_start_matches(prefix).to_owned(), result)
        }))
    }

    /// Checks that do not hold, one sentence each.
    pub(super) fn unsound(&self) -> impl Iterator<Item = String> {
        let failed = self.0.iter().filter(|(_, result)| result.holds == Some(false));
        failed.map(|(id, result)| format!("{id}: {}", result.reason))
    }

    /// A verdict in words.
    pub(super) fn verdict(result: &CheckResult) -> &'static str {
        match result.holds {
            Some(true) => "holds",
            Some(false) => "does not hold",
            None => "not testable",
        }
    }
}
