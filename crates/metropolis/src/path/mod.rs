//! Mutations of light paths in participating media (antwerpen-2011 sections 6.3 and 6.4).
//!
//! A state is a [`PathState`]: vertices, edges, and the transmittance of each edge. A mutation moves a part of it symmetrically in coordinates of its own (points
//! of the film, directions, distances), and says by how much the contribution times the Jacobian of these coordinates changes:
//!
//! | mutation | coordinates | changes |
//! |---|---|---|
//! | [`Lens`] | film, distances, directions at vertices before smooth ones | from the camera to the first two neighbours that are not smooth |
//! | [`LaiLens`] | film, distances, places of smooth vertices | the same |
//! | [`Caustic`] | a direction towards the camera, a distance | from the second vertex that is not smooth to the camera |
//! | [`Scattering`] | a direction at a vertex, a distance | one side of the vertex |
//! | [`Propagation`] | ln of a distance | one vertex in the medium |
//!
//! None of these changes the number or the kinds of vertices, and none chooses by anything else: no probability of a choice is left in a ratio. [`Fresh`]
//! draws a path independently of the old one, by the strategies of the bidirectional integrator.
//! [`PathTarget`] makes chains of them. Transmittance is a closed form, or the product over [`NullCollisions`] that belong to the state.

mod caustic;
mod coordinates;
mod fresh;
mod lai_lens;
mod lens;
mod nulls;
mod propagation;
mod proposal;
mod scattering;
mod state;
mod target;
mod vertex;
mod world;

pub use caustic::Caustic;
pub use fresh::Fresh;
pub use lai_lens::LaiLens;
pub use lens::Lens;
pub use nulls::{NoMajorant, NullCollisions};
pub use propagation::Propagation;
pub use proposal::StepSizes;
pub use scattering::Scattering;
pub use state::PathState;
pub use target::{Named, NoMutation, NotShares, PathTarget};
pub use vertex::{PathEdge, PathSite, PathVertex, Towards};
pub use world::{EdgeTransmittance, Met, PathWorld, View};
