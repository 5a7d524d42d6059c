//! Estimators compared on rays: what the report on estimators and `harness advise` share.
//!
//! An [`Entrant`] is an estimator whose parameters follow from the ray. It meets every ray of a [`RaySet`]; a [`Bout`] is what came of it
//! on one of them, a [`Gain`] how much cheaper it is than ratio tracking over all.

mod bout;
mod contest;
mod entrant;
mod gain;
mod rays;

pub use bout::{Bout, Effort, Pooled, fight, pooled};
pub use contest::{Contest, bouts_of, contest, facts, facts_of};
pub use entrant::{Entrant, Facts, entrants};
pub(crate) use gain::bootstrap_mean;
pub use gain::{Gain, Unit, gain};
pub use rays::{RaySet, TestRay, chords};
