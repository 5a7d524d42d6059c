//! PNG images, which are written and never read.

use fairflight_harness::image::{Format, Image};

/// Any numbers at all, NaN and infinities among them, become a file that a PNG reader takes: of the same size, black where radiance is
/// not positive, and nowhere darker where a channel is brighter.
pub fn check(data: &[u8]) {
    let Some((&[across, _], rest)) = data.split_first_chunk::<2>() else { return };
    let (numbers, _) = rest.as_chunks::<4>();
    let (pixels, _) = numbers.as_chunks::<3>();
    let width = usize::from(across).max(1).min(pixels.len());
    if width == 0 {
        return;
    }
    let height = pixels.len() / width;
    let pixels = pixels[..width * height].iter().map(|pixel| pixel.map(f32::from_le_bytes)).collect();
    let image = Image::new(width, height, pixels);

    let bytes = image.encode(Format::Png).expect("any image can be written");
    let mut reader = ::png::Decoder::new(bytes.as_slice()).read_info().expect("a PNG file");
    let mut found = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut found).expect("a whole PNG file");
    assert_eq!((info.width as usize, info.height as usize), (width, height));
    assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));

    let mut channels: Vec<(f32, u8)> = image.pixels().as_flattened().iter().copied().zip(found).collect();
    assert!(
        channels.iter().all(|&(radiance, byte)| radiance > 0.0 || byte == 0),
        "light where there is none"
    );
    channels.retain(|(radiance, _)| !radiance.is_nan());
    channels.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(channels.windows(2).all(|pair| pair[0].1 <= pair[1].1), "darker where brighter");
}
