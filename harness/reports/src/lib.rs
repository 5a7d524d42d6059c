//! Reports: named studies that are measured, made into documents, and written as folders.

mod bidirectional;
mod command;
mod compared;
mod estimators;
mod folder;
mod free_flight;
mod laws;
mod looks;
mod measured;
mod metropolis;
mod options;
mod particle_tracing;
mod registry;
mod replicas;
mod run;
mod scenes;
mod single_scattering;
mod speed;
mod speed_against_error;
mod stability;
mod standard;
mod virtual_lights;

pub use command::{ReportArguments, run as report};
pub use registry::{REPORTS, ReportKind};
