//! Invariants of everything that reads what others wrote, one module for each fuzz target.
//!
//! Each `check` takes arbitrary bytes and panics where an invariant does not hold; which these are is said beside each, and in
//! `docs/fuzzing.md` together. No target draws an estimate: specs are planned, and what is planned is not run.

#![forbid(unsafe_code)]

pub mod experiment;
pub mod expression;
pub mod exr;
pub mod openvdb;
pub mod pfm;
pub mod png;
pub mod scene;

mod images;
mod refusal;
