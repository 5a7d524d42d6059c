//! Portable float map images.

use fairflight_harness::image::Format;

/// An image is refused with a reason, or written and read again as itself, bit by bit.
pub fn check(data: &[u8]) {
    crate::images::round_trip(data, Format::Pfm);
}
