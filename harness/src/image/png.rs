//! Tone-mapped PNG: sRGB of min(1, max(0, exposure · radiance)), eight bits. How it was mapped stands in the file.

use super::Image;

/// The exposure at which radiance is displayed \[stops\]: 2 to this power is the factor in front of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    stops: f64,
}

impl Exposure {
    /// The whole number of stops that shows the luminance `white` at white or less than one stop below: 0 where there is
    /// no light.
    #[must_use]
    pub fn of_white(white: f64) -> Self {
        let is_light = white > 0.0 && white.is_finite();
        // No negative zero.
        Self::of_stops(if is_light { 0.0 - white.log2().ceil() } else { 0.0 })
    }

    /// An exposure that is given.
    #[must_use]
    pub fn of_stops(stops: f64) -> Self {
        Self { stops }
    }

    /// The stops.
    #[must_use]
    pub fn stops(self) -> f64 {
        self.stops
    }

    fn factor(self) -> f64 {
        self.stops.exp2()
    }
}

impl std::fmt::Display for Exposure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "sRGB of {} times linear radiance, clamped to [0, 1]", self.factor())
    }
}

/// Luminance of linear Rec. 709 primaries.
#[must_use]
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// IEC 61966-2-1, of a number in \[0, 1\].
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

pub(super) fn encode(image: &Image, exposure: Exposure) -> Result<Vec<u8>, String> {
    let factor = exposure.factor();
    let byte = |value: &f32| (255.0 * srgb((factor * f64::from(*value)).clamp(0.0, 1.0))).round() as u8;
    let data: Vec<u8> = image.pixels.as_flattened().iter().map(byte).collect();
    write(image, &data, &exposure.to_string()).map_err(|error| error.to_string())
}

fn write(image: &Image, data: &[u8], comment: &str) -> Result<Vec<u8>, ::png::EncodingError> {
    let side = |length: usize| u32::try_from(length).expect("an image has at most 2^28 pixels");
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, side(image.width), side(image.height));
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_adaptive_filter(::png::AdaptiveFilterType::Adaptive);
    encoder.add_text_chunk("Comment".to_owned(), comment.to_owned())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_says_how_it_was_mapped() {
        let image = Image::new(2, 2, vec![[0.0; 3], [4.0, 2.0, -1.0], [4.0; 3], [4.0; 3]]);
        let exposure = Exposure::of_white(4.0);
        assert_eq!(exposure, Exposure::of_stops(-2.0));
        let bytes = encode(&image, exposure).unwrap();
        let mut reader = ::png::Decoder::new(bytes.as_slice()).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut data).unwrap();
        // 0.5 in sRGB is 187.5 of 255 and a little.
        assert_eq!(data, [0, 0, 0, 255, 188, 0, 255, 255, 255, 255, 255, 255]);
        let text = &reader.info().uncompressed_latin1_text[0];
        assert_eq!(text.keyword, "Comment");
        assert_eq!(text.text, "sRGB of 0.25 times linear radiance, clamped to [0, 1]");
    }

    #[test]
    fn exposure_is_a_power_of_two_and_total() {
        let of = |white: f64| Exposure::of_white(white).factor();
        assert_eq!([0.0, -3.0, f64::NAN, f64::INFINITY].map(of), [1.0; 4]);
        assert_eq!([0.3, 0.6, 2.1, f64::from(f32::MIN_POSITIVE)].map(of), [2.0, 1.0, 0.25, 2_f64.powi(126)]);
        let grey = luminance([0.7; 3]);
        assert!((grey - 0.7).abs() < 1e-15, "{grey}");
    }
}
