//! Virtual point lights in participating media: generation and gathering (instant radiosity).
//!
//! | part | source | what |
//! |---|---|---|
//! | [`LightPaths`] | engelhardt-2013 3.2 | light paths that leave a [`Vpl`] at each vertex, on surfaces and in the medium |
//! | [`Gather`] | engelhardt-2013 3.3, raab-2008 eq. 14 | what they add at a vertex, bounded or not |
//! | [`VplIntegrator`] | engelhardt-2013 3.3 | radiance along a camera ray |
//! | [`Correction`] | raab-2008 eq. 15 | the seam for what bounding takes away |

mod correction;
mod emission;
mod gather;
mod integrator;
mod light_paths;
mod vpl;

pub use correction::{Correction, Uncorrected};
pub use emission::{Emitters, Start};
pub use gather::{Connected, Gather, Term};
pub use integrator::{Component, Pairing, VplIntegrator};
pub use light_paths::{KeepNear, Ledger, LightPaths};
pub use vpl::Vpl;
