//! What the standard report is asked for.

use crate::report::document::Volume;

/// The choices of whoever asks for the standard report.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Fewer points and samples: seconds instead of most of a minute.
    pub quick: bool,
    /// The seed of all variates.
    pub seed: u64,
    /// A volume to be studied beside the media of the paper.
    pub vdb: Option<Volume>,
    /// The threads that measure, for the record: no number but a time depends on them.
    pub threads: usize,
}
