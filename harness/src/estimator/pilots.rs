//! Knowledge of a profile gained before the first estimate, where there are no earlier rays: from streams that no estimate draws from.

use crate::field::AnyProfile;
use fairflight_media::{Bounded, Counted};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_transmittance::{Experience, Pilot, RunningCumulant, UnbiasedRayMarching};

/// Draws that a self-tuned roulette learns from, and the stream they come from: none of an estimate, whatever its seed.
pub(super) const TUNING: u32 = 32;
const TUNING_SEED: u64 = 0x7475_6E65;

/// The variance of a comb in one segment, and the look-ups that it took: by a draw of each of these estimators, whose roulette never stops
/// at once, so that each draw makes several combs.
pub(super) fn comb_variance<'a>(
    draws: impl Iterator<Item = (&'a AnyProfile, UnbiasedRayMarching)>,
) -> (f64, u64) {
    let (mut earlier, mut lookups) = (RunningCumulant::new(), 0);
    let mut source = Seeded::new(TUNING_SEED);
    for (profile, estimator) in draws {
        let counted = Counted::new(profile.field());
        estimator.estimate_and_observe(&counted, &mut source, &mut earlier);
        lookups += counted.lookups();
    }
    (earlier.value().unwrap_or(0.0), lookups)
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

/// The experience of a pilot on each of these profiles, and the look-ups of all.
pub(super) fn experience<'a>(
    profiles: impl Iterator<Item = &'a AnyProfile>,
    majorant: f64,
) -> (Experience, u64) {
    let (mut experience, mut lookups) = (Experience::default(), 0);
    for (k, profile) in (0..).zip(profiles) {
        experience.observe(&pilot(profile, majorant, derive_seed(PILOT_SEED, k)));
        lookups += Pilot::lookups(majorant * profile.length());
    }
    (experience, lookups)
}
