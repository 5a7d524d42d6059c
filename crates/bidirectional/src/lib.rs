//! Bidirectional path tracing in participating media.
//!
//! | part | source | what |
//! |---|---|---|
//! | [`Bidirectional`] | lafortune-1996, antwerpen-2011 chapters 4 and 5 | all strategies (s, t) of an eye and a light subpath, the light image included |
//! | [`Subpath`] | raab-2008 4.1, 4.2 | walks from both ends, with the densities of their vertices |
//! | [`Node`], [`LightEnd`] | antwerpen-2011 5.3, raab-2008 eq. 12 | recursive sums of densities in logarithms; base cases of all lights |
//! | [`Weigh`] | antwerpen-2011 5.2, 5.3 | weights of a strategy from its two ends |
//! | [`WeightThickness`] | raab-2008 4.3 | optical thickness in weights: deterministic |
//! | [`laws`] | antwerpen-2011 3.6, 5.2 | weights of a whole path by all its densities, for tests |
//!
//! Densities never enter a contribution: that is the product of what two walks carry and of one random transmittance. They enter
//! weights, which may be any functions of the path that sum to one over the strategies that can make it. A surrogate of a density
//! is therefore lawful, an inconsistency is not.
//!
//! ```
//! use fairflight_bidirectional::LogHeuristic;
//! use fairflight_paths::Heuristic;
//!
//! // Two strategies of densities e^-2000 and 3 e^-2000, which no number holds: the weights are 1/4 and 3/4.
//! let heuristic = Heuristic::Balance;
//! let [a, b] = [-2000.0, -2000.0 + 3f64.ln()].map(|ln| heuristic.scale(ln));
//! assert!((heuristic.weight(b - a, f64::NEG_INFINITY) - 0.25).abs() < 1e-12);
//! assert!((heuristic.weight(f64::NEG_INFINITY, a - b) - 0.75).abs() < 1e-12);
//! ```

mod heuristic;
mod integrator;
pub mod laws;
mod light_end;
mod node;
mod subpath;
mod thickness;
mod weigh;

pub use heuristic::LogHeuristic;
pub use integrator::{Bidirectional, Found, Strategy};
pub use light_end::LightEnd;
pub use node::{Node, Place, Site};
pub use subpath::{Step, Subpath, Walking};
pub use thickness::{Exact, Midpoint, Neglected, WeightThickness};
pub use weigh::{AtLight, Weigh};
