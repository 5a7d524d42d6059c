//! Blocks of node values: found in the file, decompressed to the size they must have, widened to 32-bit floats.

use flate2::{Decompress, FlushDecompress, Status};
use half::f16;

use crate::blosc::{self, ChunkError};
use crate::cursor::Cursor;
use crate::error::VdbError;

const ZIP: u32 = 1;
const ACTIVE_MASK: u32 = 2;
const BLOSC: u32 = 4;

/// Encoding of a grid's values, and the buffers that decoding goes through.
///
/// The buffers grow to the largest node at most: 32^3 values of four bytes.
pub(crate) struct Codec {
    flags: u32,
    half: bool,
    plain: Vec<u8>,
    scratch: Vec<u8>,
    inflate: Decompress,
}

impl Codec {
    pub(crate) fn new(flags: u32, half: bool) -> Result<Self, VdbError> {
        if flags & !(ZIP | ACTIVE_MASK | BLOSC) != 0 {
            return Err(VdbError::UnsupportedCompression { what: format!("flags {flags:#x}") });
        }
        Ok(Self { flags, half, plain: Vec::new(), scratch: Vec::new(), inflate: Decompress::new(true) })
    }

    /// True if nodes leave out their inactive values.
    pub(crate) fn omits_inactive(&self) -> bool {
        self.flags & ACTIVE_MASK != 0
    }

    /// Reads one block of `out.len()` values.
    pub(crate) fn read(&mut self, cursor: &mut Cursor<'_>, out: &mut [f32]) -> Result<(), VdbError> {
        // The writer skips an empty block of 16-bit values altogether, but writes the frame around one of 32-bit values.
        if self.half && out.is_empty() {
            return Ok(());
        }
        let width = if self.half { 2 } else { 4 };
        self.plain.clear();
        self.plain.resize(width * out.len(), 0);
        self.fill_plain(cursor)?;
        if self.half {
            for (value, bytes) in out.iter_mut().zip(self.plain.chunks_exact(2)) {
                *value = f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
            }
        } else {
            for (value, bytes) in out.iter_mut().zip(self.plain.chunks_exact(4)) {
                *value = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            }
        }
        Ok(())
    }

    fn fill_plain(&mut self, cursor: &mut Cursor<'_>) -> Result<(), VdbError> {
        const WHAT: &str = "node values";
        if self.flags & (ZIP | BLOSC) == 0 {
            let stored = cursor.take(self.plain.len(), WHAT)?;
            self.plain.copy_from_slice(stored);
            return Ok(());
        }
        // A framed block: its size if compressed, or minus its size if compression did not help.
        let at = cursor.at();
        let size = cursor.i64(WHAT)?;
        let stored = usize::try_from(size.unsigned_abs()).unwrap_or(usize::MAX);
        if size <= 0 {
            if stored != self.plain.len() {
                return Err(VdbError::corrupt(at, "a block has another size than its node"));
            }
            self.plain.copy_from_slice(cursor.take(stored, WHAT)?);
            return Ok(());
        }
        let packed = cursor.take(stored, WHAT)?;
        if self.plain.is_empty() {
            return Ok(());
        }
        if self.flags & BLOSC != 0 {
            blosc::decode(packed, &mut self.plain, &mut self.scratch).map_err(|error| match error {
                ChunkError::Unsupported(what) => VdbError::UnsupportedCompression { what: what.to_owned() },
                ChunkError::Corrupt(what) => VdbError::corrupt(at, what),
            })
        } else {
            self.inflate.reset(true);
            let status = self.inflate.decompress(packed, &mut self.plain, FlushDecompress::Finish);
            match status {
                Ok(Status::StreamEnd) if self.inflate.total_out() == self.plain.len() as u64 => Ok(()),
                _ => Err(VdbError::corrupt(at, "a zip block does not decode to its size")),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::{BLOSC, Codec, ZIP};
    use crate::cursor::Cursor;
    use crate::error::VdbError;

    fn read(flags: u32, half: bool, bytes: &[u8], count: usize) -> Result<Vec<f32>, VdbError> {
        let mut out = vec![0.0; count];
        Codec::new(flags, half)?.read(&mut Cursor::new(bytes, 0), &mut out).map(|()| out)
    }

    fn framed(size: i64, body: &[u8]) -> Vec<u8> {
        [&size.to_le_bytes()[..], body].concat()
    }

    fn zipped(plain: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(plain).expect("writing to memory");
        encoder.finish().expect("writing to memory")
    }

    #[test]
    fn plain_values_of_either_width() {
        assert_eq!(read(0, false, &1.5_f32.to_le_bytes(), 1), Ok(vec![1.5]));
        assert_eq!(read(0, true, &[0x00, 0x3e, 0x00, 0xc0], 2), Ok(vec![1.5, -2.0]));
    }

    #[test]
    fn frames_hold_packed_or_plain_bytes() {
        let plain: Vec<u8> = [0.5_f32; 100].iter().flat_map(|value| value.to_le_bytes()).collect();
        let packed = zipped(&plain);
        let size = i64::try_from(packed.len()).expect("short");
        assert_eq!(read(ZIP, false, &framed(size, &packed), 100), Ok(vec![0.5; 100]));
        assert_eq!(read(ZIP, false, &framed(-400, &plain), 100), Ok(vec![0.5; 100]));
        assert_eq!(read(BLOSC, false, &framed(-400, &plain), 100), Ok(vec![0.5; 100]));
        assert!(read(ZIP, false, &framed(size, &packed), 99).is_err(), "the stream is longer than the node");
        assert!(
            read(ZIP, false, &framed(size, &packed), 101).is_err(),
            "the stream is shorter than the node"
        );
        assert!(read(ZIP, false, &framed(-396, &plain), 100).is_err());
    }

    #[test]
    fn sizes_beyond_the_file_are_refused() {
        for size in [i64::MAX, i64::MIN, 9] {
            assert!(read(BLOSC, false, &framed(size, &[0; 8]), 2).is_err(), "{size}");
        }
    }

    #[test]
    fn unknown_flags_are_named() {
        let error = VdbError::UnsupportedCompression { what: "flags 0x8".to_owned() };
        assert_eq!(read(8, false, &[], 0), Err(error));
    }
}
