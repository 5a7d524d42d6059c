//! The program `harness`: its command line, and the package that answers each command.
//!
//! [`run`] is the whole program: arguments, streams, exit code.

mod cli;
mod list;
mod porting;
mod shell;

use clap::Parser;
use cli::{Cli, Command};
use fairflight_harness::{DONE, Environment, Failure, Host, NOT_WRITTEN, REFUSED};
use fairflight_harness::{advise, estimate, info, interrupt, render, verify};
use fairflight_reports::{ReportArguments, report};
use std::ffi::OsString;
use std::io::{Read, Write};

/// Runs the program with these arguments (the first is its name) and streams; returns the exit code.
///
/// Data goes to `stdout` or into files, everything for a person to `stderr`.
pub fn run(
    arguments: impl IntoIterator<Item = impl Into<OsString>>,
    stdin: &mut dyn Read,
    stdout: &mut dyn Write,
    stderr: &mut dyn Write,
    host: Host,
) -> i32 {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return answer_without_running(&error, stdout, stderr),
    };
    let environment = Environment::new(&arguments, host).telling(cli.quiet, cli.progress);
    let outcome = match cli.command {
        Some(Command::Estimate(arguments)) => estimate::run(&arguments, &environment, stdin, stdout, stderr),
        Some(Command::Advise(arguments)) => advise::run(&arguments, &environment, stdin, stdout, stderr),
        Some(Command::Render(arguments)) => render::run(&arguments, &environment, stdin, stderr),
        Some(Command::Verify(arguments)) => verify::run(&arguments, &environment, stdout),
        Some(Command::Info(arguments)) => info::run(&arguments, stdout),
        Some(Command::Vectors(arguments)) => porting::vectors(&arguments, stdout),
        Some(Command::CheckPort(arguments)) => porting::check_port(&arguments, stdout),
        Some(Command::List) => list::list(stdout),
        Some(Command::Schema(arguments)) => list::print_schema(arguments, stdout),
        Some(Command::Completions(arguments)) => shell::completions(arguments, stdout),
        Some(Command::Man(arguments)) => shell::manual(&arguments),
        Some(Command::Licences) => shell::licences(stdout),
        Some(Command::Report(arguments)) => report(&arguments, &environment, stderr),
        None => report(&ReportArguments::default(), &environment, stderr),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => {
            let interrupted = failure == Failure::Interrupted;
            // The line of a progress bar that was given up has no end yet. Nobody is left to tell if standard
            // error is closed.
            let gap = if interrupted && environment.draws_bars() { "\n" } else { "" };
            if !interrupted || interrupt::ends_here() {
                let _ = writeln!(stderr, "{gap}{failure}");
            }
            failure.code()
        }
    }
}

/// Help and version go to standard output with code 0, a command line that cannot be read is refused.
fn answer_without_running(error: &clap::Error, stdout: &mut dyn Write, stderr: &mut dyn Write) -> i32 {
    let text = error.render();
    let (stream, code): (&mut dyn Write, i32) =
        if error.use_stderr() { (stderr, REFUSED) } else { (stdout, DONE) };
    match write!(stream, "{text}") {
        Ok(()) => code,
        Err(_) => NOT_WRITTEN,
    }
}
