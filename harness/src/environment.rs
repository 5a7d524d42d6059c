//! Surroundings of a run: its command, its revision, its threads, its terminal.

use crate::Failure;
use crate::progress::{Progress, ProgressForm};
use crate::result::Provenance;
use std::ffi::OsString;

/// The program that runs the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Host {
    /// Standard error is a terminal: progress bars are drawn.
    pub progress: bool,
    /// Standard output is a terminal: results are shown as tables.
    pub tables: bool,
    /// The revision of the checkout that the program was built from, with a word about changes; the version where there was none.
    pub revision: &'static str,
}

/// No terminal, no checkout.
impl Default for Host {
    fn default() -> Self {
        Self { progress: false, tables: false, revision: concat!("v", env!("CARGO_PKG_VERSION")) }
    }
}

/// The run's surroundings.
#[derive(Clone, Debug)]
pub struct Environment {
    command: String,
    host: Host,
    quiet: bool,
    form: ProgressForm,
}

impl Environment {
    /// The surroundings of a run with these arguments, the first of which is the program.
    #[must_use]
    pub fn new(arguments: &[OsString], host: Host) -> Self {
        let words = arguments.iter().skip(1).map(|word| quoted(&word.to_string_lossy()));
        let command = std::iter::once("harness".to_owned()).chain(words).collect::<Vec<_>>().join(" ");
        Self { command, host, quiet: false, form: ProgressForm::Bar }
    }

    /// The same surroundings, in which notes and progress are told as asked for.
    #[must_use]
    pub fn telling(self, quiet: bool, form: ProgressForm) -> Self {
        Self { quiet, form, ..self }
    }

    /// True if notes for a person are left out.
    #[must_use]
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// True if results are shown as tables, unless JSON is asked for.
    #[must_use]
    pub fn shows_tables(&self) -> bool {
        self.host.tables
    }

    /// The command as a person would type it.
    #[must_use]
    pub fn command(&self) -> &str {
        &self.command
    }

    /// The seed, the revision and the command that numbers of `seed` come from.
    #[must_use]
    pub fn provenance(&self, seed: u64) -> Provenance {
        let revision = self.host.revision.to_owned();
        Provenance { seed, revision, command: self.command.clone(), spec: None }
    }

    /// True if progress is told as bars: only on a terminal.
    #[must_use]
    pub fn draws_bars(&self) -> bool {
        self.host.progress && self.form == ProgressForm::Bar && !self.quiet
    }

    /// Progress of `length` steps, told as was asked for.
    #[must_use]
    pub fn progress(&self, length: u64, what: &'static str) -> Progress {
        match self.form {
            ProgressForm::Json => Progress::lines(length, what),
            ProgressForm::Bar if self.draws_bars() => Progress::bar(length, what),
            ProgressForm::Bar => Progress::hidden(),
        }
    }

    /// Runs `work` on `threads` threads, or on all cores.
    ///
    /// # Errors
    /// If the threads cannot be started, or `work` fails.
    pub fn on_threads<R: Send>(
        &self,
        threads: Option<u16>,
        work: impl FnOnce() -> Result<R, Failure> + Send,
    ) -> Result<R, Failure> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.map_or(0, usize::from))
            .build()
            .map_err(|error| Failure::refused(format!("--threads: {error}")))?;
        pool.install(work)
    }
}

/// A word in quotes if a shell would split or expand it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
