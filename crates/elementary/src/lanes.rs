//! The same functions for arrays: lane by lane the bits of one number.
//!
//! Each is a loop over a function that is inlined and has no branch. Compiled for an instruction set with wide registers, it uses
//! them; what calls it has to be compiled for that set, and inlined there too.

use crate::{logarithm, sine};

/// Lanes that walks run in: four registers of 256 bits, so that latencies of one are hidden behind the others.
pub const LANES: usize = 16;

/// A number in each lane.
pub type Lanes = [f64; LANES];

/// A decision in each lane: all bits set where it is true, none where it is false.
pub type Mask = [u64; LANES];

/// A decision as a lane of a [`Mask`] has it.
#[inline(always)]
#[must_use]
pub fn mask(decision: bool) -> u64 {
    0_u64.wrapping_sub(u64::from(decision))
}

/// `yes` where the decision is true, else `no`.
#[inline(always)]
#[must_use]
pub fn select(mask: u64, yes: f64, no: f64) -> f64 {
    f64::from_bits((yes.to_bits() & mask) | (no.to_bits() & !mask))
}

/// True if a decision is true in some lane.
#[inline(always)]
#[must_use]
pub fn some(mask: &Mask) -> bool {
    mask.iter().fold(0, |some, decision| some | decision) != 0
}

/// The lanes in which a decision is true, in increasing order. Their number is what this costs, and one test where there are none.
#[inline(always)]
pub fn lanes_of(mask: &Mask) -> impl Iterator<Item = usize> + use<> {
    let mut bits = 0;
    for (lane, decision) in mask.iter().enumerate() {
        bits |= decision & (1 << lane);
    }
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

pub use crate::functions::of_lanes::{exp, exp_m1, ln, ln_1p};

/// [`ln`] of lanes that are all normal numbers above 0, which is not looked at.
#[inline(always)]
#[must_use]
pub fn ln_of_normal<const N: usize>(x: &[f64; N]) -> [f64; N] {
    logarithm::near_lanes(x)
}

/// Sines and cosines of the lanes.
#[inline(always)]
#[must_use]
pub fn sin_cos<const N: usize>(x: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    let mut all_near = true;
    for i in 0..N {
        (sines[i], cosines[i]) = sine::near(x[i]);
        all_near &= sine::is_near(x[i]);
    }
    if !all_near {
        again(x, &mut sines, &mut cosines);
    }
    (sines, cosines)
}

#[cold]
#[inline(never)]
fn again(x: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for (i, &x) in x.iter().enumerate() {
        if !sine::is_near(x) {
            (sines[i], cosines[i]) = sine::far(x);
        }
    }
}
