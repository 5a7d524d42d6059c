//! Metropolis sampling: its parameters checked, the target of chains, and the integrator of what they leave out.

use super::bidirectional::BidirectionalPlan;
use super::path_space::PathSpace;
use super::tile_integrator::{AnyIntegrator, SceneVolume, plain};
use super::transport::{Seen, Stage, TransportPlan};
use crate::Failure;
use crate::estimator::InScene;
use crate::spec::{Over, StagesSpec, StepsSpec};
use fairflight_media::{Line, LineThickness};
use fairflight_metropolis::{
    Experience, FromBothEnds, FromCamera, Importance, ImportanceRule, Integrand, Kernels, Lengths,
    Multiplexed, Plan, Primary, Target,
};
use fairflight_paths::transport::{Types, World};
use fairflight_paths::{Integrator, PathTracer};
use fairflight_scene::{Geometry, Segment, Spectrum, Surfaces};
use fairflight_sources::{Layout, Seeded, SmallStep, UniformSource};
use std::sync::OnceLock;

/// Metropolis sampling whose parameters are checked.
#[derive(Debug)]
pub struct MetropolisPlan {
    /// Paths from both ends, with the flights and connections of all.
    pub(super) paths: BidirectionalPlan,
    /// `None` for chains of paths.
    over: Option<Over>,
    space: PathSpace,
    layout: Layout,
    large_step: f64,
    small_step: SmallStep,
    first_order: u32,
    /// The light of each length by a pilot of the first replica that asks: the same for all, which no law asks for.
    light_by_length: OnceLock<Vec<f64>>,
    /// The rule of what chains start from.
    pub(crate) starts: ChainStarts,
    /// Independent images, at most one for each sample of a pixel.
    pub replicas: u32,
    /// True if so many replicas were asked for.
    is_asked_for: bool,
}

/// The states that chains start from, and their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ChainStarts {
    /// A few long chains for each replica.
    Bootstrap {
        /// Independent samples, of which starts are chosen; `None` for the usual share.
        samples: Option<u64>,
        /// Number of chains.
        chains: u32,
        /// What replicas learn from those before.
        learning: Learning,
    },
    /// Short chains for each sample, by the light that it found.
    EverySample {
        /// Steps of a chain.
        steps: u64,
        /// Chains of a sample on average.
        chains: f64,
        /// Most chains of a sample.
        most: Option<u64>,
    },
}

/// Learning of later replicas from earlier ones: each stage has starts of its own, and no replica learns from itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Learning {
    /// Stages of an importance of pixels, and the rule by which it is learnt.
    pub importance: Option<(u32, ImportanceRule)>,
    /// True if sizes of small steps are learnt.
    pub adapts: bool,
}

impl Learning {
    /// The learning of a spec.
    pub(super) fn of(importance: Option<&StagesSpec>, adapts: bool) -> Self {
        Self { importance: importance.map(StagesSpec::rule), adapts }
    }

    /// Stages that share the replicas; sizes of steps are learnt in two at least.
    pub(crate) fn stages(self) -> u32 {
        self.importance.map_or(1, |(stages, _)| stages).max(1 + u32::from(self.adapts))
    }
}

/// Knowledge of a replica from stages before.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lesson<'l> {
    /// Importance of pixels.
    pub importance: Option<&'l Importance>,
    /// Sizes of small steps.
    pub kernels: Option<&'l Kernels>,
}

/// Results of a replica beside its image.
#[derive(Clone, Debug, Default)]
pub(crate) struct Walked {
    /// Walks that were cut.
    pub truncated: u64,
    /// Acceptance of each size of steps in each pixel, where they are learnt.
    pub experience: Option<Experience>,
}

/// Sizes of small steps that adapt: parts of the step, of two octaves each where nothing else is asked for.
pub(crate) const SIZES: u32 = 3;

/// Replicas where nothing else is asked for.
const REPLICAS: u32 = 16;
/// Samples that tell the light of each length to multiplexed chains.
const LENGTH_PILOT: u32 = 4096;
/// The share of the geometric tail of lengths, and its ratio.
const TAIL: (f64, f64) = (0.1, 0.9);

/// Independent samples before the chains of a replica, where nothing else is asked for: a share of its mutations, and the most.
const BOOTSTRAP: (u64, u64) = (10, 100_000);

impl MetropolisPlan {
    /// The steps of a spec, with chains that start like this.
    pub(super) fn build(spec: &StepsSpec, starts: ChainStarts, scene: &InScene<'_>) -> Result<Self, Failure> {
        Ok(Self {
            paths: BidirectionalPlan::build(&spec.joined(), scene)?,
            over: spec.over,
            space: PathSpace::build(spec, scene)?,
            layout: spec.rows,
            large_step: spec.large_step,
            small_step: spec.step,
            first_order: spec.first_order(),
            light_by_length: OnceLock::new(),
            starts,
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
        match self.starts {
            ChainStarts::Bootstrap { samples: first, chains, learning } => {
                let (replicas, stages) = (self.replicas.min(samples), learning.stages());
                if stages > 1 && replicas < 2 * stages {
                    let key = if learning.importance.is_some() { "importance.stages" } else { "adaptation" };
                    return Err(Failure::refused(format!(
                        "integrator.{key}: {stages} stages need two replicas each to learn from, found {replicas}"
                    )));
                }
                let mutations = pixels * u64::from(samples / self.replicas.min(samples));
                Self::sizes(first, chains, mutations).map(|_| ())
            }
            ChainStarts::EverySample { .. } => Ok(()),
        }
    }

    /// The sizes of a replica of so many mutations in so many chains.
    ///
    /// # Errors
    /// If they are fewer than the chains.
    pub(crate) fn sizes(bootstrap: Option<u64>, chains: u32, mutations: u64) -> Result<Plan, Failure> {
        let (share, most) = BOOTSTRAP;
        let bootstrap = bootstrap.unwrap_or_else(|| (mutations / share).clamp(1, most));
        Plan::new(bootstrap, chains.into(), mutations)
            .map_err(|error| Failure::refused(format!("integrator.chains: {error}")))
    }

    /// The size of small steps where nothing is learnt.
    pub(crate) fn small_step(&self) -> SmallStep {
        self.small_step
    }

    /// What replicas learn from those before.
    pub(crate) fn learning(&self) -> Learning {
        match self.starts {
            ChainStarts::Bootstrap { learning, .. } => learning,
            ChainStarts::EverySample { .. } => Learning::default(),
        }
    }

    /// Chains over `integrand`.
    fn over<C: Spectrum>(
        &self,
        (integrand, lesson): (&mut dyn Integrand<C>, Lesson<'_>),
        work: &mut dyn FnMut(&mut dyn Target<C>),
    ) -> Result<Option<Experience>, Failure> {
        let target = Primary::new(integrand).with_small_step(self.small_step).with_layout(self.layout);
        let target = target.with_large_step(self.large_step);
        let mut target =
            target.map_err(|error| Failure::refused(format!("integrator.large_step: {error}")))?;
        if let Some(importance) = lesson.importance {
            target = target.with_importance(importance);
        }
        if let Some(kernels) = lesson.kernels {
            target = target.with_kernels(kernels);
        }
        work(&mut target);
        Ok(target.take_experience())
    }

    /// Does `work` with the target of chains in a volume, which is what a lesson makes of it.
    ///
    /// # Errors
    /// If a parameter is not lawful there.
    pub(crate) fn with_target<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        (stage, lesson): (Stage<'s, C>, Lesson<'s>),
        work: &mut dyn FnMut(&mut dyn Target<C>),
    ) -> Result<Walked, Failure> {
        let Stage { lights, surfaces, camera, unlawful, .. } = stage;
        let joined = || self.paths.joined(volume, stage);
        match self.over {
            None => {
                let truncated = self.space.with_target((joined(), lesson.importance), work)?;
                Ok(Walked { truncated, experience: None })
            }
            Some(Over::Bidirectional) => {
                let mut integrand = FromBothEnds::new(joined()).with_first_order(self.first_order);
                let experience = self.over((&mut integrand, lesson), work)?;
                Ok(Walked { truncated: integrand.integrator().truncated(), experience })
            }
            Some(Over::Multiplexed) => {
                let pilot = || FromBothEnds::new(joined()).light_by_length(LENGTH_PILOT, &mut Seeded::new(0));
                let light = self.light_by_length.get_or_init(pilot);
                let seen = light.get(self.first_order as usize - 1..).unwrap_or_default();
                let lengths = Lengths::new(self.first_order, seen, TAIL)
                    .or_else(|_| Lengths::new(self.first_order, &[], TAIL))
                    .expect("a tail is a law of lengths");
                let mut integrand = Multiplexed::new(joined(), lengths);
                let experience = self.over((&mut integrand, lesson), work)?;
                Ok(Walked { truncated: integrand.integrator().truncated(), experience })
            }
            Some(Over::PathTracer) => {
                let TransportPlan { walk, shadow, heuristic } = self.transport();
                let world = World::<Seen<'s, M, C, Surfaces<C>>>::new(volume, surfaces, lights);
                let tracer = PathTracer::new(world, walk.walk(), shadow.worker(unlawful), *heuristic)
                    .with_max_vertices(self.paths.max_vertices);
                let mut integrand = FromCamera::new(camera, tracer);
                let experience = self.over((&mut integrand, lesson), work)?;
                Ok(Walked { truncated: integrand.integrator().truncated(), experience })
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
