//! Reading a tree: first its shape with all tiles, then the leaves' values, both depth first.

use crate::budget::Budget;
use crate::codec::Codec;
use crate::cursor::Cursor;
use crate::error::VdbError;
use crate::tree::{
    LEAF_SIZE, LEAF_WORDS, LOWER_WORDS, Level, Slot, Tree, UPPER_BITS, UPPER_WORDS, count, root_key,
};
use crate::values;

/// The least bytes of a root tile: origin, value, active flag.
const TILE_BYTES: usize = 17;
/// The least bytes of an inner node: two masks and the code for inactive values.
const fn least_node_bytes(words: usize) -> usize {
    16 * words + 1
}
/// The bytes of a leaf in the tree's shape: its mask.
const LEAF_SHAPE_BYTES: usize = 8 * LEAF_WORDS;
/// The least bytes of a leaf among the values: its mask again and the code for inactive values.
const LEAF_VALUE_BYTES: usize = 8 * LEAF_WORDS + 1;

/// Reads the shape and tiles of a tree; all leaves are left without values.
pub(crate) fn shape(
    cursor: &mut Cursor<'_>,
    codec: &mut Codec,
    budget: &mut Budget,
) -> Result<Tree, VdbError> {
    let buffers = cursor.u32("the tree")?;
    if buffers != 1 {
        return Err(VdbError::Unsupported { what: format!("a tree of {buffers} buffers") });
    }
    let at = cursor.at();
    let background = cursor.f32("the background")?;
    if !background.is_finite() {
        return Err(VdbError::corrupt(at, format!("the background is {background}")));
    }
    let mut tree = Tree {
        background,
        root_keys: Vec::new(),
        root: Vec::new(),
        upper: Level::default(),
        lower: Level::default(),
        leaf_active: Vec::new(),
        leaf_values: Vec::new(),
    };
    let tiles = cursor.u32("the root's tile count")? as usize;
    let children = cursor.u32("the root's node count")? as usize;
    cursor.expect_items(tiles, TILE_BYTES, "root tiles")?;
    cursor.expect_items(children, least_node_bytes(UPPER_WORDS), "root nodes")?;
    budget.reserve(&mut tree.root, tiles + children)?;
    budget.reserve(&mut tree.root_keys, tiles + children)?;
    for _ in 0..tiles {
        let origin = root_origin(cursor)?;
        let value = cursor.f32("a root tile")?;
        let active = cursor.u8("a root tile")? != 0;
        tree.root.push((origin, Slot::Tile { value, active }));
    }
    for _ in 0..children {
        let origin = root_origin(cursor)?;
        let node = upper_node(cursor, codec, &mut tree, budget)?;
        tree.root.push((origin, Slot::Child(node)));
    }

    tree.root.sort_unstable_by_key(|(origin, _)| root_key(*origin));
    tree.root_keys.extend(tree.root.iter().map(|(origin, _)| root_key(*origin)));
    if tree.root_keys.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err(VdbError::corrupt(cursor.at(), "two root nodes lie at the same place"));
    }
    Ok(tree)
}

/// Reads the values of all leaves.
pub(crate) fn leaves(
    cursor: &mut Cursor<'_>,
    codec: &mut Codec,
    tree: &mut Tree,
    budget: &mut Budget,
) -> Result<(), VdbError> {
    let count = tree.leaf_active.len();
    cursor.expect_items(count, LEAF_VALUE_BYTES, "leaves")?;
    budget.reserve(&mut tree.leaf_values, count)?;
    for active in &tree.leaf_active {
        let at = cursor.at();
        if cursor.mask::<LEAF_WORDS>("a leaf's mask")? != *active {
            return Err(VdbError::corrupt(at, "the two masks of a leaf differ"));
        }
        let mut leaf = [0.0; LEAF_SIZE];
        values::read(cursor, codec, tree.background, active, &mut leaf)?;
        tree.leaf_values.push(leaf);
    }
    Ok(())
}

fn root_origin(cursor: &mut Cursor<'_>) -> Result<[i32; 3], VdbError> {
    let at = cursor.at();
    let origin = cursor.coordinates("a root origin")?;
    if origin.iter().any(|coordinate| coordinate.trailing_zeros() < UPPER_BITS) {
        return Err(VdbError::corrupt(
            at,
            format!("a root node at {origin:?}, which is no multiple of 4096"),
        ));
    }
    Ok(origin)
}

/// Reads an upper node and everything below it but leaf values.
fn upper_node(
    cursor: &mut Cursor<'_>,
    codec: &mut Codec,
    tree: &mut Tree,
    budget: &mut Budget,
) -> Result<u32, VdbError> {
    let first = tree.lower.children.len();
    let (node, children) = inner_node(cursor, codec, tree.background, &mut tree.upper, first, budget)?;
    cursor.expect_items(children, least_node_bytes(LOWER_WORDS), "lower nodes")?;
    for _ in 0..children {
        let first = tree.leaf_active.len();
        let (_, leaves) = inner_node(cursor, codec, tree.background, &mut tree.lower, first, budget)?;
        cursor.expect_items(leaves, LEAF_SHAPE_BYTES, "leaf masks")?;
        budget.reserve(&mut tree.leaf_active, leaves)?;
        for _ in 0..leaves {
            tree.leaf_active.push(cursor.mask("a leaf's mask")?);
        }
    }
    Ok(node)
}

/// Appends an inner node to its level. Its children come next in the file, so that they will have the indices from
/// `first_child` on. Returns the index of the node and the number of its children.
fn inner_node<const WORDS: usize>(
    cursor: &mut Cursor<'_>,
    codec: &mut Codec,
    background: f32,
    level: &mut Level<WORDS>,
    first_child: usize,
    budget: &mut Budget,
) -> Result<(u32, usize), VdbError> {
    let at = cursor.at();
    let children = cursor.mask::<WORDS>("an inner node")?;
    let active = cursor.mask::<WORDS>("an inner node")?;
    if children.iter().zip(&active).any(|(child, tile)| child & tile != 0) {
        return Err(VdbError::corrupt(at, "a slot of a node is both a child and an active tile"));
    }
    let number = count(&children);
    let node = index(level.children.len())?;
    index(first_child + number)?;
    budget.reserve(&mut level.children, 1)?;
    budget.reserve(&mut level.active, 1)?;
    budget.reserve(&mut level.slots, Level::<WORDS>::SLOTS)?;

    let mut tiles = vec![0.0; Level::<WORDS>::SLOTS];
    values::read(cursor, codec, background, &active, &mut tiles)?;
    let mut child = first_child as u32;
    for (slot, tile) in tiles.iter().enumerate() {
        let is_child = crate::tree::is_on(&children, slot);
        level.slots.push(if is_child { child } else { tile.to_bits() });
        child += u32::from(is_child);
    }
    level.children.push(children);
    level.active.push(active);
    Ok((node, number))
}

/// A node's index; files with more nodes than 32 bits count would have to be larger than 256 GiB.
fn index(count: usize) -> Result<u32, VdbError> {
    u32::try_from(count).map_err(|_| VdbError::TooLarge {
        what: "the number of nodes".to_owned(),
        asked: count as u64,
        limit: u64::from(u32::MAX),
    })
}
