//! The context of a report that is being measured: options, media, seeds, progress.

use super::looks::looks;
use super::options::Options;
use fairflight_document::{Document, Provenance, Section};
use fairflight_harness::field::MediumLibrary;
use fairflight_harness::progress::Progress;
use fairflight_harness::{Environment, Failure};
use fairflight_sources::named_seed;
use std::fmt::Display;
use std::time::Instant;

/// A report on its way.
pub(crate) struct Run<'a> {
    name: &'static str,
    pub(super) options: &'a Options,
    pub(super) media: MediumLibrary,
    environment: &'a Environment,
    progress: Progress,
    clock: Instant,
}

/// A report that was measured.
pub(crate) struct Finished {
    pub(crate) document: Document,
    /// The file `results.json`: all that was measured.
    pub(crate) results: Vec<u8>,
}

impl Finished {
    /// A report whose document holds all that was measured.
    ///
    /// # Errors
    /// If it cannot be written as JSON.
    pub(crate) fn of(document: Document) -> Result<Self, Failure> {
        let results = fairflight_document::json(&document)
            .map_err(|error| Failure::refused(format!("report {}: {error}", document.name)))?;
        Ok(Self { document, results })
    }
}

/// A part of a report.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) section: Section,
    /// Findings against what was expected, one sentence each.
    pub(super) unsound: Vec<String>,
}

impl<'a> Run<'a> {
    /// The report of this name.
    pub(super) fn new(name: &'static str, options: &'a Options, environment: &'a Environment) -> Self {
        let progress = environment.progress(1, "measuring");
        let (media, clock) = (MediumLibrary::default(), Instant::now());
        Self { name, options, media, environment, progress, clock }
    }

    /// The seed of the stream of this name, "study/subject/estimator": no number of a report depends on what else is in it.
    pub(super) fn seed(&self, name: impl Display) -> u64 {
        named_seed(self.options.seed, &format!("report/{}/{name}", self.name))
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

    /// The document of this run, which ends here, without contents.
    pub(super) fn document(&self, title: &str) -> Document {
        self.progress.finish();
        let provenance = self.environment.provenance(self.options.seed);
        let fairflight_harness::result::Provenance { seed, revision, command, .. } = provenance;
        Document {
            quick: self.options.quick,
            seconds: self.clock.elapsed().as_secs_f64(),
            threads: self.options.threads,
            looks: looks(),
            ..Document::new(self.name, title, Provenance { seed, revision, command })
        }
    }
}
