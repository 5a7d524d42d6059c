//! `harness report`: measure, make files, put them in place.

use super::folder::{Prepared, RESULTS};
use super::options::Options;
use super::registry::{REPORTS, ReportKind, find, times};
use super::run::Run;
use fairflight_document::{File, Script, files};
use fairflight_harness::cli::{VolumeValues, positive};
use fairflight_harness::{DONE, Environment, Failure, UNSOUND, interrupt};
use std::io::Write;
use std::path::PathBuf;

/// Arguments of `report`.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = times())]
pub struct ReportArguments {
    /// Which report
    #[arg(default_value = "standard")]
    pub name: String,
    /// The same report from fewer samples, with wider intervals
    #[arg(long)]
    pub quick: bool,
    /// An OpenVDB fog volume to be reported on as well
    #[arg(long, value_name = "FILE")]
    pub vdb: Option<PathBuf>,
    /// Values of the volume
    #[command(flatten)]
    pub values: VolumeValues,
    /// A page without script: static figures only, small enough to be kept in a repository
    #[arg(long)]
    pub static_figures: bool,
    /// Folder to write into [default: reports/NAME in the working directory]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// The seed of all variates
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Refuse a volume in which more look-ups are to be expected
    #[arg(long, value_name = "NUMBER", requires = "vdb", value_parser = positive, default_value = "1e11")]
    pub budget: f64,
    /// Threads [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// What the command line gives for a report that names nothing.
impl Default for ReportArguments {
    fn default() -> Self {
        Self {
            name: "standard".to_owned(),
            quick: false,
            vdb: None,
            values: VolumeValues { grid: None, scale: 1.0 },
            static_figures: false,
            out: None,
            seed: 1,
            budget: 1e11,
            threads: None,
        }
    }
}

/// Runs `harness report`; returns the exit code.
///
/// # Errors
/// If the report cannot be measured or written.
pub fn run(
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
    // Found out before a minute of measurement, not after it.
    let prepared = Prepared::new(&folder)?;
    let finished = environment.on_threads(arguments.threads, || {
        let options = Options::of(arguments);
        (kind.study)(&Run::new(kind.name, &options, environment))
    })?;
    interrupt::check()?;
    let script = if arguments.static_figures { Script::None } else { Script::Embedded };
    let document = &finished.document;
    let made = environment.on_threads(arguments.threads, || {
        files(document, script).map_err(|reason| Failure::not_written(&folder, reason))
    });
    let mut written = made?;
    written.push(File { name: RESULTS.to_owned(), bytes: finished.results });
    prepared.commit(&written)?;
    if !environment.is_quiet() {
        // A person who does not see this has the report all the same.
        let (page, seconds) = (folder.join("index.html"), document.seconds);
        let _ = writeln!(stderr, "{}: written in {seconds:.1} s", page.display());
    }
    Ok(if document.unsound.is_empty() { DONE } else { UNSOUND })
}

#[cfg(test)]
mod tests {
    use super::super::run::Finished;
    use super::*;
    use fairflight_harness::{Host, REFUSED};

    const KIND: ReportKind = ReportKind {
        name: "made-up",
        about: "",
        takes_volume: false,
        takes: ["1 s", "1 s"],
        study: |run| {
            let mut document = run.document("Made up");
            // The seed decides, so that both ends can be seen.
            if run.options.seed == 2 {
                document.unsound.push("made up".to_owned());
            }
            Finished::of(document)
        },
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
