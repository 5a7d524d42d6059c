//! Round trips of images.

use fairflight_harness::image::{Format, Image, MOST_PIXELS};

/// An image is refused with a reason, or it has as many pixels as it says, and written and read again the same, bit by bit.
pub(crate) fn round_trip(data: &[u8], format: Format) {
    let image = match Image::decode(data, format) {
        Ok(image) => image,
        Err(error) => return assert!(!error.to_string().trim().is_empty()),
    };
    let area = image.width() * image.height();
    assert!(area == image.pixels().len() && (1..=MOST_PIXELS).contains(&(area as u64)));
    let written = image.encode(format).expect("what was read can be written");
    let again = Image::decode(&written, format).expect("what was written can be read");
    assert_eq!((again.width(), again.height()), (image.width(), image.height()));
    let bits = |image: &Image| image.pixels().iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert!(bits(&again) == bits(&image), "another image came back");
}
