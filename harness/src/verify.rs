//! `harness verify`: every law over every estimator, medium and hard case.

use crate::cli::VerifyArguments;
use crate::estimator::EstimatorSpec;
use crate::reader::similar;
use crate::result::{Provenance, number};
use crate::spec::IntegratorSpec;
use crate::{DONE, Environment, Failure, UNSOUND, interrupt, print};
use fairflight_catalogue::{Check, Effort, FAMILY_LEVEL, FAMILY_SIZE, catalogue, check_level};
use fairflight_laws::CheckResult;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::Write;

/// Runs `harness verify`; returns the exit code.
///
/// # Errors
/// If there is no such kind, or the table cannot be printed.
pub fn run(
    arguments: &VerifyArguments,
    environment: &Environment,
    stdout: &mut dyn Write,
) -> Result<i32, Failure> {
    let checks = select(catalogue(), arguments.estimator.as_deref())?;
    let effort = if arguments.quick { Effort::Quick } else { Effort::Full };
    let bar = environment.progress(checks.len() as u64, "verifying");
    let results: Vec<CheckResult> = environment.on_threads(arguments.threads, || {
        checks
            .par_iter()
            // One check a task: some take a thousand times as long as others.
            .with_max_len(1)
            .map(|check| {
                interrupt::check()?;
                let result = check.run(effort, arguments.seed, check_level());
                bar.inc(1);
                Ok(result)
            })
            .collect()
    })?;
    bar.finish();
    let provenance = environment.provenance(arguments.seed);
    // A pipe gets the table too, unless JSON is asked for: it always has, and logs are read by people.
    let text = if arguments.json {
        json(&checks, &results, &provenance)?
    } else if environment.is_quiet() {
        table(&checks, &results)
    } else {
        table(&checks, &results) + &notes(&results, &provenance)
    };
    print(stdout, &text)?;
    Ok(if results.iter().any(|result| result.holds == Some(false)) { UNSOUND } else { DONE })
}

/// The checks that draw from this kind of estimator, integrator or free-flight sampler; a kind without any is refused, as an unknown
/// one is.
fn select(all: Vec<Check>, kind: Option<&str>) -> Result<Vec<Check>, Failure> {
    let Some(kind) = kind else { return Ok(all) };
    let names = kinds(&all);
    if !names.contains(&kind) {
        let meant = similar::meant(kind, names.iter().copied());
        let names = names.join(", ");
        return Err(Failure::refused(format!("--estimator: must be one of {names}, found {kind}{meant}")));
    }
    Ok(all.into_iter().filter(|check| check.kinds.contains(&kind)).collect())
}

/// The kinds that checks draw from: those of the registries first, in their order.
fn kinds(all: &[Check]) -> Vec<&'static str> {
    let drawn_from: BTreeSet<&'static str> =
        all.iter().flat_map(|check| check.kinds.iter().copied()).collect();
    let registered = EstimatorSpec::NAMES.iter().chain(IntegratorSpec::NAMES).copied();
    let mut names: Vec<&str> = registered.filter(|name| drawn_from.contains(name)).collect();
    let samplers = drawn_from.into_iter().filter(|name| !names.contains(name)).collect::<Vec<_>>();
    names.extend(samplers);
    names
}

/// A line for each check, and how many hold.
fn table(checks: &[Check], results: &[CheckResult]) -> String {
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
    let _ = writeln!(
        text,
        "\n{} checks: {} hold, {} do not hold, {} not testable at this N",
        checks.len(),
        count(Some(true)),
        count(Some(false)),
        count(None),
    );
    text
}

/// False alarm and power of all checks together, and where they come from.
fn notes(results: &[CheckResult], provenance: &Provenance) -> String {
    let worst = results.iter().filter_map(|r| r.detectable_relative_bias).fold(0.0, f64::max);
    let mut powers: Vec<f64> = results.iter().filter_map(|result| result.detectable_relative_bias).collect();
    powers.sort_unstable_by(f64::total_cmp);
    let median = powers.get(powers.len() / 2).copied().unwrap_or(f64::NAN);
    format!(
        "false alarm of the whole catalogue below {FAMILY_LEVEL:e} ({:.2e} per check, for up to {FAMILY_SIZE}); power: with \
         probability 0.99 a relative bias of {median:.1e} would have been found (median over the checks), {worst:.1e} in the \
         least powerful\n\
         seed {}, revision {}, {}\n",
        check_level(),
        provenance.seed,
        provenance.revision,
        provenance.command,
    )
}

/// One check with what it found.
#[derive(Serialize)]
struct Finding<'a> {
    id: &'a str,
    law: &'static str,
    estimator: &'a str,
    kinds: &'a [&'static str],
    medium: &'a str,
    /// True if the law holds; null: not testable.
    holds: Option<bool>,
    samples: u64,
    mean_z: Option<f64>,
    variance_z: Option<f64>,
    lookups_z: Option<f64>,
    /// P-values without the factors of safety of the verdict; `level` says how each is to be read.
    p_values: Vec<serde_json::Value>,
    detectable_relative_bias: Option<f64>,
    #[serde(serialize_with = "number")]
    normal_share: Option<f64>,
    #[serde(serialize_with = "number")]
    samples_needed: Option<f64>,
    reason: &'a str,
}

fn json(checks: &[Check], results: &[CheckResult], provenance: &Provenance) -> Result<String, Failure> {
    let finding = |(check, result): (&'_ Check, &'_ CheckResult)| {
        let p_values = result.p_values.iter();
        serde_json::to_value(Finding {
            id: &check.id,
            law: check.law.name(),
            estimator: &check.estimator,
            kinds: &check.kinds,
            medium: &check.medium,
            holds: result.holds,
            samples: result.samples,
            mean_z: result.mean_z,
            variance_z: result.variance_z,
            lookups_z: result.lookups_z,
            p_values: p_values
                .map(|p| serde_json::json!({ "of": p.of, "p": p.p, "level": p.level.name() }))
                .collect(),
            detectable_relative_bias: result.detectable_relative_bias,
            normal_share: result.normal_share,
            samples_needed: result.samples_needed,
            reason: &result.reason,
        })
    };
    let findings: Result<Vec<_>, _> = checks.iter().zip(results).map(finding).collect();
    let findings = findings.map_err(Failure::refused)?;
    let family =
        serde_json::json!({ "level": FAMILY_LEVEL, "checks": FAMILY_SIZE, "check_level": check_level() });
    let whole = serde_json::json!({ "checks": findings, "family": family, "provenance": provenance });
    serde_json::to_string_pretty(&whole).map(|text| text + "\n").map_err(Failure::refused)
}
