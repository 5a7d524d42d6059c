//! The start of a chain, and what its scores are multiplied with: both from one set of independent samples.

use crate::{NotFinite, Target};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::Moments;

/// Independent samples x_1 … x_M of a target, of which one starts a chain and all together say how bright the image is.
///
/// ```text
/// b̂ = (1/M) Σ W_i,      start x_i with probability W_i/Σ W
/// ```
///
/// **Law.** Let g(x) be the expected mean score of a chain from x, of a function h. For every M ≥ 1,
///
/// ```text
/// E[b̂ g(start)] = E[(1/M) Σ W_i g(x_i)] = ∫ f* g = ∫ f* h
/// ```
///
/// by stationarity alone: the chain need not be ergodic, and may be short. What multiplies must come from the very set that the start was
/// chosen from; a better estimate of b from elsewhere is a bias,
/// as is any other start, and any b that was pooled over chains. Where all W are 0 the score is 0, and that is its value.
///
/// Samples have streams of their own: the one that is chosen is drawn again, and none is stored.
#[derive(Clone, Debug)]
pub struct Bootstrap {
    seed: u64,
    /// Sums of the first 1, 2, … weights.
    cumulative: Vec<f64>,
    weights: Moments,
}

impl Bootstrap {
    /// Draws `samples` states of a target.
    ///
    /// # Errors
    /// The index of the first sample whose contribution is not finite.
    pub fn draw<C>(target: &mut dyn Target<C>, samples: u64, seed: u64) -> Result<Self, (u64, NotFinite)> {
        let mut sum = 0.0;
        let (mut cumulative, mut weights) = (Vec::with_capacity(samples as usize), Moments::new());
        for index in 0..samples {
            let weight = target.draw(&mut Seeded::new(derive_seed(seed, index)));
            if !weight.is_finite() {
                return Err((index, NotFinite));
            }
            debug_assert!(weight >= 0.0, "a weight of {weight}");
            sum += weight;
            cumulative.push(sum);
            weights.push(weight);
        }
        Ok(Self { seed, cumulative, weights })
    }

    /// Moments of the weights: their mean is b̂.
    #[must_use]
    pub fn weights(&self) -> &Moments {
        &self.weights
    }

    /// b̂, the mean weight; 0 without samples.
    #[must_use]
    pub fn brightness(&self) -> f64 {
        self.total() / self.cumulative.len().max(1) as f64
    }

    fn total(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    /// The index of a sample, chosen in proportion to the weights; `None` where all are 0.
    pub fn choose(&self, source: &mut dyn UniformSource) -> Option<u64> {
        let total = Some(self.total()).filter(|&total| total > 0.0)?;
        let target = source.next_uniform() * total;
        // The first sum above: never that of a weight of 0.
        let index = self.cumulative.partition_point(|&sum| sum <= target);
        Some(index.min(self.cumulative.partition_point(|&sum| sum < total)) as u64)
    }

    /// Makes a sample the present state of the target it was drawn of.
    pub fn start<C>(&self, target: &mut dyn Target<C>, index: u64) {
        let weight = target.draw(&mut Seeded::new(derive_seed(self.seed, index)));
        let before = (index as usize).checked_sub(1).map_or(0.0, |before| self.cumulative[before]);
        debug_assert!(before + weight == self.cumulative[index as usize], "a sample depends on those before");
        target.accept();
    }
}
