//! The harness: what can be asked for, and what comes of it. The only input and output of the project; `fairflight-reports` makes studies
//! of it, `fairflight-program` the command line.
//!
//! Data flows one way: a [`spec`] says what is asked for, a [`plan`] makes it fit together, [`measure`](mod@measure) draws, the
//! analysis of an [`experiment`] compares with the [`reference`](mod@reference), and writers turn the [`result`] into JSON, CSV, tables
//! and images. Writers read results only.

mod environment;
mod failure;
mod input;
mod table;

pub mod advise;
pub mod budget;
pub mod cli;
pub mod comparison;
pub mod estimate;
pub mod estimator;
pub mod experiment;
pub mod field;
pub mod image;
pub mod info;
pub mod interrupt;
pub mod measure;
pub mod parallel;
pub mod partial;
pub mod plan;
pub mod progress;
pub mod reader;
pub mod reference;
pub mod render;
pub mod result;
pub mod spec;
pub mod verify;
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
