//! The fixture files, as bytes.

use std::path::Path;

use fairflight_volumes::{VoxelGrid, read_float_grid};

/// The bytes of a fixture.
pub(crate) fn fixture(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A grid of a fixture that must be readable.
#[allow(dead_code, reason = "each test file compiles this module for itself, and not all read whole grids")]
pub(crate) fn grid(file: &str, name: &str) -> VoxelGrid {
    read_float_grid(&fixture(file), Some(name)).unwrap_or_else(|error| panic!("{file} {name}: {error}"))
}
