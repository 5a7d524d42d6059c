//! Unbiased ray marching, and what comes after it.

use super::pilots::{TUNING, comb_variance};
use super::{EstimatorKind, Expected, InScene, MOST, Preparation, Prepared, RayKnown, Shadow, Work, refuse};
use crate::field::AnyProfile;
use crate::reader::rule::{Flag, Maybe, NonNegative, Own, Ruled, Whole};
use crate::reader::{Node, Object};
use crate::{Failure, kind, words};
use fairflight_media::Extinction;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{
    Comb, CombShape, Roulette, TransmittanceEstimator, UnbiasedRayMarching, teeth_for,
};
use serde_json::{Value, json};
use std::iter::repeat_n;

/// A family of combs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CombWord {
    /// Equidistant teeth of equal weight.
    Uniform,
    /// Teeth closer to the ends.
    Periodised,
    /// Corrected for the differences of derivatives at the ends.
    Bernoulli,
}

words! {
    /// The families of combs.
    pub(super) CombRule for CombWord {
        "uniform" => CombWord::Uniform,
        "periodised" => CombWord::Periodised,
        "bernoulli" => CombWord::Bernoulli,
    }
}

/// The rule by which the series of an unbiased ray march stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RouletteSpec {
    /// The roulette that stops with this probability at once.
    Stop(f64),
    /// The roulette that fits the variance of earlier combs.
    SelfTuned,
}

impl RouletteSpec {
    /// P = 0.1 (kettunen-2021).
    pub const USUAL: Self = Self::Stop(0.9);
}

impl Ruled for RouletteSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if node.text().is_ok_and(|text| text == "self_tuned") {
            return Ok(Self::SelfTuned);
        }
        match node.within(0.0, 1.0) {
            Ok(stop) if stop < 1.0 => Ok(Self::Stop(stop)),
            _ => Err(node.refuse("must be a probability of stopping below 1, or self_tuned")),
        }
    }

    fn written(&self) -> Value {
        match self {
            Self::Stop(stop) => json!(stop),
            Self::SelfTuned => json!("self_tuned"),
        }
    }

    fn schema() -> Value {
        json!({ "anyOf": [{ "type": "number", "minimum": 0, "exclusiveMaximum": 1 }, { "const": "self_tuned" }] })
    }
}

kind! {
    /// A power series about a comb, of independent combs (kettunen-2021).
    UnbiasedRayMarchingSpec = "unbiased_ray_marching" {
        /// The optical thickness from which the rule takes the teeth; that of the field's majorant by default.
        pivot: Option<f64> as Maybe<NonNegative> = None,
        /// Look-ups per comb; by the rule by default.
        teeth: Option<u32> as Maybe<Whole<1, MOST>> = None,
        /// True to correct a uniform comb for the difference of its ends.
        endpoint_matching: Option<bool> as Maybe<Flag> = None,
        /// The order of a Bernoulli comb.
        order: Option<u32> as Maybe<Whole<2, 3>> = None,
        /// The family of combs.
        comb: CombWord as CombRule = CombWord::Uniform,
        /// The probability of stopping at once, or self_tuned.
        roulette: RouletteSpec as Own = RouletteSpec::USUAL,
        /// Factors of the transmittance.
        segments: u32 as Whole<1, MOST> = 1,
    }
    check UnbiasedRayMarchingSpec::check
}

/// Number of segments above which their closed form is costly.
pub(super) const FEW_SEGMENTS: u32 = 8;

impl UnbiasedRayMarchingSpec {
    /// The spec of one segment of so many teeth in a comb of some shape.
    #[must_use]
    pub fn of(shape: CombShape, teeth: u32) -> Self {
        let (comb, endpoint_matching, order) = match shape {
            CombShape::Uniform => (CombWord::Uniform, Some(false), None),
            CombShape::EndpointMatched => (CombWord::Uniform, Some(true), None),
            CombShape::Bernoulli2 => (CombWord::Bernoulli, None, Some(2)),
            CombShape::Bernoulli3 => (CombWord::Bernoulli, None, Some(3)),
            CombShape::Periodised => (CombWord::Periodised, None, None),
        };
        let (pivot, teeth) = (None, Some(teeth));
        Self { pivot, teeth, endpoint_matching, order, comb, roulette: RouletteSpec::USUAL, segments: 1 }
    }

    /// The teeth by the rule, from an optical thickness.
    #[must_use]
    pub fn by_the_rule(self, pivot: f64) -> Self {
        Self { pivot: Some(pivot), teeth: None, ..self }
    }

    /// The shape of its combs.
    #[must_use]
    pub fn shape(&self) -> CombShape {
        match (self.comb, self.order, self.endpoint_matching) {
            (CombWord::Uniform, _, Some(false)) => CombShape::Uniform,
            (CombWord::Uniform, ..) => CombShape::EndpointMatched,
            (CombWord::Periodised, ..) => CombShape::Periodised,
            (CombWord::Bernoulli, Some(2), _) => CombShape::Bernoulli2,
            (CombWord::Bernoulli, ..) => CombShape::Bernoulli3,
        }
    }

    /// The teeth, where the field's majorant has the optical thickness `declared`.
    #[must_use]
    pub fn teeth(&self, declared: f64) -> u32 {
        self.teeth.unwrap_or_else(|| teeth_for(self.pivot.unwrap_or(declared)))
    }

    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        if self.teeth.is_some() && self.pivot.is_some() {
            return Err(object.required("pivot")?.reject("is for the rule of `teeth`: give one of the two"));
        }
        if self.comb == CombWord::Bernoulli {
            object.required("order")?;
        } else if self.order.is_some() {
            return Err(object.required("order")?.reject("belongs to the comb bernoulli"));
        }
        if self.comb != CombWord::Uniform && self.endpoint_matching.is_some() {
            return Err(object.required("endpoint_matching")?.reject("belongs to the comb uniform"));
        }
        Ok(())
    }

    fn with(&self, teeth: u32, roulette: Roulette, key: &str) -> Result<UnbiasedRayMarching, Failure> {
        let comb = Comb::new(teeth, self.shape()).map_err(|error| refuse(&format!("{key}.teeth"), error))?;
        UnbiasedRayMarching::new(comb, roulette)
            .in_segments(self.segments)
            .map_err(|error| refuse(&format!("{key}.segments"), error))
    }

    fn stopping(stop: f64, key: &str) -> Result<Roulette, Failure> {
        Roulette::new(stop).map_err(|error| refuse(&format!("{key}.roulette"), error))
    }
}

/// The teeth of a ray.
#[derive(Clone, Copy, Debug)]
enum Teeth {
    Always(u32),
    /// The number of teeth by the rule, from the optical thickness of this majorant \[1/length\].
    OfMajorant(f64),
}

impl Teeth {
    fn on(self, length: f64) -> u32 {
        match self {
            Self::Always(teeth) => teeth,
            Self::OfMajorant(majorant) => teeth_for(majorant * length),
        }
    }
}

/// The estimator of any ray of a scene: as this one, with teeth of its own.
#[derive(Clone, Copy, Debug)]
struct OnAnyRay {
    rule: Teeth,
    estimator: UnbiasedRayMarching,
}

impl OnAnyRay {
    fn on(&self, length: f64) -> UnbiasedRayMarching {
        let comb = Comb::new(self.rule.on(length), self.estimator.comb().shape());
        let comb = comb.expect("a ray has a tooth at least");
        UnbiasedRayMarching::new(comb, self.estimator.roulette())
            .in_segments(self.estimator.segments())
            .expect("the number of segments is that of an estimator")
    }
}

impl<F: Extinction> TransmittanceEstimator<F> for OnAnyRay {
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.on(field.length()).estimate(field, source)
    }
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(field, s, sigma_t)
    }
}

impl EstimatorKind for UnbiasedRayMarchingSpec {
    fn prepare(&self, profile: &AnyProfile) -> Result<Prepared, Failure> {
        let key = "estimator";
        let needs = "the rule for the teeth of unbiased_ray_marching needs an optical thickness; give `teeth` or `pivot`";
        let teeth = match (self.teeth, self.pivot) {
            (None, None) => teeth_for(profile.declared_depth(needs)?),
            _ => self.teeth(f64::NAN),
        };
        let mut variance =
            "variance: closed form in the moments of a comb, integrated over its offset".to_owned();
        let roulette = match self.roulette {
            RouletteSpec::Stop(stop) => Self::stopping(stop, key)?,
            RouletteSpec::SelfTuned => {
                let estimator = self.with(teeth, Self::stopping(0.0, key)?, key)?;
                let (k2, _) = comb_variance(repeat_n((profile, estimator), TUNING as usize));
                let roulette = Roulette::tuned(k2);
                variance.push_str(&format!(
                    "; roulette: P = {:.4} from k2 = {k2:.3e} per segment, found by {TUNING} earlier draws whose look-ups are not charged",
                    roulette.going_on()
                ));
                roulette
            }
        };
        let trial = profile.erased_trial_in_lanes(self.with(teeth, roulette, key)?);
        let prepared = Prepared::new("unbiased_ray_marching", trial, variance);
        Ok(Prepared { closed_form_is_costly: self.segments > FEW_SEGMENTS, ..prepared })
    }

    fn for_all_rays(&self, scene: &InScene<'_>, key: &str) -> Result<Shadow, Failure> {
        let rule = match (self.teeth, self.pivot) {
            (None, None) => Teeth::OfMajorant(scene.majorant(None, &format!("{key}.teeth"))?),
            _ => Teeth::Always(self.teeth(f64::NAN)),
        };
        let with = |roulette: Roulette| {
            // What is wrong is so on every ray.
            let estimator = self.with(rule.on(scene.longest()), roulette, key)?;
            Ok(OnAnyRay { rule, estimator })
        };
        let RouletteSpec::Stop(stop) = self.roulette else {
            let never_at_once: OnAnyRay = with(Self::stopping(0.0, key)?)?;
            let profiles = scene.profiles();
            let on = |profile: &AnyProfile| never_at_once.on(profile.length());
            scene.affords(profiles.iter().map(|profile| on(profile).expected_lookups()), key)?;
            let draws = profiles.iter().cycle().take(TUNING as usize);
            let (k2, lookups) = comb_variance(draws.map(|profile| (profile, on(profile))));
            let roulette = Roulette::tuned(k2);
            let purpose = format!(
                "the roulette, P = {:.4}, from {TUNING} draws on {} rays of the scene",
                roulette.going_on(),
                profiles.len()
            );
            return Ok(Shadow::erased(with(roulette)?).after(Preparation { lookups, purpose }));
        };
        with(Self::stopping(stop, key)?).map(Shadow::erased)
    }

    fn work(&self, ray: RayKnown) -> Work {
        let teeth = f64::from(self.teeth(ray.declared_depth()));
        // Ends, shared between segments, are no more than a few for each.
        let combs = |stop: f64| {
            let order = Roulette::new(stop).map_or(0.0, |roulette| roulette.expected_order());
            f64::from(self.segments) * (1.0 + order) * teeth
        };
        let key = "estimator.teeth";
        match self.roulette {
            RouletteSpec::Stop(stop) => Work::of(key, Expected::Exactly(combs(stop))),
            RouletteSpec::SelfTuned => {
                Work::of(key, Expected::Between(0.0, combs(0.0))).after(f64::from(TUNING) * combs(0.0))
            }
        }
    }
}
