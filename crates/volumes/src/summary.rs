//! Totals of a tree, found in one walk over it, which also is where values that are not finite are refused.

use crate::error::VdbError;
use crate::tree::{LEAF_BITS, LOWER_BITS, Level, Slot, Tree, UPPER_BITS, is_on, slot_origin};

/// Totals over a tree.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Summary {
    pub(crate) active_voxels: u64,
    pub(crate) active_sum: f64,
    /// The least and the greatest of all stored values, active or not, and the background.
    pub(crate) minimum: f32,
    pub(crate) maximum: f32,
    /// The lowest and the highest active voxel along each axis.
    pub(crate) bounds: Option<([i32; 3], [i32; 3])>,
}

impl Summary {
    pub(crate) fn of(tree: &Tree) -> Result<Self, VdbError> {
        let mut summary = Self {
            active_voxels: 0,
            active_sum: 0.0,
            minimum: tree.background,
            maximum: tree.background,
            bounds: None,
        };
        for (origin, slot) in &tree.root {
            match slot {
                Slot::Tile { value, active } => summary.tile(*origin, UPPER_BITS, *value, *active)?,
                Slot::Child(upper) => summary.upper_node(tree, *origin, *upper)?,
            }
        }
        Ok(summary)
    }

    fn upper_node(&mut self, tree: &Tree, origin: [i32; 3], node: u32) -> Result<(), VdbError> {
        let child = |summary: &mut Self, origin, lower| summary.lower_node(tree, origin, lower);
        self.slots::<LOWER_BITS, UPPER_BITS, _>(&tree.upper, (origin, node), child)
    }

    fn lower_node(&mut self, tree: &Tree, origin: [i32; 3], node: u32) -> Result<(), VdbError> {
        let child = |summary: &mut Self, origin, leaf| summary.leaf(tree, origin, leaf);
        self.slots::<LEAF_BITS, LOWER_BITS, _>(&tree.lower, (origin, node), child)
    }

    /// Takes in the tiles of a node of `2^BITS` voxels along each axis, whose slots have `2^SLOT_BITS`, and each `child`.
    fn slots<const SLOT_BITS: u32, const BITS: u32, const WORDS: usize>(
        &mut self,
        level: &Level<WORDS>,
        (origin, node): ([i32; 3], u32),
        child: impl Fn(&mut Self, [i32; 3], u32) -> Result<(), VdbError>,
    ) -> Result<(), VdbError> {
        for slot in 0..Level::<WORDS>::SLOTS {
            let origin = slot_origin::<SLOT_BITS, BITS>(origin, slot);
            match level.slot(node, slot) {
                Slot::Tile { value, active } => self.tile(origin, SLOT_BITS, value, active)?,
                Slot::Child(index) => child(self, origin, index)?,
            }
        }
        Ok(())
    }

    fn leaf(&mut self, tree: &Tree, origin: [i32; 3], leaf: u32) -> Result<(), VdbError> {
        let active = &tree.leaf_active[leaf as usize];
        for (voxel, value) in tree.leaf_values[leaf as usize].iter().enumerate() {
            self.tile(slot_origin::<0, LEAF_BITS>(origin, voxel), 0, *value, is_on(active, voxel))?;
        }
        Ok(())
    }

    /// Takes in a cube of `2^bits` voxels along each axis; a voxel is the smallest.
    fn tile(&mut self, origin: [i32; 3], bits: u32, value: f32, active: bool) -> Result<(), VdbError> {
        if !value.is_finite() {
            return Err(VdbError::NonFinite { index: origin, value });
        }
        self.minimum = self.minimum.min(value);
        self.maximum = self.maximum.max(value);
        if !active {
            return Ok(());
        }
        let volume = 1_u64 << (3 * bits);
        self.active_voxels = self.active_voxels.checked_add(volume).ok_or_else(|| VdbError::TooLarge {
            what: "the number of active voxels".to_owned(),
            asked: u64::MAX,
            limit: u64::MAX,
        })?;
        self.active_sum += f64::from(value) * volume as f64;
        // Origins are multiples of the size, so that the last voxel of a cube never passes the largest coordinate.
        let last = origin.map(|coordinate| coordinate + ((1 << bits) - 1));
        let (lowest, highest) = self.bounds.get_or_insert((origin, last));
        for axis in 0..3 {
            lowest[axis] = lowest[axis].min(origin[axis]);
            highest[axis] = highest[axis].max(last[axis]);
        }
        Ok(())
    }
}
