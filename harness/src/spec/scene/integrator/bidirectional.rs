//! Bidirectional path tracing.

use super::IntegratorKind;
use super::path_tracer::MOST_VERTICES;
use super::transport::TransportSpec;
use crate::reader::kind::Among;
use crate::reader::rule::{Flag, Maybe, Nullable, Own, Rule, Ruled, Whole};
use crate::reader::{Node, Object};
use crate::{Failure, kind};
use fairflight_bidirectional::Strategy;
use serde_json::{Value, json};
use std::num::NonZeroU32;

kind! {
    /// All ways to join a path from the camera and one from a light (lafortune-1996, antwerpen-2011 chapters 4 and 5), among surfaces.
    BidirectionalSpec = "bidirectional" {
        /// Light paths for each sample of a pixel: all light the image, the first is connected with the path from the camera.
        light_paths_per_pixel: u32 as Whole<1, MOST> = 1,
        /// Optical thickness in weights: "exact", "neglected", or { "nodes": n } of the midpoint rule; by default in closed form where
        /// there is one, else 4 nodes.
        thickness: Option<ThicknessSpec> as Maybe<Own> = None,
        /// The share of the image's mean radiance, as passes before found it, below which a connection is made by chance; null for all.
        connection_roulette: Option<f64> as Nullable<Share> = None,
        /// True to follow the light of points and directions straight into smooth surfaces, which a path tracer cannot see.
        point_caustics: bool as Flag = false,
        /// Longer subpaths are cut, a bias.
        max_vertices: u32 as Whole<1, MOST_VERTICES> = MOST_VERTICES as u32,
        /// "all", or a list of [s, t] with s vertices from a light and t from the camera: a part of the light, a bias.
        strategies: Option<Vec<Strategy>> as Strategies = None,
        /// False to count what these strategies find without their weights, each as if it were alone: a bias.
        weighted: bool as Flag = true,
        /// False to leave out connections of light paths with the camera (t = 1), in weights as well.
        light_image: bool as Flag = true,
        /// The flights, connections and weights of both paths.
        transport: TransportSpec as Among,
    }
    check BidirectionalSpec::check
}

/// More light paths per pixel are a slip of the keyboard.
const MOST: u64 = 10_000;

/// An optical thickness in weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThicknessSpec {
    /// In closed form.
    Exact,
    /// By the midpoint rule of so many nodes.
    Nodes(NonZeroU32),
    /// 0.
    Neglected,
}

impl Ruled for ThicknessSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if node.is_object() {
            let object = node.object()?;
            let nodes: u32 = <Whole<1, MOST> as Rule<u32>>::read(&object.required("nodes")?)?;
            object.finish()?;
            return Ok(Self::Nodes(NonZeroU32::new(nodes).unwrap_or(NonZeroU32::MIN)));
        }
        match node.text() {
            Ok("exact") => Ok(Self::Exact),
            Ok("neglected") => Ok(Self::Neglected),
            _ => Err(node.refuse("must be \"exact\", \"neglected\", or an object of nodes")),
        }
    }
    fn written(&self) -> Value {
        match self {
            Self::Exact => json!("exact"),
            Self::Nodes(nodes) => json!({ "nodes": nodes }),
            Self::Neglected => json!("neglected"),
        }
    }
    fn schema() -> Value {
        let nodes = <Whole<1, MOST> as Rule<u32>>::schema();
        json!({ "anyOf": [
            { "enum": ["exact", "neglected"] },
            { "type": "object", "required": ["nodes"], "additionalProperties": false, "properties": { "nodes": nodes } },
        ] })
    }
}

/// A number above 0 and at most 1.
#[derive(Debug)]
pub(super) struct Share;

impl Rule<f64> for Share {
    fn read(node: &Node<'_>) -> Result<f64, Failure> {
        let refuse = |_| node.refuse("must be a number above 0 and at most 1, or null");
        let share = node.positive().map_err(refuse)?;
        node.within(0.0, 1.0).map_err(refuse)?;
        Ok(share)
    }
    fn written(share: &f64) -> Value {
        json!(share)
    }
    fn schema() -> Value {
        json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 })
    }
}

/// All strategies, or a list of some.
#[derive(Debug)]
pub(super) struct Strategies;

impl Rule<Option<Vec<Strategy>>> for Strategies {
    fn read(node: &Node<'_>) -> Result<Option<Vec<Strategy>>, Failure> {
        if node.text().is_ok_and(|text| text == "all") {
            return Ok(None);
        }
        let allowed = "must be \"all\", or a list of [s, t]";
        let items = node.items().map_err(|_| node.refuse(allowed))?;
        if items.is_empty() {
            return Err(node.refuse(allowed));
        }
        let strategy = |item: &Node<'_>| {
            let [light, eye] = item.integers(0, MOST_VERTICES as u32)?;
            match (light, eye) {
                (_, 0) => Err(item.refuse("needs t of at least 1: nothing meets the pinhole of the camera")),
                (0, 1) => Err(item.refuse("needs s + t of at least 2")),
                (1, 1) => Err(item.refuse("is left out: a light seen directly is found by [0, 2] alone")),
                _ => Ok(Strategy { light, eye }),
            }
        };
        items.iter().map(strategy).collect::<Result<_, _>>().map(Some)
    }
    fn written(strategies: &Option<Vec<Strategy>>) -> Value {
        let pairs = |all: &Vec<Strategy>| all.iter().map(|one| [one.light, one.eye]).collect::<Vec<_>>();
        strategies.as_ref().map_or(Value::Null, |all| json!(pairs(all)))
    }
    fn schema() -> Value {
        let pair = json!({ "type": "array", "items": { "type": "integer", "minimum": 0, "maximum": MOST_VERTICES },
            "minItems": 2, "maxItems": 2 });
        json!({ "anyOf": [{ "const": "all" }, { "type": "array", "items": pair, "minItems": 1 }] })
    }
}

impl BidirectionalSpec {
    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        if !self.weighted && self.strategies.is_none() {
            let why = "needs a list of strategies: all of them without weights would count most light several times";
            return Err(object.required("weighted")?.refuse(why));
        }
        if self.light_image {
            return Ok(());
        }
        if self.point_caustics {
            return Err(object.required("point_caustics")?.refuse(
                "needs light_image: true: what glass casts onto a surface that the camera sees has no other strategy",
            ));
        }
        if self.strategies.iter().flatten().any(|strategy| strategy.eye == 1) {
            return Err(object.required("strategies")?.refuse("[s, 1] needs light_image: true"));
        }
        Ok(())
    }
}

impl IntegratorKind for BidirectionalSpec {
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.transport)
    }
    fn bias(&self) -> Option<&'static str> {
        if self.strategies.is_some() {
            let unweighted = "weighted: light as strategies would find it alone, with what others find too";
            return Some(if self.weighted { "strategies: a part of the light only" } else { unweighted });
        }
        super::of_a_baseline(self.transport.is_biased_baseline())
    }
}
