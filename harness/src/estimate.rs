//! `harness estimate`: JSON in, JSON out.

use crate::cli::EstimateArguments;
use crate::experiment::run_experiment;
use crate::plan::{MediumLibrary, Plan};
use crate::result::ExperimentResult;
use crate::spec::{Experiment, Overrides, Request};
use crate::{DONE, Environment, Failure, UNSOUND};
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
    let request = Request::parse(&text, overrides).map_err(|failure| failure.within(&name))?;
    let Answer { json, unsound, warnings } = environment
        .on_threads(arguments.threads, || answer(&request, environment))
        .map_err(|failure| failure.within(&name))?;
    for warning in warnings {
        // Nobody is left to warn if standard error is closed.
        let _ = writeln!(stderr, "{name}: {warning}");
    }
    writeln!(stdout, "{json}")
        .map_err(|error| Failure::NotWritten(format!("cannot write the result: {error}")))?;
    Ok(if unsound { UNSOUND } else { DONE })
}

/// What a spec is called in a refusal; - is standard input.
pub(crate) fn named(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".to_owned() } else { path.display().to_string() }
}

/// The text of a spec; - is standard input.
pub(crate) fn read(path: &Path, stdin: &mut dyn Read) -> Result<String, Failure> {
    if path.as_os_str() == "-" {
        let mut text = String::new();
        return stdin.read_to_string(&mut text).map(|_| text).map_err(Failure::refused);
    }
    std::fs::read_to_string(path).map_err(Failure::refused)
}

/// What is written, and where.
struct Answer {
    json: String,
    unsound: bool,
    /// For a person, each once.
    warnings: Vec<String>,
}

fn answer(request: &Request, environment: &Environment) -> Result<Answer, Failure> {
    let library = MediumLibrary::default();
    match request {
        Request::Single(experiment) => {
            let outcome = one(experiment, &library, environment)?;
            let warnings = outcome.result.warning.iter().cloned().collect();
            Ok(Answer { json: to_json(&outcome.result)?, unsound: outcome.unsound, warnings })
        }
        Request::Sweep(sweep) => {
            let mut points = Vec::with_capacity(sweep.points.len());
            let (mut unsound, mut warnings) = (false, Vec::new());
            for (value, experiment) in &sweep.points {
                let outcome = one(experiment, &library, environment)
                    .map_err(|failure| failure.within(format!("sweep value {value}")))?;
                unsound |= outcome.unsound;
                warnings.extend(outcome.result.warning.clone());
                points.push(SweepPoint { value: value.clone(), result: outcome.result });
            }
            warnings.dedup();
            Ok(Answer { json: to_json(&SweepResult { points })?, unsound, warnings })
        }
    }
}

fn one(
    experiment: &Experiment,
    library: &MediumLibrary,
    environment: &Environment,
) -> Result<Outcome, Failure> {
    let plan = Plan::of(experiment, library)?;
    let bar = environment.progress(experiment.samples, "estimating");
    let result = run_experiment(&plan, environment.provenance(experiment.seed), &|samples| bar.inc(samples))?;
    bar.finish_and_clear();
    // A biased baseline is what it says it is.
    let unsound = result.verdict.sound == Some(false) && !experiment.estimator.is_biased_baseline();
    Ok(Outcome { result, unsound })
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map_err(Failure::refused)
}
