//! What is learned on a profile before the first estimate, where there are no earlier rays: from streams that no estimate draws from.

use crate::plan::{AnyProfile, Field, FieldJob, KnownField};
use fairflight_media::Bounded;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_transmittance::{Experience, Pilot, RunningCumulant, UnbiasedRayMarching};

/// Draws that a self-tuned roulette learns from, and the stream they come from: none of an estimate, whatever its seed.
pub(in crate::plan) const TUNING: u32 = 32;
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

/// Pilots of the same profile that teach a hybrid: their variates are those of no estimate.
pub(in crate::plan) const PILOTS: u32 = 8;
const PILOT_SEED: u64 = 0x7069_6C6F;

/// A look at a profile below `majorant`, from the stream of `seed`; of a medium without extinction it tells nothing.
#[must_use]
pub fn pilot(profile: &AnyProfile, majorant: f64, seed: u64) -> Pilot {
    struct Look {
        majorant: f64,
        seed: u64,
    }
    impl FieldJob for Look {
        type Output = Pilot;
        fn run<F: KnownField>(self, field: &F) -> Pilot
        where
            for<'a> &'a F: Field,
        {
            match Bounded::new(field, self.majorant) {
                Ok(bounded) if self.majorant > 0.0 => Pilot::of(&bounded, &mut Seeded::new(self.seed)),
                _ => Pilot::default(),
            }
        }
    }
    profile.with(Look { majorant, seed })
}

/// The variance of a comb in one segment, by an estimator whose roulette never stops at once.
pub(super) fn comb_variance(profile: &AnyProfile, estimator: UnbiasedRayMarching) -> f64 {
    profile.with(Tune { estimator })
}

/// What pilots of the profile tell.
pub(super) fn experience(profile: &AnyProfile, majorant: f64) -> Experience {
    let mut experience = Experience::default();
    (0..PILOTS).for_each(|k| {
        experience.observe(&pilot(profile, majorant, derive_seed(PILOT_SEED, u64::from(k))));
    });
    experience
}
