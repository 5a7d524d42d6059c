//! What is learned on a profile before the first estimate, where there are no earlier rays: from streams that no estimate draws from.

use crate::plan::{AnyProfile, Field, FieldJob, KnownField};
use fairflight_media::Bounded;
use fairflight_sources::Seeded;
use fairflight_transmittance::{Experience, Pilot, RunningCumulant, UnbiasedRayMarching};

/// Draws that a self-tuned roulette learns from, and the stream they come from: none of an estimate, whatever its seed.
pub(super) const TUNING: u32 = 32;
const TUNING_SEED: u64 = 0x7475_6E65;

/// The variance of a comb in one segment, by draws that always make several combs.
struct Tune {
    estimator: UnbiasedRayMarching,
}

impl FieldJob for Tune {
    type Output = f64;
    fn run<F: KnownField>(self, field: &F) -> f64
    where
        for<'a> &'a F: Field,
    {
        let mut earlier = RunningCumulant::new();
        let mut source = Seeded::new(TUNING_SEED);
        for _ in 0..TUNING {
            self.estimator.estimate_and_observe(&field, &mut source, &mut earlier);
        }
        earlier.value().unwrap_or(0.0)
    }
}

/// Rays of the same profile that teach a hybrid, where there is no other: their variates are those of no estimate.
pub(super) const PILOTS: u32 = 8;
const PILOT_SEED: u64 = 0x7069_6C6F;

struct Teach {
    majorant: f64,
}

impl FieldJob for Teach {
    type Output = Experience;
    fn run<F: KnownField>(self, field: &F) -> Experience
    where
        for<'a> &'a F: Field,
    {
        let mut experience = Experience::default();
        if let Ok(bounded) = Bounded::new(field, self.majorant)
            && self.majorant > 0.0
        {
            let mut source = Seeded::new(PILOT_SEED);
            for _ in 0..PILOTS {
                experience.observe(&Pilot::of(&bounded, &mut source));
            }
        }
        experience
    }
}

/// The variance of a comb in one segment, by an estimator whose roulette never stops at once.
pub(super) fn comb_variance(profile: &AnyProfile, estimator: UnbiasedRayMarching) -> f64 {
    profile.with(Tune { estimator })
}

/// What pilots of the profile tell.
pub(super) fn experience(profile: &AnyProfile, majorant: f64) -> Experience {
    profile.with(Teach { majorant })
}
