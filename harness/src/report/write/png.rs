//! Small PNG files: indexed colours for line art and error maps, eight-bit grey or RGB for pictures.

use super::median_cut;
use std::collections::HashMap;

/// Colours of a drawing: series, inks, and the blends on the edges of lines.
pub(crate) const DRAWING: usize = 32;
/// Colours of an image: one byte per pixel indexes no more.
pub(crate) const IMAGE: usize = 256;

/// Encodes grey levels, row 0 on top.
pub(crate) fn grey(pixels: &[u8], [width, height]: [usize; 2]) -> Result<Vec<u8>, String> {
    encode(pixels, [width, height], &Kind::Grey)
}

/// Encodes RGB triples, row 0 on top. The most frequent colours are kept exactly; a rarer one becomes the nearest of them.
pub(crate) fn indexed(rgb: &[u8], [width, height]: [usize; 2], colours: usize) -> Result<Vec<u8>, String> {
    let (triples, _) = rgb.as_chunks::<3>();
    let mut counts: HashMap<[u8; 3], u64> = HashMap::new();
    for &colour in triples {
        *counts.entry(colour).or_default() += 1;
    }
    let mut frequent: Vec<([u8; 3], u64)> = counts.into_iter().collect();
    // Ties are broken by colour: the file must not depend on the order of a hash map.
    frequent.sort_unstable_by_key(|&(colour, count)| (std::cmp::Reverse(count), colour));
    let palette: Vec<[u8; 3]> = frequent.iter().take(colours.min(IMAGE)).map(|&(colour, _)| colour).collect();
    with_palette(triples, &palette, [width, height])
}

/// Encodes RGB triples of a picture, row 0 on top, exactly.
pub(crate) fn colour(rgb: &[u8], size: [usize; 2]) -> Result<Vec<u8>, String> {
    encode(rgb, size, &Kind::Colour)
}

/// Encodes RGB triples of a picture, row 0 on top, with the nearest colours of a palette that is made for them.
pub(crate) fn few_colours(rgb: &[u8], size: [usize; 2], colours: usize) -> Result<Vec<u8>, String> {
    let (triples, _) = rgb.as_chunks::<3>();
    with_palette(triples, &median_cut::palette(triples, colours.min(IMAGE)), size)
}

fn with_palette(triples: &[[u8; 3]], palette: &[[u8; 3]], size: [usize; 2]) -> Result<Vec<u8>, String> {
    let mut index: HashMap<[u8; 3], u8> = HashMap::new();
    let indices: Vec<u8> = triples
        .iter()
        .map(|&colour| *index.entry(colour).or_insert_with(|| nearest(palette, colour)))
        .collect();
    encode(&indices, size, &Kind::Indexed(palette.as_flattened()))
}

fn nearest(palette: &[[u8; 3]], colour: [u8; 3]) -> u8 {
    let distance =
        |other: [u8; 3]| -> u32 { (0..3).map(|k| u32::from(colour[k].abs_diff(other[k])).pow(2)).sum() };
    (0..=u8::MAX).zip(palette).min_by_key(|&(_, &known)| distance(known)).map_or(0, |(i, _)| i)
}

/// What the bytes of an image are.
enum Kind<'a> {
    Grey,
    Colour,
    Indexed(&'a [u8]),
}

fn encode(pixels: &[u8], [width, height]: [usize; 2], kind: &Kind<'_>) -> Result<Vec<u8>, String> {
    let side = |length: usize| u32::try_from(length).map_err(|error| error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side(width)?, side(height)?);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Best);
    match kind {
        Kind::Indexed(palette) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(*palette);
            // Neighbouring indices are unrelated numbers: prediction only hurts.
            encoder.set_filter(png::FilterType::NoFilter);
        }
        Kind::Grey | Kind::Colour => {
            let grey = matches!(kind, Kind::Grey);
            encoder.set_color(if grey { png::ColorType::Grayscale } else { png::ColorType::Rgb });
            encoder.set_adaptive_filter(png::AdaptiveFilterType::Adaptive);
        }
    }
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer.write_image_data(pixels).map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// Base64 (RFC 4648, padded), for images that live inside the page.
pub(crate) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |k: usize| u32::from(chunk.get(k).copied().unwrap_or(0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standard_s_vectors() {
        let vectors = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (bytes, text) in vectors {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn few_colours_come_back_exactly() {
        let rgb: Vec<u8> = (0..64).flat_map(|i| [i, 255 - i, 7]).collect();
        let bytes = indexed(&rgb, [8, 8], IMAGE).unwrap();
        let mut decoder = png::Decoder::new(bytes.as_slice());
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut decoded = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut decoded).unwrap();
        assert_eq!(decoded, rgb);
    }

    #[test]
    fn many_colours_still_make_a_palette() {
        let rgb: Vec<u8> = (0..32_u8).flat_map(|r| (0..32_u8).flat_map(move |g| [r * 8, g * 8, 0])).collect();
        assert!(indexed(&rgb, [32, 32], DRAWING).is_ok());
    }
}
