//! Light between points: what integrators that know surfaces share.
//!
//! A [`World`] is a medium among surfaces and lights. A [`Vertex`] is a point of it at which light is scattered. Paths go from vertex to
//! vertex by [`World::follow`], vertices are connected by [`World::attenuated_visibility`], and lit by [`World::emitters_at`] and
//! [`World::emission`], whose weights sum to one.

mod direct;
#[cfg(test)]
pub(crate) mod fixtures;
mod trace;
mod types;
mod vertex;
mod world;

pub use direct::Scattered;
pub use trace::Traced;
pub use types::{MadeOf, NoShadow, Types};
pub use vertex::{Lobe, Vertex};
pub use world::{Event, Passage, World};
