//! How far a report has come.

use crate::Environment;
use indicatif::ProgressBar;

/// A progress bar of a report, counted in measurements.
#[derive(Debug)]
pub(super) struct Progress(ProgressBar);

impl Progress {
    pub(super) fn new(environment: &Environment, measurements: u64) -> Self {
        Self(environment.progress(measurements, "measuring"))
    }

    /// One more measurement is done.
    pub(super) fn advance(&self) {
        self.0.inc(1);
    }

    pub(super) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
