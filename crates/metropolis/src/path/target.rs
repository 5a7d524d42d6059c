//! Paths as the states of a chain.

use super::{PathState, PathWorld};
use crate::integrand::{film_position, pixels};
use crate::{Film, Importance, Mutation, Proposed, Target, Which, acceptance};
use fairflight_bidirectional::{Bidirectional, Found, Subpath, WeightThickness};
use fairflight_elementary::ln;
use fairflight_paths::transport::Types;
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// A mutation, and the name that its acceptance is told by.
pub type Named<'m> = (&'static str, Box<dyn Mutation<PathState> + 'm>);

/// Paths of at least `first_order` edges that bidirectional path tracing finds, moved by mutations that are chosen equally often, or by shares
/// (antwerpen-2011 sections 6.2 to 6.4).
///
/// ```text
/// f* = the greatest channel of the contribution, times the importance of the pixel
/// draw: one sample of all strategies, each path with its weighted contribution v_i; one of them with the probability v_i/Σ v, and W = Σ v
/// ```
///
/// **Law.** That of [`Target`]: E\[W h(x)\] = E\[Σ v_i h(x_i)\] = ∫ f* h, since the v_i of a path sum over strategies to its contribution over the density of
/// finding it. Mutations keep f*, each by itself, so that any choice among them does that does not look at the state.
///
/// **Assumes** contributions of at least 0: walks of a sampling extinction below the extinction, and transmittance that may be negative, have signs that
/// a density cannot have.
pub struct PathTarget<'s, W: Types, K> {
    integrator: Bidirectional<'s, W, K>,
    light: Subpath<W::Spectrum>,
    world: &'s dyn PathWorld,
    mutations: Vec<Named<'s>>,
    kinds: Vec<&'static str>,
    /// Sums of the shares of the first 1, 2, … mutations.
    cumulative: Vec<f64>,
    importance: Option<&'s Importance>,
    first_order: u32,
    /// ln f* of the present state.
    ln_present: f64,
    found: Vec<Found<W::Spectrum>>,
    present: PathState,
    proposed: PathState,
}

impl<W: Types, K> fmt::Debug for PathTarget<'_, W, K> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kinds, first_order, .. } = self;
        formatter
            .debug_struct("PathTarget")
            .field("kinds", kinds)
            .field("first_order", first_order)
            .finish_non_exhaustive()
    }
}

/// A target whose chains never move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a chain in path space needs at least one mutation")]
pub struct NoMutation;

/// Shares of mutations that are none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("each of {0} mutations needs a share, a finite number above 0")]
pub struct NotShares(pub usize);

impl<'s, W: Types, K: WeightThickness<W::Medium>> PathTarget<'s, W, K> {
    /// The paths that `integrator` finds, seen through `world`, of at least `first_order` edges.
    ///
    /// # Errors
    /// If there is no mutation.
    pub fn new(
        integrator: Bidirectional<'s, W, K>,
        world: &'s dyn PathWorld,
        mutations: Vec<Named<'s>>,
        first_order: u32,
    ) -> Result<Self, NoMutation> {
        if mutations.is_empty() {
            return Err(NoMutation);
        }
        let kinds = mutations.iter().map(|(name, _)| *name).collect();
        let (light, present, proposed) = (Subpath::empty(), PathState::default(), PathState::default());
        let (found, cumulative) = (Vec::new(), (1..=mutations.len()).map(|count| count as f64).collect());
        Ok(Self {
            integrator,
            light,
            world,
            mutations,
            kinds,
            cumulative,
            importance: None,
            first_order,
            ln_present: f64::NAN,
            found,
            present,
            proposed,
        })
    }

    /// The same with mutations that are chosen in proportion to `shares`: any do, since the choice does not look at the state.
    ///
    /// # Errors
    /// If there is not one for each mutation, or one is not positive and finite.
    pub fn with_shares(self, shares: &[f64]) -> Result<Self, NotShares> {
        let count = self.mutations.len();
        let mut sum = 0.0;
        let cumulative: Vec<f64> = shares
            .iter()
            .filter(|share| **share > 0.0)
            .map(|share| {
                sum += share;
                sum
            })
            .collect();
        if shares.len() != count || cumulative.len() != count || !sum.is_finite() {
            return Err(NotShares(count));
        }
        Ok(Self { cumulative, ..self })
    }

    /// The same with a target of brightness · importance of the pixel.
    #[must_use]
    pub fn with_importance(self, importance: &'s Importance) -> Self {
        Self { importance: Some(importance), ..self }
    }

    /// The integrator.
    pub fn integrator(&self) -> &Bidirectional<'s, W, K> {
        &self.integrator
    }

    /// A path of either state.
    #[must_use]
    pub fn path(&self, which: Which) -> &PathState {
        match which {
            Which::Present => &self.present,
            Which::Proposed => &self.proposed,
        }
    }
}

/// One of several paths, in proportion to what each contributes.
struct Reservoir<C> {
    kept: Option<Found<C>>,
    total: f64,
}

impl<C: Spectrum> Reservoir<C> {
    fn offer(&mut self, found: Found<C>, share: f64, source: &mut dyn UniformSource) {
        let value = found.value.max_channel() * share;
        debug_assert!(value >= 0.0 || value.is_nan(), "a contribution of {value} has no density");
        if value == 0.0 {
            return;
        }
        self.total += value;
        if source.next_uniform() * self.total < value {
            self.kept = Some(found);
        }
    }
}

impl<W: Types, K: WeightThickness<W::Medium>> Target<W::Spectrum> for PathTarget<'_, W, K> {
    fn draw(&mut self, mut source: &mut dyn UniformSource) -> f64 {
        let Self { integrator, light, world, importance, first_order, found, proposed, .. } = self;
        let importance = |pixel| importance.map_or(1.0, |importance| importance.of(pixel));
        let (camera, light_paths) = (integrator.weigh().camera, integrator.weigh().light_paths);
        let (pixel, within) = film_position(camera, source);
        let line = camera.ray(pixel, within);
        integrator.trace_light(light, &mut source);
        let mut reservoir = Reservoir { kept: None, total: 0.0 };
        found.clear();
        integrator.strategies(&line, light, &mut source, |_, one| {
            if one.strategy.light + one.strategy.eye > *first_order {
                found.push(one);
            }
        });
        for one in found.drain(..) {
            reservoir.offer(one, pixels(camera) * importance(pixel), source);
        }
        if light_paths > 0.0 {
            for index in (*first_order as usize).saturating_sub(2)..light.steps.len() {
                if let Some((pixel, one)) = integrator.splat(light, index, &mut source) {
                    reservoir.offer(one, light_paths * importance(pixel), source);
                }
            }
        }
        let Reservoir { kept: Some(kept), total } = reservoir else { return 0.0 };
        // Where rounding puts the path beside the image it is none.
        if proposed.set_found(*world, (&kept, integrator.eye(), light), source) { total } else { 0.0 }
    }

    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        let Self { mutations, cumulative, importance, present, proposed, .. } = self;
        let chance = source.next_uniform() * cumulative[cumulative.len() - 1];
        // Rounding may reach the end.
        let kind = cumulative.partition_point(|&sum| sum <= chance).min(cumulative.len() - 1);
        let mut ln_ratio = mutations[kind].1.propose(present, proposed, source);
        if let (Some(ln_ratio), Some(importance)) = (&mut ln_ratio, importance) {
            *ln_ratio += ln(importance.of(proposed.pixel()) / importance.of(present.pixel()));
        }
        let acceptance = if ln_ratio.is_some_and(f64::is_nan) { f64::NAN } else { acceptance(ln_ratio) };
        Proposed { kind, acceptance }
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.present, &mut self.proposed);
        let importance = self.importance.map_or(1.0, |importance| importance.of(self.present.pixel()));
        self.ln_present = self.present.ln_contribution(self.world) + ln(importance);
    }

    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, W::Spectrum>) {
        let path = self.path(which);
        let colour: DVec3 = path.colour();
        let greatest = colour.max_element();
        if greatest > 0.0 {
            let weight = greatest * self.importance.map_or(1.0, |importance| importance.of(path.pixel()));
            film(path.pixel(), W::Spectrum::from_rgb((colour / weight).to_array()) * energy);
        }
    }

    fn ln_present(&self) -> f64 {
        self.ln_present
    }

    fn kinds(&self) -> &[&'static str] {
        &self.kinds
    }
}
