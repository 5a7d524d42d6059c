//! Replicas: independent images that are made all at once, each by photons or by chains, and put together.

use super::canvas::{Drawn, MeanVariance, Spent};
use super::draw::Draw;
use crate::Failure;
use crate::result::number;
use fairflight_metropolis::Acceptance;
use fairflight_scene::Spectrum;
use fairflight_stats::Moments;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// The streams of replicas are children of this child of the seed: no pixel has its number.
pub(super) const REPLICA_STREAM: u64 = u64::MAX - 1;

/// One replica: what so many samples per pixel add to each pixel on average.
pub(super) struct Replica<C> {
    pub pixels: Vec<C>,
    pub samples: u32,
    pub cost: Spent,
    /// None of photons.
    pub chains: Option<Chains>,
}

/// Chains of one replica or of several.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chains {
    /// Their number.
    pub replicas: u32,
    /// Weights of the independent samples that starts were chosen from.
    pub bootstrap: Moments,
    /// Replicas of which no independent sample found light: their images are black, and count as others.
    pub black: u32,
    /// Steps by their kind.
    pub steps: Vec<(&'static str, Acceptance)>,
}

impl Chains {
    /// What statistics tell of them.
    pub(super) fn told(&self) -> ChainStatistics {
        ChainStatistics {
            replicas: self.replicas,
            bootstrap: BootstrapStatistics {
                b: self.bootstrap.mean(),
                standard_error: self.bootstrap.standard_error(),
                black_replicas: self.black,
            },
            acceptance: self.steps.iter().map(|(kind, steps)| (*kind, steps.mean())).collect(),
        }
    }

    fn merge(&mut self, other: &Self) {
        self.bootstrap.merge(&other.bootstrap);
        self.black += other.black;
        self.replicas += other.replicas;
        for ((_, all), (_, more)) in self.steps.iter_mut().zip(&other.steps) {
            all.merge(more);
        }
    }

    /// Sums over the chains of several replicas; `None` without any.
    fn of_all<'c>(chains: impl Iterator<Item = &'c Self>) -> Option<Self> {
        chains.cloned().reduce(|mut all, more| {
            all.merge(&more);
            all
        })
    }
}

/// Chains of all replicas.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ChainStatistics {
    /// Number of replicas.
    pub replicas: u32,
    /// Independent samples before the chains.
    pub bootstrap: BootstrapStatistics,
    /// Mean probability of accepting a step, by its kind.
    pub acceptance: BTreeMap<&'static str, Option<f64>>,
}

/// Independent samples that chains start from, of all replicas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct BootstrapStatistics {
    /// Mean brightness of a sample of the whole image: b, of which each replica uses its own estimate.
    #[serde(serialize_with = "number")]
    pub b: Option<f64>,
    /// Its standard error.
    #[serde(serialize_with = "number")]
    pub standard_error: Option<f64>,
    /// Replicas that found no light, and are black.
    pub black_replicas: u32,
}

/// The light of replicas, to be added to what is drawn pixel by pixel.
#[derive(Clone, Debug)]
pub(super) struct ReplicaLayer<C> {
    /// Mean, and variance of one sample, of each pixel.
    pixels: Vec<(C, C)>,
    /// The variance of the image's mean that pixels share; `None` for one replica.
    shared_variance: Option<f64>,
    chains: Option<Chains>,
}

impl<C: Spectrum> ReplicaLayer<C> {
    /// Adds it to an image that holds the light that replicas leave out.
    pub(super) fn add_to(&self, drawn: &mut Drawn<C>) {
        for (pixel, &(mean, variance)) in drawn.pixels.iter_mut().zip(&self.pixels) {
            pixel.add_independent(mean, variance);
        }
        drawn.mean_variance = MeanVariance::OfPixels { shared: self.shared_variance };
        drawn.chains.clone_from(&self.chains);
    }
}

impl<C: Spectrum> Draw<'_, C> {
    /// All replicas, put together: `replica` makes the one with a number, of so many samples per pixel. One copy for all media.
    ///
    /// # Errors
    /// That of the first replica that fails.
    pub(super) fn layer(
        &self,
        count: u32,
        replica: &(dyn Fn(u32, u32) -> Result<Replica<C>, Failure> + Sync),
    ) -> Result<(ReplicaLayer<C>, Spent), Failure> {
        let all = self.plan.samples_per_pixel;
        let numbered = |index: u32| replica(index, all / count + u32::from(index < all % count));
        let replicas: Vec<Result<Replica<C>, Failure>> = (0..count).into_par_iter().map(numbered).collect();
        let replicas = replicas.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let samples = f64::from(all);
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
        let chains = Chains::of_all(replicas.iter().filter_map(|replica| replica.chains.as_ref()));
        Ok((ReplicaLayer { pixels, shared_variance, chains }, cost))
    }
}
