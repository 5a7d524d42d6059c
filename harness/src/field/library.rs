//! Volumes that were read so far, shared by all rays.

use super::{MediumSpec, VoxelLattice};
use crate::Failure;
use fairflight_media::{BoundGrid, Bounds, Voxels};
use fairflight_volumes::{Affine, VoxelGrid, read_float_grid};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// The media that were built so far: the points of a sweep share a file and its voxels.
#[derive(Debug, Default)]
pub struct MediumLibrary {
    volumes: Mutex<HashMap<VolumeKey, Volume>>,
    /// Grids of bounds of each medium, by the number of boxes along its longest edge.
    grids: Mutex<Vec<(MediumSpec, u32, Arc<BoundGrid>)>>,
}

type VolumeKey = (PathBuf, Option<String>, u64);
type Volume = (Arc<Voxels<VoxelLattice>>, Bounds);

impl MediumLibrary {
    /// A volume, its grid chosen by name, and the box of its active voxels; `path` leads to the medium.
    ///
    /// # Errors
    /// If the file cannot be read, or has no such grid.
    pub(super) fn volume(
        &self,
        file: &Path,
        grid: Option<&str>,
        scale: f64,
        path: &str,
    ) -> Result<Volume, Failure> {
        let key = (file.to_owned(), grid.map(str::to_owned), scale.to_bits());
        let mut volumes = self.volumes.lock().expect("no thread panics while it reads a volume");
        if let Some(volume) = volumes.get(&key) {
            return Ok(volume.clone());
        }
        let in_file = |error: &dyn std::fmt::Display| {
            Failure::refused(format!("{path}.file: {}: {error}", file.display()))
        };
        let bytes = std::fs::read(file).map_err(|error| in_file(&error))?;
        let grid = read_float_grid(&bytes, grid).map_err(|error| in_file(&error))?;
        let bounds = grown_bounds(&grid).ok_or_else(|| in_file(&"the grid has no active voxel"))?;
        let index_from_world = glam_affine(&grid.index_from_world());
        let medium = Voxels::new(VoxelLattice(grid), index_from_world, scale)
            .map_err(|error| Failure::refused(format!("{path}: {error}")))?;
        let volume = (Arc::new(medium), bounds);
        volumes.insert(key, volume.clone());
        Ok(volume)
    }

    /// The grid of bounds of a medium, built where it was not: the pilots of a scene share that of its image.
    ///
    /// # Errors
    /// If building it fails.
    pub(crate) fn bound_grid(
        &self,
        (medium, longest): (&MediumSpec, u32),
        build: impl FnOnce() -> Result<BoundGrid, Failure>,
    ) -> Result<Arc<BoundGrid>, Failure> {
        let mut grids = self.grids.lock().expect("no thread panics while it builds a grid");
        if let Some((.., grid)) = grids.iter().find(|(spec, n, _)| (spec, *n) == (medium, longest)) {
            return Ok(Arc::clone(grid));
        }
        let grid = Arc::new(build()?);
        grids.push((medium.clone(), longest, Arc::clone(&grid)));
        Ok(grid)
    }
}

/// The world box of the active voxels grown by one voxel; `None` if nothing is active.
pub(crate) fn grown_bounds(grid: &VoxelGrid) -> Option<Bounds> {
    let (low, high) = grid.active_bounds()?;
    let transform = glam_affine(&grid.world_from_index());
    let corner = |bits: usize| {
        let pick = |axis: usize| {
            if bits >> axis & 1 == 0 { f64::from(low[axis]) - 1.0 } else { f64::from(high[axis]) + 1.0 }
        };
        transform.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
    };
    let corners = (0..8).map(corner);
    let (min, max) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), corner| {
        (min.min(corner), max.max(corner))
    });
    Some(Bounds::Box { min, max })
}

pub(crate) fn glam_affine(affine: &Affine) -> DAffine3 {
    let axis = |v: [f64; 3]| DVec3::from_array(affine.apply_vector(v));
    DAffine3::from_cols(
        axis([1.0, 0.0, 0.0]),
        axis([0.0, 1.0, 0.0]),
        axis([0.0, 0.0, 1.0]),
        DVec3::from_array(affine.apply_point([0.0; 3])),
    )
}
