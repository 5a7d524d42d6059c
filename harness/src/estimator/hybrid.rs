//! A choice between unbiased ray marching and jittered ratio tracking, by pilots.

use super::erased::ByMajorant;
use super::pilots::{PILOTS, experience};
use super::unbiased_ray_marching::FEW_SEGMENTS;
use super::{EstimatorKind, Expected, InScene, Preparation, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Maybe, NonNegative};
use crate::{Failure, kind};
use fairflight_media::Majorant;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{
    Choice, CombShape, Experience, Hybrid, Pilot, TransmittanceEstimator, teeth_for,
};
use std::iter::repeat_n;

kind! {
    /// Unbiased ray marching or jittered ratio tracking, chosen by pilots.
    HybridSpec = "hybrid" {
        /// An upper bound of σ_t \[1/length\]; what the field declares by default.
        majorant: Option<f64> as Maybe<NonNegative> = None,
    }
}

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
        let (experience, lookups) = experience(repeat_n(profile, PILOTS as usize), majorant);
        let mut prepared = Prepared::hybrid(&experience, profile, majorant, Hybrid::USUAL_BUDGET)?;
        prepared
            .variance
            .push_str(&format!(", by {PILOTS} pilots of {lookups} look-ups together, which are not charged"));
        Ok(prepared)
    }

    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        let key = format!("{key}.majorant");
        let majorant = scene.majorant(self.majorant, &key)?;
        let claim = ByMajorant::new((), majorant).map_err(|error| refuse(&key, error))?;
        let profiles = scene.profiles();
        let pilot = |profile: &AnyProfile| Pilot::lookups(majorant * profile.length()) as f64;
        scene.affords(profiles.iter().map(pilot), &key)?;
        let (experience, lookups) = experience(profiles.iter(), majorant);
        let purpose = format!("the choice, by pilots on {} rays of the scene", profiles.len());
        let choices = Choices::of(&experience, majorant, scene.longest());
        Ok(Shadow::erased(claim.with(choices)).after(Preparation { lookups, purpose }))
    }

    fn work(&self, ray: RayKnown) -> Work {
        let depth = self.majorant.map_or_else(|| ray.declared_depth(), |majorant| ray.depth(majorant));
        let most = (Hybrid::USUAL_BUDGET * depth).max(f64::from(teeth_for(depth)));
        Work::of("estimator.majorant", Expected::Between(0.0, most))
            .after(f64::from(PILOTS) * Pilot::lookups(depth) as f64)
    }
}

/// A choice for each class of lengths, the longest first: made once, as one for each ray would cost more than its estimate.
#[derive(Clone, Debug)]
struct Choices(Vec<(f64, Hybrid)>);

impl Choices {
    /// Octaves of lengths; shorter rays are estimated as the shortest of these.
    const OCTAVES: u32 = 10;
    /// The lengths of an octave, over its greatest.
    const STEPS: [f64; 4] = [1.0, 0.875, 0.75, 0.625];

    fn of(experience: &Experience, majorant: f64, longest: f64) -> Self {
        let choose = |length: f64| {
            (length, Hybrid::choose(experience, length, majorant * length, Hybrid::USUAL_BUDGET))
        };
        let octave = |k: u32| longest * 0.5_f64.powi(k as i32);
        Self((0..Self::OCTAVES).flat_map(|k| Self::STEPS.map(|step| choose(step * octave(k)))).collect())
    }

    /// The choice of the shortest class that is as long as the ray.
    fn on(&self, length: f64) -> &Hybrid {
        let shorter = self.0.partition_point(|(class, _)| *class >= length);
        &self.0[shorter.saturating_sub(1)].1
    }
}

impl<F: Majorant> TransmittanceEstimator<F> for Choices {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.on(field.length()).estimate(field, source)
    }
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.on(field.length()).admits(field, s, sigma_t)
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

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Bounded, Constant};

    #[test]
    fn a_ray_takes_the_choice_of_the_shortest_class_that_is_as_long() {
        let constant = Constant::new(0.5, 8.0).unwrap();
        let mut experience = Experience::default();
        let mut source = fairflight_sources::Seeded::new(1);
        (0..8).for_each(|_| {
            experience.observe(&Pilot::of(&Bounded::new(&constant, 1.0).unwrap(), &mut source));
        });
        let choices = Choices::of(&experience, 1.0, 16.0);
        for (length, class) in [
            (20.0, 16.0),
            (16.0, 16.0),
            (15.0, 16.0),
            (14.0, 14.0),
            (8.0, 8.0),
            (7.5, 8.0),
            (1e-9, 0.625 / 32.0),
        ] {
            assert_eq!(
                *choices.on(length),
                Hybrid::choose(&experience, class, class, Hybrid::USUAL_BUDGET),
                "{length}"
            );
        }
    }
}
