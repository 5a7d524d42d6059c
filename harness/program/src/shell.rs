//! Texts that belong to the program: completions for shells, man pages, licences of third parties.

use crate::cli::{Cli, CompletionsArguments, ManArguments};
use clap::CommandFactory;
use fairflight_harness::{DONE, Failure, print};
use std::fs;
use std::io::Write;

/// `harness completions`.
pub(crate) fn completions(arguments: CompletionsArguments, stdout: &mut dyn Write) -> Result<i32, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "harness", &mut script);
    print(stdout, &String::from_utf8_lossy(&script))?;
    Ok(DONE)
}

/// `harness man`.
pub(crate) fn manual(arguments: &ManArguments) -> Result<i32, Failure> {
    let folder = &arguments.folder;
    let written = fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written.map_err(|error| Failure::not_written(folder, error))?;
    Ok(DONE)
}

/// `harness licences`.
pub(crate) fn licences(stdout: &mut dyn Write) -> Result<i32, Failure> {
    print(stdout, include_str!("../../NOTICES.md"))?;
    Ok(DONE)
}
