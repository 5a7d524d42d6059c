//! The same functions for arrays: lane by lane the bits of one number.
//!
//! Each is a loop over a function that is inlined and has no branch. Compiled for an instruction set with wide registers, it uses
//! them; what calls it has to be compiled for that set, and inlined there too.

use crate::sine;

/// Lanes that walks run in: four registers of 256 bits, so that latencies of one are hidden behind the others.
pub const LANES: usize = 16;

/// A number in each lane.
pub type Lanes = [f64; LANES];

pub use crate::functions::of_lanes::{exp, exp_m1, ln, ln_1p};

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
