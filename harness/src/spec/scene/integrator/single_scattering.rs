//! Single scattering.

use super::line_splitting::StartsWord;
use super::{IntegratorKind, MOST, SamplerSpec};
use crate::estimator::{EstimatorSpec, ForAllRays};
use crate::reader::kind::Among;
use crate::reader::rule::{Maybe, Whole};
use crate::{kind, words};
use fairflight_paths::Heuristic;
use fairflight_transmittance::Starts;

/// The technique that chooses the scattering point of single scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategy {
    /// By the transmittance that one walk estimated.
    Attenuation,
    /// The same, with a walk of its own for each point.
    AttenuationResampled,
    /// By the light that arrives.
    Source,
    /// By the extinction.
    Scattering,
    /// Two of them combined.
    SourceAndScattering,
    /// Two of them combined.
    AttenuationAndSource,
    /// Two of them combined.
    AttenuationAndScattering,
}

words! {
    /// The technique that chooses the scattering point of single scattering.
    pub(super) StrategyWord for Strategy {
        "attenuation" => Strategy::Attenuation,
        "attenuation_resampled" => Strategy::AttenuationResampled,
        "source" => Strategy::Source,
        "scattering" => Strategy::Scattering,
        "source_and_scattering" => Strategy::SourceAndScattering,
        "attenuation_and_source" => Strategy::AttenuationAndSource,
        "attenuation_and_scattering" => Strategy::AttenuationAndScattering,
    }
}

words! {
    /// The heuristic that combines two techniques.
    pub(super) CombinationWord for Heuristic {
        "balance" => Heuristic::Balance,
        "power" => Heuristic::Power,
    }
}

kind! {
    /// Light that scatters once (szirmay-kalos-2017 section 4.3).
    SingleScatteringSpec = "single_scattering" {
        /// The technique that chooses the scattering point.
        sampling: Strategy as StrategyWord,
        /// The estimator of the transmittance along the camera's ray.
        estimator: EstimatorSpec as ForAllRays,
        /// Scattering points per ray, light and technique.
        samples_per_ray: u32 as Whole<1, MOST>,
        /// The layout of the first steps of the flights of line_integral.
        starts: Starts as StartsWord = Starts::Equidistant,
        /// The heuristic that combines techniques.
        heuristic: Heuristic as CombinationWord = Heuristic::Balance,
        /// The estimator of the transmittance to the lights; that of the camera ray by default.
        shadow: Option<EstimatorSpec> as Maybe<ForAllRays> = None,
        /// Neighbouring pixels that share one fitted control.
        shared_explorers: u32 as Whole<1, MOST> = 1,
        /// Variates of the samples of a pixel.
        points: SamplerSpec as Among,
    }
    check |spec, object| spec.points.check(object)
}

impl IntegratorKind for SingleScatteringSpec {
    fn sampler(&self) -> Option<&SamplerSpec> {
        Some(&self.points)
    }
    fn bias(&self) -> Option<&'static str> {
        let is_biased = EstimatorSpec::is_biased_baseline;
        super::of_a_baseline(is_biased(&self.estimator) || self.shadow.as_ref().is_some_and(is_biased))
    }
}
