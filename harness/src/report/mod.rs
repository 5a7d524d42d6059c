//! `harness report`: measure, then write.

pub mod result;
