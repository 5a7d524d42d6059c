//! What the parts of a report share: its options, its media, its seeds, and how far it has come.

use super::document::Options;
use crate::Environment;
use crate::field::MediumLibrary;
use fairflight_sources::derive_seed;
use indicatif::ProgressBar;

/// A report on its way.
pub(super) struct Run<'a> {
    pub(super) options: &'a Options,
    pub(super) media: MediumLibrary,
    progress: ProgressBar,
}

impl<'a> Run<'a> {
    /// A report of so many measurements.
    pub(super) fn new(options: &'a Options, environment: &Environment, measurements: u64) -> Self {
        let progress = environment.progress(measurements, "measuring");
        Self { options, media: MediumLibrary::default(), progress }
    }

    /// A seed of its own for each measurement of each part.
    pub(super) fn seed(&self, part: u64, measurement: u64) -> u64 {
        derive_seed(derive_seed(self.options.seed, part), measurement)
    }

    /// One of two values: the one for a quick report, or the full one.
    pub(super) fn quick_or<T>(&self, quick: T, full: T) -> T {
        if self.options.quick { quick } else { full }
    }

    /// Samples per pixel: fewer where it must be quick.
    pub(super) fn samples(&self, full: u32) -> u32 {
        self.quick_or((full / 8).max(2), full)
    }

    /// Columns and rows of the images of a scene.
    pub(super) fn resolution(&self) -> u32 {
        self.quick_or(48, 128)
    }

    /// There are so many measurements in all.
    pub(super) fn expect(&self, measurements: u64) {
        self.progress.set_length(measurements);
    }

    /// One more measurement is done.
    pub(super) fn advance(&self) {
        self.progress.inc(1);
    }

    pub(super) fn finish(&self) {
        self.progress.finish_and_clear();
    }
}
