//! Light between points: what integrators that know surfaces share.
//!
//! A [`World`] is a medium among surfaces and lights. A [`Vertex`] is a point of it at which light is scattered. Paths go from vertex to
//! vertex by [`World::follow`], vertices are connected by [`World::attenuated_visibility`], and lit by [`World::emitters_at`] and
//! [`World::emission`], whose weights sum to one. [`World::random_walk`] is the walk of light paths and of eye paths that
//! are joined with them. Light paths start on [`Emitters`], and account for their power in a [`Ledger`].

mod direct;
mod emitters;
#[cfg(test)]
pub(crate) mod fixtures;
mod ledger;
mod random_walk;
mod trace;
mod types;
mod vertex;
mod world;

pub use direct::{EmitterSample, Scattered};
pub use emitters::{Emitters, Light, Sides, Start};
pub use ledger::Ledger;
pub use random_walk::{Carried, Met, WalkEnd};
pub use trace::Traced;
pub use types::{MadeOf, NoShadow, Types};
pub use vertex::{Lobe, Vertex};
pub use world::{Event, Passage, World};
