//! Progress of a run on standard error: a bar for a person, or lines of JSON for another program.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The form in which progress is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum ProgressForm {
    /// A bar, where standard error is a terminal
    #[default]
    Bar,
    /// One JSON object a line: done, total, what, seconds
    Json,
}

/// The least time between two lines, but for the first and the last.
const PAUSE: Duration = Duration::from_millis(250);

/// Steps of a run that are done, told as they come.
#[derive(Debug)]
pub struct Progress(Told);

#[derive(Debug)]
enum Told {
    Nowhere,
    Bar(ProgressBar),
    Lines(Mutex<Lines>),
}

impl Progress {
    /// Progress that nobody is told.
    #[must_use]
    pub fn hidden() -> Self {
        Self(Told::Nowhere)
    }

    /// A bar of `length` steps.
    pub fn bar(length: u64, what: &'static str) -> Self {
        let style = ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} % {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
        Self(Told::Bar(bar.with_style(style).with_message(what)))
    }

    /// Lines about `length` steps.
    pub fn lines(length: u64, what: &'static str) -> Self {
        let start = Instant::now();
        let mut lines = Lines { what, done: 0, total: length, start, last: start };
        lines.tell();
        Self(Told::Lines(Mutex::new(lines)))
    }

    /// Adds so many steps to those that are done.
    pub fn inc(&self, steps: u64) {
        match &self.0 {
            Told::Nowhere => {}
            Told::Bar(bar) => bar.inc(steps),
            Told::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                lines.done += steps;
                if lines.last.elapsed() >= PAUSE {
                    lines.tell();
                }
            }
        }
    }

    /// Sets the number of steps in all.
    pub fn set_length(&self, length: u64) {
        match &self.0 {
            Told::Nowhere => {}
            Told::Bar(bar) => bar.set_length(length),
            Told::Lines(lines) => lines.lock().unwrap_or_else(PoisonError::into_inner).total = length,
        }
    }

    /// Puts a text in front of a bar that is seen, and only then makes it.
    pub fn with_text(&self, text: impl FnOnce() -> Option<String>) {
        if let Told::Bar(bar) = &self.0
            && !bar.is_hidden()
            && let Some(text) = text()
        {
            bar.set_message(text);
        }
    }

    /// The run has come to its end.
    pub fn finish(&self) {
        match &self.0 {
            Told::Nowhere => {}
            Told::Bar(bar) => bar.finish_and_clear(),
            Told::Lines(lines) => lines.lock().unwrap_or_else(PoisonError::into_inner).tell(),
        }
    }
}

#[derive(Debug)]
struct Lines {
    what: &'static str,
    done: u64,
    total: u64,
    start: Instant,
    last: Instant,
}

impl Lines {
    fn tell(&mut self) {
        self.last = Instant::now();
        let Self { what, done, total, start, last } = self;
        let seconds = last.duration_since(*start).as_secs_f64();
        let line =
            json!({ "done": done, "total": total, "what": what, "seconds": seconds }).to_string() + "\n";
        // Nobody is left to tell if standard error is closed.
        let _ = io::stderr().write_all(line.as_bytes());
    }
}
