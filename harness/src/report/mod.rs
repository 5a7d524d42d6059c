//! Reports: what they say, how they are measured, how they are written.

pub(crate) mod command;
pub mod document;
pub(crate) mod registry;
pub mod result;
mod stability;
pub mod study;
pub mod write;
