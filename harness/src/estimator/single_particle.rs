//! Tracking that keeps at most one particle per collision.

use super::ray::RayKind;
use super::tracking::{for_all_rays, of_one_ray, tracking, with_facts};
use super::{
    AnyControl, AnySampling, ControlSpec, EstimatorKind, Expected, InScene, Prepared, RayKnown, SamplingSpec,
    Shadow, Work,
};
use crate::field::AnyProfile;
use crate::reader::Node;
use crate::reader::rule::{Own, Rule};
use crate::{Failure, kind, words};
use fairflight_collision::{Albedo, SingleParticle, Version};
use fairflight_transmittance::Tracking;
use serde_json::{Value, json};

words! {
    /// The rule of the probabilities of a collision.
    pub VersionWord for Version {
        "terminating" => Version::Terminating,
        "non_terminating" => Version::NonTerminating,
        "adaptive" => Version::Adaptive,
    }
}

/// A number from 0 to 1.
#[derive(Debug)]
pub(super) struct AlbedoNumber;

impl Rule<Albedo> for AlbedoNumber {
    fn read(node: &Node<'_>) -> Result<Albedo, Failure> {
        Albedo::new(node.within(0.0, 1.0)?).map_err(|error| node.reject(error))
    }
    fn written(albedo: &Albedo) -> Value {
        json!(albedo.get())
    }
    fn schema() -> Value {
        json!({ "type": "number", "minimum": 0, "maximum": 1 })
    }
}

kind! {
    /// At most one particle leaves a collision (szirmay-kalos-2017 sections 4.3 to 4.5).
    SingleParticleSpec = "single_particle" {
        /// The rule of the probabilities of a collision.
        version: Version as VersionWord,
        /// σ_s/σ_t, which sets how often a particle scatters instead.
        albedo: Albedo as AlbedoNumber,
        /// The sampling extinction \[1/length\]: a number, or one per cell.
        sigma_samp: SamplingSpec as Own,
        /// The control, whose transmittance is known in closed form.
        control: ControlSpec as Own = ControlSpec::none(),
    }
}

impl SingleParticleSpec {
    fn model(&self) -> SingleParticle {
        SingleParticle { version: self.version, albedo: self.albedo }
    }
}

impl EstimatorKind for SingleParticleSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let tracking = tracking(self.model(), &self.sigma_samp, &self.control, profile)?;
        let variance = "variance: szirmay-kalos-2017 eq. 16, integrated over the ray";
        let trial = match (tracking.control(), tracking.sampling()) {
            // The usual case: no branch at each look-up, and lanes.
            (AnyControl::None(none), AnySampling::Constant(rate)) => {
                profile.trial_in_lanes(Tracking::new(self.model(), *none, *rate))
            }
            _ => profile.trial(tracking.clone()),
        };
        let prepared = Prepared::new("single_particle", trial, variance);
        Ok(with_facts(prepared, tracking, profile))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        for_all_rays(self.model(), &self.sigma_samp, &self.control, key)
            .map(RayKind::SingleParticle)
            .map(Shadow::of)
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        of_one_ray(&self.sigma_samp, &self.control)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("estimator.sigma_samp", Expected::Between(0.0, ray.sampled(&self.sigma_samp)))
            .after_on_each_ray(self.control.explorers())
    }
}
