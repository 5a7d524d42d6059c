//! All values of one node, of which the file may omit the inactive ones.
//!
//! Before the values stands a code. In a fog volume nearly every inactive value is the background and in a level set plus
//! or minus the background, so that most nodes store their active values only, plus at most two inactive ones and a mask
//! that tells those apart.

use crate::codec::Codec;
use crate::cursor::Cursor;
use crate::error::VdbError;

/// Inactive values are the background.
const BACKGROUND: u8 = 0;
/// Inactive values are minus the background.
const MINUS_BACKGROUND: u8 = 1;
/// Inactive values are one value, which follows.
const ONE_VALUE: u8 = 2;
/// A mask selects between minus and plus the background.
const MASKED_BACKGROUNDS: u8 = 3;
/// A mask selects between a value, which follows, and the background.
const MASKED_ONE_VALUE: u8 = 4;
/// A mask selects between two values, which follow.
const MASKED_TWO_VALUES: u8 = 5;
/// Inactive values are stored like active ones.
const ALL_VALUES: u8 = 6;

/// Reads the values of a node of `64 * WORDS` slots. Slots that are child nodes get an arbitrary value.
pub(crate) fn read<const WORDS: usize>(
    cursor: &mut Cursor<'_>,
    codec: &mut Codec,
    background: f32,
    active: &[u64; WORDS],
    out: &mut [f32],
) -> Result<(), VdbError> {
    debug_assert_eq!(out.len(), 64 * WORDS, "one value for each bit of the mask");
    const WHAT: &str = "inactive values";
    let at = cursor.at();
    let code = cursor.u8(WHAT)?;
    let (zero_bit, one_bit) = match code {
        BACKGROUND | ALL_VALUES => (background, background),
        MINUS_BACKGROUND | MASKED_BACKGROUNDS => (-background, background),
        ONE_VALUE | MASKED_ONE_VALUE => (cursor.f32(WHAT)?, background),
        MASKED_TWO_VALUES => (cursor.f32(WHAT)?, cursor.f32(WHAT)?),
        _ => return Err(VdbError::corrupt(at, format!("unknown code {code} for inactive values"))),
    };
    let selection = match code {
        MASKED_BACKGROUNDS | MASKED_ONE_VALUE | MASKED_TWO_VALUES => cursor.mask::<WORDS>(WHAT)?,
        _ => [0; WORDS],
    };
    if code == ALL_VALUES || !codec.omits_inactive() {
        return codec.read(cursor, out);
    }

    // The active values are stored without gaps: read them to the front, then spread them from the back, where each one
    // moves to its own place or further back and so never lands on one that is still to move.
    let mut packed: usize = active.iter().map(|word| word.count_ones() as usize).sum();
    codec.read(cursor, &mut out[..packed])?;
    for slot in (0..out.len()).rev() {
        let (word, bit) = (slot / 64, slot % 64);
        out[slot] = if active[word] >> bit & 1 != 0 {
            packed -= 1;
            out[packed]
        } else if selection[word] >> bit & 1 != 0 {
            one_bit
        } else {
            zero_bit
        };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::read;
    use crate::codec::Codec;
    use crate::cursor::Cursor;
    use crate::error::VdbError;

    const OMIT_INACTIVE: u32 = 2;

    /// The first four of 64 values, of which slots 1 and 3 are active; the selection mask has slot 2 on.
    fn first_four(
        flags: u32,
        code: u8,
        inactive: &[f32],
        masked: bool,
        stored: &[f32],
    ) -> Result<[f32; 4], VdbError> {
        let mut bytes = vec![code];
        bytes.extend(inactive.iter().flat_map(|value| value.to_le_bytes()));
        if masked {
            bytes.extend(0b0100_u64.to_le_bytes());
        }
        bytes.extend(stored.iter().flat_map(|value| value.to_le_bytes()));
        let mut out = [f32::NAN; 64];
        let mut cursor = Cursor::new(&bytes, 0);
        read(&mut cursor, &mut Codec::new(flags, false)?, 0.5, &[0b1010], &mut out)?;
        assert_eq!(cursor.remaining(), 0);
        Ok([out[0], out[1], out[2], out[3]])
    }

    #[test]
    fn each_code_restores_its_inactive_values() {
        let omitting = |code, inactive: &[f32], masked| {
            first_four(OMIT_INACTIVE, code, inactive, masked, &[1.0, 2.0]).expect("well formed")
        };
        assert_eq!(omitting(0, &[], false), [0.5, 1.0, 0.5, 2.0]);
        assert_eq!(omitting(1, &[], false), [-0.5, 1.0, -0.5, 2.0]);
        assert_eq!(omitting(2, &[7.0], false), [7.0, 1.0, 7.0, 2.0]);
        assert_eq!(omitting(3, &[], true), [-0.5, 1.0, 0.5, 2.0]);
        assert_eq!(omitting(4, &[7.0], true), [7.0, 1.0, 0.5, 2.0]);
        assert_eq!(omitting(5, &[7.0, 8.0], true), [7.0, 1.0, 8.0, 2.0]);
    }

    #[test]
    fn all_values_are_stored_under_code_six_or_without_the_flag() {
        let all: Vec<f32> = (0..64_u8).map(f32::from).collect();
        let expected = Ok([0.0, 1.0, 2.0, 3.0]);
        assert_eq!(first_four(OMIT_INACTIVE, 6, &[], false, &all), expected);
        assert_eq!(first_four(0, 6, &[], false, &all), expected);
        assert_eq!(first_four(0, 2, &[7.0], false, &all), expected);
    }

    #[test]
    fn unknown_codes_are_refused() {
        assert!(matches!(first_four(OMIT_INACTIVE, 7, &[], false, &[]), Err(VdbError::Corrupt { .. })));
    }
}
