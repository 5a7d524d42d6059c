//! OpenVDB fog volumes from bytes.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let bytes = std::fs::read("cloud.vdb")?;
//! let density = fairflight_volumes::read_float_grid(&bytes, Some("density"))?;
//! let [x, y, z] = density.index_from_world().apply_point([0.0, 1.0, 0.0]);
//! println!("{} of at most {}", density.trilinear(x, y, z), density.maximum());
//! # Ok(())
//! # }
//! ```
//!
//! # What is read
//! Files of format version 222 to 224, of which OpenVDB 10 writes the last, with grids of type `Tree_float_5_4_3`, also where
//! their values are saved with 16 bits; uncompressed, zip or Blosc (LZ4, with byte shuffling); with or without the omission
//! of inactive values; tiles at every level, which stay tiles; uniform and other scales, translations, rotations and affine
//! maps; several grids per file, also of one name.
//!
//! # What is refused, with a [`VdbError`] that says so
//! Several float grids of which none was named and none, or more than one, is called `density`. Level sets and
//! staggered grids, by their class: their values are no densities. Other value types and tree shapes, instanced
//! grids, files written as a stream without offsets, camera frusta and singular maps, other codecs inside
//! Blosc. Values that are not finite, because an extinction is. A grid whose active voxels are not as many as
//! its metadata state.
//!
//! # Files that cannot be trusted
//! The reader opens nothing, and it neither panics nor loops without end on any bytes. Every size in the file is checked
//! against the bytes that are there before memory is taken for it, and all memory together is bounded by
//! [`MAX_EXPANSION`] times the length of the file plus [`FIXED_ALLOWANCE`]. The format has no checksums: a flipped bit in a
//! stored value is a different value, and nobody can tell.
//!
//! # Why not vdb-rs
//! Measured on the files of this repository, vdb-rs 0.6 reads grids saved with 16 bits wrong without saying so, asks for
//! petabytes of memory on one of them, and takes a grid of vectors for an empty grid of floats.

mod affine;
mod archive;
mod blosc;
mod budget;
mod codec;
mod cursor;
mod error;
mod grid;
#[cfg(test)]
mod hand_made;
mod metadata;
mod read_tree;
mod summary;
mod transform;
mod tree;
mod trilinear;
mod values;

pub use affine::Affine;
pub use archive::GridInfo;
pub use budget::{FIXED_ALLOWANCE, MAX_EXPANSION};
pub use error::VdbError;
pub use grid::{VoxelGrid, grids, read_float_grid};
