//! `harness report`: measure, then write.

use super::document::{self, Volume};
use super::registry::{REPORTS, ReportKind, Study, find};
use super::result::Report;
use super::run::Run;
use super::stability::stability;
use super::study::{Options, standard};
use super::write::{self, Files};
use crate::budget::Budget;
use crate::cli::ReportArguments;
use crate::{DONE, Environment, Failure, UNSOUND, interrupt};
use std::io::Write;
use std::path::{Path, PathBuf};

pub(crate) fn run(
    arguments: &ReportArguments,
    environment: &Environment,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    report(find(&arguments.name)?, arguments, environment, stderr)
}

fn report(
    kind: &ReportKind,
    arguments: &ReportArguments,
    environment: &Environment,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    if arguments.vdb.is_some() && !kind.takes_volume {
        let takers: Vec<&str> =
            REPORTS.iter().filter(|kind| kind.takes_volume).map(|kind| kind.name).collect();
        return Err(Failure::refused(format!(
            "report {}: --vdb is an option of {} only",
            kind.name,
            takers.join(" and ")
        )));
    }
    let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from("reports").join(kind.name));
    if arguments.out.is_none() && !environment.is_quiet() {
        let place = std::path::absolute(&folder).unwrap_or_else(|_| folder.clone());
        // A person who does not see this finds it in the working directory.
        let _ = writeln!(stderr, "the report {} goes to {}", kind.name, place.display());
    }
    let (seconds, sound) = match kind.study {
        Study::Standard => {
            let report = measured_and_written(&folder, arguments, environment, || {
                standard_report(arguments, environment)
            })?;
            (report.seconds, is_sound(&report))
        }
        Study::Document(study) => {
            let document = measured_and_written(&folder, arguments, environment, || {
                let options = document::Options {
                    quick: arguments.quick,
                    seed: arguments.seed,
                    threads: rayon::current_num_threads(),
                    vdb: volume(arguments),
                    budget: Budget::of(arguments.budget),
                };
                study(&Run::new(kind.name, &options, environment))
            })?;
            (document.seconds, document.unsound.is_empty())
        }
    };
    if !environment.is_quiet() {
        // A person who does not see this has the report all the same.
        let _ = writeln!(stderr, "{}: written in {seconds:.1} s", folder.join("index.html").display());
    }
    Ok(if sound { DONE } else { UNSOUND })
}

fn measured_and_written<R: Files + Send + Sync>(
    folder: &Path,
    arguments: &ReportArguments,
    environment: &Environment,
    measure: impl FnOnce() -> Result<R, Failure> + Send,
) -> Result<R, Failure> {
    // Found out before a minute of measurement, not after it.
    let prepared = write::prepare(folder)?;
    let report = environment.on_threads(arguments.threads, measure)?;
    interrupt::check()?;
    environment.on_threads(arguments.threads, || prepared.commit(&report))?;
    Ok(report)
}

fn volume(arguments: &ReportArguments) -> Option<Volume> {
    let file = arguments.vdb.clone()?;
    Some(Volume { file, grid: arguments.grid.clone(), scale: arguments.scale })
}

fn standard_report(arguments: &ReportArguments, environment: &Environment) -> Result<Report, Failure> {
    let options = Options {
        quick: arguments.quick,
        seed: arguments.seed,
        vdb: volume(arguments),
        threads: rayon::current_num_threads(),
    };
    let mut report = standard(&options, environment)?;
    report.stability = stability(arguments.seed);
    Ok(report)
}

/// Whether the unbiased estimators agree with their closed forms, and the hard cases are right.
fn is_sound(report: &Report) -> bool {
    let unsound = report.media.iter().flat_map(|medium| &medium.sweeps).any(|curve| {
        !curve.series.is_baseline()
            && curve
                .points
                .iter()
                .any(|point| point.measured.as_ref().is_some_and(|measured| measured.sound == Some(false)))
    });
    !unsound && report.stability.iter().all(|row| row.passes)
}

#[cfg(test)]
mod tests {
    use super::super::write::fixture_document;
    use super::*;
    use crate::{Host, REFUSED};

    const KIND: ReportKind = ReportKind {
        name: "made-up",
        about: "",
        takes_volume: false,
        study: Study::Document(|run| {
            let mut document = fixture_document();
            // The seed decides, so that both ends can be seen.
            if run.options.seed == 2 {
                document.unsound.push("made up".to_owned());
            }
            Ok(document)
        }),
    };

    fn code(arguments: &ReportArguments) -> i32 {
        let environment = Environment::new(&[], Host::default());
        report(&KIND, arguments, &environment, &mut Vec::new()).unwrap_or_else(|failure| failure.code())
    }

    #[test]
    fn a_document_is_written_whether_it_is_sound_or_not() {
        let root = tempfile::tempdir().unwrap();
        for (seed, expected) in [(1, DONE), (2, UNSOUND)] {
            let out = root.path().join(seed.to_string());
            let arguments = ReportArguments { out: Some(out.clone()), seed, ..ReportArguments::default() };
            assert_eq!(code(&arguments), expected);
            assert!(out.join("index.html").is_file());
        }
    }

    #[test]
    fn a_volume_is_for_reports_that_take_one() {
        let root = tempfile::tempdir().unwrap();
        let arguments = ReportArguments {
            out: Some(root.path().join("out")),
            vdb: Some("some.vdb".into()),
            ..ReportArguments::default()
        };
        assert_eq!(code(&arguments), REFUSED);
        assert!(!root.path().join("out").exists());
    }
}
