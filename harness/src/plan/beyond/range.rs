//! Which values an estimate can take, by what is known of σ_t: an end of its law is what a verdict without a closed variance rests on.

use crate::plan::{AnyProfile, Field, FieldJob, KnownField};

/// What σ_t is known not to fall below and not to exceed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds {
    pub(super) least: Option<f64>,
    pub(super) most: Option<f64>,
}

impl Bounds {
    /// Of a profile.
    pub(super) fn of(profile: &AnyProfile) -> Self {
        struct Known;
        impl FieldJob for Known {
            type Output = Bounds;
            fn run<F: KnownField>(self, field: &F) -> Bounds
            where
                for<'a> &'a F: Field,
            {
                let knowledge = field.knowledge();
                Bounds { least: knowledge.lower_bound, most: knowledge.upper_bound }
            }
        }
        profile.with(Known)
    }

    /// The range of products and sums of 1 − σ_t/μ, μ = `majorant`: never negative where μ is a majorant.
    pub(super) fn of_null_collisions(self, majorant: f64) -> Option<(f64, f64)> {
        (self.most? <= majorant).then_some((0.0, f64::INFINITY))
    }

    /// The range of telescoping combs: T_0 at most, as no difference is positive. A comb sums the least σ_t over the profile, and
    /// `matched` ends take half a step of the difference between two values.
    pub(super) fn of_telescoping(self, length: f64, teeth: u32, matched: bool) -> Option<(f64, f64)> {
        let least = self.least?;
        let ends = if matched { 0.5 * length / f64::from(teeth) * (self.most? - least) } else { 0.0 };
        Some((f64::NEG_INFINITY, (ends - least * length).exp()))
    }

    /// The range of a walk that is clamped at its guess of a majorant.
    pub(super) fn of_clamped_walk(self) -> Option<(f64, f64)> {
        (self.least? >= 0.0).then_some((0.0, 1.0))
    }
}
