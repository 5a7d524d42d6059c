//! Light that paths from the lights bring to whatever pixels see them.

use fairflight_scene::Spectrum;

/// The light image of a pass: a sum for each pixel, to be added to its sample before that enters the moments.
///
/// Tiles hand over what they found in their order, so that sums have the same bits whatever the threads.
#[derive(Clone, Debug)]
pub(super) struct LightImage<C> {
    columns: u32,
    pixels: Vec<C>,
}

impl<C: Spectrum> LightImage<C> {
    /// Number of tiles whose light waits for those before them: of a few megabytes, and enough for many threads.
    pub(super) const TILES: usize = 64;

    /// A dark image.
    pub(super) fn new([columns, rows]: [u32; 2]) -> Self {
        Self { columns, pixels: vec![C::ZERO; columns as usize * rows as usize] }
    }

    /// Adds light to pixels; gives the sum, in the mean of the channels.
    pub(super) fn add(&mut self, splats: &[([u32; 2], C)]) -> f64 {
        for &(position, value) in splats {
            let index = self.index(position);
            self.pixels[index] += value;
        }
        splats.iter().map(|(_, value)| value.mean()).sum()
    }

    /// The light of a pixel.
    pub(super) fn at(&self, position: [u32; 2]) -> C {
        self.pixels[self.index(position)]
    }

    fn index(&self, [column, row]: [u32; 2]) -> usize {
        row as usize * self.columns as usize + column as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_added_where_it_is_seen() {
        let mut image = LightImage::new([3, 2]);
        assert_eq!(image.add(&[([2, 1], 0.5), ([0, 1], 2.0), ([2, 1], 0.25)]), 2.75);
        let pixels = [[0, 0], [2, 0], [0, 1], [2, 1]].map(|position| image.at(position));
        assert_eq!(pixels, [0.0, 0.0, 2.0, 0.75]);
    }
}
