//! The standard report: what it says, how it is measured, how it is written.

pub(crate) mod command;
pub mod result;
mod stability;
pub mod study;
pub mod write;
