//! Tests over the crates; see the files under `tests/`.
