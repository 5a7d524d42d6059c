//! Groups of pixels that use each other's paths.

/// A partition of an image into groups of `tile` × `tile` pixels, `spacing` apart along rows and columns, less where the image ends.
///
/// Neighbours are in different groups for a spacing above 1, so that noise that a group shares does not show as a patch (antwerpen-2011
/// section 4.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelGroups {
    resolution: [u32; 2],
    tile: u32,
    spacing: u32,
}

impl PixelGroups {
    /// The groups of an image of so many columns and rows; a tile and a spacing of 0 are taken for 1.
    #[must_use]
    pub fn new(resolution: [u32; 2], tile: u32, spacing: u32) -> Self {
        Self { resolution, tile: tile.max(1), spacing: spacing.max(1) }
    }

    /// The number of groups; some of those at the end of the image may be empty.
    #[must_use]
    pub fn count(&self) -> usize {
        let [columns, rows] = self.blocks();
        (columns * rows * self.spacing * self.spacing) as usize
    }

    /// Blocks of pixels that groups of one place fill, along rows and columns.
    fn blocks(&self) -> [u32; 2] {
        self.resolution.map(|pixels| pixels.div_ceil(self.tile * self.spacing))
    }

    /// The pixels (column, row) of a group.
    pub fn pixels(&self, group: usize) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Self { resolution, tile, spacing } = *self;
        let [columns, _] = self.blocks();
        let (block, within) = (group as u32 / (spacing * spacing), group as u32 % (spacing * spacing));
        let first = [
            block % columns * tile * spacing + within % spacing,
            block / columns * tile * spacing + within / spacing,
        ];
        (0..tile * tile)
            .map(move |k| [first[0] + spacing * (k % tile), first[1] + spacing * (k / tile)])
            .filter(move |pixel| pixel[0] < resolution[0] && pixel[1] < resolution[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn each_pixel_is_in_one_group() {
        for (resolution, tile, spacing) in [([16, 16], 2, 4), ([7, 5], 3, 2), ([1, 9], 8, 4), ([6, 6], 2, 1)]
        {
            let groups = PixelGroups::new(resolution, tile, spacing);
            let mut seen = BTreeSet::new();
            let mut count = 0;
            for group in 0..groups.count() {
                let pixels: Vec<[u32; 2]> = groups.pixels(group).collect();
                assert!(pixels.len() <= (tile * tile) as usize);
                let is_apart = |pair: &[[u32; 2]]| {
                    pair[1] == [pair[0][0] + spacing, pair[0][1]] || pair[1][1] > pair[0][1]
                };
                assert!(pixels.windows(2).all(is_apart));
                count += pixels.len();
                seen.extend(pixels);
            }
            assert_eq!((seen.len(), count), ((resolution[0] * resolution[1]) as usize, seen.len()));
            assert!(seen.iter().all(|&[column, row]| column < resolution[0] && row < resolution[1]));
        }
        let first: Vec<[u32; 2]> = PixelGroups::new([16, 16], 2, 4).pixels(5).collect();
        assert_eq!(first, [[1, 1], [5, 1], [1, 5], [5, 5]]);
    }
}
