//! Paths as the states of a chain.

use super::{PathState, PathWorld};
use crate::integrand::{film_position, pixels};
use crate::{Film, Mutation, Proposed, Target, Which, acceptance};
use fairflight_bidirectional::{Bidirectional, Found, Subpath, WeightThickness};
use fairflight_paths::transport::Types;
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use glam::DVec3;
use std::fmt;

/// A mutation, and the name that its acceptance is told by.
pub type Named<'m> = (&'static str, Box<dyn Mutation<PathState> + 'm>);

/// Paths of at least `first_order` edges that bidirectional path tracing finds, moved by mutations that are chosen equally often (antwerpen-2011 sections 6.2
/// to 6.4).
///
/// ```text
/// f* = the greatest channel of the contribution
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
    first_order: u32,
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
        let found = Vec::new();
        Ok(Self { integrator, light, world, mutations, kinds, first_order, found, present, proposed })
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
        let Self { integrator, light, world, first_order, found, proposed, .. } = self;
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
            reservoir.offer(one, pixels(camera), source);
        }
        if light_paths > 0.0 {
            for index in (*first_order as usize).saturating_sub(2)..light.steps.len() {
                if let Some((_, one)) = integrator.splat(light, index, &mut source) {
                    reservoir.offer(one, light_paths, source);
                }
            }
        }
        let Reservoir { kept: Some(kept), total } = reservoir else { return 0.0 };
        // Where rounding puts the path beside the image it is none.
        if proposed.set_found(*world, (&kept, integrator.eye(), light), source) { total } else { 0.0 }
    }

    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        let Self { mutations, present, proposed, .. } = self;
        let kind = (source.next_uniform() * mutations.len() as f64) as usize;
        let ln_ratio = mutations[kind].1.propose(present, proposed, source);
        let acceptance = if ln_ratio.is_some_and(f64::is_nan) { f64::NAN } else { acceptance(ln_ratio) };
        Proposed { kind, acceptance }
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.present, &mut self.proposed);
    }

    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, W::Spectrum>) {
        let path = self.path(which);
        let colour: DVec3 = path.colour();
        let greatest = colour.max_element();
        if greatest > 0.0 {
            film(path.pixel(), W::Spectrum::from_rgb((colour / greatest).to_array()) * energy);
        }
    }

    fn kinds(&self) -> &[&'static str] {
        &self.kinds
    }
}
