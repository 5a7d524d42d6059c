//! Blosc 1 chunks, decoded without the C library.
//!
//! A chunk is a header of 16 bytes, then either the plain bytes, or the offset of each block and the blocks. A block is one
//! or several LZ4 streams, each with its length in front; with several, stream `n` carries byte `n` of every element. The
//! output has the size that the caller knows it must have, so that nothing in the chunk decides over memory.

/// Bytes before the block offsets: version, codec version, flags, element size, then three 32-bit sizes.
const HEADER: usize = 16;
const SHUFFLED: u8 = 1 << 0;
const PLAIN: u8 = 1 << 1;
const BIT_SHUFFLED: u8 = 1 << 2;
const UNSPLIT: u8 = 1 << 4;
/// The upper three bits of the flags name the codec.
const CODECS: [&str; 8] = ["blosclz", "LZ4", "Snappy", "zlib", "Zstandard", "codec 5", "codec 6", "codec 7"];
const LZ4: u8 = 1;
/// The format versions of Blosc 1; Blosc 2 continues at 3 with a longer header.
const VERSIONS: std::ops::RangeInclusive<u8> = 1..=2;
/// Blocks of larger elements, or with fewer elements than this, are one stream.
const LARGEST_SPLIT_ELEMENT: usize = 16;
const FEWEST_SPLIT_ELEMENTS: usize = 128;

/// Error of a chunk that could not be decoded.
#[derive(Debug, PartialEq)]
pub(crate) enum ChunkError {
    /// Encoded in a way that this decoder leaves out.
    Unsupported(&'static str),
    /// Contradicts itself, or the caller's size.
    Corrupt(&'static str),
}

use ChunkError::{Corrupt, Unsupported};

/// Decodes a chunk that must yield exactly `out.len()` bytes. `scratch` keeps its allocation between calls.
pub(crate) fn decode(chunk: &[u8], out: &mut [u8], scratch: &mut Vec<u8>) -> Result<(), ChunkError> {
    let Some((header, body)) = chunk.split_first_chunk::<HEADER>() else {
        return Err(Corrupt("a Blosc chunk is shorter than its header"));
    };
    let [version, _, flags, element, ..] = *header;
    if !VERSIONS.contains(&version) {
        return Err(Unsupported("this version of the Blosc format"));
    }
    let size_at = |at: usize| read_u32(header, at).unwrap_or(0) as usize;
    let (decoded_size, block_size, encoded_size) = (size_at(4), size_at(8), size_at(12));
    if decoded_size != out.len() {
        return Err(Corrupt("a Blosc chunk has another size than its node"));
    }
    if encoded_size != chunk.len() {
        return Err(Corrupt("a Blosc chunk does not end where it says"));
    }
    if flags & PLAIN != 0 {
        let plain = body.get(..out.len()).ok_or(Corrupt("a plain Blosc chunk is too short"))?;
        out.copy_from_slice(plain);
        return Ok(());
    }
    let codec = flags >> 5;
    if codec != LZ4 {
        return Err(Unsupported(CODECS[usize::from(codec)]));
    }
    if flags & BIT_SHUFFLED != 0 {
        return Err(Unsupported("Blosc with bit shuffling"));
    }
    let element = usize::from(element);
    if element == 0 || block_size == 0 {
        return Err(Corrupt("a Blosc chunk of empty elements or blocks"));
    }

    let splits_full_blocks = flags & UNSPLIT == 0
        && element <= LARGEST_SPLIT_ELEMENT
        && block_size / element >= FEWEST_SPLIT_ELEMENTS;
    for (number, block) in out.chunks_mut(block_size).enumerate() {
        let start = read_u32(body, 4 * number).ok_or(Corrupt("a Blosc chunk ends among its offsets"))?;
        let encoded = chunk.get(start as usize..).ok_or(Corrupt("a Blosc block lies outside its chunk"))?;
        let streams = if splits_full_blocks && block.len() == block_size { element } else { 1 };
        if flags & SHUFFLED != 0 && element > 1 {
            scratch.clear();
            scratch.resize(block.len(), 0);
            decode_block(encoded, streams, scratch)?;
            unshuffle(scratch, element, block);
        } else {
            decode_block(encoded, streams, block)?;
        }
    }
    Ok(())
}

/// Decodes the streams of one block, which fill `out` in equal parts.
fn decode_block(mut encoded: &[u8], streams: usize, out: &mut [u8]) -> Result<(), ChunkError> {
    if !out.len().is_multiple_of(streams) {
        return Err(Corrupt("a Blosc block does not hold whole elements"));
    }
    for part in out.chunks_mut(out.len() / streams) {
        let length = read_u32(encoded, 0).ok_or(Corrupt("a Blosc stream lies outside its chunk"))? as usize;
        let stream = encoded
            .get(4..)
            .and_then(|rest| rest.get(..length))
            .ok_or(Corrupt("a Blosc stream is too short"))?;
        // Streams that would not shrink are stored as they are.
        if stream.len() == part.len() {
            part.copy_from_slice(stream);
        } else if lz4_flex::block::decompress_into(stream, part).ok() != Some(part.len()) {
            return Err(Corrupt("an LZ4 stream does not decode to its size"));
        }
        encoded = &encoded[4 + length..];
    }
    Ok(())
}

/// Gathers the bytes of each element, which shuffling has spread over as many runs as an element has bytes.
///
/// Bytes beyond the last whole element were left in place.
fn unshuffle(shuffled: &[u8], element: usize, out: &mut [u8]) {
    let count = shuffled.len() / element;
    for (n, bytes) in out.chunks_exact_mut(element).enumerate() {
        for (byte, run) in bytes.iter_mut().zip(shuffled.chunks_exact(count)) {
            *byte = run[n];
        }
    }
    let whole = count * element;
    out[whole..].copy_from_slice(&shuffled[whole..]);
}

fn read_u32(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*four))
}

#[cfg(test)]
mod tests {
    use super::{ChunkError, decode};

    /// A chunk of one or more blocks from ready-made streams.
    fn chunk(flags: u8, element: u8, decoded: usize, block: usize, blocks: &[Vec<&[u8]>]) -> Vec<u8> {
        let word = |n: usize| u32::try_from(n).expect("small").to_le_bytes();
        let mut offsets = Vec::new();
        let mut body = Vec::new();
        for streams in blocks {
            offsets.extend(word(16 + 4 * blocks.len() + body.len()));
            for stream in streams {
                body.extend(word(stream.len()));
                body.extend(*stream);
            }
        }
        let size = 16 + offsets.len() + body.len();
        let mut chunk = vec![2, 1, flags, element];
        chunk.extend([word(decoded), word(block), word(size)].concat());
        chunk.extend(offsets);
        chunk.extend(body);
        chunk
    }

    fn decoded(chunk: &[u8], size: usize) -> Result<Vec<u8>, ChunkError> {
        let mut out = vec![0; size];
        decode(chunk, &mut out, &mut Vec::new()).map(|()| out)
    }

    #[test]
    fn shuffled_streams_are_joined_and_unshuffled() {
        // 150 elements of two bytes in blocks of 128: the full block is split into two streams, the rest is one.
        let values: Vec<u8> = (0..150_u8).flat_map(|n| [n, 200]).collect();
        let low: Vec<u8> = (0..128).collect();
        let high = lz4_flex::block::compress(&[200; 128]);
        let rest: Vec<u8> = (128..150).chain([200; 22]).collect();
        let rest = lz4_flex::block::compress(&rest);
        let chunk = chunk(1 | 1 << 5, 2, 300, 256, &[vec![&low, &high], vec![&rest]]);
        assert_eq!(decoded(&chunk, 300), Ok(values));
    }

    #[test]
    fn odd_bytes_at_the_end_stay_in_place() {
        let chunk = chunk(1 | 1 << 4 | 1 << 5, 2, 5, 5, &[vec![&[1, 3, 2, 4, 9]]]);
        assert_eq!(decoded(&chunk, 5), Ok(vec![1, 2, 3, 4, 9]));
    }

    #[test]
    fn elements_larger_than_their_block_are_left_alone() {
        let chunk = chunk(1 | 1 << 5, 200, 5, 5, &[vec![&[1, 3, 2, 4, 9]]]);
        assert_eq!(decoded(&chunk, 5), Ok(vec![1, 3, 2, 4, 9]));
    }

    #[test]
    fn plain_chunks_are_copied() {
        let mut chunk = chunk(2, 4, 3, 3, &[]);
        chunk.extend([7, 8, 9]);
        chunk[12] = 19;
        assert_eq!(decoded(&chunk, 3), Ok(vec![7, 8, 9]));
    }

    #[test]
    fn other_codecs_are_named() {
        assert_eq!(decoded(&chunk(4 << 5, 4, 4, 4, &[]), 4), Err(ChunkError::Unsupported("Zstandard")));
        assert_eq!(decoded(&chunk(0, 4, 4, 4, &[]), 4), Err(ChunkError::Unsupported("blosclz")));
    }

    #[test]
    fn contradictions_are_refused() {
        let good = chunk(1 << 5, 1, 4, 4, &[vec![&[1, 2, 3, 4]]]);
        assert_eq!(decoded(&good, 4), Ok(vec![1, 2, 3, 4]));
        assert!(decoded(&good, 5).is_err(), "another size than asked for");
        assert!(decoded(&good[..good.len() - 1], 4).is_err(), "cut off");
        for byte in [3, 8, 16, 19, 20, 23] {
            let mut bad = good.clone();
            bad[byte] = if byte == 3 || byte == 8 { 0 } else { 0xff };
            assert!(matches!(decoded(&bad, 4), Err(ChunkError::Corrupt(_))), "byte {byte}");
        }
    }
}
