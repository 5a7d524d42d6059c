//! Elementary functions with the same bits on every machine, for one number and for lanes.
//!
//! The standard library's `f64::ln` is the system's: another library rounds another value the other way, and one library may do so
//! from processor to processor. An estimate that depends on a logarithm then depends on the machine. Here a function is a fixed sequence of additions,
//! multiplications, divisions and integer operations, each of which IEEE 754 defines to the last bit; nothing is contracted to a fused
//! multiply-add.
//!
//! | function | greatest error over the vectors \[ulp\] | not correctly rounded, of 10⁸ | arguments |
//! |---|---|---|---|
//! | [`ln`] | 0.504 | 0.06 % | all |
//! | [`ln_1p`] | 0.498 | 0.5 % | all |
//! | [`exp`] | 0.495 | 0.1 % | all |
//! | [`exp_m1`] | 0.61 | 0.9 % | all |
//! | [`sin`], [`cos`], [`sin_cos`] | 0.58 | 3.1 % | all; slower from 1.6 · 10⁶ on |
//!
//! No value of those 10⁸ of each was off by more than one (`cargo run --release -p fairflight-elementary --example errors -- 100000000`).
//!
//! But for rare arguments they have no branch, so that a loop over an array of them becomes vector instructions: [`lanes`] has
//! them for arrays, with the bits of one number, and [`InstructionSet`] compiles loops over them for the widest registers of a machine. What no inner loop needs ([`pow`], [`tan`], [`acos`], [`atan2`], …) comes from the crate `libm`, which
//! is a fixed sequence of operations as well.
//!
//! ```
//! use fairflight_elementary::{exp, lanes, ln};
//!
//! assert_eq!(exp(0.0), 1.0);
//! // A free flight through an extinction of 2, for four lanes and for one.
//! let uniforms = [0.1, 0.5, 0.9, 0.99];
//! let logarithms = lanes::ln(&uniforms);
//! assert_eq!(-logarithms[2] / 2.0, -ln(0.9) / 2.0);
//! ```

#![allow(clippy::excessive_precision, reason = "coefficients stand as their source prints them")]

mod exponential;
mod functions;
mod instruction_set;
pub mod lanes;
mod logarithm;
mod parts;
mod rare;
mod sine;
mod table_of_logarithms;
mod table_of_powers;

pub use instruction_set::{InstructionSet, LaneWork};

pub use functions::{cos, exp, exp_m1, ln, ln_1p, sin, sin_cos};
pub use rare::{acos, asin, atan, atan2, cbrt, exp2, hypot, log2, log10, pow, sinh, tan};
