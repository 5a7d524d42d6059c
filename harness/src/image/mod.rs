//! Images: linear radiance in memory, and one file per format.
//!
//! | format | written | read |
//! |---|---|---|
//! | `.pfm` | f32 RGB, little-endian | RGB and gray, both byte orders |
//! | `.exr` | f32 RGB, scan lines | RGB and gray of the first layer that has either, f16, f32 and u32 |
//! | `.png` | eight-bit sRGB, tone-mapped | no |

mod exr;
#[cfg(test)]
mod hostile;
mod pfm;
mod png;

pub use self::png::{Exposure, luminance};

use crate::Failure;
use std::path::Path;

/// Linear radiance per pixel: row 0 on top, column 0 on the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

/// An image that claims more pixels than this is refused before memory is asked for: 3 GiB of f32 RGB.
pub const MOST_PIXELS: u64 = 1 << 28;

/// Error of bytes that are no image.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImageError {
    /// The header, or what the format's reader says.
    #[error("not a readable {format} file: {reason}")]
    Malformed {
        /// The format.
        format: &'static str,
        /// The reason, in words.
        reason: String,
    },
    /// Fewer or more bytes than the header promises.
    #[error(
        "its header says {width} x {height} pixels, which take {needed} bytes after it, but {found} are there"
    )]
    WrongLength {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
        /// Bytes that should follow.
        needed: u64,
        /// Bytes that do.
        found: u64,
    },
    /// No pixels, or too many.
    #[error("its header says {width} x {height} pixels, allowed are 1 to {MOST_PIXELS}")]
    Size {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// Radiance is a finite number.
    #[error("pixel (column {column}, row {row}) holds {value}, which is no radiance")]
    NotFinite {
        /// Column from the left.
        column: usize,
        /// Row from the top.
        row: usize,
        /// The value that was found.
        value: f32,
    },
}

impl Image {
    /// An image of these pixels, row by row from the top.
    ///
    /// # Panics
    /// If their number is not `width` times `height`.
    #[must_use]
    pub fn new(width: usize, height: usize, pixels: Vec<[f32; 3]>) -> Self {
        assert_eq!(pixels.len(), width * height, "an image of {width} x {height}");
        Self { width, height, pixels }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Red, green and blue, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// Reads an image file whose pixels are all finite; its extension says the format.
    ///
    /// # Errors
    /// If the extension is none of those that can be read, the file cannot be read, is no such image, or holds a
    /// number that is not finite. The file is named.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let named = |error: &dyn std::fmt::Display| Failure::refused(format!("{}: {error}", path.display()));
        let Some(format @ (Format::Pfm | Format::Exr)) = Format::of(path) else {
            return Err(named(&"an image is read from a file that ends in .pfm or .exr"));
        };
        let bytes = std::fs::read(path).map_err(|error| named(&error))?;
        Self::decode(&bytes, format).and_then(Self::finite).map_err(|error| named(&error))
    }

    /// The image in the bytes of a file of `format`, with whatever numbers it holds.
    ///
    /// # Errors
    /// If they are no such file, or the format is only written.
    pub fn decode(bytes: &[u8], format: Format) -> Result<Self, ImageError> {
        match format {
            Format::Pfm => pfm::decode(bytes),
            Format::Exr => exr::decode(bytes),
            Format::Png => {
                Err(ImageError::Malformed { format: "PNG", reason: "it is written only".to_owned() })
            }
        }
    }

    fn finite(self) -> Result<Self, ImageError> {
        let bad = |pixel: &[f32; 3]| pixel.iter().copied().find(|value| !value.is_finite());
        match self.pixels.iter().enumerate().find_map(|(i, pixel)| bad(pixel).map(|value| (i, value))) {
            None => Ok(self),
            Some((i, value)) => {
                Err(ImageError::NotFinite { column: i % self.width, row: i / self.width, value })
            }
        }
    }

    /// The bytes of this image as a file of `format`; what is tone-mapped is shown as it is, at an exposure of 1.
    ///
    /// # Errors
    /// If the format's writer fails.
    pub fn encode(&self, format: Format) -> Result<Vec<u8>, String> {
        match format {
            Format::Pfm => Ok(pfm::encode(self)),
            Format::Exr => exr::encode(self),
            Format::Png => self.tone_mapped(Exposure::default()),
        }
    }

    /// The bytes of this image as a `.png` file, shown at this exposure.
    ///
    /// # Errors
    /// If the format's writer fails.
    pub fn tone_mapped(&self, exposure: Exposure) -> Result<Vec<u8>, String> {
        png::encode(self, exposure)
    }
}

/// A file format of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable float map.
    Pfm,
    /// OpenEXR.
    Exr,
    /// Portable network graphics.
    Png,
}

impl Format {
    /// The format that an extension says, in upper or lower case.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "pfm" => Some(Self::Pfm),
            "exr" => Some(Self::Exr),
            "png" => Some(Self::Png),
            _ => None,
        }
    }
}

/// The number of pixels of a header, if it is one that memory may be asked for.
fn checked_area(width: u64, height: u64) -> Result<usize, ImageError> {
    match width.checked_mul(height) {
        Some(area @ 1..=MOST_PIXELS) => Ok(area as usize),
        _ => Err(ImageError::Size { width, height }),
    }
}
