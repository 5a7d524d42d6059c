//! The file around the grids: header, and for each grid a descriptor with its place in the file.

use crate::budget::Budget;
use crate::cursor::{Cursor, NUMBER_SEPARATOR};
use crate::error::VdbError;
use crate::metadata::Metadata;

const MAGIC: [u8; 8] = [0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0];
/// The versions from node mask compression (222) over Blosc (223) to the current one, with more passes for points (224).
const VERSIONS: std::ops::RangeInclusive<u32> = 222..=224;
const UUID_LENGTH: usize = 36;
/// Bytes of the shortest descriptor: three empty names and three offsets.
const SHORTEST_DESCRIPTOR: usize = 36;
const FLOAT_TREE: &str = "Tree_float_5_4_3";
const HALF_SUFFIX: &str = "_HalfFloat";

/// Description of a grid by its file, without the grid having been read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GridInfo {
    /// The grid's name; grids that share a name are numbered, as in `density[1]`.
    pub name: String,
    /// The type of its values: `float`, `vec3s`, `int32`, ...
    pub value_type: String,
    /// The type of its tree, as `Tree_float_5_4_3`: value type, then the logarithms of the nodes' sides.
    pub tree_type: String,
    /// True if 32-bit values are stored with 16 bits. They are read as the 32-bit floats that these bits stand for.
    pub saved_as_half: bool,
    /// The grid whose tree this one shares, if it has none of its own. Such grids are not read.
    pub instance_of: Option<String>,
    /// The grid's class as the file spells it: `fog volume`, `level set`, ...; none where the file states none.
    ///
    /// Values of a level set are distances, those of a staggered grid sit on faces: neither is a volume, and
    /// both are refused.
    pub class: Option<String>,
    /// The number of active voxels that the file states, tiles counted with their volume.
    pub file_voxel_count: Option<i64>,
}

/// A grid and where its parts lie.
pub(crate) struct Descriptor {
    pub(crate) info: GridInfo,
    /// The grid's name without number.
    plain_name: String,
    /// The flags that say how values are stored.
    pub(crate) compression: u32,
    /// Offset at which the metadata end and the transform begins.
    pub(crate) transform_pos: usize,
    /// Offset at which the tree's shape ends and its leaf values begin.
    pub(crate) block_pos: usize,
    /// Offset of the end of the grid.
    pub(crate) end_pos: usize,
}

/// All descriptors of a file, in file order.
pub(crate) fn descriptors(bytes: &[u8], budget: &mut Budget) -> Result<Vec<Descriptor>, VdbError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(VdbError::NotOpenVdb);
    }
    let mut cursor = Cursor::new(bytes, MAGIC.len());
    let found = cursor.u32("the file version")?;
    if !VERSIONS.contains(&found) {
        return Err(VdbError::UnsupportedVersion { found });
    }
    cursor.take(8, "the library version")?;
    if cursor.u8("the offset flag")? == 0 {
        let what = "a file written as a stream, without the grids' offsets".to_owned();
        return Err(VdbError::Unsupported { what });
    }
    cursor.take(UUID_LENGTH, "the file's identifier")?;
    Metadata::read(&mut cursor)?;
    let count = cursor.u32("the grid count")? as usize;
    cursor.expect_items(count, SHORTEST_DESCRIPTOR, "grid descriptors")?;
    let mut descriptors = Vec::new();
    for _ in 0..count {
        let descriptor = Descriptor::read(bytes, &mut cursor)?;
        budget.charge(descriptor.text_bytes())?;
        budget.reserve(&mut descriptors, 1)?;
        descriptors.push(descriptor);
    }
    Ok(descriptors)
}

impl Descriptor {
    /// Reads a descriptor and the head of its grid, and leaves the cursor at the grid's end, where the next one begins.
    fn read<'a>(bytes: &'a [u8], cursor: &mut Cursor<'a>) -> Result<Self, VdbError> {
        let unique_name = cursor.name("a grid name")?;
        let stored_type = cursor.name("a grid type")?;
        let parent = cursor.name("an instance parent")?;
        let is_instance = !parent.is_empty();
        let offsets_at = cursor.at();
        let mut offset = || {
            let offset = cursor.i64("the grid's offsets")?;
            usize::try_from(offset).map_err(|_| VdbError::corrupt(offsets_at, "a grid's offset is negative"))
        };
        let (grid_pos, block_pos, end_pos) = (offset()?, offset()?, offset()?);
        // An instance has no tree and leaves the offset of the tree's values unset.
        let ordered = cursor.at() <= grid_pos
            && if is_instance { grid_pos <= end_pos } else { grid_pos <= block_pos && block_pos <= end_pos };
        if !ordered {
            return Err(VdbError::corrupt(offsets_at, "the grid's offsets are not in order"));
        }
        if end_pos > bytes.len() {
            return Err(VdbError::truncated(bytes.len(), format!("grid \"{}\"", displayed(&unique_name))));
        }

        let mut head = Cursor::new(&bytes[..end_pos], grid_pos);
        let compression = head.u32("the grid's compression")?;
        let metadata = Metadata::read(&mut head)?;
        let (tree_type, half_by_type) = match stored_type.strip_suffix(HALF_SUFFIX) {
            Some(tree_type) => (tree_type.to_owned(), true),
            None => (stored_type, false),
        };
        // OpenVDB writes both; values read with the wrong width are plausible nonsense, so that a contradiction is refused.
        if metadata.saved_as_half.is_some_and(|half| half != half_by_type) {
            return Err(VdbError::corrupt(
                grid_pos,
                "type and metadata disagree on the values being 16 bits wide",
            ));
        }
        *cursor = Cursor::new(bytes, end_pos);
        let info = GridInfo {
            name: displayed(&unique_name),
            value_type: value_type(&tree_type),
            tree_type,
            saved_as_half: half_by_type,
            instance_of: is_instance.then(|| displayed(&parent)),
            class: metadata.class,
            file_voxel_count: metadata.voxel_count,
        };
        let plain_name = unique_name.split(NUMBER_SEPARATOR).next().unwrap_or_default().to_owned();
        Ok(Self { info, plain_name, compression, transform_pos: head.at(), block_pos, end_pos })
    }

    /// Bytes of all names held.
    fn text_bytes(&self) -> usize {
        let GridInfo { name, value_type, tree_type, instance_of, class, .. } = &self.info;
        let optional = [instance_of, class].into_iter().flatten();
        [&self.plain_name, name, value_type, tree_type].into_iter().chain(optional).map(String::len).sum()
    }

    fn is_float_tree(&self) -> bool {
        self.info.tree_type == FLOAT_TREE
    }
}

/// The name of the grid that is read where none is asked for.
const USUAL_NAME: &str = "density";

/// The grid to be read: the one asked for; else `density`; else the only float grid.
pub(crate) fn select<'a>(grids: &'a [Descriptor], name: Option<&str>) -> Result<&'a Descriptor, VdbError> {
    let grid = match name {
        // A full name is unique; a name without its number means the first grid of that name.
        Some(asked) => grids
            .iter()
            .find(|grid| grid.info.name == asked)
            .or_else(|| grids.iter().find(|grid| grid.plain_name == asked))
            .ok_or_else(|| VdbError::NoSuchGrid {
                asked: asked.to_owned(),
                available: grids.iter().map(|grid| grid.info.name.clone()).collect(),
            })?,
        None => usual(grids)?,
    };
    let name = grid.info.name.clone();
    if !grid.is_float_tree() {
        return Err(VdbError::WrongType { grid: name, found: grid.info.tree_type.clone() });
    }
    if let Some(parent) = &grid.info.instance_of {
        let what = format!("grid \"{name}\" has no tree of its own, it is an instance of \"{parent}\"");
        return Err(VdbError::Unsupported { what });
    }
    match &grid.info.class {
        Some(class) if is_no_volume(class) => Err(VdbError::NotAVolume { grid: name, class: class.clone() }),
        _ => Ok(grid),
    }
}

/// The grid that can be meant where none is asked for: of all float grids, whatever their trees and also where
/// they are instances, the only one, or the only one that is called [`USUAL_NAME`].
fn usual(grids: &[Descriptor]) -> Result<&Descriptor, VdbError> {
    let floats: Vec<&Descriptor> =
        grids.iter().filter(|grid| matches!(grid.info.value_type.as_str(), "float" | "double")).collect();
    let densities: Vec<&Descriptor> =
        floats.iter().copied().filter(|grid| grid.plain_name == USUAL_NAME).collect();
    match (densities.as_slice(), floats.as_slice()) {
        ([grid], _) | ([], [grid]) => Ok(grid),
        ([], []) => {
            let described = |grid: &Descriptor| format!("{} ({})", grid.info.name, grid.info.tree_type);
            Err(VdbError::NoFloatGrid { available: grids.iter().map(described).collect() })
        }
        ([], several) | (several, _) => Err(VdbError::SeveralFloatGrids {
            available: several.iter().map(|grid| grid.info.name.clone()).collect(),
        }),
    }
}

/// True if the values of a grid of this class are no property of its voxels. OpenVDB compares classes trimmed
/// and in lower case, and takes every other text for an unknown class.
fn is_no_volume(class: &str) -> bool {
    matches!(class.trim().to_lowercase().as_str(), "level set" | "staggered")
}

/// `density`, or `density[1]` for the second grid of that name.
fn displayed(unique_name: &str) -> String {
    match unique_name.split_once(NUMBER_SEPARATOR) {
        Some((name, number)) => format!("{name}[{}]", number.replace(NUMBER_SEPARATOR, "\u{fffd}")),
        None => unique_name.to_owned(),
    }
}

/// `float` from `Tree_float_5_4_3`.
fn value_type(tree_type: &str) -> String {
    let without_prefix = tree_type.strip_prefix("Tree_").unwrap_or(tree_type);
    without_prefix.split('_').next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::{displayed, value_type};

    #[test]
    fn names_and_types_are_shown_as_openvdb_shows_them() {
        assert_eq!(displayed("density"), "density");
        assert_eq!(displayed("density\u{1e}1"), "density[1]");
        assert_eq!(displayed("\u{1e}0"), "[0]", "a grid without a name");
        assert_eq!(value_type("Tree_vec3s_5_4_3"), "vec3s");
        assert_eq!(value_type("odd"), "odd");
    }
}
