//! Metropolis sampling of light paths in participating media (antwerpen-2011 chapter 6, raab-2008 4.4).

pub mod laws;
mod mutation;
pub mod path;

pub use mutation::{Mutation, acceptance};
