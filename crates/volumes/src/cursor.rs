//! A position in the file's bytes; every read is checked against what remains and names what was being read.

use crate::error::VdbError;

/// Separates a grid's name from the number that tells grids of one name apart.
pub(crate) const NUMBER_SEPARATOR: char = '\x1e';
/// Names and type names longer than this are taken for damage: they end up in messages and memory.
const LONGEST_NAME: usize = 4096;

#[derive(Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    pub(crate) fn at(&self) -> usize {
        self.at
    }

    pub(crate) fn remaining(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    pub(crate) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], VdbError> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.bytes.len());
        let Some(end) = end else { return Err(VdbError::truncated(self.bytes.len(), what)) };
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], VdbError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    pub(crate) fn u8(&mut self, what: &str) -> Result<u8, VdbError> {
        Ok(self.array::<1>(what)?[0])
    }

    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, VdbError> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    pub(crate) fn i64(&mut self, what: &str) -> Result<i64, VdbError> {
        Ok(i64::from_le_bytes(self.array(what)?))
    }

    pub(crate) fn f32(&mut self, what: &str) -> Result<f32, VdbError> {
        Ok(f32::from_le_bytes(self.array(what)?))
    }

    pub(crate) fn f64(&mut self, what: &str) -> Result<f64, VdbError> {
        Ok(f64::from_le_bytes(self.array(what)?))
    }

    /// Three signed 32-bit coordinates.
    pub(crate) fn coordinates(&mut self, what: &str) -> Result<[i32; 3], VdbError> {
        let mut read = || Ok(i32::from_le_bytes(self.array(what)?));
        Ok([read()?, read()?, read()?])
    }

    /// A node's bit mask, bit `n` of it being bit `n % 64` of word `n / 64`.
    pub(crate) fn mask<const WORDS: usize>(&mut self, what: &str) -> Result<[u64; WORDS], VdbError> {
        let mut mask = [0; WORDS];
        for (word, bytes) in mask.iter_mut().zip(self.take(8 * WORDS, what)?.chunks_exact(8)) {
            *word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        }
        Ok(mask)
    }

    /// A length-prefixed name. Names only have to be recognised and to fit a line of text: what is not UTF-8 and control
    /// characters become replacement characters, but for the separator that the format itself puts into grid names.
    pub(crate) fn name(&mut self, what: &str) -> Result<String, VdbError> {
        let start = self.at;
        let length = self.u32(what)? as usize;
        if length > LONGEST_NAME && length <= self.remaining() {
            return Err(VdbError::corrupt(start, format!("{what} of {length} bytes")));
        }
        let text = String::from_utf8_lossy(self.take(length, what)?);
        let unfit = |c: char| c.is_control() && c != NUMBER_SEPARATOR;
        Ok(text.replace(unfit, "\u{fffd}"))
    }

    /// Refuses `count` items that take at least `least` bytes each if the remaining bytes cannot hold them.
    ///
    /// This comes before any allocation whose size the file states.
    pub(crate) fn expect_items(&self, count: usize, least: usize, what: &str) -> Result<(), VdbError> {
        match count.checked_mul(least) {
            Some(bytes) if bytes <= self.remaining() => Ok(()),
            _ => Err(VdbError::truncated(self.bytes.len(), format!("{what} ({count} of them)"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Cursor;
    use crate::error::VdbError;

    #[test]
    fn reads_little_endian_and_stops_at_the_end() {
        let mut cursor = Cursor::new(&[1, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0xfe], 0);
        assert_eq!(cursor.u32("count"), Ok(1));
        assert_eq!(cursor.remaining(), 5);
        let before = cursor.clone().name("name");
        assert_eq!(before, Err(VdbError::truncated(9, "name")), "a length of 4 GiB is not allocated");
        assert!(cursor.i64("offset").is_err());
        assert_eq!(cursor.at(), 4, "a failed read does not move");
    }

    #[test]
    fn mask_bits_are_in_file_order() {
        let mut bytes = [0; 16];
        bytes[0] = 0b10;
        bytes[15] = 0x80;
        assert_eq!(Cursor::new(&bytes, 0).mask::<2>("mask"), Ok([2, 1 << 63]));
    }

    #[test]
    fn impossible_counts_are_refused() {
        let cursor = Cursor::new(&[0; 100], 0);
        assert!(cursor.expect_items(10, 10, "nodes").is_ok());
        assert!(cursor.expect_items(11, 10, "nodes").is_err());
        assert!(cursor.expect_items(usize::MAX, 10, "nodes").is_err());
    }
}
