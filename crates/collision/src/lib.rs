//! Models of the collision of a light particle with the medium.
//!
//! A walk meets collisions at the rate of a *sampling extinction* σ_samp. At each it looks up σ_t and forms the ratio
//! r = σ_diff / σ_samp, where σ_diff = σ_t − σ_main is the extinction that a control leaves (szirmay-kalos-2017 eq. 5
//! and 6). A collision model turns r into a scattered and a transmitted particle, each with a probability and an energy
//! factor, such that (eq. 8)
//!
//! > E\[scattered energy\] = a · r,   E\[transmitted energy\] = 1 − r
//!
//! for every r that the model admits. That identity is the law of [`CollisionModel`], and all of unbiasedness.
//!
//! | model | source | admits |
//! |---|---|---|
//! | [`Woodcock`] | eq. 7 | 0 ≤ r ≤ 1 |
//! | [`DoubleParticle`] | eq. 8, 10, 11 | every r |
//! | [`SingleParticle`] terminating | eq. 9, 19 | 0 ≤ r ≤ 2 / (1 + a) |
//! | [`SingleParticle`] non-terminating | eq. 9, 12 | every r |
//! | [`SingleParticle`] adaptive | SimulateParticle, section 4.1 | every r |
//!
//! Transmittance keeps the transmitted branch only; free flight and particle tracing keep both.
//!
//! # Porting
//!
//! A model is two lines of a port: the walk of `fairflight-transmittance` multiplies its weight by 1 − r at each look-up ([`DoubleParticle`]: ratio
//! tracking, residual ratio tracking with a control), or ends where u · majorant < σ_t ([`Woodcock`]). What each model makes of a ratio and a variate
//! is in `tests/vectors/collision.jsonl`; walks with them in `tests/vectors/double_particle.jsonl`, `tests/vectors/single_particle.jsonl` and
//! `tests/vectors/woodcock.jsonl`. Loops, traps and the mistakes that a port may make: `docs/PORTING.md`, `docs/porting/transmittance.md`.
//!
//! ```
//! use fairflight_collision::{Albedo, CollisionModel, DoubleParticle};
//!
//! // A sampling extinction of half the extinction, r = 2: the transmitted particle carries a negative weight.
//! let model = DoubleParticle { albedo: Albedo::new(0.9).unwrap() };
//! assert!(model.admits(2.0));
//! assert_eq!(model.transmitted(2.0).moment(1), 1.0 - 2.0);
//! assert_eq!(model.scattered(2.0).moment(1), 0.9 * 2.0);
//! ```

mod branch;
mod double_particle;
mod model;
mod single_particle;
mod woodcock;

pub use branch::Branch;
pub use double_particle::DoubleParticle;
pub use model::{Albedo, AlbedoError, CollisionModel, Outcome, SingleOutcome};
pub use single_particle::{SingleParticle, Version};
pub use woodcock::Woodcock;
