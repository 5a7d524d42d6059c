//! OpenEXR through the crate of that name.

use super::{Image, ImageError, checked_area};
use ::exr::image::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, SpecificChannels,
};
use ::exr::meta::MetaData;
use ::exr::prelude::{Blocks, Compression, LineOrder, ReadChannels, ReadLayers, WritableImage};
use std::io::Cursor;

/// RGB scan lines of f32, losslessly compressed.
pub(super) fn encode(image: &Image) -> Result<Vec<u8>, String> {
    let width = image.width;
    let channels = SpecificChannels::rgb(|position: ::exr::math::Vec2<usize>| {
        let [r, g, b] = image.pixels[position.y() * width + position.x()];
        (r, g, b)
    });
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new((width, image.height), Default::default(), encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    ExrImage::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Bytes per compressed byte, at most: of the compressions that the reader knows, deflate shrinks the most.
const MOST_EXPANSION: u64 = 1032;

pub(super) fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    check_claims(bytes)?;
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| malformed(error.to_string()))?;
    let found = image.layer_data.iter().find_map(|layer| Some((layer, Radiance::of(&layer.channel_data)?)));
    let Some((layer, radiance)) = found else {
        let names = image.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
        let names: Vec<String> = names.map(|channel| channel.name.to_string()).collect();
        return Err(malformed(format!("it has neither R, G, B nor Y, but {}", names.join(", "))));
    };
    let (width, height) = (layer.size.width(), layer.size.height());
    let pixels = radiance.pixels();
    // Subsampled channels have fewer samples than the layer pixels.
    if pixels.len() != width * height {
        return Err(malformed("its colour channels are subsampled".to_owned()));
    }
    Ok(Image::new(width, height, pixels))
}

fn malformed(reason: String) -> ImageError {
    ImageError::Malformed { format: "OpenEXR", reason }
}

/// The reader asks for the memory of all layers before it decompresses the first: what the headers claim is held
/// against the length of the file.
fn check_claims(bytes: &[u8]) -> Result<(), ImageError> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(|error| malformed(error.to_string()))?;
    let mut claimed = 0_u64;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
        let area = checked_area(width, height)? as u64;
        claimed = claimed.saturating_add(area.saturating_mul(header.channels.bytes_per_pixel as u64));
    }
    let most = MOST_EXPANSION.saturating_mul(bytes.len() as u64);
    if claimed > most {
        return Err(malformed(format!(
            "its header claims {claimed} bytes of pixels, more than a file of {} bytes can hold",
            bytes.len()
        )));
    }
    Ok(())
}

/// The channels of a layer that are radiance.
enum Radiance<'a> {
    Colour([&'a FlatSamples; 3]),
    Gray(&'a FlatSamples),
}

impl<'a> Radiance<'a> {
    fn of(channels: &'a AnyChannels<FlatSamples>) -> Option<Self> {
        // A channel `diffuse.R` is the R of a layer inside the layer.
        let is = |channel: &AnyChannel<FlatSamples>, name: &str| {
            channel.name.to_string().rsplit('.').next() == Some(name)
        };
        let named = |name| channels.list.iter().find(|channel| is(channel, name)).map(|c| &c.sample_data);
        match (named("R"), named("G"), named("B"), named("Y")) {
            (Some(r), Some(g), Some(b), _) => Some(Self::Colour([r, g, b])),
            (_, _, _, Some(y)) => Some(Self::Gray(y)),
            _ => None,
        }
    }

    fn pixels(&self) -> Vec<[f32; 3]> {
        match self {
            Self::Colour([r, g, b]) => {
                let (r, g, b) = (r.values_as_f32(), g.values_as_f32(), b.values_as_f32());
                r.zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect()
            }
            Self::Gray(y) => y.values_as_f32().map(|y| [y; 3]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::{LayerAttributes, f16};

    fn written(names: &[&str], samples: impl Fn(usize) -> FlatSamples) -> Vec<u8> {
        let channels = names.iter().enumerate().map(|(i, &name)| AnyChannel::new(name, samples(i)));
        let channels = AnyChannels::sort(channels.collect());
        let layer = Layer::new((2, 1), LayerAttributes::named("main"), Encoding::FAST_LOSSLESS, channels);
        let mut bytes = Cursor::new(Vec::new());
        ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn what_is_written_is_read() {
        let pixels = (0..35).map(|i| [i as f32, -0.1 * i as f32, 1e30 / (i + 1) as f32]).collect();
        let image = Image::new(7, 5, pixels);
        assert_eq!(decode(&encode(&image).unwrap()).unwrap(), image);
    }

    #[test]
    fn gray_half_and_unusual_channels() {
        let half = |_| FlatSamples::F16(vec![f16::from_f32(0.5), f16::from_f32(-2.0)]);
        assert_eq!(decode(&written(&["Y"], half)).unwrap().pixels(), [[0.5; 3], [-2.0; 3]]);
        let float = |i: usize| FlatSamples::F32(vec![i as f32, 10.0]);
        let nested = decode(&written(&["sky.A", "sky.B", "sky.G", "sky.R"], float)).unwrap();
        assert_eq!(nested.pixels(), [[3.0, 2.0, 1.0], [10.0; 3]]);
        let error = decode(&written(&["A", "Z"], float)).unwrap_err().to_string();
        assert!(error.contains("neither R, G, B nor Y, but A, Z"), "{error}");
    }
}
