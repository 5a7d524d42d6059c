//! `harness estimate`: JSON in, JSON or a table out.

mod table;

use crate::budget::{Budget, patience, seconds_per_lookup};
use crate::cli::EstimateArguments;
use crate::experiment::Prepared;
use crate::field::MediumLibrary;
use crate::input::Input;
use crate::result::{ExperimentResult, SweepPoint, SweepResult};
use crate::spec::{Experiment, Overrides, Request};
use crate::{DONE, Environment, Failure, UNSOUND, interrupt, print};
use serde::Serialize;
use serde_json::Value;
use std::io::{Read, Write};

/// A result at a value of the swept key, if there is one, and whether it is an unbiased estimator found unsound.
struct Outcome {
    value: Option<Value>,
    result: ExperimentResult,
    unsound: bool,
}

/// Runs `harness estimate`; returns the exit code.
///
/// # Errors
/// If the experiment cannot be read or run, or the result not be printed.
pub fn run(
    arguments: &EstimateArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stdout: &mut dyn Write,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let input = Input::read(&arguments.spec, stdin)?;
    let overrides = Overrides { samples: arguments.samples, seed: arguments.seed };
    let request = Request::parse_in(input.text(), input.folder(), overrides);
    let request = request.map_err(|failure| input.within(failure))?;
    let budget = Budget::of(arguments.limits.budget);
    let prepared = environment.on_threads(arguments.limits.threads, || {
        let prepared = prepare(&request, budget)?;
        let warnings = warnings(&prepared);
        Ok((prepared, warnings))
    });
    let (prepared, warnings) = prepared.map_err(|failure| input.within(failure))?;
    for warning in warnings {
        // Nobody is left to tell if standard error is closed.
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let outcomes =
        environment.on_threads(arguments.limits.threads, || answer(&prepared, &input, environment));
    let outcomes = outcomes.map_err(|failure| input.within(failure))?;
    let unsound = outcomes.iter().any(|outcome| outcome.unsound);
    let text = if environment.shows_tables() && !arguments.json {
        table::table(request.path(), &outcomes) + &table::notes(&outcomes, environment)
    } else {
        json(outcomes)?
    };
    print(stdout, &text)?;
    Ok(if unsound { UNSOUND } else { DONE })
}

/// An experiment before it is drawn, and the value of the swept key, if there is one.
type Point = (Option<Value>, Prepared);

/// Plans of the experiments of a request, none of which is drawn before all are known to be lawful and together within
/// the budget.
fn prepare(request: &Request<Experiment>, budget: Budget) -> Result<Vec<Point>, Failure> {
    let library = MediumLibrary::default();
    let mut prepared = Vec::new();
    for (value, experiment) in request.points() {
        interrupt::check()?;
        let point = Prepared::of(experiment, &library, budget);
        prepared.push((value.cloned(), point.map_err(|failure| failure.at(value))?));
    }
    if let Request::Sweep(_) = request {
        let points = format!("the sum over {} points", prepared.len());
        budget.check("sweep.values", lookups(&prepared), &points)?;
    }
    Ok(prepared)
}

fn lookups(prepared: &[Point]) -> f64 {
    prepared.iter().map(|(_, prepared)| prepared.lookups).sum()
}

/// Warnings, each once: all this takes more than an hour; a reference may have missed something, as a declared majorant says; a ray
/// misses its medium.
fn warnings(prepared: &[Point]) -> Vec<String> {
    let prepared_alone = || prepared.iter().map(|(_, prepared)| prepared);
    let dearest = prepared_alone().max_by(|a, b| a.lookups.total_cmp(&b.lookups));
    let patience =
        dearest.and_then(|dearest| patience(lookups(prepared), seconds_per_lookup(&dearest.plan().profile)));
    let mut doubts: Vec<String> =
        prepared_alone().filter_map(|prepared| prepared.truth().warning()).collect();
    doubts.dedup();
    let misses = prepared_alone().any(|prepared| prepared.plan().profile.misses());
    let misses = misses.then(|| "profile: the ray misses the medium: T = 1".to_owned());
    patience.into_iter().chain(doubts).chain(misses).collect()
}

fn answer(prepared: &[Point], input: &Input, environment: &Environment) -> Result<Vec<Outcome>, Failure> {
    let one = |(value, prepared): &Point| {
        let plan = prepared.plan();
        let bar = environment.progress(plan.samples, "estimating");
        let provenance = input.provenance(environment, plan.seed)?;
        let result = prepared
            .run(provenance, &|samples| bar.inc(samples))
            .map_err(|failure| failure.at(value.as_ref()))?;
        bar.finish();
        // A biased baseline is what it says it is.
        let unsound = result.verdict.sound == Some(false) && !plan.spec.is_biased_baseline();
        Ok(Outcome { value: value.clone(), result, unsound })
    };
    prepared.iter().map(one).collect()
}

/// The results of a sweep as a list, or the only one.
fn json(outcomes: Vec<Outcome>) -> Result<String, Failure> {
    let mut points = Vec::new();
    for Outcome { value, result, .. } in outcomes {
        let Some(value) = value else { return written(&result) };
        points.push(SweepPoint { value, result });
    }
    written(&SweepResult { points })
}

fn written(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map(|text| text + "\n").map_err(Failure::refused)
}
