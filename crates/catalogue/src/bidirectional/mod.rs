//! The laws of bidirectional path tracing: the weights of a path sum to one, and every strategy finds one light.
//!
//! * [`partition`]: weights as they are used, as the recursion has them, and by all densities of the whole path.
//! * [`pairs`]: any two strategies, each weighted by both.
//! * [`means`]: the whole, and each length of paths, against the path tracer; a furnace; the light image against photons.

pub mod means;
pub mod pairs;
pub mod partition;
pub(crate) mod scenes;

pub use scenes::View;
