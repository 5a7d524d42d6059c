//! From a spec to something that can run: fields and estimators that fit together.
//!
//! The registry of the harness. A profile is one of a closed list of field types; the estimator is instantiated over that
//! type, so that a look-up is a direct call. Control and sampling extinction are enums inside the estimator: their
//! branches are the same at every collision, and a bench shows that they cost nothing measurable.

mod beyond;
mod control;
mod estimator;
mod field;
mod integrator;
mod media;
mod phase;
mod profile;
mod ray_estimator;
mod sampling;
mod scene;
mod shadow;
mod single_scattering;
mod surfaces;
mod transport;
mod voxel_lattice;
mod walk;
mod work;

pub use beyond::{Beyond, pilot};
pub use control::AnyControl;
pub use estimator::{AnyEstimator, Estimator, EstimatorJob, Lawful};
pub use field::{Field, Knowledge, KnownField, ThicknessMethod};
pub use integrator::{IntegratorJob, IntegratorPlan, TileIntegrator};
pub use media::{AnyMedium, MediumJob, MediumLibrary};
pub use phase::AnyPhase;
pub use profile::{AnyProfile, FieldJob};
pub use ray_estimator::{RayEstimator, RayWorker, Unlawful};
pub use sampling::AnySampling;
pub use scene::{Radiant, ScenePlan, Spectra};
pub use single_scattering::SingleScatteringPlan;
pub use transport::{PathTracerPlan, Stage, TransportPlan, VplPlan};
pub use voxel_lattice::VoxelLattice;
pub use walk::{SpaceSampling, WalkPlan};
pub use work::{Expected, RayKnown, Work};

use crate::Failure;
use crate::measure::MOST_COUNTED;
use crate::spec::{EstimatorSpec, Experiment};

/// An experiment whose parts fit together.
#[derive(Debug)]
pub struct Plan {
    /// The extinction along the ray.
    pub profile: AnyProfile,
    /// What estimates its transmittance, prepared for that ray.
    pub estimator: AnyEstimator,
    /// The estimator as it was asked for.
    pub spec: EstimatorSpec,
    /// The number of estimates.
    pub samples: u64,
    /// The seed of their variates.
    pub seed: u64,
    /// Of how many estimates the look-ups are counted.
    pub counted: u64,
}

impl Plan {
    /// Builds the fields and the estimator of an experiment; reads the files that it names.
    ///
    /// # Errors
    /// If a file cannot be read, or the parts do not fit.
    pub fn of(experiment: &Experiment, library: &MediumLibrary) -> Result<Self, Failure> {
        let profile = AnyProfile::build(&experiment.profile, library)?;
        Self::on(profile, experiment.estimator.clone(), experiment.samples, experiment.seed)
    }

    /// Prepares an estimator for a profile that is already built.
    ///
    /// # Errors
    /// If the two do not fit.
    pub fn on(profile: AnyProfile, spec: EstimatorSpec, samples: u64, seed: u64) -> Result<Self, Failure> {
        let estimator = AnyEstimator::build(&spec, &profile)?;
        Ok(Self { profile, estimator, spec, samples, seed, counted: MOST_COUNTED })
    }
}
