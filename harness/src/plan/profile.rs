//! A profile of any kind.

use super::{AnyMedium, Field, KnownField, MediumLibrary, VoxelLattice};
use crate::Failure;
use crate::spec::ProfileSpec;
use fairflight_media::{
    AnalyticCosine, Certified, Clip, Constant, ExpressionMedium, ExpressionProfile, Homogeneous, Perlin,
    PiecewiseConstant, PiecewiseLinear, Ray, Voxels,
};
use glam::DVec3;
use std::sync::Arc;

/// A profile: one of the field types that the harness knows.
#[derive(Clone, Debug)]
pub enum AnyProfile {
    /// The same everywhere.
    Constant(Constant),
    /// One value per cell.
    PiecewiseConstant(PiecewiseConstant),
    /// Linear between nodes.
    PiecewiseLinear(PiecewiseLinear),
    /// A formula in s.
    Expression(Certified<ExpressionProfile>),
    /// A ray through a homogeneous medium.
    Homogeneous(Ray<Arc<Homogeneous>>),
    /// A ray through szirmay-kalos-2017 eq. 21.
    AnalyticCosine(Ray<Arc<AnalyticCosine>>),
    /// A ray through noise.
    Perlin(Certified<Ray<Arc<Perlin>>>),
    /// A ray through a formula in x, y, z.
    ExpressionMedium(Certified<Ray<Arc<ExpressionMedium>>>),
    /// A ray through voxels.
    Voxels(Ray<Arc<Voxels<VoxelLattice>>>),
}

/// Something to be done with a field of whatever type it has.
pub trait FieldJob {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run<F: KnownField>(self, field: &F) -> Self::Output
    where
        for<'a> &'a F: Field;
}

/// A ray that crosses more voxel cells than this is refused: its reference alone would take minutes.
const MOST_CELLS: u64 = 1 << 24;

impl AnyProfile {
    /// The profile of a spec.
    ///
    /// # Errors
    /// If a file cannot be read, or a parameter is not lawful.
    pub fn build(spec: &ProfileSpec, library: &MediumLibrary) -> Result<Self, Failure> {
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("profile: {error}"));
        Ok(match spec {
            ProfileSpec::Constant { sigma_t, length } => {
                Self::Constant(Constant::new(*sigma_t, *length).map_err(|error| refuse(&error))?)
            }
            ProfileSpec::PiecewiseConstant { edges, sigma_t } => Self::PiecewiseConstant(
                PiecewiseConstant::new(edges.clone(), sigma_t.clone()).map_err(|error| refuse(&error))?,
            ),
            ProfileSpec::PiecewiseLinear { positions, sigma_t } => Self::PiecewiseLinear(
                PiecewiseLinear::new(positions.clone(), sigma_t.clone()).map_err(|error| refuse(&error))?,
            ),
            ProfileSpec::Expression { sigma_t, length, majorant } => Self::Expression(Certified::new(
                ExpressionProfile::new(sigma_t, *length, *majorant)
                    .map_err(|error| Failure::refused(format!("profile.sigma_t: {error}")))?,
            )),
            ProfileSpec::Ray { medium, origin, direction, length } => {
                let (medium, bounds) = library.build(medium, "profile.medium")?;
                let clip = bounds.clip(*origin, *direction, *length).map_err(|error| refuse(&error))?;
                Self::ray(&medium, &clip.unwrap_or_else(|| Clip::empty(*origin, *direction)))?
            }
        })
    }

    /// A clipped ray through a medium.
    ///
    /// # Errors
    /// If it crosses too many voxels.
    pub fn ray(medium: &AnyMedium, clip: &Clip) -> Result<Self, Failure> {
        Ok(match medium {
            AnyMedium::Empty => Self::Constant(
                Constant::new(0.0, clip.length)
                    .map_err(|error| Failure::refused(format!("profile: {error}")))?,
            ),
            AnyMedium::Homogeneous(medium) => Self::Homogeneous(Ray::new(Arc::clone(medium), clip)),
            AnyMedium::AnalyticCosine(medium) => Self::AnalyticCosine(Ray::new(Arc::clone(medium), clip)),
            AnyMedium::Perlin(medium) => Self::Perlin(Certified::new(Ray::new(Arc::clone(medium), clip))),
            AnyMedium::Expression(medium) => {
                Self::ExpressionMedium(Certified::new(Ray::new(Arc::clone(medium), clip)))
            }
            AnyMedium::Voxels(medium) => {
                let ray = Ray::new(Arc::clone(medium), clip);
                let cells = medium.cells_crossed(ray.local_line(), clip.length);
                if cells > MOST_CELLS {
                    return Err(Failure::refused(format!(
                        "profile: the ray crosses up to {cells} voxel cells, more than {MOST_CELLS}"
                    )));
                }
                Self::Voxels(ray)
            }
        })
    }

    /// Does a job with the field inside.
    pub fn with<J: FieldJob>(&self, job: J) -> J::Output {
        match self {
            Self::Constant(field) => job.run(field),
            Self::PiecewiseConstant(field) => job.run(field),
            Self::PiecewiseLinear(field) => job.run(field),
            Self::Expression(field) => job.run(field),
            Self::Homogeneous(field) => job.run(field),
            Self::AnalyticCosine(field) => job.run(field),
            Self::Perlin(field) => job.run(field),
            Self::ExpressionMedium(field) => job.run(field),
            Self::Voxels(field) => job.run(field),
        }
    }

    /// The distance from the ray's origin to the start of the profile: 0 for a profile that is no ray.
    #[must_use]
    pub fn entry_distance(&self) -> f64 {
        match self {
            Self::Constant(_)
            | Self::PiecewiseConstant(_)
            | Self::PiecewiseLinear(_)
            | Self::Expression(_) => 0.0,
            Self::Homogeneous(ray) => ray.entry_distance(),
            Self::AnalyticCosine(ray) => ray.entry_distance(),
            Self::Perlin(ray) => ray.field().entry_distance(),
            Self::ExpressionMedium(ray) => ray.field().entry_distance(),
            Self::Voxels(ray) => ray.entry_distance(),
        }
    }

    /// The length of the profile.
    #[must_use]
    pub fn length(&self) -> f64 {
        struct Length;
        impl FieldJob for Length {
            type Output = f64;
            fn run<F: KnownField>(self, field: &F) -> f64
            where
                for<'a> &'a F: Field,
            {
                field.length()
            }
        }
        self.with(Length)
    }

    /// A distance inside the profile as a person gave it: from the ray's origin, with the point for a ray.
    #[must_use]
    pub fn place(&self, s: f64) -> String {
        let at = format!("s = {}", self.entry_distance() + s);
        let point = |ray: DVec3| format!("{at}, point [{}, {}, {}]", ray.x, ray.y, ray.z);
        match self {
            Self::Constant(_)
            | Self::PiecewiseConstant(_)
            | Self::PiecewiseLinear(_)
            | Self::Expression(_) => at,
            Self::Homogeneous(ray) => point(ray.world_point(s)),
            Self::AnalyticCosine(ray) => point(ray.world_point(s)),
            Self::Perlin(ray) => point(ray.field().world_point(s)),
            Self::ExpressionMedium(ray) => point(ray.field().world_point(s)),
            Self::Voxels(ray) => point(ray.world_point(s)),
        }
    }
}
