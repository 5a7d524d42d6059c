//! Metropolis sampling: its parameters checked, the integrand that chains move over, and the integrator of what they leave out.

use super::bidirectional::BidirectionalPlan;
use super::integrator::{AnyIntegrator, SceneVolume, plain};
use super::transport::{Seen, Stage, TransportPlan};
use crate::Failure;
use crate::estimator::InScene;
use crate::spec::{MetropolisSpec, Over};
use fairflight_media::{Line, LineThickness};
use fairflight_metropolis::{FromBothEnds, FromCamera, Integrand, Plan, Primary};
use fairflight_paths::transport::{Types, World};
use fairflight_paths::{Integrator, PathTracer};
use fairflight_scene::{Geometry, Segment, Spectrum, Surfaces};
use fairflight_sources::{Layout, SmallStep, UniformSource};

/// Metropolis sampling whose parameters are checked.
#[derive(Debug)]
pub struct MetropolisPlan {
    /// Paths from both ends, with the flights and connections of all.
    pub(super) paths: BidirectionalPlan,
    over: Over,
    layout: Layout,
    large_step: f64,
    small_step: SmallStep,
    bootstrap: Option<u64>,
    chains: u32,
    first_order: u32,
    /// Independent images, at most one for each sample of a pixel.
    pub replicas: u32,
    /// True if so many replicas were asked for.
    is_asked_for: bool,
}

/// Replicas where nothing else is asked for.
const REPLICAS: u32 = 16;

/// Independent samples before the chains of a replica, where nothing else is asked for: a share of its mutations, and the most.
const BOOTSTRAP: (u64, u64) = (10, 100_000);

impl MetropolisPlan {
    pub(super) fn build(spec: &MetropolisSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        Ok(Self {
            paths: BidirectionalPlan::build(&spec.from_both_ends(), scene)?,
            over: spec.over,
            layout: spec.rows,
            large_step: spec.large_step,
            small_step: spec.step,
            bootstrap: spec.bootstrap,
            chains: spec.chains,
            first_order: spec.first_order(),
            replicas: spec.replicas.unwrap_or(REPLICAS),
            is_asked_for: spec.replicas.is_some(),
        })
    }

    /// The flights and connections of paths.
    pub(super) fn transport(&self) -> &TransportPlan {
        &self.paths.transport
    }

    /// Checks that so many samples for each of so many pixels make as many replicas as were asked for, each of as many chains.
    ///
    /// # Errors
    /// If they do not.
    pub(super) fn check(&self, pixels: u64, samples: u32) -> Result<(), Failure> {
        if self.is_asked_for && self.replicas > samples {
            return Err(Failure::refused(format!(
                "integrator.replicas: {} of them need at least as many samples per pixel, found {samples}",
                self.replicas
            )));
        }
        self.sizes(pixels * u64::from(samples / self.replicas.min(samples))).map(|_| ())
    }

    /// The sizes of a replica of so many mutations.
    ///
    /// # Errors
    /// If they are fewer than the chains.
    pub(crate) fn sizes(&self, mutations: u64) -> Result<Plan, Failure> {
        let (share, most) = BOOTSTRAP;
        let bootstrap = self.bootstrap.unwrap_or_else(|| (mutations / share).clamp(1, most));
        Plan::new(bootstrap, self.chains.into(), mutations)
            .map_err(|error| Failure::refused(format!("integrator.chains: {error}")))
    }

    /// Chains over `integrand`.
    ///
    /// # Errors
    /// If the probability of a large step is none.
    pub(crate) fn target<'i, C: Spectrum>(
        &self,
        integrand: &'i mut dyn Integrand<C>,
    ) -> Result<Primary<'i, C>, Failure> {
        let target = Primary::new(integrand).with_small_step(self.small_step).with_layout(self.layout);
        target
            .with_large_step(self.large_step)
            .map_err(|error| Failure::refused(format!("integrator.large_step: {error}")))
    }

    /// Does `work` with the integrand in a volume; gives the number of walks that were cut.
    pub(crate) fn over<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
        work: &mut dyn FnMut(&mut dyn Integrand<C>),
    ) -> u64 {
        let Stage { lights, surfaces, camera, unlawful, .. } = stage;
        match self.over {
            Over::Bidirectional => {
                let joined = self.paths.joined(volume, stage);
                let mut integrand = FromBothEnds::new(joined).with_first_order(self.first_order);
                work(&mut integrand);
                integrand.integrator().truncated()
            }
            Over::PathTracer => {
                let TransportPlan { walk, shadow, heuristic } = self.transport();
                let world = World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights);
                let tracer = PathTracer::new(world, walk.walk(), shadow.worker(unlawful), *heuristic)
                    .with_max_vertices(self.paths.max_vertices);
                let mut integrand = FromCamera::new(camera, tracer);
                work(&mut integrand);
                integrand.integrator().truncated()
            }
        }
    }

    /// The integrator of one tile: what chains leave out.
    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> AnyIntegrator<'s, C> {
        if self.first_order == 1 {
            return plain(Nothing);
        }
        let Stage { lights, surfaces, unlawful, .. } = stage;
        let world = World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights);
        plain(SeenDirectly { world, shadow: self.transport().shadow.worker(unlawful) })
    }
}

/// Light of paths of one edge: of surfaces and the background, where nothing stands before them.
struct SeenDirectly<'s, W: Types> {
    world: World<'s, W>,
    shadow: W::Shadow,
}

impl<W: Types> Integrator<W::Spectrum> for SeenDirectly<'_, W> {
    fn radiance(&mut self, line: &Line, source: &mut impl UniformSource) -> W::Spectrum {
        let Self { world, shadow } = self;
        let mut segment = Segment { line: *line, length: f64::INFINITY, from: None, to: None };
        let hit = world.surfaces.intersect(&segment);
        let emitted = match &hit {
            Some(hit) => hit.surface.emission,
            None => world.lights.background.radiance(line.direction),
        };
        if emitted == W::Spectrum::ZERO {
            return emitted;
        }
        if let Some(hit) = hit {
            (segment.length, segment.to) = (hit.distance, Some(hit.index));
        }
        emitted * world.transmittance(&segment, shadow, source)
    }
}

/// No light.
struct Nothing;

impl<C: Spectrum> Integrator<C> for Nothing {
    fn radiance(&mut self, _line: &Line, _source: &mut impl UniformSource) -> C {
        C::ZERO
    }
}
