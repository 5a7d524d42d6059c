//! Ray marching: a biased baseline.

use super::ray::RayKind;
use super::{EstimatorKind, Expected, InScene, MOST_POINTS, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Flag, Whole};
use crate::{Failure, kind};
use fairflight_laws::scores::{self, Interval};
use fairflight_transmittance::{Offset, RayMarching};

kind! {
    /// The exponential of a Riemann sum: a biased baseline.
    RayMarchingSpec = "ray_marching" {
        /// Look-ups per estimate.
        steps: u32 as Whole<1, MOST_POINTS>,
        /// True for one random place in all steps, false for their middles.
        jitter: bool as Flag,
    }
}

impl RayMarchingSpec {
    /// The spec of ray marching with so many steps, with a look-up of each at `offset`.
    #[must_use]
    pub fn at(steps: u32, offset: Offset) -> Self {
        Self { steps, jitter: offset == Offset::Jittered }
    }

    /// The place of a look-up in its step.
    #[must_use]
    pub fn offset(&self) -> Offset {
        if self.jitter { Offset::Jittered } else { Offset::Fixed }
    }

    fn estimator(&self, key: &str) -> Result<RayMarching, Failure> {
        RayMarching::new(self.steps, self.offset()).map_err(|error| refuse(&format!("{key}.steps"), error))
    }
}

impl EstimatorKind for RayMarchingSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.trial_in_lanes(self.estimator("estimator")?);
        let (sigma_t, length) = (Interval::from(profile.field().knowledge()), profile.length());
        Ok(Prepared::new("ray_marching", trial, "variance: quadrature over the offset (a biased baseline)")
            .scoring(move |unit| scores::ray_marching(sigma_t, length, unit))
            .objecting(|place, _, sigma_t| {
                format!("estimator: not defined for sigma_t = {sigma_t} at {place}")
            }))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(RayKind::RayMarching).map(Shadow::of)
    }

    fn work(&self, _ray: RayKnown) -> Work {
        Work::of("estimator.steps", Expected::Exactly(f64::from(self.steps)))
    }

    fn is_biased_baseline(&self) -> bool {
        true
    }
}
