//! Errors of files that are refused: one variant per reason, each with a one-line message for the user who chose the file.

use thiserror::Error;

/// The reasons for which a file, or a grid in it, is refused.
///
/// Positions are byte offsets from the start of the file.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum VdbError {
    /// The first eight bytes are not those of an OpenVDB file; an empty file is one case.
    #[error("not an OpenVDB file")]
    NotOpenVdb,
    /// The file ends before the named part of it does.
    #[error("the file is cut off: {what} reaches past byte {at}")]
    Truncated {
        /// The end of the bytes that are there.
        at: usize,
        /// The part that was being read.
        what: String,
    },
    /// The file format is older or newer than the versions 222 to 224 that this reader knows.
    #[error("OpenVDB file version {found} is not supported (222 to 224 are)")]
    UnsupportedVersion {
        /// The version that the file names.
        found: u32,
    },
    /// No grid of the file has the asked name.
    #[error("no grid named \"{asked}\"; the file has {}", list(available))]
    NoSuchGrid {
        /// The name asked for.
        asked: String,
        /// The names of all grids of the file.
        available: Vec<String>,
    },
    /// No name was asked for and the file has no float grid that can be read.
    #[error("no float grid; the file has {}", list(available))]
    NoFloatGrid {
        /// All grids of the file as "name (tree type)".
        available: Vec<String>,
    },
    /// No name was asked for, and which of several float grids is meant cannot be known.
    #[error("several float grids, of which one must be named: the file has {}", list(available))]
    SeveralFloatGrids {
        /// The names that are possible.
        available: Vec<String>,
    },
    /// The values of the grid are no property of its voxels: distances of a level set, say.
    #[error("grid \"{grid}\" is a {class}, not a fog volume: its values are no densities")]
    NotAVolume {
        /// The grid's name.
        grid: String,
        /// The grid's class as the file spells it.
        class: String,
    },
    /// The grid asked for has other values than floats, or another tree than the usual 5-4-3.
    #[error("grid \"{grid}\" is a {found}, not a Tree_float_5_4_3")]
    WrongType {
        /// The grid's name.
        grid: String,
        /// The grid's tree type as the file spells it.
        found: String,
    },
    /// The values are stored by a codec that this reader does not have.
    #[error("compression not supported: {what}")]
    UnsupportedCompression {
        /// The codec or flag in question.
        what: String,
    },
    /// The grid's map to world space is not an invertible affine one.
    #[error("transform not supported: {what}")]
    UnsupportedTransform {
        /// The map and what is wrong with it.
        what: String,
    },
    /// The file uses a part of the format that this reader leaves out.
    #[error("not supported: {what}")]
    Unsupported {
        /// The part in question.
        what: String,
    },
    /// The bytes contradict the format.
    #[error("the file is corrupt at byte {at}: {what}")]
    Corrupt {
        /// The offset at which the contradiction was noticed.
        at: usize,
        /// The contradiction, in words.
        what: String,
    },
    /// The number of active voxels is not the one that the file's own metadata states.
    #[error("the file states {expected} active voxels, but its tree has {found}")]
    Inconsistent {
        /// The metadata `file_voxel_count`.
        expected: i64,
        /// The active voxels counted after reading.
        found: u64,
    },
    /// A value of the grid is infinite or not a number, which no extinction can be.
    #[error("voxel {index:?} has the value {value}")]
    NonFinite {
        /// The first such voxel in tree order, or the lowest voxel of the tile.
        index: [i32; 3],
        /// The value of that voxel.
        value: f32,
    },
    /// Reading would need more memory than a file of this size can justify, or a count does not fit its type.
    #[error("{what} is too large: {asked}, where at most {limit} is allowed")]
    TooLarge {
        /// The part that would not fit.
        what: String,
        /// The amount asked for.
        asked: u64,
        /// The amount allowed.
        limit: u64,
    },
}

impl VdbError {
    pub(crate) fn corrupt(at: usize, what: impl Into<String>) -> Self {
        Self::Corrupt { at, what: what.into() }
    }

    pub(crate) fn truncated(at: usize, what: impl Into<String>) -> Self {
        Self::Truncated { at, what: what.into() }
    }
}

/// Names for a message; a file can hold thousands of grids, a message line cannot.
fn list(names: &[String]) -> String {
    const SHOWN: usize = 16;
    match names.len() {
        0 => "no grid at all".to_owned(),
        n if n <= SHOWN => names.join(", "),
        n => format!("{}, and {} more", names[..SHOWN].join(", "), n - SHOWN),
    }
}

#[cfg(test)]
mod tests {
    use super::VdbError;

    #[test]
    fn messages_are_one_line_and_name_the_alternatives() {
        let error = VdbError::NoSuchGrid { asked: "smoke".into(), available: vec!["a".into(), "b".into()] };
        assert_eq!(error.to_string(), "no grid named \"smoke\"; the file has a, b");
        let none = VdbError::NoFloatGrid { available: Vec::new() };
        assert_eq!(none.to_string(), "no float grid; the file has no grid at all");
        let many = VdbError::NoFloatGrid { available: vec!["g".into(); 20] };
        assert!(many.to_string().ends_with("g, and 4 more"), "{many}");
    }
}
