//! Where a run takes place: its command, its revision, its threads, its terminal.

use crate::Failure;
use crate::result::Provenance;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ffi::OsString;

/// The program that runs the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Host {
    /// Standard error is a terminal: progress bars are drawn.
    pub progress: bool,
    /// The revision of the checkout that the program was built from, with a word about changes; the version where there was none.
    pub revision: &'static str,
}

/// No terminal, no checkout.
impl Default for Host {
    fn default() -> Self {
        Self { progress: false, revision: concat!("v", env!("CARGO_PKG_VERSION")) }
    }
}

/// The run's surroundings.
#[derive(Clone, Debug)]
pub struct Environment {
    command: String,
    host: Host,
}

impl Environment {
    /// The surroundings of a run with these arguments, the first of which is the program.
    #[must_use]
    pub fn new(arguments: &[OsString], host: Host) -> Self {
        let words = arguments.iter().skip(1).map(|word| quoted(&word.to_string_lossy()));
        let command = std::iter::once("harness".to_owned()).chain(words).collect::<Vec<_>>().join(" ");
        Self { command, host }
    }

    /// The command as a person would type it.
    #[must_use]
    pub fn command(&self) -> &str {
        &self.command
    }

    /// Where the numbers of `seed` come from.
    #[must_use]
    pub fn provenance(&self, seed: u64) -> Provenance {
        Provenance { seed, revision: self.host.revision.to_owned(), command: self.command.clone() }
    }

    /// A progress bar of `length` steps, drawn if there is a terminal.
    #[must_use]
    pub fn progress(&self, length: u64, what: &'static str) -> ProgressBar {
        if !self.host.progress {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} % {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
        bar.with_style(style).with_message(what)
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
