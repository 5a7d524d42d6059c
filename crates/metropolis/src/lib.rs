//! Metropolis sampling of light paths in participating media (antwerpen-2011 chapter 6, raab-2008 section 4.4).
//!
//! | part | source | what |
//! |---|---|---|
//! | [`Target`] | antwerpen-2011 6.2 | what a chain follows: f*, a present state and a proposal |
//! | [`Chain`] | antwerpen-2011 algorithm 5, corrected | expected-value scores of both states of a step |
//! | [`Bootstrap`] | antwerpen-2011 6.5 | the start and the brightness, of one set of samples: no start-up bias |
//! | [`Plan`], [`Replica`] | | independent estimates of an image: errors come from them alone |
//! | [`Primary`] | kelemen-2002, antwerpen-2011 6.6 | states are variates, over any integrator |
//! | [`Integrand`], [`FromCamera`], [`FromBothEnds`] | | path tracing and bidirectional path tracing as functions of variates |
//! | [`Multiplexed`], [`Lengths`] | hachisuka-2014 | one strategy per sample |
//! | [`Redistribution`] | cline-2005, antwerpen-2011 6.8 | chains from every sample that finds light |
//! | [`Importance`] | hoberock-2010, antwerpen-2011 6.7 | more of a chain where the image is noisy |
//! | [`Kernels`] | lai-2007, antwerpen-2011 6.9 | sizes of steps, learnt from other replicas |
//! | [`Mutation`], [`path`] | antwerpen-2011 6.3, 6.4 | steps in path space |
//! | [`laws`] | | one step judged by independent states |
//!
//! A replica is unbiased for every length of its chains, also where they reach no more than a part of the light: what multiplies its scores
//! comes from the set that its start was chosen from. No image is divided by its own mean, and no brightness is pooled.
//!
//! ```
//! use fairflight_metropolis::{Plan, Primary, Splats};
//! use fairflight_sources::UniformSource;
//!
//! // An image of two pixels, 1/3 and -1/2: a function of one variate and of two.
//! let mut integrand = |splats: &mut Splats<f64>, source: &mut dyn UniformSource| {
//!     let u = source.next_uniform();
//!     if source.next_uniform() < 0.5 {
//!         splats.push([0, 0], 2.0 * u * u);
//!     } else {
//!         splats.push([1, 0], -4.0 * u * source.next_uniform());
//!     }
//! };
//! let mut target = Primary::new(&mut integrand);
//! let plan = Plan::new(20, 1, 20)?;
//! let mut image = [0.0; 2];
//! for index in 0..1000 {
//!     plan.replica(&mut target, (index, 1), &mut |[column, _], value| image[column as usize] += value / 1000.0)?;
//! }
//! assert!((image[0] - 1.0 / 3.0).abs() < 0.05 && (image[1] + 0.5).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chain;
mod importance;
mod integrand;
pub mod laws;
mod lengths;
mod multiplexed;
mod mutation;
pub mod path;
mod population;
mod primary;
mod redistribution;
mod replica;
mod splats;
mod start;
mod target;

pub use chain::{Chain, NotFinite};
pub use importance::{Aim, Importance, ImportanceError, ImportanceRule};
pub use integrand::{FromBothEnds, FromCamera, Integrand};
pub use lengths::{Lengths, LengthsError};
pub use multiplexed::Multiplexed;
pub use mutation::{Mutation, acceptance};
pub use population::{Experience, Kernels, KernelsError};
pub use primary::{NotAProbability, Primary};
pub use redistribution::{Redistributed, Redistribution, RedistributionError};
pub use replica::{Phase, Plan, PlanError, Refused, Replica};
pub use splats::Splats;
pub use start::Bootstrap;
pub use target::{Acceptance, Film, Proposed, Target, Which};
