//! Light between points: what integrators that know surfaces share.
//!
//! A [`World`] is a medium among surfaces and lights. A [`Vertex`] is a point of it at which light is scattered. Paths go from vertex to
//! vertex by [`World::follow`], vertices are connected by [`World::attenuated_visibility`], and lit by [`World::emitters_at`] and
//! [`World::emission`], whose weights sum to one. Light paths start on [`Emitters`], and account for their power in a [`Ledger`].

mod direct;
mod emitters;
#[cfg(test)]
pub(crate) mod fixtures;
mod ledger;
mod trace;
mod types;
mod vertex;
mod world;

pub use direct::{EmitterSample, Scattered};
pub use emitters::{Emitters, Light, Sides, Start};
pub use ledger::Ledger;
pub use trace::Traced;
pub use types::{MadeOf, NoShadow, Types};
pub use vertex::{Lobe, Vertex};
pub use world::{Event, Passage, World};
