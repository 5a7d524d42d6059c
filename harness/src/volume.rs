//! An OpenVDB fog volume that a command line names.

use crate::cli::VolumeValues;
use crate::field::{MediumSpec, VdbSpec};
use std::path::{Path, PathBuf};

/// An OpenVDB fog volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// The file.
    pub file: PathBuf,
    /// The grid; without it `density`, or else the only float grid.
    pub grid: Option<String>,
    /// A factor in front of the voxel values \[1/length\].
    pub scale: f64,
}

impl Volume {
    /// The volume that a command line names.
    pub fn new(file: &Path, values: &VolumeValues) -> Self {
        Self { file: file.to_owned(), grid: values.grid.clone(), scale: values.scale }
    }

    /// The medium that it is, its voxels nowhere below 0.
    #[must_use]
    pub fn medium(&self) -> MediumSpec {
        let Self { file, grid, scale } = self.clone();
        VdbSpec { file, grid, scale, allow_negative: false, bounds: None }.into()
    }
}
