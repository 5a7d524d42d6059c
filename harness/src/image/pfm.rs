//! Portable float map: three lines of text, then f32 numbers from the bottom row up.
//!
//! `PF` has three numbers per pixel, `Pf` one. The third line is a factor of no agreed meaning; its sign is the byte
//! order, negative for little-endian.

use super::{Image, ImageError, checked_area};

/// Little-endian RGB.
pub(super) fn encode(image: &Image) -> Vec<u8> {
    let mut bytes = format!("PF\n{} {}\n-1.0\n", image.width, image.height).into_bytes();
    bytes.reserve_exact(image.pixels.len() * 12);
    for row in image.pixels.chunks_exact(image.width).rev() {
        bytes.extend(row.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes
}

pub(super) fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let (header, data) = Header::parse(bytes)?;
    let (width, height) = (header.width, header.height);
    let area = checked_area(width, height)?;
    let per_pixel = if header.colour { 12 } else { 4 };
    let needed = area as u64 * per_pixel;
    // The length is compared before memory is asked for: a header may claim anything.
    if data.len() as u64 != needed {
        return Err(ImageError::WrongLength { width, height, needed, found: data.len() as u64 });
    }
    let number = |bytes: &[u8; 4]| {
        if header.little_endian { f32::from_le_bytes(*bytes) } else { f32::from_be_bytes(*bytes) }
    };
    let (numbers, _) = data.as_chunks::<4>();
    let width = width as usize;
    let mut pixels = Vec::with_capacity(area);
    if header.colour {
        for row in numbers.chunks_exact(3 * width).rev() {
            let (triples, _) = row.as_chunks::<3>();
            pixels.extend(triples.iter().map(|triple| triple.each_ref().map(number)));
        }
    } else {
        for row in numbers.chunks_exact(width).rev() {
            pixels.extend(row.iter().map(|value| [number(value); 3]));
        }
    }
    Ok(Image::new(width, header.height as usize, pixels))
}

struct Header {
    colour: bool,
    width: u64,
    height: u64,
    little_endian: bool,
}

impl Header {
    /// The header, and the bytes after the one white space that ends it.
    fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), ImageError> {
        let malformed = |reason: String| ImageError::Malformed { format: "PFM", reason };
        let mut rest = bytes;
        let mut word = || next_word(&mut rest);
        let colour = match word() {
            Some("PF") => true,
            Some("Pf") => false,
            _ => return Err(malformed("it starts with neither PF nor Pf".to_owned())),
        };
        let mut side = |what: &str| match word() {
            Some(text) => text
                .parse::<u64>()
                .map_err(|_| malformed(format!("its {what} is {text:?}, not a whole number"))),
            None => Err(malformed(format!("it ends before its {what}"))),
        };
        let (width, height) = (side("width")?, side("height")?);
        let scale = word().unwrap_or_default();
        let little_endian = match scale.parse::<f64>() {
            Ok(scale) if scale.is_finite() && scale != 0.0 => scale < 0.0,
            _ => return Err(malformed(format!("its scale is {scale:?}, not a number other than 0"))),
        };
        Ok((Self { colour, width, height, little_endian }, rest))
    }
}

/// The next word, with one white space after it taken as well.
fn next_word<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    /// No word of a header is longer: the search does not run through the pixels.
    const LONGEST: usize = 64;
    let start = rest.iter().take(LONGEST).position(|byte| !byte.is_ascii_whitespace())?;
    let length = rest[start..].iter().take(LONGEST).position(u8::is_ascii_whitespace)?;
    let word = std::str::from_utf8(&rest[start..start + length]).ok()?;
    *rest = &rest[start + length + 1..];
    Some(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_row_comes_first() {
        let image = Image::new(2, 2, vec![[1.0; 3], [2.0; 3], [3.0; 3], [4.0, 5.0, -6.0]]);
        let bytes = encode(&image);
        let header = b"PF\n2 2\n-1.0\n";
        assert!(bytes.starts_with(header));
        assert_eq!(bytes[header.len()..header.len() + 4], 3.0_f32.to_le_bytes());
        assert_eq!(decode(&bytes).unwrap(), image);
    }

    #[test]
    fn gray_and_big_endian() {
        let mut bytes = b"Pf\n1 2 2.5\n".to_vec();
        bytes.extend(7.0_f32.to_be_bytes());
        bytes.extend(8.0_f32.to_be_bytes());
        assert_eq!(decode(&bytes).unwrap(), Image::new(1, 2, vec![[8.0; 3], [7.0; 3]]));
    }

    #[test]
    fn what_is_wrong_is_told() {
        let files: [(&[u8], &str); 12] = [
            (b"", "neither PF nor Pf"),
            (b"P6\n1 1\n255\n", "neither PF nor Pf"),
            (b"PF\n1\n", "ends before its height"),
            (b"PF\n-1 1\n-1\n", "width is \"-1\""),
            (b"PF\n0 1\n-1\n", "0 x 1 pixels"),
            (b"PF\n1 1\n0\n", "scale is \"0\""),
            (b"PF\n1 1\nnan\n", "scale is \"nan\""),
            (b"PF\n1 1\n-1\nabc", "take 12 bytes after it, but 3 are there"),
            (b"PF\n1 1\n-1\n0123456789abcdef", "12 bytes after it, but 16"),
            (b"PF\n16384 16384\n-1\n", "3221225472 bytes after it, but 0"),
            (b"PF\n4294967296 4294967296\n-1\n", "allowed are 1 to"),
            (b"PF\n1000000 1000000\n-1\n", "allowed are 1 to"),
        ];
        for (bytes, words) in files {
            let error = decode(bytes).unwrap_err().to_string();
            assert!(error.contains(words), "no {words:?} in: {error}");
        }
    }
}
