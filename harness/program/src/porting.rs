//! `harness vectors` and `harness check-port`: test vectors, and programs that are held to them.

mod check;
mod verdict;

pub(crate) use check::{CheckPortArguments, check_port};

use clap::Args;
use fairflight_harness::reader::similar::meant;
use fairflight_harness::{DONE, Failure, partial, print};
use fairflight_vectors::{KINDS, Kind};
use rayon::prelude::*;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Arguments of `vectors`.
#[derive(Clone, Debug, Args)]
pub(crate) struct VectorsArguments {
    /// Kinds of estimators, samplers and phase functions; all by default
    #[arg(value_name = "KIND")]
    pub kinds: Vec<String>,
    /// The folder, made if there is none: a file KIND.jsonl each
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
}

/// Runs `harness vectors`; returns the exit code.
pub(crate) fn vectors(arguments: &VectorsArguments, stdout: &mut dyn Write) -> Result<i32, Failure> {
    let kinds = chosen(&arguments.kinds)?;
    let folder = &arguments.out;
    fs::create_dir_all(folder).map_err(|error| Failure::not_written(folder, error))?;
    let written: Vec<String> =
        kinds.into_par_iter().map(|kind| write(kind, folder)).collect::<Result<_, Failure>>()?;
    print(stdout, &written.concat())?;
    Ok(DONE)
}

/// Writes the file of a kind; returns a line about it.
fn write(kind: &Kind, folder: &Path) -> Result<String, Failure> {
    let name = format!("{}.jsonl", kind.name);
    let path = folder.join(&name);
    let lines = kind.lines();
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let written = partial::file(folder, name.as_ref()).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.persist(&path)?;
        Ok(())
    });
    written.map_err(|error| Failure::not_written(&path, error))?;
    Ok(format!("{}: {} cases\n", path.display(), lines.len() - 1))
}

/// The kinds of these names, or all.
fn chosen(names: &[String]) -> Result<Vec<&'static Kind>, Failure> {
    if names.is_empty() {
        return Ok(KINDS.to_vec());
    }
    let found = |name: &String| {
        KINDS.iter().copied().find(|kind| kind.name == name).ok_or_else(|| {
            let known = KINDS.iter().map(|kind| kind.name);
            let all = known.clone().collect::<Vec<_>>().join(", ");
            let meant = meant(name, known);
            Failure::refused(format!("there are vectors of {all}, found {name}{meant}"))
        })
    };
    names.iter().map(found).collect()
}
