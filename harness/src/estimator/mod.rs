//! Estimators of transmittance: one file per kind, with its keys, its preparation and what is known of it; the list of all.

mod adaptive_ratio;
mod cells;
mod control;
mod double_particle;
mod erased;
mod expected;
mod generalised_poisson;
mod hybrid;
mod in_grid;
mod in_scene;
mod jackknife;
mod jittered_ratio;
mod line_integral;
mod naive;
mod next_flight;
mod p_series;
mod pilots;
mod prepared;
mod progressive_majorant;
mod range;
mod ray;
mod ray_marching;
mod regular;
mod residual_cells;
mod sampling;
mod shadow;
mod single_particle;
mod telescoping;
mod tracking;
mod trial;
mod unbiased_ray_marching;
mod woodcock;

pub use adaptive_ratio::AdaptiveRatioSpec;
pub use cells::CellsSpec;
pub use control::{AnyControl, ControlSpec};
pub use double_particle::DoubleParticleSpec;
pub use expected::{Expected, RayKnown, Work};
pub use generalised_poisson::GeneralisedPoissonSpec;
pub use hybrid::HybridSpec;
pub use in_scene::{InScene, Preparation};
pub use jackknife::JackknifeSpec;
pub use jittered_ratio::JitteredRatioSpec;
pub use line_integral::LineIntegralSpec;
pub use naive::NaiveSpec;
pub use next_flight::{NextFlightKind, NextFlightSpec};
pub use p_series::PSeriesSpec;
pub use pilots::pilot;
pub use prepared::Prepared;
pub use progressive_majorant::ProgressiveMajorantSpec;
pub use ray::{RayEstimator, RayWorker, Unlawful};
pub use ray_marching::RayMarchingSpec;
pub use regular::RegularSpec;
pub use residual_cells::ResidualCellsSpec;
pub use sampling::{AnySampling, SamplingSpec};
pub use shadow::{Shadow, ShadowWorker};
pub use single_particle::{SingleParticleSpec, VersionWord};
pub use telescoping::TelescopingSpec;
pub use trial::{AnyPieces, Estimator, InLanes, Lawful, On, Trial};
pub use unbiased_ray_marching::{CombWord, RouletteSpec, UnbiasedRayMarchingSpec};
pub use woodcock::WoodcockSpec;

use crate::field::AnyProfile;
use crate::reader::{Node, Rule};
use crate::{Failure, registry};
use serde_json::{Value, json};

registry! {
    /// An estimator of transmittance with its parameters, in the coordinates of the profile spec.
    EstimatorSpec: EstimatorKind {
        Woodcock(WoodcockSpec),
        DoubleParticle(DoubleParticleSpec),
        SingleParticle(SingleParticleSpec),
        LineIntegral(LineIntegralSpec),
        RayMarching(RayMarchingSpec),
        NextFlight(NextFlightSpec),
        PSeries(PSeriesSpec),
        GeneralisedPoisson(GeneralisedPoissonSpec),
        UnbiasedRayMarching(UnbiasedRayMarchingSpec),
        Telescoping(TelescopingSpec),
        JitteredRatio(JitteredRatioSpec),
        ResidualCells(ResidualCellsSpec),
        AdaptiveRatio(AdaptiveRatioSpec),
        Regular(RegularSpec),
        Hybrid(HybridSpec),
        Jackknife(JackknifeSpec),
        Naive(NaiveSpec),
        ProgressiveMajorant(ProgressiveMajorantSpec),
    }
}

/// A kind of estimators: its preparation, its cost, its bias.
pub trait EstimatorKind {
    /// The estimator on one profile.
    ///
    /// # Errors
    /// If a parameter is not lawful there, or the profile lacks what the estimator needs to know.
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure>;

    /// The estimator of all rays of a scene; `key` leads to the spec.
    ///
    /// # Errors
    /// If a parameter is not lawful, or belongs to one ray, or the scene's medium lacks what the estimator needs to know.
    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure>;

    /// The key that a scene cannot take, and why: what belongs to one ray.
    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        None
    }

    /// The look-ups on a ray, before anything is built.
    fn work(&self, ray: RayKnown) -> Work;

    /// True for a labelled biased baseline.
    fn is_biased_baseline(&self) -> bool {
        false
    }
}

/// The rule of an estimator of a scene, which has many rays.
#[derive(Debug)]
pub struct ForAllRays;

impl Rule<EstimatorSpec> for ForAllRays {
    fn read(node: &Node<'_>) -> Result<EstimatorSpec, Failure> {
        EstimatorSpec::read_for_all_rays(node)
    }
    fn written(spec: &EstimatorSpec) -> Value {
        spec.written()
    }
    fn schema() -> Value {
        json!({ "$ref": "#/$defs/estimator" })
    }
}

impl EstimatorSpec {
    /// Reads the estimator of a scene, which has many rays.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind, or belongs to one ray.
    pub fn read_for_all_rays(node: &Node<'_>) -> Result<Self, Failure> {
        let spec = Self::read(node)?;
        if let Self::DoubleParticle(DoubleParticleSpec { sigma_samp: SamplingSpec::Constant(0.0), .. })
        | Self::SingleParticle(SingleParticleSpec { sigma_samp: SamplingSpec::Constant(0.0), .. }) = &spec
        {
            // Where nothing is sampled the control would have to be the medium itself, on every ray.
            return Err(node.object()?.required("sigma_samp")?.refuse("must be a number above 0"));
        }
        match spec.kind().of_one_ray() {
            Some((key, reason)) => Err(node.at(key)?.reject(reason)),
            None => Ok(spec),
        }
    }

    /// True for a labelled biased baseline.
    #[must_use]
    pub fn is_biased_baseline(&self) -> bool {
        self.kind().is_biased_baseline()
    }
}

/// More look-ups, explorers, teeth, cells or segments than this are a slip of the keyboard.
const MOST_POINTS: u64 = 10_000_000;
const MOST: u64 = 1_000_000;

/// A refusal of a key for a reason.
fn refuse(key: &str, reason: impl std::fmt::Display) -> Failure {
    Failure::refused(format!("{key}: {reason}"))
}

/// The reason why a scene refuses a parameter of one ray.
const FOR_ONE_RAY: &str = "is given along one ray, but a scene has many";
