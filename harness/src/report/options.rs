//! Choices of whoever asks for a report.

use crate::budget::Budget;
use crate::cli::{ReportArguments, VolumeValues};
use crate::field::{MediumSpec, VdbSpec};
use std::path::{Path, PathBuf};

/// An OpenVDB fog volume.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Volume {
    /// The file.
    pub(crate) file: PathBuf,
    /// The grid; without it `density`, or else the only float grid.
    pub(crate) grid: Option<String>,
    /// A factor in front of the voxel values \[1/length\].
    pub(crate) scale: f64,
}

impl Volume {
    /// The volume that a command line names.
    pub(crate) fn new(file: &Path, values: &VolumeValues) -> Self {
        Self { file: file.to_owned(), grid: values.grid.clone(), scale: values.scale }
    }

    /// The medium that it is, its voxels nowhere below 0.
    #[must_use]
    pub(crate) fn medium(&self) -> MediumSpec {
        let Self { file, grid, scale } = self.clone();
        VdbSpec { file, grid, scale, allow_negative: false, bounds: None }.into()
    }
}

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
