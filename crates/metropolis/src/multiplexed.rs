//! Multiplexed Metropolis sampling: one strategy per sample.

use crate::integrand::{film_position, pixels};
use crate::{Integrand, Lengths, Splats};
use fairflight_bidirectional::{Bidirectional, Strategy, Subpath, WeightThickness};
use fairflight_paths::transport::Types;
use fairflight_sources::{Purpose, Row, UniformSource};

/// Bidirectional path tracing by one strategy (s, t) per sample (hachisuka-2014).
///
/// ```text
/// length k by pmf(k), one of its n strategies by 1/n
/// subpaths of exactly s and t vertices: no roulette, neither in walks nor in the densities of weights
/// F = w_(s,t) C_(s,t) n/pmf(k)
/// ```
///
/// **Law.** That of [`Integrand`]: weights sum to 1 over the strategies of a path, each of which is tried with the probability that F is divided by.
///
/// **Steps.** k and s are variates as all others, in rows of their own: k changes in large steps only; a small one chooses s anew with the probability
/// 0.1, and keeps it else. Either is symmetric, so that the ratio of acceptance is that of f*, in which 1/pmf is already.
///
/// **Cost.** One connection per sample, where all strategies together make as many as their subpaths have pairs of vertices.
pub struct Multiplexed<'s, W: Types, K> {
    integrator: Bidirectional<'s, W, K>,
    light: Subpath<W::Spectrum>,
    lengths: Lengths,
}

impl<W: Types, K> std::fmt::Debug for Multiplexed<'_, W, K> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { integrator, lengths, .. } = self;
        formatter
            .debug_struct("Multiplexed")
            .field("integrator", integrator)
            .field("lengths", lengths)
            .finish_non_exhaustive()
    }
}

impl<'s, W: Types, K: WeightThickness<W::Medium>> Multiplexed<'s, W, K> {
    /// Strategies of `integrator`, whose roulette is taken away, of lengths by `lengths`: shorter paths than its first are left out.
    pub fn new(integrator: Bidirectional<'s, W, K>, lengths: Lengths) -> Self {
        Self { integrator: integrator.without_roulette(), light: Subpath::empty(), lengths }
    }

    /// The integrator.
    pub fn integrator(&self) -> &Bidirectional<'s, W, K> {
        &self.integrator
    }

    /// The number of strategies that make paths of a length: s = 0, 1, …; t = 1 with a light image alone, and not for a light seen directly.
    fn strategies(&self, length: u32) -> u32 {
        match length {
            1 => 1,
            _ if self.integrator.weigh().light_paths > 0.0 => length + 1,
            _ => length,
        }
    }
}

impl<W: Types, K: WeightThickness<W::Medium>> Integrand<W::Spectrum> for Multiplexed<'_, W, K> {
    fn sample(&mut self, splats: &mut Splats<W::Spectrum>, mut source: &mut dyn UniformSource) {
        source.row(Row { purpose: Purpose::Kept, ..Row::FIRST });
        let length = self.lengths.sample(source);
        let count = self.strategies(length);
        source.row(Row { purpose: Purpose::Redrawn, ..Row::FIRST });
        let s = (source.next_uniform() * f64::from(count)) as u32;
        let strategy = Strategy { light: s, eye: length + 1 - s };
        source.row(Row::FIRST);
        let Self { integrator, light, lengths } = self;
        let (camera, light_paths) = (integrator.weigh().camera, integrator.weigh().light_paths);
        let (pixel, within) = film_position(camera, source);
        let scale = f64::from(count) / lengths.pmf(length);
        integrator.alone(strategy, &camera.ray(pixel, within), light, &mut source, |seen, found| {
            // Of n_L light paths that make the image this is one, of its pixels the one that the film position is in.
            let (pixel, share) = seen.map_or((pixel, pixels(camera)), |seen| (seen, light_paths));
            splats.push(pixel, found.value * (share * scale));
        });
    }
}
