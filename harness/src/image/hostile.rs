//! Files that are cut off, bent, or claim what they do not have: an error, never a panic, never the memory they claim.

use super::{Format, Image, exr, pfm};
use proptest::prelude::*;

fn image() -> Image {
    Image::new(9, 21, (0..189).map(|i| [i as f32, 0.5, -1.0 / (1 + i) as f32]).collect())
}

#[test]
fn every_truncation_is_refused() {
    let bytes = image().encode(Format::Pfm).unwrap();
    for length in 0..bytes.len() {
        assert!(pfm::decode(&bytes[..length]).is_err(), "{length}");
    }
    let bytes = image().encode(Format::Exr).unwrap();
    for length in 0..bytes.len() {
        assert!(exr::decode(&bytes[..length]).is_err(), "{length}");
    }
}

#[test]
fn an_exr_that_claims_more_than_its_length_can_hold() {
    let mut bytes = image().encode(Format::Exr).unwrap();
    // dataWindow: four integers after the name, the type and the size of the attribute.
    let name = b"dataWindow\0box2i\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len() + 4;
    bytes[at + 8..at + 12].copy_from_slice(&16_383_i32.to_le_bytes());
    bytes[at + 12..at + 16].copy_from_slice(&16_383_i32.to_le_bytes());
    assert!(exr::decode(&bytes).is_err());
    bytes[at + 12..at + 16].copy_from_slice(&i32::MAX.to_le_bytes());
    assert!(exr::decode(&bytes).is_err());
}

#[test]
fn a_number_that_is_none_is_named() {
    let folder = tempfile::tempdir().unwrap();
    for (format, name) in [(Format::Pfm, "image.pfm"), (Format::Exr, "image.EXR")] {
        for value in [f32::NAN, f32::INFINITY] {
            let mut image = image();
            image.pixels[2 * 9 + 4][1] = value;
            let path = folder.path().join(name);
            std::fs::write(&path, image.encode(format).unwrap()).unwrap();
            let failure = Image::read(&path).unwrap_err().to_string();
            for words in [name, "column 4, row 2", &value.to_string()] {
                assert!(failure.contains(words), "no {words:?} in: {failure}");
            }
        }
    }
}

proptest! {
    #[test]
    fn a_bent_file_is_an_image_or_an_error(places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        for format in [Format::Pfm, Format::Exr] {
            let mut bytes = image().encode(format).unwrap();
            for (place, value) in &places {
                let place = place.index(bytes.len());
                bytes[place] = *value;
            }
            // Either is right: what counts is that it returns.
            let _ = if format == Format::Pfm { pfm::decode(&bytes) } else { exr::decode(&bytes) };
        }
    }
}
