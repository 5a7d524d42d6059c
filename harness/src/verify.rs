//! `harness verify`: every law over every estimator, medium and hard case.

use crate::cli::VerifyArguments;
use crate::{DONE, Environment, Failure, UNSOUND, interrupt};
use fairflight_laws::{Check, CheckResult, Effort, Kind, catalogue};
use fairflight_stats::sidak_level;
use rayon::prelude::*;
use std::fmt::Write as _;
use std::io::Write;

/// False alarm of a whole run: one in a million, whatever the number of checks.
const FAMILY_LEVEL: f64 = 1e-6;

pub(crate) fn run(
    arguments: &VerifyArguments,
    environment: &Environment,
    stdout: &mut dyn Write,
) -> Result<i32, Failure> {
    let all = catalogue();
    // The level is that of the whole catalogue also where a part of it is run: a check keeps its verdict.
    let alpha = sidak_level(FAMILY_LEVEL, all.len());
    let checks = select(all, arguments.estimator.as_deref())?;
    let effort = if arguments.quick { Effort::Quick } else { Effort::Full };
    let bar = environment.progress(checks.len() as u64, "verifying");
    let results: Vec<CheckResult> = environment.on_threads(arguments.threads, || {
        checks
            .par_iter()
            // One check a task: some take a thousand times as long as others.
            .with_max_len(1)
            .map(|check| {
                interrupt::check()?;
                let result = check.run(effort, arguments.seed, alpha);
                bar.inc(1);
                Ok(result)
            })
            .collect()
    })?;
    bar.finish_and_clear();
    let text = table(&checks, &results, alpha, environment, arguments.seed);
    stdout
        .write_all(text.as_bytes())
        .map_err(|error| Failure::NotWritten(format!("cannot write the result: {error}")))?;
    Ok(if results.iter().any(|result| result.holds == Some(false)) { UNSOUND } else { DONE })
}

/// The checks that are about this kind of estimator.
fn select(all: Vec<Check>, estimator: Option<&str>) -> Result<Vec<Check>, Failure> {
    let Some(name) = estimator else { return Ok(all) };
    let Some(kind) = Kind::ALL.into_iter().find(|kind| kind.name() == name) else {
        let names = Kind::ALL.map(Kind::name).join(", ");
        return Err(Failure::refused(format!("--estimator: must be one of {names}, found {name}")));
    };
    Ok(all.into_iter().filter(|check| check.kinds.contains(&kind)).collect())
}

fn table(
    checks: &[Check],
    results: &[CheckResult],
    alpha: f64,
    environment: &Environment,
    seed: u64,
) -> String {
    let width =
        |column: fn(&Check) -> &str| checks.iter().map(|c| column(c).chars().count()).max().unwrap_or(0);
    let id_width = width(|check| &check.id);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:id_width$}  {:12}  {:>9}  {:>7}  {:>7}  {:>7}  {:>10}",
        "check", "verdict", "samples", "mean z", "var. z", "cost z", "detectable"
    );
    for (check, result) in checks.iter().zip(results) {
        let verdict = match result.holds {
            Some(true) => "holds",
            Some(false) => "DOES NOT HOLD",
            None => "not testable",
        };
        let z = |z: Option<f64>| z.map_or_else(|| "-".to_owned(), |z| format!("{z:.2}"));
        let power =
            result.detectable_relative_bias.map_or_else(|| "-".to_owned(), |bias| format!("{bias:.1e}"));
        let _ = writeln!(
            text,
            "{:id_width$}  {verdict:12}  {:>9}  {:>7}  {:>7}  {:>7}  {power:>10}",
            check.id,
            result.samples,
            z(result.mean_z),
            z(result.variance_z),
            z(result.lookups_z),
        );
        if result.holds != Some(true) {
            let _ = writeln!(text, "    {}", result.reason);
        }
    }
    let count = |holds: Option<bool>| results.iter().filter(|result| result.holds == holds).count();
    let worst = results.iter().filter_map(|r| r.detectable_relative_bias).fold(0.0, f64::max);
    let mut powers: Vec<f64> = results.iter().filter_map(|result| result.detectable_relative_bias).collect();
    powers.sort_unstable_by(f64::total_cmp);
    let median = powers.get(powers.len() / 2).copied().unwrap_or(f64::NAN);
    let _ = writeln!(
        text,
        "\n{} checks: {} hold, {} do not hold, {} not testable at this N\n\
         false alarm of the whole catalogue below {FAMILY_LEVEL:e} ({alpha:.2e} per check); power: with probability 0.99 \
         a relative bias of {median:.1e} would have been found (median over the checks), {worst:.1e} in the least powerful\n\
         seed {seed}, revision {}, {}",
        checks.len(),
        count(Some(true)),
        count(Some(false)),
        count(None),
        environment.provenance(seed).revision,
        environment.command(),
    );
    text
}
