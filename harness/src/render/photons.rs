//! Photons: all pixels at once, in independent replicas of the whole image.

use super::batch::Batch;
use super::canvas::{Drawn, MeanVariance, Spent};
use super::draw::Draw;
use crate::plan::WalkPlan;
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_media::Medium;
use fairflight_paths::PhotonTracer;
use fairflight_scene::Spectrum;
use fairflight_sources::{Seeded, derive_seed};
use rayon::prelude::*;

/// Photons of one replica share an image, and one photon lights many pixels: only replicas tell a variance.
const REPLICAS: u32 = 16;

/// The streams of replicas are children of this child of the seed: no pixel has its number.
const PHOTON_STREAM: u64 = u64::MAX - 1;

/// One replica: what one sample per pixel, that is as many photons as pixels, adds to each pixel on average.
struct Replica<C> {
    pixels: Vec<C>,
    samples: u32,
    cost: Spent,
}

/// The light of photons, to be added to what is drawn pixel by pixel.
#[derive(Clone, Debug)]
pub(super) struct PhotonLayer<C> {
    /// Mean, and variance of one sample, of each pixel.
    pixels: Vec<(C, C)>,
    /// The variance of the image's mean that pixels share; `None` for one replica.
    shared_variance: Option<f64>,
}

impl<C: Spectrum> PhotonLayer<C> {
    /// Adds it to an image that holds the unscattered background.
    pub(super) fn add_to(&self, drawn: &mut Drawn<C>) {
        for (pixel, &(mean, variance)) in drawn.pixels.iter_mut().zip(&self.pixels) {
            pixel.add_independent(mean, variance);
        }
        drawn.mean_variance = MeanVariance::OfPixels { shared: self.shared_variance };
    }
}

impl<C: Spectrum> Draw<'_, C> {
    /// The light of scattered photons, and what it cost.
    ///
    /// # Errors
    /// If a look-up is not lawful, or a contribution not finite: that of the first replica where it happens.
    pub(super) fn photons<M: Medium + Copy + Sync>(
        &self,
        medium: M,
        walk: &WalkPlan,
    ) -> Result<(Batch<C>, Spent), Failure> {
        let count = REPLICAS.min(self.plan.samples_per_pixel);
        let (layer, spent) = self.layer(count, &|index| self.replica(medium, walk, index, count))?;
        Ok((Batch { photons: Some(layer), ..Batch::none() }, spent))
    }

    /// All replicas, put together. One copy for all media.
    fn layer(
        &self,
        count: u32,
        replica: &(dyn Fn(u32) -> Result<Replica<C>, Failure> + Sync),
    ) -> Result<(PhotonLayer<C>, Spent), Failure> {
        let replicas: Vec<Result<Replica<C>, Failure>> = (0..count).into_par_iter().map(replica).collect();
        let replicas = replicas.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let samples = f64::from(self.plan.samples_per_pixel);
        // Of one sample, from replicas of n_k samples each: Σ n_k (x_k − x)²/(K − 1).
        let share = f64::from(count.max(2) - 1).recip();
        let mut image_means = vec![0.0; replicas.len()];
        let [columns, rows] = self.plan.camera.resolution().map(|side| side as usize);
        let mut pixels = Vec::with_capacity(columns * rows);
        for i in 0..columns * rows {
            let mut mean = C::ZERO;
            for replica in &replicas {
                mean += replica.pixels[i] * (f64::from(replica.samples) / samples);
            }
            let mut variance = C::ZERO;
            for (replica, image_mean) in replicas.iter().zip(&mut image_means) {
                let off = replica.pixels[i] + mean * -1.0;
                variance += off * off * (f64::from(replica.samples) * share);
                *image_mean += replica.pixels[i].mean();
            }
            pixels.push((mean, variance));
        }
        let n = pixels.len() as f64;
        let weights: Vec<f64> = replicas.iter().map(|replica| f64::from(replica.samples)).collect();
        let mean = image_means.iter().zip(&weights).map(|(m, n)| m * n).sum::<f64>() / samples;
        let variance: f64 =
            image_means.iter().zip(&weights).map(|(m, n)| n * (m - mean).powi(2) * share).sum();
        let shared_variance = (count > 1).then(|| variance / (n * n * samples));
        let cost = replicas.iter().fold(Spent::default(), |cost, replica| cost.and(replica.cost));
        Ok((PhotonLayer { pixels, shared_variance }, cost))
    }

    fn replica<M: Medium>(
        &self,
        medium: M,
        walk: &WalkPlan,
        index: u32,
        count: u32,
    ) -> Result<Replica<C>, Failure> {
        let clock = ThreadTime::now();
        let [columns, rows] = self.plan.camera.resolution();
        let volume = self.volume(medium);
        let mut tracer = PhotonTracer::new(&self.plan.camera, &volume, &self.radiant.lights, walk.walk());
        let all = self.plan.samples_per_pixel;
        let samples = all / count + u32::from(index < all % count);
        let photons = u64::from(columns) * u64::from(rows);
        let mut source = Seeded::for_batch(derive_seed(self.seed, PHOTON_STREAM), u64::from(index));
        let mut pixels = vec![C::ZERO; photons as usize];
        let mut bad = None;
        for sample in 0..samples {
            interrupt::check()?;
            for photon in 0..photons {
                tracer.trace(&mut source, |[column, row], radiance| {
                    if !radiance.is_finite() && bad.is_none() {
                        bad = Some((column, row, u64::from(sample) * photons + photon, radiance.rgb()));
                    }
                    pixels[row as usize * columns as usize + column as usize] += radiance;
                });
            }
            (self.advance)(photons);
        }
        let truncated = tracer.truncated();
        self.judge(&volume.medium)?;
        if let Some((column, row, photon, radiance)) = bad {
            return Err(Failure::refused(format!(
                "what photon {photon} of replica {index}, seed {}, adds to pixel (column {column}, row {row}) is \
                 {radiance:?}",
                self.seed
            )));
        }
        let scale = 1.0 / (f64::from(samples) * photons as f64);
        pixels.iter_mut().for_each(|pixel| *pixel = *pixel * scale);
        let cpu_seconds = clock.elapsed().as_secs_f64();
        let cost = Spent { lookups: volume.medium.lookups(), cpu_seconds, truncated, ..Spent::default() };
        Ok(Replica { pixels, samples, cost })
    }
}
