//! A rectangle of pixels: one worker's piece of work, with one integrator.

use super::light_image::LightImage;
use super::pixel::Pixel;
use crate::Failure;
use crate::plan::{Counts, PixelPoints, Splatted, Tally, TileIntegrator};
use crate::spec::ReuseSpec;
use fairflight_paths::extend::PixelGroups;
use fairflight_scene::{Camera, Spectrum};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use std::ops::ControlFlow;

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

/// The areas of an image, of so many columns and rows, each pixel in one of them.
fn areas([columns, rows]: [u32; 2], side: u32) -> Vec<Area> {
    let cut = |start: u32, end: u32| [start, end.min(start + side)];
    let steps = |end: u32| (0..end).step_by(side as usize);
    let row =
        |top: u32| steps(columns).map(move |left| Area { columns: cut(left, columns), rows: cut(top, rows) });
    steps(rows).flat_map(row).collect()
}

/// The pixels of an area, and where their streams of variates stand: a later pass goes on there.
#[derive(Clone, Debug)]
pub(super) struct Tile<C> {
    pub area: Area,
    /// Pixels, row by row.
    pixels: Vec<Pixel<C>>,
    sources: Vec<Seeded>,
    /// Samples of a pass that wait for the light image.
    waiting: Vec<C>,
    /// The sums of each pass by strategy.
    strategies: Vec<Pixel<f64>>,
}

impl<C: Spectrum> Tile<C> {
    /// Memory that a pixel takes until it is written: its moments here and in the finished image, its stream,
    /// its mean \[bytes\].
    pub(super) const BYTES_PER_PIXEL: usize = 2 * (size_of::<Pixel<C>>() + size_of::<C>())
        + size_of::<Seeded>()
        + size_of::<[f64; 3]>()
        + size_of::<[f32; 3]>();

    /// The tiles of an image without samples: a stream of its own for each pixel, whatever the tiles.
    ///
    /// A group of pixels that use each other's paths lies in one tile.
    pub(super) fn all(resolution: [u32; 2], seed: u64, groups: Option<ReuseSpec>) -> Vec<Self> {
        let block = groups.map_or(SIDE, |groups| groups.tile * groups.spacing);
        let source = |[column, row]: [u32; 2]| {
            let index = u64::from(row) * u64::from(resolution[0]) + u64::from(column);
            Seeded::for_batch(seed, index)
        };
        let tile = |area: Area| {
            let sources: Vec<Seeded> = area.positions().map(source).collect();
            let pixels = vec![Pixel::new(); sources.len()];
            Self { area, pixels, sources, waiting: Vec::new(), strategies: Vec::new() }
        };
        areas(resolution, SIDE.next_multiple_of(block)).into_iter().map(tile).collect()
    }

    /// Adds `samples` samples to each pixel, which has `drawn` of them.
    ///
    /// # Errors
    /// If a sample is not finite.
    pub(super) fn add_samples(
        &mut self,
        integrator: &mut dyn TileIntegrator<C>,
        camera: &Camera,
        range: (u32, u32, u64),
    ) -> Result<Added<C>, Failure> {
        self.draw(integrator, camera, range, |pixel, _, radiance| pixel.push(radiance))
    }

    /// Adds a replica to each pixel, which has `drawn` samples: the mean over the points of a set of its own.
    ///
    /// # Errors
    /// If a sample is not finite.
    pub(super) fn add_replica(
        &mut self,
        integrator: &mut dyn TileIntegrator<C>,
        camera: &Camera,
        (drawn, samples, seed): (u32, u32, u64),
        points: &PixelPoints,
    ) -> Result<Added<C>, Failure> {
        let mut sum = 0.0;
        for (position, pixel) in self.area.positions().zip(&mut self.pixels) {
            let index = u64::from(position[1]) * u64::from(camera.resolution()[0]) + u64::from(position[0]);
            let set = derive_seed(derive_seed(seed, index), u64::from(drawn / samples));
            let mean = points.mean(set, |point, source| {
                let within = [source.next_uniform(), source.next_uniform()];
                let radiance = integrator.radiance_by_point(&camera.ray(position, within), source);
                check(radiance, position, (drawn + point, seed), integrator).map(|()| radiance)
            })?;
            sum += mean.mean() * f64::from(samples);
            pixel.push_mean(mean, samples);
        }
        Ok(Added { sum, counts: integrator.counts(), splatted: integrator.splatted() })
    }

    /// Draws one sample of each pixel, which wait for what other pixels' light paths add to them.
    ///
    /// # Errors
    /// If a sample is not finite.
    pub(super) fn hold_samples(
        &mut self,
        integrator: &mut dyn TileIntegrator<C>,
        camera: &Camera,
        range: (u32, u32, u64),
    ) -> Result<Added<C>, Failure> {
        self.draw(integrator, camera, range, |_, waiting, radiance| waiting.push(radiance))
    }

    /// Adds one sample to each pixel, of groups that use each other's paths; behind the camera their variates are those of the first pixel.
    ///
    /// # Errors
    /// If a sample is not finite.
    pub(super) fn share_samples(
        &mut self,
        integrator: &mut dyn TileIntegrator<C>,
        camera: &Camera,
        (drawn, _, seed): (u32, u32, u64),
        groups: &ReuseSpec,
    ) -> Result<Added<C>, Failure> {
        let Area { columns: [left, right], rows: [top, bottom] } = self.area;
        let index = |[column, row]: [u32; 2]| (row * (right - left) + column) as usize;
        let groups = PixelGroups::new([right - left, bottom - top], groups.tile, groups.spacing);
        let (mut sum, mut lines, mut radiances) = (0.0, Vec::new(), Vec::new());
        for group in 0..groups.count() {
            let place = |[column, row]: [u32; 2]| [left + column, top + row];
            lines.clear();
            lines.extend(groups.pixels(group).map(|pixel| {
                let source = &mut self.sources[index(pixel)];
                camera.ray(place(pixel), [source.next_uniform(), source.next_uniform()])
            }));
            let Some(first) = groups.pixels(group).next() else { continue };
            radiances.clear();
            radiances.resize(lines.len(), C::ZERO);
            integrator.radiances(&lines, &mut radiances, &mut self.sources[index(first)]);
            for (pixel, &radiance) in groups.pixels(group).zip(&radiances) {
                check(radiance, place(pixel), (drawn, seed), integrator)?;
                sum += radiance.mean();
                self.pixels[index(pixel)].push(radiance);
            }
        }
        Ok(Added { sum, counts: integrator.counts(), splatted: integrator.splatted() })
    }

    /// Completes the samples that wait.
    pub(super) fn complete(&mut self, light: &LightImage<C>) {
        let samples = self.waiting.drain(..).zip(self.area.positions());
        for (pixel, (radiance, position)) in self.pixels.iter_mut().zip(samples) {
            pixel.push(radiance + light.at(position));
        }
    }

    /// Adds the sums of a pass by strategy.
    pub(super) fn tell(&mut self, tally: &Tally) {
        self.strategies.resize(tally.sums().len(), Pixel::new());
        for (moments, &sum) in self.strategies.iter_mut().zip(tally.sums()) {
            moments.push(sum);
        }
    }

    /// The moments of those sums; none if nothing was told.
    pub(super) fn strategies(&self) -> &[Pixel<f64>] {
        &self.strategies
    }

    fn draw(
        &mut self,
        integrator: &mut dyn TileIntegrator<C>,
        camera: &Camera,
        (drawn, samples, seed): (u32, u32, u64),
        take: impl Fn(&mut Pixel<C>, &mut Vec<C>, C),
    ) -> Result<Added<C>, Failure> {
        let positions = Vec::from_iter(self.area.positions());
        let Self { pixels, sources, waiting, .. } = self;
        // Pixel by pixel, so that the sum does not depend on the order of pixels.
        let mut sums = vec![(0.0, 0); positions.len()];
        let mut refused: Option<(usize, u32, C)> = None;
        integrator.pixels(camera, (&positions, samples), sources, &mut |pixel, radiance| {
            let (sum, count) = &mut sums[pixel];
            if !radiance.is_finite() && refused.is_none_or(|(first, ..)| pixel < first) {
                refused = Some((pixel, *count, radiance));
            }
            (*sum, *count) = (*sum + radiance.mean(), *count + 1);
            take(&mut pixels[pixel], waiting, radiance);
            if refused.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if let Some((pixel, sample, radiance)) = refused {
            check(radiance, positions[pixel], (drawn + sample, seed), integrator)?;
        }
        let sum = sums.iter().map(|(sum, _)| sum).sum();
        Ok(Added { sum, counts: integrator.counts(), splatted: integrator.splatted() })
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

/// Refuses a sample that is not finite.
fn check<C: Spectrum>(
    radiance: C,
    [column, row]: [u32; 2],
    (sample, seed): (u32, u64),
    integrator: &dyn TileIntegrator<C>,
) -> Result<(), Failure> {
    if radiance.is_finite() {
        return Ok(());
    }
    let by = integrator.culprit().map_or_else(String::new, |what| format!(" by {what}"));
    Err(Failure::refused(format!(
        "the radiance of pixel (column {column}, row {row}), sample {sample}, seed {seed} is {:?}{by}",
        radiance.rgb()
    )))
}

/// The samples that a pass added to a tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Added<C> {
    /// The sum of all samples, in the mean of their channels.
    pub sum: f64,
    /// Events of the integrator.
    pub counts: Counts,
    /// Light for other pixels, too.
    pub splatted: Splatted<C>,
}

impl<C> Added<C> {
    /// Nothing.
    pub(super) fn none() -> Self {
        Self { sum: 0.0, counts: Counts::default(), splatted: Splatted::none() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_cover_each_pixel_once() {
        for (columns, rows) in [(1, 1), (16, 16), (17, 33), (40, 5)] {
            let mut seen = vec![0; columns as usize * rows as usize];
            for [column, row] in areas([columns, rows], SIDE).into_iter().flat_map(Area::positions) {
                seen[(row * columns + column) as usize] += 1;
            }
            assert!(seen.iter().all(|&times| times == 1), "{columns} x {rows}");
        }
    }

    #[test]
    fn pixels_are_copied_to_their_places() {
        let mut tiles = Tile::<f64>::all([20, 18], 1, None);
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
