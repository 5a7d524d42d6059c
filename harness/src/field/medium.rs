//! A medium of any kind.

use super::VoxelLattice;
use crate::Failure;
use fairflight_media::{
    AnalyticCosine, EmptySpace, ExpressionMedium, Homogeneous, LineThickness, Medium, Perlin, Voxels,
};
use std::sync::Arc;

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
    /// The result of the job.
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
    pub fn greatest_extinction(&self, key: &str) -> Result<f64, Failure> {
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
