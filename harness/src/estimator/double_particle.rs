//! Ratio tracking, residual ratio tracking, and all beyond.

use super::ray::RayKind;
use super::tracking::{for_all_rays, of_one_ray, tracking, with_facts};
use super::{
    AnyControl, AnySampling, ControlSpec, EstimatorKind, Expected, InScene, Prepared, RayKnown, SamplingSpec,
    Shadow, Work,
};
use crate::field::AnyProfile;
use crate::reader::rule::Own;
use crate::{Failure, kind};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_transmittance::Tracking;

kind! {
    /// Ratio tracking, with a control residual ratio tracking (szirmay-kalos-2017 section 4.2).
    DoubleParticleSpec = "double_particle" {
        /// The sampling extinction \[1/length\]: a number, or one per cell.
        sigma_samp: SamplingSpec as Own,
        /// The control, whose transmittance is known in closed form.
        control: ControlSpec as Own = ControlSpec::none(),
    }
}

/// The albedo does not enter: only the transmitted particle is followed.
fn model() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

impl DoubleParticleSpec {
    /// The spec with a constant sampling extinction \[1/length\].
    #[must_use]
    pub fn at(sigma_samp: f64, control: ControlSpec) -> Self {
        Self { sigma_samp: SamplingSpec::Constant(sigma_samp), control }
    }
}

impl EstimatorKind for DoubleParticleSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let tracking = tracking(model(), &self.sigma_samp, &self.control, profile)?;
        let variance = "variance: szirmay-kalos-2017 eq. 16, integrated over the ray";
        let trial = match (tracking.control(), tracking.sampling()) {
            // The usual cases: no branch at each look-up, and lanes.
            (AnyControl::None(none), AnySampling::Constant(rate)) => {
                profile.trial_in_lanes(Tracking::new(model(), *none, *rate))
            }
            (AnyControl::Constant(control), AnySampling::Constant(rate)) => {
                profile.trial_in_lanes(Tracking::new(model(), *control, *rate))
            }
            _ => profile.trial(tracking.clone()),
        };
        let prepared = Prepared::new("double_particle", trial, variance);
        Ok(with_facts(prepared, tracking, profile))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        for_all_rays(model(), &self.sigma_samp, &self.control, key)
            .map(RayKind::DoubleParticle)
            .map(Shadow::of)
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        of_one_ray(&self.sigma_samp, &self.control)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("estimator.sigma_samp", Expected::Exactly(ray.sampled(&self.sigma_samp)))
            .after_on_each_ray(self.control.explorers())
    }
}
