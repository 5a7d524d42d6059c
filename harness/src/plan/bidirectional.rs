//! Bidirectional path tracing: its parameters checked, and the integrator of one tile.

use super::Tally;
use super::tile_integrator::{AnyIntegrator, Counts, SceneVolume, Splatted, TileIntegrator};
use super::transport::{Seen, Stage, TransportPlan};
use crate::Failure;
use crate::estimator::InScene;
use crate::spec::{BidirectionalSpec, ThicknessSpec};
use fairflight_bidirectional::{
    Bidirectional, Exact, Found, Midpoint, Neglected, Strategy, Subpath, Walking, Weigh, WeightThickness,
};
use fairflight_media::{Line, LineThickness, Ray};
use fairflight_paths::transport::{Types, World};
use fairflight_scene::{Spectrum, Surfaces};
use fairflight_sources::{Seeded, UniformSource};
use std::num::NonZeroU32;

/// Nodes of the midpoint rule where there is no closed form.
const NODES: NonZeroU32 = NonZeroU32::new(4).unwrap();

/// Bidirectional path tracing whose parameters are checked.
#[derive(Debug)]
pub struct BidirectionalPlan {
    /// The flights and connections of both paths.
    pub transport: TransportPlan,
    connection_roulette: Option<f64>,
    pub(super) thickness: ThicknessSpec,
    pub(super) max_vertices: u32,
    point_caustics: bool,
    light_paths_per_pixel: u32,
    light_image: bool,
    strategies: Option<Vec<Strategy>>,
    weighted: bool,
}

/// Paths from both ends, among surfaces.
pub(super) type Joined<'s, M, C> = Bidirectional<'s, Seen<'s, M, C, Surfaces<C>>, ThicknessSpec>;

impl BidirectionalPlan {
    pub(super) fn build(spec: &BidirectionalSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let usual =
            if scene.medium.has_closed_form() { ThicknessSpec::Exact } else { ThicknessSpec::Nodes(NODES) };
        Ok(Self {
            transport: TransportPlan::build(&spec.transport, scene)?,
            connection_roulette: spec.connection_roulette,
            thickness: spec.thickness.unwrap_or(usual),
            max_vertices: spec.max_vertices,
            point_caustics: spec.point_caustics,
            light_paths_per_pixel: spec.light_paths_per_pixel,
            light_image: spec.light_image,
            strategies: spec.strategies.clone(),
            weighted: spec.weighted,
        })
    }

    /// The integrator of one tile. Surfaces are asked for also where there are none: that costs next to nothing, and saves a copy.
    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> AnyIntegrator<'s, C> {
        let integrator = self.joined(volume, stage);
        Box::new(OfTile { plan: self, integrator, light: Subpath::empty(), found: nothing(), bad: None })
    }

    /// Paths from both ends.
    pub(super) fn joined<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> Joined<'s, M, C> {
        let Stage { lights, surfaces, camera, emitters, mean, unlawful, .. } = stage;
        let TransportPlan { walk, shadow, heuristic } = &self.transport;
        let [columns, rows] = camera.resolution().map(f64::from);
        let per_pixel = if self.light_image { f64::from(self.light_paths_per_pixel) } else { 0.0 };
        let weigh = Weigh {
            world: World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights),
            camera,
            emitters,
            thickness: self.thickness,
            heuristic: *heuristic,
            light_paths: per_pixel * columns * rows,
        };
        let Self { max_vertices, point_caustics, .. } = *self;
        let walking = Walking { walk: walk.walk(), max_vertices, point_caustics };
        // Nothing is left to chance before something is known, or where all is dark.
        let threshold = self.connection_roulette.zip(mean).map(|(share, mean)| share * mean);
        Bidirectional::new(weigh, walking, shadow.worker(unlawful))
            .with_connection_roulette(threshold.filter(|&threshold| threshold > 0.0))
    }
}

impl<M: LineThickness> WeightThickness<M> for ThicknessSpec {
    #[inline]
    fn thickness(&self, ray: &Ray<&M>) -> f64 {
        match self {
            Self::Exact => Exact.thickness(ray),
            Self::Nodes(nodes) => Midpoint(*nodes).thickness(ray),
            Self::Neglected => WeightThickness::<M>::thickness(&Neglected, ray),
        }
    }
}

/// Nothing, by no strategy.
fn nothing<C>() -> Splatted<C> {
    Splatted { tally: Tally::zero(), ..Splatted::none() }
}

/// The integrator of one tile: each sample of a pixel traces its light paths, and connects with the first of them.
struct OfTile<'s, W: Types> {
    plan: &'s BidirectionalPlan,
    integrator: Bidirectional<'s, W, ThicknessSpec>,
    light: Subpath<W::Spectrum>,
    found: Splatted<W::Spectrum>,
    /// The first contribution that is not finite.
    bad: Option<Strategy>,
}

impl<W: Types<Medium: LineThickness>> TileIntegrator<W::Spectrum> for OfTile<'_, W> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> W::Spectrum {
        let mut own = source.clone();
        let mut radiance = self.trace_light(&mut own);
        let Self { plan, integrator, light, found, bad } = self;
        integrator.strategies(line, light, &mut own, |_, one| {
            if let Some(value) = plan.counted(&one) {
                radiance += value;
                found.tally.add(one.strategy, value.mean());
                if !value.is_finite() {
                    bad.get_or_insert(one.strategy);
                }
            }
        });
        for _ in 1..self.plan.light_paths_per_pixel {
            radiance += self.trace_light(&mut own);
        }
        *source = own;
        radiance
    }

    fn counts(&self) -> Counts {
        Counts::cut(self.integrator.truncated())
    }

    fn splatted(&mut self) -> Splatted<W::Spectrum> {
        std::mem::replace(&mut self.found, nothing())
    }

    fn culprit(&self) -> Option<String> {
        self.bad.map(|Strategy { light, eye }| format!("strategy [s, t] = [{light}, {eye}]"))
    }
}

impl<W: Types<Medium: LineThickness>> OfTile<'_, W> {
    /// Traces a light path, and adds it to the light image; gives what of it is not finite, else 0.
    fn trace_light(&mut self, source: &mut impl UniformSource) -> W::Spectrum {
        let Self { plan, integrator, light, found, bad } = self;
        integrator.trace_light(light, source);
        found.light_paths += 1;
        found.unseen_power += light.unseen.map_or(0.0, Spectrum::mean);
        let mut lost = W::Spectrum::ZERO;
        if plan.light_image {
            for index in 0..light.steps.len() {
                let Some((pixel, one)) = integrator.splat(light, index, source) else { continue };
                let Some(value) = plan.counted(&one) else { continue };
                if value.is_finite() {
                    found.splats.push((pixel, value));
                    found.tally.add(one.strategy, value.mean());
                } else {
                    lost += value;
                    bad.get_or_insert(one.strategy);
                }
            }
        }
        lost
    }
}

impl BidirectionalPlan {
    /// Light that counts of what a strategy found: none if it is not asked for. What a weight of 0 has taken is not given back.
    #[inline]
    fn counted<C: Spectrum>(&self, found: &Found<C>) -> Option<C> {
        let is_asked_for = self.strategies.as_ref().is_none_or(|asked| asked.contains(&found.strategy));
        let is_whole = self.weighted || found.weight < f64::MIN_POSITIVE;
        is_asked_for.then(|| if is_whole { found.value } else { found.value * found.weight.recip() })
    }
}
