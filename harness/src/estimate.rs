//! `harness estimate`: JSON in, JSON out.

use crate::budget::{Budget, patience, seconds_per_lookup};
use crate::cli::EstimateArguments;
use crate::experiment::Prepared;
use crate::field::MediumLibrary;
use crate::reader::json;
use crate::result::ExperimentResult;
use crate::spec::{Overrides, Request};
use crate::{DONE, Environment, Failure, UNSOUND, interrupt};
use serde::Serialize;
use serde_json::Value;
use std::io::{Read, Write};
use std::path::Path;

/// The result of a sweep.
#[derive(Debug, Serialize)]
struct SweepResult {
    points: Vec<SweepPoint>,
}

#[derive(Debug, Serialize)]
struct SweepPoint {
    value: Value,
    #[serde(flatten)]
    result: ExperimentResult,
}

/// A result, and whether it is an unbiased estimator found unsound.
struct Outcome {
    result: ExperimentResult,
    unsound: bool,
}

pub(crate) fn run(
    arguments: &EstimateArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stdout: &mut dyn Write,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let name = named(&arguments.spec);
    let text = read(&arguments.spec, stdin).map_err(|failure| failure.within(&name))?;
    let overrides = Overrides { samples: arguments.samples, seed: arguments.seed };
    let request = Request::parse_in(&text, folder_of(&arguments.spec), overrides)
        .map_err(|failure| failure.within(&name))?;
    let budget = Budget::of(arguments.budget);
    let (prepared, warnings) = environment
        .on_threads(arguments.threads, || {
            let prepared = prepare(&request, budget)?;
            let warnings = warnings(&prepared);
            Ok((prepared, warnings))
        })
        .map_err(|failure| failure.within(&name))?;
    for warning in warnings {
        // Nobody is left to tell if standard error is closed.
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let (json, unsound) = environment
        .on_threads(arguments.threads, || answer(&request, &prepared, environment))
        .map_err(|failure| failure.within(&name))?;
    writeln!(stdout, "{json}")
        .map_err(|error| Failure::NotWritten(format!("cannot write the result: {error}")))?;
    Ok(if unsound { UNSOUND } else { DONE })
}

/// What a spec is called in a refusal; - is standard input.
pub(crate) fn named(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".to_owned() } else { path.display().to_string() }
}

/// The folder of a spec, to which the paths in it are relative; of - the working directory.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The text of a spec; - is standard input.
pub(crate) fn read(path: &Path, stdin: &mut dyn Read) -> Result<String, Failure> {
    if path.as_os_str() == "-" {
        let mut bytes = Vec::new();
        stdin.read_to_end(&mut bytes).map_err(Failure::refused)?;
        return json::text(bytes);
    }
    std::fs::read(path).map_err(Failure::refused).and_then(json::text)
}

/// All experiments of a request, none of which is drawn before all are known to be lawful and together within
/// the budget.
fn prepare(request: &Request, budget: Budget) -> Result<Vec<Prepared>, Failure> {
    let library = MediumLibrary::default();
    match request {
        Request::Single(experiment) => Ok(vec![Prepared::of(experiment, &library, budget)?]),
        Request::Sweep(sweep) => {
            let mut prepared = Vec::with_capacity(sweep.points.len());
            for (value, experiment) in &sweep.points {
                interrupt::check()?;
                let point = Prepared::of(experiment, &library, budget);
                prepared.push(point.map_err(|failure| failure.within(format!("sweep value {value}")))?);
            }
            let points = format!("the sum over {} points", prepared.len());
            budget.check("sweep.values", lookups(&prepared), &points)?;
            Ok(prepared)
        }
    }
}

fn lookups(prepared: &[Prepared]) -> f64 {
    prepared.iter().map(|prepared| prepared.lookups).sum()
}

/// Where all this takes more than an hour, and where a declared majorant says that a reference may have missed something; each once.
fn warnings(prepared: &[Prepared]) -> Vec<String> {
    let dearest = prepared.iter().max_by(|a, b| a.lookups.total_cmp(&b.lookups));
    let patience =
        dearest.and_then(|dearest| patience(lookups(prepared), seconds_per_lookup(&dearest.plan().profile)));
    let mut doubts: Vec<String> = prepared.iter().filter_map(|prepared| prepared.truth().warning()).collect();
    doubts.dedup();
    patience.into_iter().chain(doubts).collect()
}

fn answer(
    request: &Request,
    prepared: &[Prepared],
    environment: &Environment,
) -> Result<(String, bool), Failure> {
    match request {
        Request::Single(_) => {
            let outcome = one(&prepared[0], environment)?;
            Ok((to_json(&outcome.result)?, outcome.unsound))
        }
        Request::Sweep(sweep) => {
            let mut points = Vec::with_capacity(sweep.points.len());
            let mut unsound = false;
            for ((value, _), prepared) in sweep.points.iter().zip(prepared) {
                let outcome = one(prepared, environment)
                    .map_err(|failure| failure.within(format!("sweep value {value}")))?;
                unsound |= outcome.unsound;
                points.push(SweepPoint { value: value.clone(), result: outcome.result });
            }
            Ok((to_json(&SweepResult { points })?, unsound))
        }
    }
}

fn one(prepared: &Prepared, environment: &Environment) -> Result<Outcome, Failure> {
    let plan = prepared.plan();
    let bar = environment.progress(plan.samples, "estimating");
    let result = prepared.run(environment.provenance(plan.seed), &|samples| bar.inc(samples))?;
    bar.finish_and_clear();
    // A biased baseline is what it says it is.
    let unsound = result.verdict.sound == Some(false) && !plan.spec.is_biased_baseline();
    Ok(Outcome { result, unsound })
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map_err(Failure::refused)
}
