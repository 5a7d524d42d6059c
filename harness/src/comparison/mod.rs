//! Estimators compared on rays: the part that the report on estimators and `harness advise` share.
//!
//! An [`Entrant`] is an estimator whose parameters follow from the ray. It runs on every ray of a [`RaySet`]; a [`Bout`] is its result
//! on one of them, a [`Gain`] its efficiency over that of ratio tracking, over all.

mod bout;
mod contest;
mod entrant;
mod gain;
mod rays;

pub use bout::{Bout, Effort, Pooled, fight, pooled};
pub use contest::{Contest, bouts_of, contest, facts, facts_of};
pub use entrant::{Entrant, Facts, entrants, others};
pub use gain::bootstrap_mean;
pub use gain::{Gain, Unit, gain};
pub use rays::{RaySet, TestRay, chords};
