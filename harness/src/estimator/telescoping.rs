//! Debiasing by telescoping levels.

use super::{EstimatorKind, Expected, InScene, MOST, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Flag, Number, Whole};
use crate::{Failure, kind};
use fairflight_transmittance::{CombShape, Telescoping};

kind! {
    /// A coarse comb and the difference between two finer ones (misso-2022).
    TelescopingSpec = "telescoping" {
        /// Look-ups of the coarsest comb.
        teeth: u32 as Whole<1, MOST>,
        /// The probability of stopping at a level.
        level_ratio: f64 as Number,
        /// True to correct each comb for the difference of its ends.
        endpoint_matching: bool as Flag = true,
    }
}

impl TelescopingSpec {
    fn estimator(&self, key: &str) -> Result<Telescoping, Failure> {
        let shape = if self.endpoint_matching { CombShape::EndpointMatched } else { CombShape::Uniform };
        Telescoping::new(self.teeth, self.level_ratio, shape)
            .map_err(|error| refuse(&format!("{key}.level_ratio"), error))
    }
}

impl EstimatorKind for TelescopingSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let trial = profile.erased_trial_in_lanes(self.estimator("estimator")?);
        let variance = "variance: closed form in the moments of a comb, integrated over its offset";
        let knowledge = profile.field().knowledge();
        let range = knowledge.of_telescoping(profile.length(), self.teeth, self.endpoint_matching);
        Ok(Prepared::new("telescoping", trial, variance).within(range))
    }

    fn for_all_rays(&self, _scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        self.estimator(key).map(Shadow::erased)
    }

    fn work(&self, _ray: RayKnown) -> Work {
        // Level l has 2^l combs, and is reached with the probability r (1 − r)^l.
        let r = self.level_ratio;
        let combs = if r > 0.5 { r / (2.0 * r - 1.0) } else { 1.0 };
        Work::of("estimator.level_ratio", Expected::Exactly(f64::from(self.teeth) * combs))
    }
}
