//! A rectangle of pixels: one worker's piece of work, with one integrator.

use super::pixel::Pixel;
use crate::Failure;
use crate::plan::{IntegratorJob, TileIntegrator};
use fairflight_scene::{Camera, Spectrum};
use fairflight_sources::{Seeded, UniformSource};

/// Columns and rows of a tile.
const SIDE: u32 = 16;

/// Columns and rows of pixels: from, to (not included).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub columns: [u32; 2],
    pub rows: [u32; 2],
}

impl Area {
    fn width(self) -> usize {
        (self.columns[1] - self.columns[0]) as usize
    }

    pub(super) fn pixels(self) -> u64 {
        u64::from(self.columns[1] - self.columns[0]) * u64::from(self.rows[1] - self.rows[0])
    }

    pub(super) fn name(self) -> String {
        let Self { columns, rows } = self;
        format!("columns {} to {}, rows {} to {}", columns[0], columns[1] - 1, rows[0], rows[1] - 1)
    }

    /// Column and row of each pixel, row by row.
    fn positions(self) -> impl Iterator<Item = [u32; 2]> {
        let Self { columns, rows } = self;
        (rows[0]..rows[1]).flat_map(move |row| (columns[0]..columns[1]).map(move |column| [column, row]))
    }
}

/// The areas of an image, each pixel in one of them.
fn areas([columns, rows]: [u32; 2]) -> Vec<Area> {
    let cut = |start: u32, end: u32| [start, end.min(start + SIDE)];
    let steps = |end: u32| (0..end).step_by(SIDE as usize);
    let row =
        |top: u32| steps(columns).map(move |left| Area { columns: cut(left, columns), rows: cut(top, rows) });
    steps(rows).flat_map(row).collect()
}

/// The pixels of an area, and where their streams of variates stand: a later pass goes on there.
#[derive(Clone, Debug)]
pub(super) struct Tile<C> {
    pub area: Area,
    /// Row by row.
    pixels: Vec<Pixel<C>>,
    sources: Vec<Seeded>,
}

impl<C: Spectrum> Tile<C> {
    /// Memory that a pixel takes until it is written: its moments here and in the finished image, its stream,
    /// its mean \[bytes\].
    pub(super) const BYTES_PER_PIXEL: usize =
        2 * size_of::<Pixel<C>>() + size_of::<Seeded>() + size_of::<[f64; 3]>() + size_of::<[f32; 3]>();

    /// The tiles of an image without samples: a stream of its own for each pixel, whatever the tiles.
    pub(super) fn all(resolution: [u32; 2], seed: u64) -> Vec<Self> {
        let source = |[column, row]: [u32; 2]| {
            let index = u64::from(row) * u64::from(resolution[0]) + u64::from(column);
            Seeded::for_batch(seed, index)
        };
        let tile = |area: Area| {
            let sources: Vec<Seeded> = area.positions().map(source).collect();
            Self { area, pixels: vec![Pixel::new(); sources.len()], sources }
        };
        areas(resolution).into_iter().map(tile).collect()
    }

    /// Copies the pixels to where they are in an image of so many columns.
    pub(super) fn copy_to(&self, image: &mut [Pixel<C>], columns: u32) {
        let Area { columns: [left, _], rows: [top, _] } = self.area;
        for (row, line) in (top..).zip(self.pixels.chunks_exact(self.area.width())) {
            let start = row as usize * columns as usize + left as usize;
            image[start..start + line.len()].copy_from_slice(line);
        }
    }
}

/// Adds samples to the pixels of a tile.
pub(super) struct AddSamples<'a, C> {
    pub camera: &'a Camera,
    pub tile: &'a mut Tile<C>,
    /// The number of samples that each pixel has, and how many are added.
    pub drawn: u32,
    pub samples: u32,
    pub seed: u64,
}

/// What was added to a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Added {
    /// The sum of all samples, in the mean of their channels.
    pub sum: f64,
    /// Walks that were cut.
    pub truncated: u64,
    /// Compensation vertices that were tried, and those that counted.
    pub compensation: (u64, u64),
}

impl<C: Spectrum> IntegratorJob<C> for AddSamples<'_, C> {
    type Output = Result<Added, Failure>;

    fn run<I: TileIntegrator<C>>(self, mut integrator: I) -> Self::Output {
        let Self { camera, tile: Tile { area, pixels, sources }, drawn, samples, seed } = self;
        let mut sum = 0.0;
        for (position, (kept, stream)) in area.positions().zip(pixels.iter_mut().zip(sources)) {
            // In registers while they change.
            let (mut pixel, mut source) = (*kept, stream.clone());
            for i in 0..samples {
                let within = [source.next_uniform(), source.next_uniform()];
                let line = camera.ray(position, within);
                let radiance = integrator.radiance(&line, &mut source);
                if !radiance.is_finite() {
                    let [column, row] = position;
                    return Err(Failure::refused(format!(
                        "the radiance of pixel (column {column}, row {row}), sample {}, seed {seed} is {:?}",
                        drawn + i,
                        radiance.rgb()
                    )));
                }
                sum += radiance.mean();
                pixel.push(radiance);
            }
            (*kept, *stream) = (pixel, source);
        }
        let (truncated, compensation) = (integrator.truncated(), integrator.compensation_vertices());
        Ok(Added { sum, truncated, compensation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_cover_each_pixel_once() {
        for (columns, rows) in [(1, 1), (16, 16), (17, 33), (40, 5)] {
            let mut seen = vec![0; columns as usize * rows as usize];
            for [column, row] in areas([columns, rows]).into_iter().flat_map(Area::positions) {
                seen[(row * columns + column) as usize] += 1;
            }
            assert!(seen.iter().all(|&times| times == 1), "{columns} x {rows}");
        }
    }

    #[test]
    fn pixels_are_copied_to_their_places() {
        let mut tiles = Tile::<f64>::all([20, 18], 1);
        for tile in &mut tiles {
            for (pixel, [column, row]) in tile.pixels.iter_mut().zip(tile.area.positions()) {
                pixel.push(f64::from(row * 20 + column));
            }
        }
        let mut image = vec![Pixel::new(); 360];
        tiles.iter().for_each(|tile| tile.copy_to(&mut image, 20));
        assert!(image.iter().enumerate().all(|(i, pixel)| pixel.mean() == i as f64));
    }
}
