//! What is learned on a profile before the first estimate, where there are no earlier rays: from streams that no estimate draws from.

use crate::field::AnyProfile;
use fairflight_media::Bounded;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_transmittance::{Experience, Pilot, RunningCumulant, UnbiasedRayMarching};

/// Draws that a self-tuned roulette learns from, and the stream they come from: none of an estimate, whatever its seed.
pub(super) const TUNING: u32 = 32;
const TUNING_SEED: u64 = 0x7475_6E65;

/// The variance of a comb in one segment, by an estimator whose roulette never stops at once: each draw makes several combs.
pub(super) fn comb_variance(profile: &AnyProfile, estimator: UnbiasedRayMarching) -> f64 {
    let mut earlier = RunningCumulant::new();
    let mut source = Seeded::new(TUNING_SEED);
    for _ in 0..TUNING {
        estimator.estimate_and_observe(&profile.field(), &mut source, &mut earlier);
    }
    earlier.value().unwrap_or(0.0)
}

/// Pilots of the same profile that teach a hybrid: their variates are those of no estimate.
pub(super) const PILOTS: u32 = 8;
const PILOT_SEED: u64 = 0x7069_6C6F;

/// A look at a profile below `majorant`, from the stream of `seed`; of a medium without extinction it tells nothing.
#[must_use]
pub fn pilot(profile: &AnyProfile, majorant: f64, seed: u64) -> Pilot {
    match Bounded::new(profile.field(), majorant) {
        Ok(bounded) if majorant > 0.0 => Pilot::of(&bounded, &mut Seeded::new(seed)),
        _ => Pilot::default(),
    }
}

/// What pilots of the profile tell.
pub(super) fn experience(profile: &AnyProfile, majorant: f64) -> Experience {
    let mut experience = Experience::default();
    (0..PILOTS).for_each(|k| {
        experience.observe(&pilot(profile, majorant, derive_seed(PILOT_SEED, u64::from(k))));
    });
    experience
}
