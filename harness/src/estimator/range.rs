//! Range of the values that an estimate can take, and of those of σ_t that it admits.
//!
//! An end of the law of an estimate is what a verdict without a closed variance rests on.

use crate::field::Knowledge;
use fairflight_laws::scores::Interval;

/// The values that σ_t is known not to leave.
impl From<Knowledge> for Interval {
    fn from(knowledge: Knowledge) -> Self {
        Self {
            minimum: knowledge.lower_bound.unwrap_or(f64::NEG_INFINITY),
            maximum: knowledge.upper_bound.unwrap_or(f64::INFINITY),
        }
    }
}

impl Knowledge {
    /// The range of products and sums of 1 − σ_t/μ, μ = `majorant`: never negative where μ is a majorant.
    pub(super) fn of_null_collisions(self, majorant: f64) -> Option<(f64, f64)> {
        (self.upper_bound? <= majorant).then_some((0.0, f64::INFINITY))
    }

    /// The range of telescoping combs: T_0 at most, as no difference is positive. A comb sums the least σ_t over the profile, and
    /// `matched` ends take half a step of the difference between two values.
    pub(super) fn of_telescoping(self, length: f64, teeth: u32, matched: bool) -> Option<(f64, f64)> {
        let least = self.lower_bound?;
        let ends = if matched { 0.5 * length / f64::from(teeth) * (self.upper_bound? - least) } else { 0.0 };
        Some((f64::NEG_INFINITY, (ends - least * length).exp()))
    }

    /// The range of a walk that is clamped at its guess of a majorant.
    pub(super) fn of_clamped_walk(self) -> Option<(f64, f64)> {
        (self.lower_bound? >= 0.0).then_some((0.0, 1.0))
    }
}

/// The objection of a probability σ_t/μ to values below 0.
pub(super) fn below_zero(place: &str, _s: f64, sigma_t: f64) -> String {
    format!("estimator.majorant: needs sigma_t of at least 0, but sigma_t = {sigma_t} at {place}")
}
