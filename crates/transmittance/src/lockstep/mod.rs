//! Estimates of many streams side by side, in the widest registers that the machine has.
//!
//! A lane is a stream with its own walk; where a walk ends the next one of that stream begins. Nothing passes between lanes, and every operation is the one of the
//! scalar estimator, so that the law of this module is equality: lane by lane the bits of the scalar estimates. Its theory is theirs.

mod products;
mod tracking;

pub use products::Products;

use crate::TransmittanceEstimator;
use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_media::Extinction;
use fairflight_sources::SeededLanes;

/// An estimator that runs in lanes.
///
/// **Law.** [`fill`](Self::fill) writes into each slice, bit for bit, what [`estimate`](TransmittanceEstimator::estimate) returns in turn from
/// [`Seeded::new`](fairflight_sources::Seeded::new) of that lane's seed.
pub trait Lockstep<F: Extinction>: TransmittanceEstimator<F> {
    /// Fills a slice of estimates from the stream of each lane; slices may differ in length, and be empty.
    ///
    /// Has to be inlined into a function of the instruction set that it shall use: [`fill`].
    /// Returns the look-ups of each lane.
    fn fill(&self, field: &F, source: &mut SeededLanes, estimates: &mut [&mut [f64]; LANES]) -> [u64; LANES];

    /// True where [`admits`](TransmittanceEstimator::admits) holds in all lanes; where it holds in all, it may be false.
    fn admits_lanes(&self, field: &F, s: &Lanes, sigma_t: &Lanes) -> bool;
}

/// Fills a slice of estimates from the stream of each seed, by the best instruction set that the machine has: the same bits on all. Returns the look-ups of each.
pub fn fill<F: Extinction, E: Lockstep<F>>(
    estimator: &E,
    field: &F,
    seeds: [u64; LANES],
    estimates: &mut [&mut [f64]; LANES],
) -> [u64; LANES] {
    pulp::Arch::new().dispatch(Fill { estimator, field, seeds, estimates })
}

/// Work of [`fill`], as the dispatcher takes it.
struct Fill<'a, 'b, F, E> {
    estimator: &'a E,
    field: &'a F,
    seeds: [u64; LANES],
    estimates: &'a mut [&'b mut [f64]; LANES],
}

impl<F: Extinction, E: Lockstep<F>> pulp::WithSimd for Fill<'_, '_, F, E> {
    type Output = [u64; LANES];

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> [u64; LANES] {
        self.estimator.fill(self.field, &mut SeededLanes::new(self.seeds), self.estimates)
    }
}

#[cfg(test)]
mod tests;
