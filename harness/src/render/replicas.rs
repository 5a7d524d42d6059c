//! Replicas: independent images that are made all at once, each by photons or by chains, and put together.

use super::canvas::{Drawn, MeanVariance, Spent};
use super::draw::Draw;
use crate::Failure;
use crate::result::number;
use fairflight_metropolis::{Acceptance, Experience};
use fairflight_scene::Spectrum;
use fairflight_stats::{Autocorrelation, Moments};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;

/// The streams of replicas are children of this child of the seed: no pixel has its number.
pub(super) const REPLICA_STREAM: u64 = u64::MAX - 1;

/// One replica: what so many samples per pixel add to each pixel on average.
pub(super) struct Replica<C> {
    pub number: u32,
    pub pixels: Vec<C>,
    pub samples: u32,
    pub cost: Spent,
    /// None of photons.
    pub chains: Option<Chains>,
    /// What later replicas may learn from.
    pub experience: Option<Experience>,
}

impl<C> Replica<C> {
    /// Leaves the autocorrelation of its chains out of account.
    pub(super) fn forget_series(&mut self) {
        if let Some(chains) = &mut self.chains {
            chains.autocorrelation = Autocorrelation::new();
        }
    }
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
    /// Series of ln f* along the long ones.
    pub autocorrelation: Autocorrelation,
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
            autocorrelation_time: self.autocorrelation.time(),
            acceptance: self.steps.iter().map(|(kind, steps)| (*kind, steps.mean())).collect(),
        }
    }

    fn merge(&mut self, other: &Self) {
        self.bootstrap.merge(&other.bootstrap);
        self.black += other.black;
        self.replicas += other.replicas;
        self.autocorrelation.merge(&other.autocorrelation);
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
    /// Integrated autocorrelation time of ln f* along the chains \[steps\], those of the last stage: a diagnosis, of which no error follows. Null where
    /// chains are too short to tell it.
    #[serde(serialize_with = "number")]
    pub autocorrelation_time: Option<f64>,
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
    /// Samples per pixel of all replicas together.
    pub samples: u32,
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
    /// The replicas of a range, of `count` in all: `replica` makes the one with a number, of so many samples per pixel. One copy for all media.
    ///
    /// Once drawing is asked to end none begins, but for the very first; one that has begun is finished. Whether a replica is part of the image so depends on
    /// those before it and not on itself: to leave out what a clock cuts would leave out slow replicas, which may be the bright ones. The sum over the
    /// replicas is unbiased at any such end (Wald's identity). Their number is not independent of it: of the mean that leaves a bias of the order of 1/number
    /// where time and brightness go together, as for whole passes of any integrator; a number that no clock chose has none.
    ///
    /// # Errors
    /// That of the first replica that fails.
    pub(super) fn replicas(
        &self,
        (range, count): (Range<u32>, u32),
        replica: &(dyn Fn(u32, u32) -> Result<Replica<C>, Failure> + Sync),
    ) -> Result<Vec<Replica<C>>, Failure> {
        let all = self.plan.samples_per_pixel;
        let numbered = |index: u32| {
            let begins = index == 0 || !(self.ends)();
            begins.then(|| replica(index, all / count + u32::from(index < all % count)))
        };
        let replicas: Vec<_> = range.into_par_iter().with_max_len(1).map(numbered).collect();
        replicas.into_iter().flatten().collect()
    }

    /// Replicas put together, and what they cost: one at least.
    pub(super) fn layer(&self, replicas: &[Replica<C>]) -> (ReplicaLayer<C>, Spent) {
        let samples: u32 = replicas.iter().map(|replica| replica.samples).sum();
        let pixels: Vec<(C, C)> = mean_and_variance(replicas).collect();
        // The same of the image's sum.
        let sum = |replica: &Replica<C>| replica.pixels.iter().map(|pixel| pixel.mean()).sum::<f64>();
        let sums: Vec<(f64, f64)> =
            replicas.iter().map(|replica| (f64::from(replica.samples), sum(replica))).collect();
        let mean = sums.iter().map(|(n, sum)| sum * n).sum::<f64>() / f64::from(samples);
        let share = share(replicas.len());
        let variance: f64 = sums.iter().map(|(n, sum)| n * (sum - mean).powi(2) * share).sum();
        let n = pixels.len() as f64;
        let shared_variance = (replicas.len() > 1).then(|| variance / (n * n * f64::from(samples)));
        let cost = replicas.iter().fold(Spent::default(), |cost, replica| cost.and(replica.cost));
        let chains = Chains::of_all(replicas.iter().filter_map(|replica| replica.chains.as_ref()));
        (ReplicaLayer { samples, pixels, shared_variance, chains }, cost)
    }
}

/// 1/(K − 1).
fn share(replicas: usize) -> f64 {
    (replicas.max(2) as f64 - 1.0).recip()
}

/// Mean, and variance of one sample, of each pixel, of replicas of n_k samples each: Σ n_k x_k/Σ n_k and Σ n_k (x_k − x)²/(K − 1).
pub(super) fn mean_and_variance<C: Spectrum>(replicas: &[Replica<C>]) -> impl Iterator<Item = (C, C)> {
    let samples: u32 = replicas.iter().map(|replica| replica.samples).sum();
    let share = share(replicas.len());
    (0..replicas.first().map_or(0, |first| first.pixels.len())).map(move |i| {
        let mut mean = C::ZERO;
        for replica in replicas {
            mean += replica.pixels[i] * (f64::from(replica.samples) / f64::from(samples));
        }
        let mut variance = C::ZERO;
        for replica in replicas {
            let off = replica.pixels[i] + mean * -1.0;
            variance += off * off * (f64::from(replica.samples) * share);
        }
        (mean, variance)
    })
}
