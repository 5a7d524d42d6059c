//! Reports: what they say, how they are measured, how they are written.

pub(crate) mod command;
pub mod document;
mod free_flight;
mod particle_tracing;
mod progress;
pub(crate) mod registry;
mod replicas;
pub mod result;
mod single_scattering;
mod stability;
pub mod study;
pub mod write;
