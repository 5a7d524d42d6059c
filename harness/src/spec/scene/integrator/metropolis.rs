//! Metropolis sampling, and energy redistribution by its steps.

use super::path_tracer::{MOST_VERTICES, PathTracerSpec};
use super::transport::TransportSpec;
use super::walk::Collisions;
use super::{BidirectionalSpec, IntegratorKind, IntegratorSpec};
use crate::reader::kind::Among;
use crate::reader::rule::{Maybe, Nullable, Positive, Rule, Whole};
use crate::reader::{Node, Object};
use crate::{Failure, keys, kind, words};
use fairflight_metropolis::{Aim, ImportanceRule};
use fairflight_sources::{Layout, SmallStep};
use serde_json::{Map, Value, json};

/// The space that chains move in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Variates of an integrator.
    Primary,
    /// Paths.
    Path,
}

words! {
    /// The space that chains move in.
    pub(super) SpaceWord for Space {
        "primary" => Space::Primary,
        "path" => Space::Path,
    }
}

/// The integrator whose variates are the states of chains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Paths from both ends, joined in all ways.
    Bidirectional,
    /// Paths from the camera.
    PathTracer,
    /// Paths from both ends, joined in one way each.
    Multiplexed,
}

words! {
    /// The integrator whose variates are the states of chains.
    pub(super) OverWord for Over {
        "bidirectional" => Over::Bidirectional,
        "path_tracer" => Over::PathTracer,
        "multiplexed" => Over::Multiplexed,
    }
}

words! {
    /// The order of variates.
    pub(super) RowsWord for Layout {
        "per_vertex" => Layout::Rows,
        "flat" => Layout::Flat,
    }
}

keys! {
    /// States of chains and their steps.
    pub StepsSpec {
        /// The space that chains move in: the variates of an integrator, or paths of bidirectional path tracing.
        space: Space as SpaceWord,
        /// The integrator whose variates they are, in primary space: bidirectional, path_tracer, or multiplexed, which joins paths in one way each
        /// (hachisuka-2014).
        over: Option<Over> as Maybe<OverWord> = None,
        /// The mutations of paths, in path space: a list, each of their variants as probable, or an object with the share of each. All by default,
        /// bidirectional with a closed form only.
        mutations: Option<Vec<(MutationKind, f64)>> as Maybe<Mutations> = None,
        /// The order of variates: by the vertex that they are drawn for, or one after the other.
        rows: Layout as RowsWord = Layout::Rows,
        /// The probability of a step that draws all variates afresh; with 0 a chain stays in the mode where it starts, without a bias.
        large_step: f64 as Probability = 0.3,
        /// The least and the largest step of a variate.
        step: SmallStep as Steps = SmallStep::default(),
        /// Independent images, which share the samples: errors are told by them alone. By default 16, or one for each sample of a pixel.
        replicas: Option<u32> as Maybe<Whole<1, MOST_REPLICAS>> = None,
        /// Edges of the shortest paths that chains make: with 2, which a path tracer cannot, and path space must, lights seen directly are drawn pixel by pixel. 2 by default, 1
        /// over path_tracer.
        first_order: Option<u32> as Maybe<Whole<1, 2>> = None,
        /// The flights, connections and weights of paths.
        transport: TransportSpec as Among,
    }
}

kind! {
    /// Chains of paths (kelemen-2002, antwerpen-2011 chapter 6, raab-2008 section 4.4), among surfaces: replicas of the whole image, each without a
    /// start-up bias.
    MetropolisSpec = "metropolis" {
        /// Independent samples of each replica, by which it chooses its starts and scales its image; by default a tenth of its mutations, at most 100000.
        bootstrap: Option<u64> as Maybe<Whole<1, MOST>> = None,
        /// Chains of each replica.
        chains: u32 as Whole<1, MOST> = 1,
        /// More of the chains where the image is noisy (hoberock-2010), as stages before found: { "stages": n, "floor": 0.1 }; null for brightness alone.
        importance: Option<StagesSpec> as Nullable<Among> = None,
        /// Sizes of small steps by pixel, in primary space (lai-2007): learnt by two halves of the replicas from each other, or not at all.
        adaptation: Adaptation as AdaptationWord = Adaptation::None,
        /// The states of chains and their steps.
        steps: StepsSpec as Among,
    }
    check MetropolisSpec::check
}

keys! {
    /// Stages of replicas, of which each follows an importance that those before it taught.
    pub StagesSpec {
        /// Number of stages, which share the replicas evenly: at least two for each.
        stages: u32 as Whole<2, 100> = 2,
        /// The least importance of a pixel, in units of the mean importance.
        floor: f64 as Positive = ImportanceRule::default().floor,
        /// Pixels on each side that means and variances are averaged over before a stage learns from them.
        radius: u32 as Whole<0, 100> = ImportanceRule::default().radius,
        /// What visits of the pixels are spread for: the squared error of the image, that of each pixel relative to its mean, or as many visits to each.
        aim: Aim as AimWord = Aim::SquaredError,
    }
}

words! {
    /// Aim of the spread of a chain's visits.
    pub(super) AimWord for Aim {
        "squared_error" => Aim::SquaredError,
        "relative_error" => Aim::RelativeError,
        "even_visits" => Aim::EvenVisits,
    }
}

impl StagesSpec {
    /// Number of stages, and the rule by which they learn.
    pub(crate) fn rule(&self) -> (u32, ImportanceRule) {
        let Self { stages, floor, radius, aim } = *self;
        (stages, ImportanceRule { aim, floor, radius })
    }
}

/// Learning of sizes of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adaptation {
    /// One size everywhere.
    None,
    /// Two halves of the replicas teach each other.
    Crosswise,
}

words! {
    /// Learning of sizes of steps.
    pub(super) AdaptationWord for Adaptation {
        "none" => Adaptation::None,
        "crosswise" => Adaptation::Crosswise,
    }
}

impl MetropolisSpec {
    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        if self.adaptation == Adaptation::Crosswise && self.steps.space == Space::Path {
            return Err(object
                .required("adaptation")?
                .refuse("crosswise needs space: primary: its sizes are those of steps of variates"));
        }
        self.steps.check(object)
    }
}

kind! {
    /// Short chains from every sample that finds light, as many as it found (cline-2005, antwerpen-2011 section 6.8), among surfaces.
    EnergyRedistributionSpec = "energy_redistribution" {
        /// Steps of a chain.
        chain_length: u64 as Whole<1, MOST> = 100,
        /// Chains of a sample, on average.
        chains_per_sample: f64 as Positive = 1.0,
        /// Most chains of a sample, each of which then carries more energy; null for any number.
        most_chains: Option<u64> as Nullable<Whole<1, MOST>> = None,
        /// The states of chains and their steps.
        steps: StepsSpec as Among,
    }
    check |spec, object| spec.steps.check(object)
}

/// More are a slip of the keyboard.
const MOST: u64 = 1_000_000_000;
/// Each replica is an image in memory.
const MOST_REPLICAS: u64 = 1_000;

/// A mutation of paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MutationKind {
    /// Another point of the film, distances kept or scaled.
    Lens,
    /// The same onto the places of smooth vertices.
    LaiLens,
    /// Another direction towards the camera.
    Caustic,
    /// Another direction at a vertex in the medium, towards the camera or the light.
    Scattering,
    /// Another distance of a vertex in the medium, along either edge.
    Propagation,
    /// A fresh path.
    Bidirectional,
}

words! {
    /// A mutation of paths.
    pub(super) MutationWord for MutationKind {
        "lens" => MutationKind::Lens,
        "lai_lens" => MutationKind::LaiLens,
        "caustic" => MutationKind::Caustic,
        "scattering" => MutationKind::Scattering,
        "propagation" => MutationKind::Propagation,
        "bidirectional" => MutationKind::Bidirectional,
    }
}

impl MutationKind {
    /// Variants that share what the mutation is given: lens with distances kept and scaled, the two others towards camera and light.
    #[must_use]
    pub fn variants(self) -> f64 {
        if matches!(self, Self::Lens | Self::Scattering | Self::Propagation) { 2.0 } else { 1.0 }
    }
}

/// A list of mutations, not empty, or an object with their shares.
#[derive(Debug)]
pub(super) struct Mutations;

impl Rule<Vec<(MutationKind, f64)>> for Mutations {
    fn read(node: &Node<'_>) -> Result<Vec<(MutationKind, f64)>, Failure> {
        let kinds: Vec<_> = if node.is_object() {
            let object = node.object()?;
            let given = MutationWord::WORDS
                .iter()
                .filter_map(|&(word, kind)| Some((kind, object.optional(word)?)))
                .map(|(kind, share)| Ok((kind, share.positive()?)))
                .collect::<Result<_, Failure>>()?;
            object.finish()?;
            given
        } else {
            let read = |item| <MutationWord as Rule<MutationKind>>::read(item);
            let each = |item| read(item).map(|kind| (kind, kind.variants()));
            node.items()?.iter().map(each).collect::<Result<_, _>>()?
        };
        if kinds.is_empty() { Err(node.refuse("must name at least one mutation")) } else { Ok(kinds) }
    }
    fn written(kinds: &Vec<(MutationKind, f64)>) -> Value {
        let word = |kind| <MutationWord as Rule<_>>::written(kind);
        if kinds.iter().all(|(kind, share)| *share == kind.variants()) {
            return kinds.iter().map(|(kind, _)| word(kind)).collect();
        }
        let shares = kinds
            .iter()
            .map(|(kind, share)| (word(kind).as_str().unwrap_or_default().to_owned(), json!(share)));
        Value::Object(shares.collect::<Map<_, _>>())
    }
    fn schema() -> Value {
        let share = json!({ "type": "number", "exclusiveMinimum": 0 });
        let shares: Map<_, _> =
            MutationWord::WORDS.iter().map(|(word, _)| ((*word).to_owned(), share.clone())).collect();
        json!({ "anyOf": [
            { "type": "array", "items": <MutationWord as Rule<MutationKind>>::schema(), "minItems": 1 },
            { "type": "object", "properties": shares, "additionalProperties": false, "minProperties": 1 },
        ] })
    }
}

/// A number from 0 to 1.
#[derive(Debug)]
pub(super) struct Probability;

impl Rule<f64> for Probability {
    fn read(node: &Node<'_>) -> Result<f64, Failure> {
        node.within(0.0, 1.0)
    }
    fn written(probability: &f64) -> Value {
        json!(probability)
    }
    fn schema() -> Value {
        json!({ "type": "number", "minimum": 0, "maximum": 1 })
    }
}

/// The least and the largest step of a variate.
#[derive(Debug)]
pub(super) struct Steps;

impl Rule<SmallStep> for Steps {
    fn read(node: &Node<'_>) -> Result<SmallStep, Failure> {
        let numbers = node.numbers()?;
        let [least, largest] = numbers[..] else { return Err(node.refuse("must be a list of two steps")) };
        SmallStep::new(least, largest).map_err(|error| node.refuse(error.to_string()))
    }
    fn written(step: &SmallStep) -> Value {
        json!([step.least(), step.largest()])
    }
    fn schema() -> Value {
        json!({ "type": "array", "items": { "type": "number", "exclusiveMinimum": 0, "maximum": 0.5 }, "minItems": 2, "maxItems": 2 })
    }
}

impl StepsSpec {
    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        let (own, other, foreign) = match self.space {
            Space::Primary => ("primary", "path", &["mutations"][..]),
            Space::Path => ("path", "primary", &["over", "rows", "large_step", "step"][..]),
        };
        if let Some(key) = foreign.iter().find(|key| object.has(key)) {
            return Err(object
                .required("space")?
                .refuse(format!("{own} has no {key}: that is a key of {other}")));
        }
        if self.space == Space::Primary && self.over.is_none() {
            object.required("over")?;
        }
        if self.space == Space::Path && self.first_order == Some(1) {
            return Err(object
                .required("first_order")?
                .refuse("1 needs space: primary: no mutation changes a path of one edge"));
        }
        if self.transport.walk.colour == Collisions::Separate {
            return Err(object
                .required("colour")?
                .refuse("separate would be three targets: render three scenes"));
        }
        if self.over == Some(Over::PathTracer) && self.first_order == Some(2) {
            return Err(object.required("first_order")?.refuse(
                "2 needs paths from both ends: the variates of a path tracer do not tell light seen directly apart",
            ));
        }
        Ok(())
    }

    /// Edges of the shortest paths that chains make.
    #[must_use]
    pub fn first_order(&self) -> u32 {
        self.first_order.unwrap_or(if self.over == Some(Over::PathTracer) { 1 } else { 2 })
    }

    /// The integrator that draws the same image by independent samples.
    #[must_use]
    pub fn independent(&self) -> IntegratorSpec {
        match self.over {
            None | Some(Over::Bidirectional | Over::Multiplexed) => self.joined().into(),
            Some(Over::PathTracer) => PathTracerSpec::of_all_lengths(self.transport.clone()).into(),
        }
    }

    /// Bidirectional path tracing with the same paths.
    pub(crate) fn joined(&self) -> BidirectionalSpec {
        BidirectionalSpec {
            light_paths_per_pixel: 1,
            thickness: None,
            connection_roulette: None,
            point_caustics: false,
            max_vertices: MOST_VERTICES as u32,
            strategies: None,
            weighted: true,
            light_image: true,
            transport: self.transport.clone(),
        }
    }
}

impl IntegratorKind for MetropolisSpec {
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.steps.transport)
    }
    fn bias(&self) -> Option<&'static str> {
        super::of_a_baseline(self.steps.transport.is_biased_baseline())
    }
}

impl IntegratorKind for EnergyRedistributionSpec {
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.steps.transport)
    }
    fn bias(&self) -> Option<&'static str> {
        super::of_a_baseline(self.steps.transport.is_biased_baseline())
    }
}
