//! The laws of virtual point lights: what bounding takes away and compensation gives back is all there is.
//!
//! * [`local`]: bounded connections and one compensation vertex, for a few lights and one point, against quadrature.
//! * [`rooms`]: the whole recursion over random sets, judged by replicas of the set.
//! * [`ledger`]: where the power of light paths goes.
//! * [`lamps`]: light of one reflection by quadrature and in closed form.
//! * [`bounds`]: what one compensation is at most, and limits that are equal to the last digit.

pub mod bounds;
pub mod lamps;
pub mod ledger;
pub mod local;
pub mod rooms;
pub(crate) mod scenes;
pub(crate) mod tiny;
