//! `harness report`: measure, then write.

use super::stability::stability;
use super::study::{Options, Volume, standard};
use super::write;
use crate::cli::ReportArguments;
use crate::{DONE, Environment, Failure, UNSOUND};
use std::io::Write;
use std::path::PathBuf;

/// The reports that there are.
const NAMES: [&str; 1] = ["standard"];

pub(crate) fn run(
    arguments: &ReportArguments,
    environment: &Environment,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let name = arguments.name.as_str();
    if !NAMES.contains(&name) {
        return Err(Failure::refused(format!("report {name}: must be one of {}", NAMES.join(", "))));
    }
    let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from("reports").join(name));
    let report = {
        // Found out before a minute of measurement, not after it.
        let prepared = write::prepare(&folder)?;
        let report = environment.on_threads(arguments.threads, || {
            let options = Options {
                quick: arguments.quick,
                seed: arguments.seed,
                vdb: arguments.vdb.clone().map(|file| Volume {
                    file,
                    grid: arguments.grid.clone(),
                    scale: arguments.scale,
                }),
                threads: rayon::current_num_threads(),
            };
            let mut report = standard(&options, environment)?;
            report.stability = stability(arguments.seed);
            Ok(report)
        })?;
        environment.on_threads(arguments.threads, || prepared.commit(&report))?;
        report
    };
    // A person who does not see this has the report all the same.
    let _ = writeln!(stderr, "{}: written in {:.1} s", folder.join("index.html").display(), report.seconds);
    let unsound = report.media.iter().flat_map(|medium| &medium.sweeps).any(|curve| {
        !curve.series.is_baseline()
            && curve
                .points
                .iter()
                .any(|point| point.measured.as_ref().is_some_and(|measured| measured.sound == Some(false)))
    });
    let broken = report.stability.iter().any(|row| !row.passes);
    Ok(if unsound || broken { UNSOUND } else { DONE })
}
