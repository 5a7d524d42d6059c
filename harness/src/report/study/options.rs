//! What the standard report is asked for.

use std::path::PathBuf;

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

/// An OpenVDB fog volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// The file.
    pub file: PathBuf,
    /// The grid; without it, the first float grid.
    pub grid: Option<String>,
    /// A factor in front of the voxel values \[1/length\].
    pub scale: f64,
}
