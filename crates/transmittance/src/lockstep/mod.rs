//! Estimates of many streams side by side, in the widest registers that the machine has.
//!
//! A lane is a stream with its own walk; where a walk ends the next one of that stream begins. Nothing passes between lanes, and every operation is the one of the
//! scalar estimator, so that the law of this module is equality: lane by lane the bits of the scalar estimates. Its theory is theirs.
//!
//! | in lanes | scalar twin |
//! |---|---|
//! | `tracking`, with any collision model, control and sampling extinction | [`Tracking`](crate::Tracking) |
//! | `woodcock` | [`Woodcock`](crate::Woodcock) |
//! | `strata` | [`JitteredRatio`](crate::JitteredRatio), [`JitteredRatioInCells`](crate::JitteredRatioInCells) |
//! | `combs` | [`UnbiasedRayMarching`](crate::UnbiasedRayMarching), [`Telescoping`](crate::Telescoping), [`Jackknife`](crate::Jackknife) |
//! | `ray_marching` | [`RayMarching`](crate::RayMarching) |

mod batches;
mod combs;
mod products;
mod ray_marching;
mod strata;
mod tracking;
mod walk;
mod watched;
mod woodcock;

pub use products::Products;

use crate::TransmittanceEstimator;
use fairflight_elementary::lanes::Lanes;
use fairflight_elementary::{InstructionSet, LaneWork};
use fairflight_media::Extinction;
use fairflight_sources::SeededLanes;

pub use batches::Batches;
pub use fairflight_elementary::lanes::LANES;
pub use watched::Watched;

/// An estimator that runs in lanes.
///
/// **Law.** [`fill`](Self::fill) writes into each slice, bit for bit, what [`estimate`](TransmittanceEstimator::estimate) returns in turn from
/// [`Seeded::new`](fairflight_sources::Seeded::new) of that lane's seed, and tells as many look-ups.
pub trait Lockstep<F: Extinction>: TransmittanceEstimator<F> {
    /// Fills a slice of estimates from the stream of each lane.
    ///
    /// Has to be inlined into [`LaneWork::run`], as [`fill`] does.
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>);

    /// True where [`admits`](TransmittanceEstimator::admits) holds in all lanes; where it holds in all, it may be false.
    #[inline(always)]
    fn admits_lanes(&self, field: &F, s: &Lanes, sigma_t: &Lanes) -> bool {
        s.iter().zip(sigma_t).fold(true, |all, (&s, &sigma_t)| all & self.admits(field, s, sigma_t))
    }
}

/// Fills a slice of estimates from the stream of each seed, by the widest instruction set that the machine has. Returns the look-ups of each.
pub fn fill<F: Extinction, E: Lockstep<F>>(
    estimator: &E,
    field: &F,
    seeds: [u64; LANES],
    estimates: &mut [&mut [f64]; LANES],
) -> [u64; LANES] {
    fill_by(InstructionSet::widest(), (estimator, field), seeds, &mut Batches::new(estimates, None))
}

/// Fills as [`fill`], and tells the look-ups of each estimate, in slices of the same lengths.
pub fn fill_and_count<'a, F: Extinction, E: Lockstep<F>>(
    estimator: &E,
    field: &F,
    seeds: [u64; LANES],
    estimates: &mut [&'a mut [f64]; LANES],
    lookups: &mut [&'a mut [f64]; LANES],
) {
    let batches = &mut Batches::new(estimates, Some(lookups));
    fill_by(InstructionSet::widest(), (estimator, field), seeds, batches);
}

/// Fills batches by an instruction set: the same bits on all. Returns the look-ups of each lane.
pub fn fill_by<F: Extinction, E: Lockstep<F>>(
    set: InstructionSet,
    (estimator, field): (&E, &F),
    seeds: [u64; LANES],
    batches: &mut Batches<'_, '_>,
) -> [u64; LANES] {
    set.run(Fill { estimator, field, seeds, batches });
    batches.lookups()
}

/// Work of [`fill_by`].
struct Fill<'a, 'b, 'c, F, E> {
    estimator: &'a E,
    field: &'a F,
    seeds: [u64; LANES],
    batches: &'a mut Batches<'b, 'c>,
}

impl<F: Extinction, E: Lockstep<F>> LaneWork for Fill<'_, '_, '_, F, E> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.estimator.fill(self.field, &mut SeededLanes::new(self.seeds), self.batches);
    }
}

#[cfg(test)]
mod tests;
