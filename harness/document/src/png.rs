//! PNG files with eight bits a channel.

use ::png::{AdaptiveFilterType, BitDepth, ColorType, Compression, Encoder};

/// Encodes grey levels, row 0 on top.
pub(crate) fn grey(pixels: &[u8], size: [usize; 2]) -> Result<Vec<u8>, String> {
    encode(pixels, size, ColorType::Grayscale)
}

/// Encodes RGB triples, row 0 on top.
pub(crate) fn colour(rgb: &[u8], size: [usize; 2]) -> Result<Vec<u8>, String> {
    encode(rgb, size, ColorType::Rgb)
}

fn encode(pixels: &[u8], [width, height]: [usize; 2], colour: ColorType) -> Result<Vec<u8>, String> {
    let side = |length: usize| u32::try_from(length).map_err(|error| error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side(width)?, side(height)?);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_color(colour);
    encoder.set_compression(Compression::Default);
    encoder.set_adaptive_filter(AdaptiveFilterType::Adaptive);
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer.write_image_data(pixels).map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())?;
    Ok(bytes)
}
