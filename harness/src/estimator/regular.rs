//! The closed form of a profile, as an estimator.

use super::{EstimatorKind, Expected, InScene, Prepared, RayKnown, Shadow, Work};
use crate::field::AnyProfile;
use crate::{Failure, kind};
use fairflight_media::{Extinction, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};

kind! {
    /// exp(−τ) in closed form, where the profile has one.
    RegularSpec = "regular" {}
}

/// exp(−τ) from the closed form that the profile has: evaluated anew for each estimate, so that its seconds are those of the
/// closed form.
#[derive(Debug)]
struct Exact(AnyProfile);

impl<F: Extinction> TransmittanceEstimator<F> for Exact {
    fn estimate(&self, _field: &F, _source: &mut impl UniformSource) -> f64 {
        self.0.field().knowledge().optical_thickness.map_or(f64::NAN, |tau| (-tau).exp())
    }
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t.is_finite()
    }
}

impl<F: Extinction> ClosedForm<F> for Exact {
    fn theory(&self, _nodes: &mut RayQuadrature<F>, _tau: f64, _tolerance: Tolerance) -> Theory {
        Theory::exact()
    }
}

impl EstimatorKind for RegularSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        if profile.field().knowledge().optical_thickness.is_none() {
            return Err(Failure::refused(
                "estimator: regular needs a profile whose optical thickness has a closed form (constant, piecewise_constant, \
                 piecewise_linear, or a ray through a homogeneous, analytic_cosine or vdb medium); use unbiased_ray_marching, which \
                 needs look-ups only",
            ));
        }
        let trial = profile.erased_trial(Exact(profile.clone()));
        Ok(Prepared::new("regular", trial, "variance: none").within(Some((0.0, f64::INFINITY))))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, _key: &str) -> Result<Shadow, Failure> {
        Ok(Shadow::Regular)
    }

    fn work(&self, ray: RayKnown) -> Work {
        Work::of("profile", Expected::Exactly(ray.breakpoints as f64 + 1.0))
    }
}
