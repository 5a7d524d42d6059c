//! The harness: the only program of the project, and its only input and output.
//!
//! Data flows one way: a [`spec`] says what is asked for, a [`plan`] makes it fit together, [`measure`](mod@measure) draws, the
//! analysis of an [`experiment`] compares with the [`reference`](mod@reference), and writers turn the [`result`] into JSON, CSV, Markdown,
//! plots and a page. Writers read results only.
//!
//! [`run`] is the whole program: arguments, streams, exit code.

pub mod advise;
pub mod cli;
mod environment;
pub mod estimate;
mod failure;
pub mod info;
mod input;
pub mod parallel;
pub mod partial;
pub mod render;
mod table;
pub mod verify;

pub mod budget;
pub mod comparison;
pub mod estimator;
pub mod experiment;
pub mod field;
pub mod image;
pub mod interrupt;
pub mod measure;
pub mod plan;
pub mod progress;
pub mod reader;
pub mod reference;
pub mod result;
pub mod spec;
pub mod vocabulary;
pub mod volume;

pub use environment::{Environment, Host};
pub use failure::{DONE, Failure, INTERRUPTED, NOT_WRITTEN, REFUSED, UNSOUND};

use std::io::Write;

/// Puts a result on standard output.
///
/// # Errors
/// If nobody takes it.
pub fn print(stdout: &mut dyn Write, text: &str) -> Result<(), Failure> {
    let written = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
    written.map_err(|error| Failure::NotWritten(format!("cannot write to standard output: {error}")))
}
