//! Reports: what they say, how they are measured, how they are written.

pub(crate) mod command;
pub mod document;
mod estimators;
mod free_flight;
mod measured;
mod particle_tracing;
pub(crate) mod registry;
mod replicas;
pub mod result;
mod run;
mod single_scattering;
mod speed;
mod stability;
pub mod study;
mod virtual_lights;
pub mod write;
