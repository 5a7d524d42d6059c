//! Voxels of an OpenVDB fog volume.

use super::known::{Knowledge, KnownField, ThicknessMethod, closed_form_of};
use super::{AnyMedium, BoundsRule, MediumKind, MediumLibrary, VoxelLattice};
use crate::reader::rule::{File, Flag, Maybe, Number, Text};
use crate::{Failure, kind};
use fairflight_media::{Bounds, Ray, Voxels};
use std::path::PathBuf;
use std::sync::Arc;

kind! {
    /// Trilinear between the voxels of an OpenVDB fog volume.
    VdbSpec = "vdb" {
        /// The file, relative to the one in which it is named.
        file: PathBuf as File,
        /// The grid; density by default, else the only float grid.
        grid: Option<String> as Maybe<Text> = None,
        /// A factor of the voxel values \[1/length\].
        scale: f64 as Number = 1.0,
        /// True to take voxels below 0 for negative extinctions.
        allow_negative: bool as Flag = false,
        /// The bounds, with vacuum outside; the box of the active voxels, grown by one, by default.
        bounds: Option<Bounds> as Maybe<BoundsRule> = None,
    }
}

impl MediumKind for VdbSpec {
    fn build(&self, library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let (medium, bounds) = library.volume(&self.file, self.grid.as_deref(), self.scale, key)?;
        let least = medium.lattice().0.minimum();
        if least < 0.0 && !self.allow_negative {
            return Err(Failure::refused(format!(
                "{key}.file: {}: grid \"{}\" has values down to {least}, which no density has; \
                 \"allow_negative\": true in a medium of kind vdb takes them for negative extinctions",
                self.file.display(),
                medium.lattice().0.info().name
            )));
        }
        Ok((AnyMedium::Voxels(medium), self.bounds.unwrap_or(bounds)))
    }
}

impl KnownField for Ray<Arc<Voxels<VoxelLattice>>> {
    fn knowledge(&self) -> Knowledge {
        closed_form_of(self, ThicknessMethod::GaussPerCell)
    }
}
