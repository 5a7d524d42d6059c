//! The sparse tree: root, nodes of 32^3 and 16^3 slots, leaves of 8^3 voxels, each level in one flat array.
//!
//! A slot of an inner node covers either a child node or a *tile*, one value for the whole slot. A leaf spans 8 voxels, a
//! lower node 128 and an upper node 4096 along each axis; the root is a sorted list of upper nodes and tiles of that size.

/// log2 of the voxels that a leaf, a lower node and an upper node span.
pub(crate) const LEAF_BITS: u32 = 3;
pub(crate) const LOWER_BITS: u32 = 7;
pub(crate) const UPPER_BITS: u32 = 12;
/// 64-bit words in the masks of each level; 64 times that is the number of slots.
pub(crate) const LEAF_WORDS: usize = 8;
pub(crate) const LOWER_WORDS: usize = 64;
pub(crate) const UPPER_WORDS: usize = 512;
/// Voxels of a leaf.
pub(crate) const LEAF_SIZE: usize = 64 * LEAF_WORDS;

/// Content of a slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Slot {
    /// The index of a node in the next level's arrays.
    Child(u32),
    /// One value for all voxels of the slot.
    Tile { value: f32, active: bool },
}

/// Value and activity of a voxel, or the leaf that holds them.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Located {
    /// The index of the leaf that holds the voxel.
    Leaf(u32),
    /// The tile, or the background, that covers the voxel and the aligned 8^3 block around it.
    Tile { value: f32, active: bool },
}

/// The inner nodes of one level.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level<const WORDS: usize> {
    /// Slots of each node: the index of a child, or the bits of a tile's value.
    pub(crate) slots: Vec<u32>,
    /// Slots of each node that are children.
    pub(crate) children: Vec<[u64; WORDS]>,
    /// Slots of each node that are active tiles.
    pub(crate) active: Vec<[u64; WORDS]>,
}

impl<const WORDS: usize> Level<WORDS> {
    pub(crate) const SLOTS: usize = 64 * WORDS;

    #[inline]
    pub(crate) fn slot(&self, node: u32, slot: usize) -> Slot {
        let node = node as usize;
        let bits = self.slots[node * Self::SLOTS + slot];
        if is_on(&self.children[node], slot) {
            Slot::Child(bits)
        } else {
            Slot::Tile { value: f32::from_bits(bits), active: is_on(&self.active[node], slot) }
        }
    }
}

/// The tree of a grid.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    pub(crate) background: f32,
    /// Packed origins of the root's slots, in increasing order.
    pub(crate) root_keys: Vec<u64>,
    /// The root's slots in the same order: origin and content.
    pub(crate) root: Vec<([i32; 3], Slot)>,
    pub(crate) upper: Level<UPPER_WORDS>,
    pub(crate) lower: Level<LOWER_WORDS>,
    /// Active voxels of each leaf.
    pub(crate) leaf_active: Vec<[u64; LEAF_WORDS]>,
    /// Voxels of each leaf, z fastest.
    pub(crate) leaf_values: Vec<[f32; LEAF_SIZE]>,
}

impl Tree {
    /// Descends to the leaf or tile that covers a voxel.
    #[inline]
    pub(crate) fn locate(&self, i: i32, j: i32, k: i32) -> Located {
        let Ok(root) = self.root_keys.binary_search(&root_key([i, j, k])) else {
            return Located::Tile { value: self.background, active: false };
        };
        let upper = match self.root[root].1 {
            Slot::Child(upper) => upper,
            Slot::Tile { value, active } => return Located::Tile { value, active },
        };
        let lower = match self.upper.slot(upper, slot_of::<LOWER_BITS, UPPER_BITS>(i, j, k)) {
            Slot::Child(lower) => lower,
            Slot::Tile { value, active } => return Located::Tile { value, active },
        };
        match self.lower.slot(lower, slot_of::<LEAF_BITS, LOWER_BITS>(i, j, k)) {
            Slot::Child(leaf) => Located::Leaf(leaf),
            Slot::Tile { value, active } => Located::Tile { value, active },
        }
    }

    /// Bytes that the arrays hold.
    pub(crate) fn memory_bytes(&self) -> usize {
        fn held<T>(vec: &Vec<T>) -> usize {
            vec.capacity() * size_of::<T>()
        }
        held(&self.root_keys)
            + held(&self.root)
            + held(&self.upper.slots)
            + held(&self.upper.children)
            + held(&self.upper.active)
            + held(&self.lower.slots)
            + held(&self.lower.children)
            + held(&self.lower.active)
            + held(&self.leaf_active)
            + held(&self.leaf_values)
    }
}

/// The root slot of a voxel as one number: the upper 20 bits of each coordinate side by side.
#[inline]
pub(crate) fn root_key([i, j, k]: [i32; 3]) -> u64 {
    let part = |coordinate: i32| u64::from(coordinate.cast_unsigned() >> UPPER_BITS);
    part(i) << 40 | part(j) << 20 | part(k)
}

/// A voxel's slot in a node that spans `2^OUTER` voxels and whose slots span `2^INNER`.
#[inline]
pub(crate) fn slot_of<const INNER: u32, const OUTER: u32>(i: i32, j: i32, k: i32) -> usize {
    let bits = OUTER - INNER;
    let part = |coordinate: i32| (coordinate.cast_unsigned() >> INNER & ((1 << bits) - 1)) as usize;
    part(i) << (2 * bits) | part(j) << bits | part(k)
}

/// The lowest voxel of a slot, given that of its node.
pub(crate) fn slot_origin<const INNER: u32, const OUTER: u32>(origin: [i32; 3], slot: usize) -> [i32; 3] {
    let bits = OUTER - INNER;
    let part = |shift: u32| (((slot >> shift) & ((1 << bits) - 1)) << INNER) as i32;
    [origin[0] + part(2 * bits), origin[1] + part(bits), origin[2] + part(0)]
}

#[inline]
pub(crate) fn is_on<const WORDS: usize>(mask: &[u64; WORDS], bit: usize) -> bool {
    mask[bit / 64] >> (bit % 64) & 1 != 0
}

pub(crate) fn count<const WORDS: usize>(mask: &[u64; WORDS]) -> usize {
    mask.iter().map(|word| word.count_ones() as usize).sum()
}

#[cfg(test)]
mod tests {
    use super::{LEAF_BITS, LOWER_BITS, UPPER_BITS, root_key, slot_of, slot_origin};

    #[test]
    fn slots_and_origins_are_inverse_on_both_sides_of_zero() {
        for voxel in [[0, 0, 0], [-1, -1, -1], [4095, 17, -129], [i32::MIN, i32::MAX, 1000]] {
            let [i, j, k] = voxel;
            let upper = voxel.map(|coordinate| coordinate & !0xfff);
            let lower =
                slot_origin::<LOWER_BITS, UPPER_BITS>(upper, slot_of::<LOWER_BITS, UPPER_BITS>(i, j, k));
            assert_eq!(lower, voxel.map(|coordinate| coordinate & !0x7f));
            let leaf = slot_origin::<LEAF_BITS, LOWER_BITS>(lower, slot_of::<LEAF_BITS, LOWER_BITS>(i, j, k));
            assert_eq!(leaf, voxel.map(|coordinate| coordinate & !7));
            assert_eq!(slot_origin::<0, LEAF_BITS>(leaf, slot_of::<0, LEAF_BITS>(i, j, k)), voxel);
        }
    }

    #[test]
    fn root_keys_tell_origins_apart() {
        let key = |i, j, k| root_key([i, j, k]);
        assert_eq!(key(0, 0, 0), key(4095, 4095, 4095));
        assert_ne!(key(0, 0, 0), key(0, 0, 4096));
        assert_ne!(key(-4096, 0, 0), key(0, -4096, 0));
    }
}
