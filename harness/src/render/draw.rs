//! Drawing an image in parallel, the same one whatever the number of threads.

use super::pixel::Pixel;
use crate::Failure;
use crate::plan::{IntegratorJob, IntegratorPlan, MediumJob, Radiant, ScenePlan, TileIntegrator, Unlawful};
use cpu_time::ThreadTime;
use fairflight_media::{LineThickness, Medium, Observed};
use fairflight_scene::{Spectrum, Volume};
use fairflight_sources::{Seeded, UniformSource};
use glam::DVec3;
use rayon::prelude::*;
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Columns and rows of a tile: one worker's piece of work, with one integrator.
const TILE: u32 = 16;

/// An image with what it cost.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drawn<C> {
    /// Row by row from the top.
    pub pixels: Vec<Pixel<C>>,
    pub cost: Spent,
    /// The variance of the image's mean that pixels share, 0 where they share nothing; `None` if it is not known.
    pub shared_variance: Option<f64>,
    /// What is to be said of the walks.
    pub warning: Option<String>,
}

impl Drawn<DVec3> {
    /// An image of three channels that were drawn one by one.
    pub(super) fn of_channels([red, green, blue]: [Drawn<f64>; 3]) -> Self {
        let pixels = red.pixels.iter().zip(&green.pixels).zip(&blue.pixels);
        Self {
            pixels: pixels.map(|((r, g), b)| Pixel::of_channels([*r, *g, *b])).collect(),
            cost: red.cost.and(green.cost).and(blue.cost),
            // Of the mean of three independent channels.
            shared_variance: [red.shared_variance, green.shared_variance, blue.shared_variance]
                .into_iter()
                .sum::<Option<f64>>()
                .map(|sum| sum / 9.0),
            warning: red.warning.or(green.warning).or(blue.warning),
        }
    }
}

/// What drawing cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spent {
    /// Look-ups of the medium.
    pub lookups: u64,
    /// CPU seconds over all threads, without the start of them.
    pub cpu_seconds: f64,
    /// Walks that were cut at their greatest number of collisions.
    pub truncated: u64,
}

impl Spent {
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            lookups: self.lookups + other.lookups,
            cpu_seconds: self.cpu_seconds + other.cpu_seconds,
            truncated: self.truncated + other.truncated,
        }
    }
}

/// A rectangle of pixels: from, to (not included).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Tile {
    columns: [u32; 2],
    rows: [u32; 2],
}

/// Draws all pixels of a plan with the variates of `seed`. `advance` is told how many samples were added.
///
/// # Errors
/// If a look-up is not lawful, or a sample not finite: that of the first tile where it happens.
pub(super) fn draw<C: Spectrum>(
    plan: &ScenePlan,
    radiant: &Radiant<C>,
    seed: u64,
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Drawn<C>, Failure> {
    plan.medium.with(Draw { plan, radiant, seed, advance })
}

pub(super) struct Draw<'a, C> {
    pub plan: &'a ScenePlan,
    pub radiant: &'a Radiant<C>,
    pub seed: u64,
    pub advance: &'a (dyn Fn(u64) + Sync),
}

impl<C: Spectrum> MediumJob for Draw<'_, C> {
    type Output = Result<Drawn<C>, Failure>;

    fn by_look_ups<M: Medium + Sync>(self, medium: &M) -> Self::Output {
        let integrator = &self.plan.integrator;
        // Whether they fit together is known before the first tile.
        integrator.by_look_ups(&self.volume(medium), &self.radiant.lights, &Cell::new(None), Fits)?;
        let warning = self.check_growth(medium)?;
        let drawn = self.tiles(warning, |tile| {
            self.tile(medium, |volume, unlawful| {
                let job = DrawTile { plan: self.plan, seed: self.seed, tile };
                integrator.by_look_ups(volume, &self.radiant.lights, unlawful, job)
            })
        })?;
        self.finish(medium, drawn)
    }

    fn by_closed_form<M: LineThickness + Sync>(self, medium: &M) -> Self::Output {
        let integrator = &self.plan.integrator;
        integrator.by_closed_form(&self.volume(medium), &self.radiant.lights, &Cell::new(None), Fits)?;
        let warning = self.check_growth(medium)?;
        let drawn = self.tiles(warning, |tile| {
            self.tile(medium, |volume, unlawful| {
                let job = DrawTile { plan: self.plan, seed: self.seed, tile };
                integrator.by_closed_form(volume, &self.radiant.lights, unlawful, job)
            })
        })?;
        self.finish(medium, drawn)
    }
}

/// An integrator that could be built.
struct Fits;

impl<C> IntegratorJob<C> for Fits {
    type Output = ();
    fn run<I: TileIntegrator<C>>(self, _integrator: I) {}
}

/// The pixels of a tile, and how many walks were cut.
type TilePixels<C> = Result<(Vec<Pixel<C>>, u64), Failure>;
/// The volume of a tile, observed.
pub(super) type ObservedVolume<'a, M, C> = Volume<Observed<&'a M>, &'a crate::plan::AnyPhase, C>;

impl<C: Spectrum> Draw<'_, C> {
    pub(super) fn volume<'a, M: Medium>(&'a self, medium: &'a M) -> ObservedVolume<'a, M, C> {
        Volume {
            medium: Observed::new(medium),
            bounds: self.plan.bounds,
            albedo: self.radiant.albedo,
            phase: &self.plan.phase,
        }
    }

    /// Whether the walks of the integrator have a second moment. Its look-ups are not part of the cost: it is a diagnosis.
    fn check_growth<M: Medium>(&self, medium: &M) -> Result<Option<String>, Failure> {
        let Some(walk) = self.plan.integrator.walk() else { return Ok(None) };
        let volume = self.volume(medium);
        let growth = walk.check_growth(&volume, self.seed);
        // Where walks are not defined they do not grow either.
        self.judge(&volume.medium)?;
        growth
    }

    /// What is not drawn pixel by pixel.
    fn finish<M: Medium + Sync>(&self, medium: &M, drawn: Drawn<C>) -> Result<Drawn<C>, Failure> {
        match &self.plan.integrator {
            IntegratorPlan::PhotonTracer(walk) => self.add_photons(medium, walk, drawn),
            _ => Ok(drawn),
        }
    }

    /// Whether all look-ups so far were lawful.
    pub(super) fn judge<M: Medium>(&self, observed: &Observed<M>) -> Result<(), Failure> {
        if !observed.is_finite() {
            return Err(Failure::refused("medium: sigma_t is not finite somewhere"));
        }
        let (lowest, highest) = observed.range();
        if let Some(bound) = observed.upper_bound()
            && highest > bound
        {
            return Err(Failure::refused(format!(
                "medium: sigma_t = {highest} exceeds the declared majorant {bound}"
            )));
        }
        if observed.lookups() > 0 {
            self.plan.integrator.admits((lowest, highest), self.radiant.albedo.max_channel())?;
        }
        Ok(())
    }

    /// One tile on an observed medium; what was met is judged afterwards.
    fn tile<M: Medium>(
        &self,
        medium: &M,
        draw: impl FnOnce(&ObservedVolume<'_, M, C>, &Cell<Option<Unlawful>>) -> Result<TilePixels<C>, Failure>,
    ) -> Result<(Vec<Pixel<C>>, Spent), Failure> {
        let plan = self.plan;
        let clock = ThreadTime::now();
        let volume = self.volume(medium);
        let unlawful = Cell::new(None);
        let drawn = draw(&volume, &unlawful)?;
        // Before the samples: a look-up that is not finite explains a sample that is not.
        self.judge(&volume.medium)?;
        if let Some(unlawful) = unlawful.get() {
            return Err(plan.integrator.explain(unlawful));
        }
        let (pixels, truncated) = drawn?;
        let cpu_seconds = clock.elapsed().as_secs_f64();
        Ok((pixels, Spent { lookups: volume.medium.lookups(), cpu_seconds, truncated }))
    }

    /// All tiles, put together in the order of their pixels.
    fn tiles(
        &self,
        warning: Option<String>,
        tile: impl Fn(Tile) -> Result<(Vec<Pixel<C>>, Spent), Failure> + Sync,
    ) -> Result<Drawn<C>, Failure> {
        let [columns, rows] = self.plan.camera.resolution();
        let tiles = tiles_of(columns, rows);
        // A tile behind the first failure is not drawn; one before it is, since it might fail too.
        let first_failure = AtomicUsize::new(usize::MAX);
        let drawn: Vec<Option<Result<_, Failure>>> = tiles
            .par_iter()
            .enumerate()
            .with_max_len(1)
            .map(|(i, &area)| {
                if i > first_failure.load(Ordering::Relaxed) {
                    return None;
                }
                let drawn = tile(area).map_err(|failure| failure.within(area.name()));
                if drawn.is_err() {
                    first_failure.fetch_min(i, Ordering::Relaxed);
                }
                (self.advance)(area.pixels() * u64::from(self.plan.samples_per_pixel));
                Some(drawn)
            })
            .collect();
        let mut pixels = vec![Pixel::new(); columns as usize * rows as usize];
        let mut cost = Spent::default();
        for (area, drawn) in tiles.iter().zip(drawn.into_iter().flatten()) {
            let (tile, spent) = drawn?;
            let width = (area.columns[1] - area.columns[0]) as usize;
            for (row, line) in (area.rows[0]..).zip(tile.chunks_exact(width)) {
                let start = row as usize * columns as usize + area.columns[0] as usize;
                pixels[start..start + width].copy_from_slice(line);
            }
            cost = cost.and(spent);
        }
        Ok(Drawn { pixels, cost, shared_variance: Some(0.0), warning })
    }
}

fn tiles_of(columns: u32, rows: u32) -> Vec<Tile> {
    let cut = |start: u32, end: u32| [start, end.min(start + TILE)];
    let steps = |end: u32| (0..end).step_by(TILE as usize);
    let row =
        |top: u32| steps(columns).map(move |left| Tile { columns: cut(left, columns), rows: cut(top, rows) });
    steps(rows).flat_map(row).collect()
}

impl Tile {
    fn pixels(self) -> u64 {
        u64::from(self.columns[1] - self.columns[0]) * u64::from(self.rows[1] - self.rows[0])
    }

    fn name(self) -> String {
        let Self { columns, rows } = self;
        format!("columns {} to {}, rows {} to {}", columns[0], columns[1] - 1, rows[0], rows[1] - 1)
    }
}

struct DrawTile<'a> {
    plan: &'a ScenePlan,
    seed: u64,
    tile: Tile,
}

impl<C: Spectrum> IntegratorJob<C> for DrawTile<'_> {
    type Output = TilePixels<C>;

    fn run<I: TileIntegrator<C>>(self, mut integrator: I) -> Self::Output {
        let Self { plan, seed, tile } = self;
        let [columns, _] = plan.camera.resolution();
        let mut pixels = Vec::with_capacity(tile.pixels() as usize);
        for row in tile.rows[0]..tile.rows[1] {
            for column in tile.columns[0]..tile.columns[1] {
                let index = u64::from(row) * u64::from(columns) + u64::from(column);
                let mut source = Seeded::for_batch(seed, index);
                let mut pixel = Pixel::new();
                for i in 0..plan.samples_per_pixel {
                    let within = [source.next_uniform(), source.next_uniform()];
                    let line = plan.camera.ray([column, row], within);
                    let radiance = integrator.radiance(&line, &mut source);
                    if !radiance.is_finite() {
                        return Err(Failure::refused(format!(
                            "the radiance of pixel (column {column}, row {row}), sample {i}, seed {seed} is {:?}",
                            radiance.rgb()
                        )));
                    }
                    pixel.push(radiance);
                }
                pixels.push(pixel);
            }
        }
        Ok((pixels, integrator.truncated()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_each_pixel_once() {
        for (columns, rows) in [(1, 1), (16, 16), (17, 33), (40, 5)] {
            let mut seen = vec![0; columns as usize * rows as usize];
            for tile in tiles_of(columns, rows) {
                for row in tile.rows[0]..tile.rows[1] {
                    for column in tile.columns[0]..tile.columns[1] {
                        seen[(row * columns + column) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{columns} x {rows}");
        }
    }
}
