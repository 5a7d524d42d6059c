//! `harness advise`: which estimator of transmittance to use in a medium, and at what cost.
//!
//! Rays are sent through the medium; what each estimator would cost on them is forecast from a pilot of each ray, or found by a short
//! trial where nothing forecasts it; the best few are measured.

mod answer;
mod forecast;
mod question;
mod trial;

use crate::budget::Budget;
use crate::cli::AdviseArguments;
use crate::{DONE, Environment, Failure, print};
use std::io::{Read, Write};

/// Runs `harness advise`; returns the exit code.
///
/// # Errors
/// If the medium cannot be read or measured, or the answer not be printed.
pub fn run(
    arguments: &AdviseArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stdout: &mut dyn Write,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let question = question::Question::of(arguments, stdin)?;
    let budget = Budget::of(arguments.limits.budget);
    let (rays, warning) =
        environment.on_threads(arguments.limits.threads, || trial::rays(&question, budget))?;
    // A person who does not see this has the JSON all the same.
    if let Some(warning) = warning {
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let answer = environment.on_threads(arguments.limits.threads, || {
        trial::answer(&question, &rays, arguments.seed, environment)
    })?;
    let notes = if environment.is_quiet() { String::new() } else { answer.notes() };
    if environment.shows_tables() && !arguments.json {
        print(stdout, &(answer.table() + &notes))?;
        return Ok(DONE);
    }
    // Beside JSON the table is itself a note.
    if !arguments.json && !environment.is_quiet() {
        let _ = write!(stderr, "{}{notes}", answer.table());
    }
    let json = serde_json::to_string_pretty(&answer)
        .map_err(|error| Failure::refused(format!("the answer: {error}")))?;
    print(stdout, &(json + "\n"))?;
    Ok(DONE)
}
