//! Media and their bounds, built once and shared by all rays.

use super::VoxelLattice;
use crate::Failure;
use crate::spec::{MediumKind, MediumSpec, NegativeVoxels};
use fairflight_media::{
    AnalyticCosine, Bounds, EmptySpace, ExpressionMedium, FieldError, Homogeneous, LineThickness, Medium,
    Perlin, Voxels,
};
use fairflight_volumes::{Affine, VoxelGrid, read_float_grid};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// A medium of any kind.
#[derive(Clone, Debug)]
pub enum AnyMedium {
    /// None: of a scene without a medium.
    Empty,
    /// The same everywhere.
    Homogeneous(Arc<Homogeneous>),
    /// szirmay-kalos-2017 eq. 21.
    AnalyticCosine(Arc<AnalyticCosine>),
    /// Noise.
    Perlin(Arc<Perlin>),
    /// A formula.
    Expression(Arc<ExpressionMedium>),
    /// Voxels of a file.
    Voxels(Arc<Voxels<VoxelLattice>>),
}

/// Something to be done with a medium of whatever type it has. The two differ in what is known of it.
pub trait MediumJob {
    /// What comes of it.
    type Output;
    /// Does it where only look-ups are to be had.
    fn by_look_ups<M: Medium + Sync>(self, medium: &M) -> Self::Output;
    /// Does it where the optical thickness along a line has a closed form.
    fn by_closed_form<M: LineThickness + Sync>(self, medium: &M) -> Self::Output;
}

impl AnyMedium {
    /// Does a job with the medium inside.
    pub fn with<J: MediumJob>(&self, job: J) -> J::Output {
        match self {
            Self::Empty => job.by_closed_form(&EmptySpace),
            Self::Homogeneous(medium) => job.by_closed_form(&**medium),
            Self::AnalyticCosine(medium) => job.by_closed_form(&**medium),
            Self::Perlin(medium) => job.by_look_ups(&**medium),
            Self::Expression(medium) => job.by_look_ups(&**medium),
            Self::Voxels(medium) => job.by_closed_form(&**medium),
        }
    }
}

impl AnyMedium {
    /// The bound of σ_t that the medium declares \[1/length\].
    #[must_use]
    pub fn upper_bound(&self) -> Option<f64> {
        self.with(UpperBound)
    }

    /// The greatest extinction that the medium declares, positive also where there is none; `key` is what needs it.
    ///
    /// # Errors
    /// If it declares none.
    pub(super) fn greatest_extinction(&self, key: &str) -> Result<f64, Failure> {
        let bound = self.upper_bound().ok_or_else(|| {
            Failure::refused(format!(
                "{key}: this key is missing, and the medium declares no majorant that could stand for it"
            ))
        })?;
        // Walks through nothing need a rate all the same; at this one they never collide.
        Ok(bound.max(f64::MIN_POSITIVE))
    }
}

struct UpperBound;

impl MediumJob for UpperBound {
    type Output = Option<f64>;
    fn by_look_ups<M: Medium + Sync>(self, medium: &M) -> Option<f64> {
        medium.upper_bound()
    }
    fn by_closed_form<M: LineThickness + Sync>(self, medium: &M) -> Option<f64> {
        medium.upper_bound()
    }
}

/// The media that were built so far: the points of a sweep share a file and its voxels.
#[derive(Debug, Default)]
pub struct MediumLibrary {
    volumes: Mutex<HashMap<VolumeKey, Volume>>,
}

type VolumeKey = (PathBuf, Option<String>, u64);
type Volume = (Arc<Voxels<VoxelLattice>>, Bounds);

impl MediumLibrary {
    /// The medium of a spec, and its bounds. A refusal names `key`, where the medium stands.
    ///
    /// # Errors
    /// If a file cannot be read, or a parameter is not lawful.
    pub fn build(&self, spec: &MediumSpec, key: &str) -> Result<(AnyMedium, Bounds), Failure> {
        let given = spec.bounds;
        let in_medium = |error: FieldError| Failure::refused(format!("{key}: {error}"));
        // A medium without bounds of its own was given some: the spec saw to it.
        let unbounded = || Failure::refused(format!("{key}.bounds: this key is missing"));
        Ok(match &spec.kind {
            MediumKind::Homogeneous { sigma_t } => {
                let medium = Homogeneous::new(*sigma_t).map_err(in_medium)?;
                (AnyMedium::Homogeneous(Arc::new(medium)), given.ok_or_else(unbounded)?)
            }
            MediumKind::AnalyticCosine { scale } => {
                let medium = AnalyticCosine::new(*scale).map_err(in_medium)?;
                let bounds = given.unwrap_or_else(AnalyticCosine::default_bounds);
                (AnyMedium::AnalyticCosine(Arc::new(medium)), bounds)
            }
            MediumKind::Perlin(parameters) => {
                let medium = Perlin::new(*parameters).map_err(in_medium)?;
                (AnyMedium::Perlin(Arc::new(medium)), given.ok_or_else(unbounded)?)
            }
            MediumKind::Expression { sigma_t, majorant } => {
                let medium = ExpressionMedium::new(sigma_t, *majorant)
                    .map_err(|error| Failure::refused(format!("{key}.sigma_t: {error}")))?;
                (AnyMedium::Expression(Arc::new(medium)), given.ok_or_else(unbounded)?)
            }
            MediumKind::Vdb { file, grid, scale, negative } => {
                let (medium, bounds) = self.volume(file, grid.as_deref(), *scale, key)?;
                let least = medium.lattice().0.minimum();
                if least < 0.0 && *negative == NegativeVoxels::Refused {
                    return Err(Failure::refused(format!(
                        "{key}.file: {}: grid \"{}\" has values down to {least}, which no density has; \
                         \"allow_negative\": true in a medium of kind vdb takes them for negative extinctions",
                        file.display(),
                        medium.lattice().0.info().name
                    )));
                }
                (AnyMedium::Voxels(medium), given.unwrap_or(bounds))
            }
        })
    }

    fn volume(&self, file: &Path, grid: Option<&str>, scale: f64, path: &str) -> Result<Volume, Failure> {
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
}

/// The world box of the active voxels grown by one voxel; `None` if nothing is active.
fn grown_bounds(grid: &VoxelGrid) -> Option<Bounds> {
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

fn glam_affine(affine: &Affine) -> DAffine3 {
    let axis = |v: [f64; 3]| DVec3::from_array(affine.apply_vector(v));
    DAffine3::from_cols(
        axis([1.0, 0.0, 0.0]),
        axis([0.0, 1.0, 0.0]),
        axis([0.0, 0.0, 1.0]),
        DVec3::from_array(affine.apply_point([0.0; 3])),
    )
}
