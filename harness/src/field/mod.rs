//! Extinction along rays and in space: one file per kind of profile and of medium, with its keys and what is known of it; the lists.

mod along_a_ray;
mod analytic_cosine;
mod bounds;
mod constant;
mod expression;
mod homogeneous;
mod known;
mod library;
mod medium;
mod perlin;
mod piecewise_constant;
mod piecewise_linear;
mod profile;
mod vdb;
mod voxel_lattice;

pub use along_a_ray::RaySpec;
pub use analytic_cosine::AnalyticCosineSpec;
pub use bounds::BoundsRule;
pub use constant::ConstantSpec;
pub use expression::{ExpressionMediumSpec, ExpressionSpec};
pub use homogeneous::HomogeneousSpec;
pub use known::{ErasedField, Field, Knowledge, KnownField, ThicknessMethod};
pub use library::MediumLibrary;
pub(crate) use library::{glam_affine, grown_bounds};
pub use medium::{AnyMedium, OnlyLookUps};
pub use perlin::PerlinSpec;
pub use piecewise_constant::PiecewiseConstantSpec;
pub use piecewise_linear::PiecewiseLinearSpec;
pub use profile::AnyProfile;
pub use vdb::VdbSpec;
pub use voxel_lattice::VoxelLattice;

use crate::{Failure, registry};
use fairflight_media::Bounds;

registry! {
    /// The extinction along one ray.
    ProfileSpec: ProfileKind {
        Constant(ConstantSpec),
        PiecewiseConstant(PiecewiseConstantSpec),
        PiecewiseLinear(PiecewiseLinearSpec),
        Expression(ExpressionSpec),
        Ray(RaySpec),
    }
}

registry! {
    /// The extinction in space.
    MediumSpec: MediumKind as "medium" {
        Homogeneous(HomogeneousSpec),
        AnalyticCosine(AnalyticCosineSpec),
        Perlin(PerlinSpec),
        Expression(ExpressionMediumSpec),
        Vdb(VdbSpec),
    }
}

/// A kind of profiles: how it is built.
pub trait ProfileKind {
    /// The profile.
    ///
    /// # Errors
    /// If a file cannot be read, or a parameter is not lawful.
    fn build(&self, library: &MediumLibrary) -> Result<AnyProfile, Failure>;
}

/// A kind of media: how it is built.
pub trait MediumKind {
    /// The medium and its bounds; `key` leads to the spec.
    ///
    /// # Errors
    /// If a file cannot be read, or a parameter is not lawful.
    fn build(&self, library: &MediumLibrary, key: &str) -> Result<(AnyMedium, Bounds), Failure>;
}

/// A refusal of a profile.
fn refused(error: impl std::fmt::Display) -> Failure {
    Failure::refused(format!("profile: {error}"))
}
