//! Metadata maps: the few entries that reading depends on; all others are stepped over without being kept.

use crate::cursor::Cursor;
use crate::error::VdbError;

/// Bytes of the shortest entry: three lengths, no text, no value.
const SHORTEST_ENTRY: usize = 12;

/// Entries that the reader takes from a grid's metadata.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Metadata {
    /// `class`: "fog volume", "level set", ...
    pub(crate) class: Option<String>,
    /// `is_saved_as_half_float`.
    pub(crate) saved_as_half: Option<bool>,
    /// `file_voxel_count`: active voxels, tiles counted with their volume.
    pub(crate) voxel_count: Option<i64>,
}

impl Metadata {
    pub(crate) fn read(cursor: &mut Cursor<'_>) -> Result<Self, VdbError> {
        let count = cursor.u32("the metadata")? as usize;
        cursor.expect_items(count, SHORTEST_ENTRY, "metadata entries")?;
        let mut metadata = Self::default();
        for _ in 0..count {
            let name = cursor.name("a metadata name")?;
            let kind = cursor.name("a metadata type")?;
            let length = cursor.u32("a metadata value")? as usize;
            let at = cursor.at();
            let value = cursor.take(length, "a metadata value")?;
            let mistyped = || VdbError::corrupt(at, format!("{name} is a {kind} of {length} bytes"));
            match name.as_str() {
                "class" if kind == "string" => {
                    let short = &value[..value.len().min(64)];
                    metadata.class =
                        Some(String::from_utf8_lossy(short).replace(char::is_control, "\u{fffd}"));
                }
                "is_saved_as_half_float" => match (kind.as_str(), value) {
                    ("bool", [flag]) => metadata.saved_as_half = Some(*flag != 0),
                    _ => return Err(mistyped()),
                },
                "file_voxel_count" => match (kind.as_str(), value.try_into()) {
                    ("int64", Ok(bytes)) => metadata.voxel_count = Some(i64::from_le_bytes(bytes)),
                    _ => return Err(mistyped()),
                },
                _ => {}
            }
        }
        Ok(metadata)
    }
}

#[cfg(test)]
mod tests {
    use super::Metadata;
    use crate::cursor::Cursor;
    use crate::error::VdbError;

    fn entry(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for part in [name.as_bytes(), kind.as_bytes(), value] {
            bytes.extend(u32::try_from(part.len()).expect("short").to_le_bytes());
            bytes.extend(part);
        }
        bytes
    }

    #[test]
    fn known_entries_are_kept_and_others_stepped_over() {
        let mut bytes = 3_u32.to_le_bytes().to_vec();
        bytes.extend(entry("whatever", "__delayedload", &[7; 99]));
        bytes.extend(entry("is_saved_as_half_float", "bool", &[1]));
        bytes.extend(entry("file_voxel_count", "int64", &5_i64.to_le_bytes()));
        let metadata = Metadata::read(&mut Cursor::new(&bytes, 0)).expect("well formed");
        assert_eq!(metadata, Metadata { class: None, saved_as_half: Some(true), voxel_count: Some(5) });
    }

    #[test]
    fn mistyped_and_uncountable_entries_are_refused() {
        let mut bytes = 1_u32.to_le_bytes().to_vec();
        bytes.extend(entry("file_voxel_count", "int32", &[0; 4]));
        assert!(matches!(Metadata::read(&mut Cursor::new(&bytes, 0)), Err(VdbError::Corrupt { .. })));
        let endless = [0xff; 16];
        assert!(matches!(Metadata::read(&mut Cursor::new(&endless, 0)), Err(VdbError::Truncated { .. })));
    }
}
