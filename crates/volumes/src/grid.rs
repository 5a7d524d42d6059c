//! A grid that has been read, and what can be asked of it.

use crate::affine::Affine;
use crate::archive::{GridInfo, descriptors, select};
use crate::budget::Budget;
use crate::codec::Codec;
use crate::cursor::Cursor;
use crate::error::VdbError;
use crate::summary::Summary;
use crate::tree::{LEAF_BITS, Located, Tree, is_on, slot_of};
use crate::{read_tree, transform};

/// Lists the grids of a file, in file order, without reading their trees.
///
/// # Errors
/// The file is not an OpenVDB file, is of another version, is cut off, or contradicts itself.
pub fn grids(bytes: &[u8]) -> Result<Vec<GridInfo>, VdbError> {
    let descriptors = descriptors(bytes, &mut Budget::for_file(bytes.len()))?;
    Ok(descriptors.into_iter().map(|descriptor| descriptor.info).collect())
}

/// Reads the float grid of the given name; without a name `density`, or else the only float grid of the file.
///
/// With several grids of one name, `density[1]` means the second and `density` the first.
///
/// # Errors
/// Everything that [`VdbError`] lists: the grid is missing, ambiguous, of another type, a level set, damaged,
/// or uses a part of the format that is not supported. A grid whose number of active voxels is not the one in
/// its metadata, or that has a value which is not finite, is an error too.
pub fn read_float_grid(bytes: &[u8], name: Option<&str>) -> Result<VoxelGrid, VdbError> {
    read_within(bytes, name, &mut Budget::for_file(bytes.len()))
}

pub(crate) fn read_within(
    bytes: &[u8],
    name: Option<&str>,
    budget: &mut Budget,
) -> Result<VoxelGrid, VdbError> {
    let descriptors = descriptors(bytes, budget)?;
    let descriptor = select(&descriptors, name)?;
    let mut cursor = Cursor::new(&bytes[..descriptor.end_pos], descriptor.transform_pos);
    let (world_from_index, index_from_world) = transform::read(&mut cursor)?;
    let mut codec = Codec::new(descriptor.compression, descriptor.info.saved_as_half)?;
    let mut tree = read_tree::shape(&mut cursor, &mut codec, budget)?;
    if cursor.at() != descriptor.block_pos {
        return Err(VdbError::corrupt(cursor.at(), "the tree's shape does not end where its values begin"));
    }
    read_tree::leaves(&mut cursor, &mut codec, &mut tree, budget)?;
    if cursor.remaining() != 0 {
        return Err(VdbError::corrupt(cursor.at(), "the tree's values do not end where the grid ends"));
    }

    let summary = Summary::of(&tree)?;
    if let Some(expected) = descriptor.info.file_voxel_count
        && u64::try_from(expected) != Ok(summary.active_voxels)
    {
        return Err(VdbError::Inconsistent { expected, found: summary.active_voxels });
    }
    Ok(VoxelGrid { info: descriptor.info.clone(), world_from_index, index_from_world, tree, summary })
}

/// A sparse grid of 32-bit floats, immutable once read.
///
/// A *voxel* is a point of the integer lattice of index space, and its value sits there: the cell between eight voxels is
/// what [`trilinear`](Self::trilinear) interpolates in. A voxel is active where the file says that it belongs to the volume;
/// inactive voxels have values as well, usually the background. Large regions of one value are stored as tiles and stay
/// tiles in memory.
///
/// Values have the unit that the file's author meant, which the format does not record.
#[derive(Debug, Clone)]
pub struct VoxelGrid {
    info: GridInfo,
    world_from_index: Affine,
    index_from_world: Affine,
    pub(crate) tree: Tree,
    summary: Summary,
}

impl VoxelGrid {
    /// The file's description of the grid.
    #[must_use]
    pub fn info(&self) -> &GridInfo {
        &self.info
    }

    /// The value at a voxel; the background where the tree has nothing.
    #[must_use]
    #[inline]
    pub fn value(&self, i: i32, j: i32, k: i32) -> f32 {
        match self.tree.locate(i, j, k) {
            Located::Leaf(leaf) => self.tree.leaf_values[leaf as usize][slot_of::<0, LEAF_BITS>(i, j, k)],
            Located::Tile { value, .. } => value,
        }
    }

    /// True if a voxel is active, by itself or as a part of an active tile.
    #[must_use]
    pub fn is_active(&self, i: i32, j: i32, k: i32) -> bool {
        match self.tree.locate(i, j, k) {
            Located::Leaf(leaf) => {
                is_on(&self.tree.leaf_active[leaf as usize], slot_of::<0, LEAF_BITS>(i, j, k))
            }
            Located::Tile { active, .. } => active,
        }
    }

    /// The number of active voxels, each tile counted with its volume. Zero for an empty grid.
    #[must_use]
    pub fn active_voxel_count(&self) -> u64 {
        self.summary.active_voxels
    }

    /// The sum of the values of all active voxels, each tile counted with its volume. Zero for an empty grid.
    #[must_use]
    pub fn active_sum(&self) -> f64 {
        self.summary.active_sum
    }

    /// The greatest value that [`value`](Self::value) and [`trilinear`](Self::trilinear) return anywhere: a majorant.
    ///
    /// It is taken over all stored values, active or not, and the background, and so can be greater than the maximum over
    /// the active voxels alone. For an empty grid it is the background.
    #[must_use]
    pub fn maximum(&self) -> f32 {
        self.summary.maximum
    }

    /// The least value that [`value`](Self::value) and [`trilinear`](Self::trilinear) return anywhere: a minorant.
    ///
    /// Taken over the same values as [`maximum`](Self::maximum). A fog volume that is to be an extinction has none below zero.
    #[must_use]
    pub fn minimum(&self) -> f32 {
        self.summary.minimum
    }

    /// The lowest and the highest active voxel along each axis, both included; none if no voxel is active.
    ///
    /// Interpolation reaches one voxel further: beyond `lowest - 1` and `highest + 1` no active voxel has any weight.
    #[must_use]
    pub fn active_bounds(&self) -> Option<([i32; 3], [i32; 3])> {
        self.summary.bounds
    }

    /// The value of all voxels that the tree does not cover.
    #[must_use]
    pub fn background(&self) -> f32 {
        self.tree.background
    }

    /// The map from index space, where voxels are integer points, to world space.
    #[must_use]
    pub fn world_from_index(&self) -> Affine {
        self.world_from_index
    }

    /// The map from world space to index space, where voxels are integer points.
    #[must_use]
    pub fn index_from_world(&self) -> Affine {
        self.index_from_world
    }

    /// The bytes of memory that the tree holds; at most [`MAX_EXPANSION`](crate::MAX_EXPANSION) times the length of the file
    /// plus [`FIXED_ALLOWANCE`](crate::FIXED_ALLOWANCE).
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.tree.memory_bytes()
    }
}
