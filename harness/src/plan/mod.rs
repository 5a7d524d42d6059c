//! Plans: fields and estimators of a spec that fit together and can run.
//!
//! The registry of the harness. A profile is one of a closed list of field types; the estimator is instantiated over that
//! type, so that a look-up is a direct call. Control and sampling extinction are enums inside the estimator: their
//! branches are the same at every collision, and a bench shows that they cost nothing measurable.

mod beam_radiance;
mod bidirectional;
mod integrator;
mod metropolis;
mod passes;
mod path_space;
mod path_tracer;
mod phase;
mod rays;
mod sampler;
mod scene;
mod single_scattering;
mod surfaces;
mod tally;
mod tile_integrator;
mod transport;
mod walk;

pub use beam_radiance::BeamRadiancePlan;
pub use bidirectional::BidirectionalPlan;
pub use integrator::IntegratorPlan;
pub use metropolis::MetropolisPlan;
pub(crate) use metropolis::{ChainStarts, Learning, Lesson, SIZES, Walked};
pub use path_tracer::PathTracerPlan;
pub use phase::AnyPhase;
pub use sampler::PixelPoints;
pub use scene::{Radiant, ScenePlan, Spectra};
pub use single_scattering::SingleScatteringPlan;
pub use tally::Tally;
pub use tile_integrator::{AnyIntegrator, Counts, SceneVolume, Splatted, TileIntegrator};
pub use transport::{Seen, Stage, TransportPlan, VplPlan};
pub use walk::{SpaceSampling, WalkPlan};

use crate::Failure;
use crate::estimator::{EstimatorSpec, Prepared};
use crate::field::{AnyProfile, MediumLibrary};
use crate::measure::MOST_COUNTED;
use crate::spec::Experiment;

/// An experiment whose parts fit together.
#[derive(Debug)]
pub struct Plan {
    /// The extinction along the ray.
    pub profile: AnyProfile,
    /// The estimator of its transmittance, prepared for that ray.
    pub estimator: Prepared,
    /// The estimator as it was asked for.
    pub spec: EstimatorSpec,
    /// The number of estimates.
    pub samples: u64,
    /// The seed of their variates.
    pub seed: u64,
    /// Number of estimates whose look-ups are counted.
    pub counted: u64,
}

impl Plan {
    /// Builds the fields and the estimator of an experiment; reads the files that it names.
    ///
    /// # Errors
    /// If a file cannot be read, or the parts do not fit.
    pub fn of(experiment: &Experiment, library: &MediumLibrary) -> Result<Self, Failure> {
        let profile = experiment.profile.kind().build(library)?;
        Self::on(profile, experiment.estimator.clone(), experiment.samples, experiment.seed)
    }

    /// Prepares an estimator for a profile that is already built.
    ///
    /// # Errors
    /// If the two do not fit.
    pub fn on(profile: AnyProfile, spec: EstimatorSpec, samples: u64, seed: u64) -> Result<Self, Failure> {
        let estimator = spec.kind().prepare(&profile)?;
        Ok(Self { profile, estimator, spec, samples, seed, counted: MOST_COUNTED })
    }
}
