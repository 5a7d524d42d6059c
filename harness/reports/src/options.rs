//! Choices of whoever asks for a report.

use crate::command::ReportArguments;
use fairflight_harness::budget::Budget;
use fairflight_harness::volume::Volume;

/// The choices of whoever asks for a report.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// Fewer points and samples.
    pub(crate) quick: bool,
    /// The seed of all variates.
    pub(crate) seed: u64,
    /// The threads that measure, for the record: no number but a time depends on them.
    pub(crate) threads: usize,
    /// A volume to be studied as well; only some reports take one.
    pub(crate) vdb: Option<Volume>,
    /// Of the look-ups in that volume.
    pub(crate) budget: Budget,
}

impl Options {
    /// The options of a command line, on the threads of the current pool.
    pub(crate) fn of(arguments: &ReportArguments) -> Self {
        Self {
            quick: arguments.quick,
            seed: arguments.seed,
            threads: rayon::current_num_threads(),
            vdb: arguments.vdb.as_ref().map(|file| Volume::new(file, &arguments.values)),
            budget: Budget::of(arguments.budget),
        }
    }
}
