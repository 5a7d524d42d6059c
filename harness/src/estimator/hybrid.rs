//! A choice between unbiased ray marching and jittered ratio tracking, by pilots.

use super::erased::ByMajorant;
use super::pilots::{PILOTS, experience};
use super::unbiased_ray_marching::FEW_SEGMENTS;
use super::{EstimatorKind, Expected, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Maybe, NonNegative};
use crate::{Failure, kind};
use fairflight_transmittance::{Choice, CombShape, Experience, Hybrid, Pilot, teeth_for};

kind! {
    /// Unbiased ray marching or jittered ratio tracking, chosen by pilots.
    HybridSpec = "hybrid" {
        /// An upper bound of σ_t \[1/length\]; what the field declares by default.
        majorant: Option<f64> as Maybe<NonNegative> = None,
    }
}

const OF_ONE_RAY: &str = "hybrid chooses for one ray, but a scene has many";

impl Prepared {
    /// The hybrid that chooses by `experience`, with a budget of so many look-ups per unit of the majorant's depth.
    ///
    /// # Errors
    /// If no field can have that majorant.
    pub fn hybrid(
        experience: &Experience,
        profile: &AnyProfile,
        majorant: f64,
        budget: f64,
    ) -> Result<Self, Failure> {
        let hybrid = Hybrid::choose(experience, profile.length(), majorant * profile.length(), budget);
        let variance = format!("variance: that of what it chose; {}", chosen(&hybrid));
        let costly =
            matches!(hybrid.choice(), Choice::Marching(marching) if marching.segments() > FEW_SEGMENTS);
        let estimator =
            ByMajorant::new(hybrid, majorant).map_err(|error| refuse("estimator.majorant", error))?;
        let prepared = Self::new("hybrid", profile.erased_trial(estimator), variance).claiming(majorant);
        Ok(Self { closed_form_is_costly: costly, ..prepared })
    }
}

impl EstimatorKind for HybridSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let majorant = self.majorant.or_else(|| profile.declared()).ok_or_else(|| {
            Failure::refused(
                "estimator: hybrid needs a majorant; give `majorant` or use unbiased_ray_marching with `teeth`, which needs none",
            )
        })?;
        let experience = experience(profile, majorant);
        let mut prepared = Prepared::hybrid(&experience, profile, majorant, Hybrid::USUAL_BUDGET)?;
        let lookups = u64::from(PILOTS) * Pilot::lookups(majorant * profile.length());
        prepared
            .variance
            .push_str(&format!(", by {PILOTS} pilots of {lookups} look-ups together, which are not charged"));
        Ok(prepared)
    }

    fn for_all_rays(&self, key: &str) -> Result<Shadow, Failure> {
        Err(refuse(&format!("{key}.kind"), OF_ONE_RAY))
    }

    fn of_one_ray(&self) -> Option<(&'static str, String)> {
        Some(("kind", OF_ONE_RAY.to_owned()))
    }

    fn work(&self, ray: RayKnown) -> Work {
        let depth = self.majorant.map_or_else(|| ray.declared_depth(), |majorant| ray.depth(majorant));
        let most = (Hybrid::USUAL_BUDGET * depth).max(f64::from(teeth_for(depth)));
        Work::of("estimator.majorant", Expected::Between(0.0, most))
            .after(f64::from(PILOTS) * Pilot::lookups(depth) as f64)
    }
}

/// The choice of a hybrid, in words.
fn chosen(hybrid: &Hybrid) -> String {
    match hybrid.choice() {
        Choice::Marching(marching) => {
            let matched =
                if marching.comb().shape() == CombShape::EndpointMatched { ", ends matched" } else { "" };
            format!(
                "chosen: unbiased ray marching, {} segment(s) of {} teeth{matched}, P = {:.4}",
                marching.segments(),
                marching.comb().teeth(),
                marching.roulette().going_on()
            )
        }
        Choice::Jittered(jittered) => {
            format!("chosen: jittered ratio tracking, epsilon = {}", jittered.epsilon())
        }
    }
}
