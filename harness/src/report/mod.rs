//! Reports: named studies that are measured, made into documents, and written as folders.

mod bidirectional;
pub(crate) mod command;
mod estimators;
mod folder;
mod free_flight;
mod laws;
mod looks;
mod measured;
pub(crate) mod options;
mod particle_tracing;
pub(crate) mod registry;
mod replicas;
mod run;
mod single_scattering;
mod speed;
mod stability;
mod standard;
mod virtual_lights;
