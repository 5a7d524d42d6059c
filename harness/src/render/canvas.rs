//! An image that grows pass by pass, with what it cost.

use super::batch::Batch;
use super::pixel::Pixel;
use super::replicas::Chains;
use super::tile::Tile;
use crate::spec::ReuseSpec;
use fairflight_scene::Spectrum;
use fairflight_stats::Moments;
use glam::DVec3;

/// The part of an image of one seed that is drawn so far.
#[derive(Clone, Debug)]
pub(super) struct Canvas<C> {
    pub seed: u64,
    resolution: [u32; 2],
    pub tiles: Vec<Tile<C>>,
    pub cost: Spent,
    /// Samples per pixel so far.
    pub samples: u32,
    /// The mean over pixels and channels of each pass.
    pub pass_means: Vec<f64>,
    /// The mean of those means; `None` before the first pass.
    pub mean: Option<f64>,
    /// What the tiles of the last pass shared; in it the part of the image that is not drawn pixel by pixel.
    pub batch: Option<Batch<C>>,
    /// Warning about the walks.
    pub warning: Option<String>,
}

/// An image with what it cost.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drawn<C> {
    /// Pixels, row by row from the top.
    pub pixels: Vec<Pixel<C>>,
    pub cost: Spent,
    /// Samples per pixel.
    pub samples: u32,
    pub mean_variance: MeanVariance,
    /// Light by strategy; none where it is not told.
    pub strategies: Vec<Found>,
    /// Chains that drew a part of it.
    pub chains: Option<Chains>,
    /// Warning about the walks.
    pub warning: Option<String>,
}

/// Light that one strategy found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// The mean over all pixels.
    pub mean: f64,
    /// The variance of one sample, averaged over pixels; `None` for one sample.
    pub variance: Option<f64>,
}

/// Source of the variance of the image's mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MeanVariance {
    /// The pixels, which share no randomness but for what adds this; `None` if that is not known.
    OfPixels { shared: Option<f64> },
    /// This variance, from the means of passes: all pixels of a pass share its batch. `None` for fewer than two passes.
    OfPasses(Option<f64>),
}

/// Cost of drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spent {
    /// Look-ups of the medium.
    pub lookups: u64,
    /// CPU seconds over all threads, without the start of them.
    pub cpu_seconds: f64,
    /// Walks that were cut at their greatest number of collisions.
    pub truncated: u64,
    /// Virtual point lights or photons of maps, of all passes.
    pub vpls: u64,
    /// CPU seconds of their light paths, a part of all.
    pub light_path_seconds: f64,
    /// Compensation vertices that were tried.
    pub compensation_tried: u64,
    /// Compensation vertices that lay where something was lost.
    pub compensation_inside: u64,
    /// Light paths of a bidirectional integrator.
    pub light_paths: u64,
    /// The sum over them of the power that was not followed.
    pub unseen_power: f64,
}

impl<C: Spectrum> Canvas<C> {
    /// No sample yet.
    pub(super) fn new(resolution: [u32; 2], seed: u64, groups: Option<ReuseSpec>) -> Self {
        Self {
            seed,
            resolution,
            tiles: Tile::all(resolution, seed, groups),
            cost: Spent::default(),
            samples: 0,
            pass_means: Vec::new(),
            mean: None,
            batch: None,
            warning: None,
        }
    }

    /// Adds the mean of a pass of so many samples per pixel.
    pub(super) fn push_pass(&mut self, mean: f64, samples: u32) {
        self.pass_means.push(mean);
        let before = self.mean.unwrap_or(0.0);
        self.mean = Some(before + (mean - before) / self.pass_means.len() as f64);
        self.samples += samples;
    }

    /// Light by strategy, over all tiles, which are independent of each other.
    fn strategies(&self) -> Vec<Found> {
        let pixels: f64 = self.resolution.map(f64::from).iter().product();
        let count = self.tiles.iter().map(|tile| tile.strategies().len()).max().unwrap_or(0);
        let of = |index: usize| {
            let moments = || self.tiles.iter().filter_map(move |tile| tile.strategies().get(index));
            let variance: Option<f64> = moments().map(Pixel::variance).sum();
            Found {
                mean: moments().map(Pixel::mean).sum::<f64>() / pixels,
                variance: variance.map(|variance| variance / pixels),
            }
        };
        (0..count).map(of).collect()
    }

    /// The image so far. `shares_batches` says that the pixels of a pass are not independent of each other.
    pub(super) fn drawn(&self, shares_batches: bool) -> Drawn<C> {
        let [columns, rows] = self.resolution.map(|side| side as usize);
        let mut pixels = vec![Pixel::new(); columns * rows];
        self.tiles.iter().for_each(|tile| tile.copy_to(&mut pixels, self.resolution[0]));
        let mean_variance = if shares_batches {
            MeanVariance::OfPasses(Moments::from_slice(&self.pass_means).variance_of_mean())
        } else {
            MeanVariance::OfPixels { shared: Some(0.0) }
        };
        let (cost, samples, warning) = (self.cost, self.samples, self.warning.clone());
        let strategies = self.strategies();
        let mut drawn = Drawn { pixels, cost, samples, mean_variance, strategies, chains: None, warning };
        if let Some(replicas) = self.batch.as_ref().and_then(|batch| batch.replicas.as_ref()) {
            replicas.add_to(&mut drawn);
        }
        drawn
    }
}

impl Drawn<DVec3> {
    /// An image of three channels that were drawn one by one.
    pub(super) fn of_channels([red, green, blue]: [Drawn<f64>; 3]) -> Self {
        let pixels = red.pixels.iter().zip(&green.pixels).zip(&blue.pixels);
        Self {
            pixels: pixels.map(|((r, g), b)| Pixel::of_channels([*r, *g, *b])).collect(),
            cost: red.cost.and(green.cost).and(blue.cost),
            samples: red.samples,
            mean_variance: MeanVariance::of_channels([&red, &green, &blue].map(|drawn| drawn.mean_variance)),
            strategies: Found::of_channels([&red, &green, &blue].map(|drawn| drawn.strategies.as_slice())),
            // Chains have one target: no channels of their own.
            chains: None,
            warning: red.warning.or(green.warning).or(blue.warning),
        }
    }
}

impl Found {
    /// The mean of three independent channels.
    fn of_channels(channels: [&[Self]; 3]) -> Vec<Self> {
        let count = channels.map(<[Self]>::len).into_iter().max().unwrap_or(0);
        let of = |index: usize| {
            let found = || channels.into_iter().filter_map(move |channel| channel.get(index));
            let variance: Option<f64> = found().map(|found| found.variance).sum();
            Self {
                mean: found().map(|found| found.mean).sum::<f64>() / 3.0,
                variance: variance.map(|variance| variance / 9.0),
            }
        };
        (0..count).map(of).collect()
    }
}

impl MeanVariance {
    /// The variance of the mean of three independent channels that were drawn alike.
    fn of_channels(channels: [Self; 3]) -> Self {
        let known = channels.map(|(Self::OfPixels { shared: known } | Self::OfPasses(known))| known);
        let sum = known.into_iter().sum::<Option<f64>>().map(|sum| sum / 9.0);
        match channels[0] {
            Self::OfPixels { .. } => Self::OfPixels { shared: sum },
            Self::OfPasses(_) => Self::OfPasses(sum),
        }
    }
}

impl Spent {
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            lookups: self.lookups + other.lookups,
            cpu_seconds: self.cpu_seconds + other.cpu_seconds,
            truncated: self.truncated + other.truncated,
            vpls: self.vpls + other.vpls,
            light_path_seconds: self.light_path_seconds + other.light_path_seconds,
            compensation_tried: self.compensation_tried + other.compensation_tried,
            compensation_inside: self.compensation_inside + other.compensation_inside,
            light_paths: self.light_paths + other.light_paths,
            unseen_power: self.unseen_power + other.unseen_power,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_that_share_tell_the_variance_of_the_mean() {
        let mut canvas = Canvas::<f64>::new([2, 2], 1, None);
        canvas.pass_means = vec![1.0];
        assert_eq!(canvas.drawn(true).mean_variance, MeanVariance::OfPasses(None));
        canvas.pass_means = vec![1.0, 2.0, 6.0];
        // Sample variance 7 of three passes.
        let MeanVariance::OfPasses(Some(variance)) = canvas.drawn(true).mean_variance else {
            panic!("three passes have a variance")
        };
        assert!((variance - 7.0 / 3.0).abs() < 1e-15);
        assert_eq!(canvas.drawn(false).mean_variance, MeanVariance::OfPixels { shared: Some(0.0) });
    }

    #[test]
    fn channels_are_averaged() {
        use MeanVariance::{OfPasses, OfPixels};
        assert_eq!(
            MeanVariance::of_channels([3.0, 6.0, 9.0].map(|v| OfPasses(Some(v)))),
            OfPasses(Some(2.0))
        );
        let unknown = [Some(1.0), None, Some(1.0)].map(|shared| OfPixels { shared });
        assert_eq!(MeanVariance::of_channels(unknown), OfPixels { shared: None });
    }
}
