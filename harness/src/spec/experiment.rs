//! A whole experiment: profile, estimator, samples, seed; or a sweep of them.

use crate::Failure;
use crate::estimator::EstimatorSpec;
use crate::field::ProfileSpec;
use crate::reader::{Node, json};
use serde_json::Value;
use std::path::Path;

/// One measurement that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The extinction along the ray.
    pub profile: ProfileSpec,
    /// What estimates its transmittance.
    pub estimator: EstimatorSpec,
    /// The number of estimates.
    pub samples: u64,
    /// The seed of their variates.
    pub seed: u64,
}

/// What the command line says instead of the spec.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// `--samples`
    pub samples: Option<u64>,
    /// `--seed`
    pub seed: Option<u64>,
}

/// What a spec file asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// One experiment.
    Single(Box<Experiment>),
    /// One experiment per value of a swept key.
    Sweep(Sweep),
}

/// The points of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The value of the swept key, and the experiment with it.
    pub points: Vec<(Value, Experiment)>,
}

/// A thousand billion samples would take months.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

impl Request {
    /// Reads a whole spec; paths of files in it are relative to the working directory.
    ///
    /// # Errors
    /// If it is not JSON, or a key is missing, unknown or of the wrong kind.
    pub fn parse(text: &str, overrides: Overrides) -> Result<Self, Failure> {
        Self::parse_in(text, Path::new(""), overrides)
    }

    /// Reads a whole spec; paths of files in it are relative to the folder `base`.
    ///
    /// # Errors
    /// If it is not JSON, or a key is missing, unknown or of the wrong kind.
    pub fn parse_in(text: &str, base: &Path, overrides: Overrides) -> Result<Self, Failure> {
        let spec = json::parse(text)?;
        let root = Node::root_in(&spec, base).object()?;
        if root.has("camera") && !root.has("profile") {
            return Err(Failure::refused("this is a scene, no experiment: `harness render` takes it"));
        }
        let Some(sweep) = root.optional("sweep") else {
            return Ok(Self::Single(Box::new(Experiment::read(&spec, base, overrides)?)));
        };
        let object = sweep.object()?;
        let path_node = object.required("path")?;
        let path = path_node.text()?;
        let values = object.required("values")?;
        let items = values.items()?;
        object.finish()?;
        if items.is_empty() {
            return Err(values.refuse("must be a list of at least one value"));
        }
        let points = items.iter().map(|item| {
            let mut point = spec.clone();
            let target = locate(&mut point, path)
                .ok_or_else(|| path_node.refuse("must name a key of profile or estimator"))?;
            *target = item.value().clone();
            Ok((item.value().clone(), Experiment::read(&point, base, overrides)?))
        });
        Ok(Self::Sweep(Sweep { points: points.collect::<Result<_, Failure>>()? }))
    }
}

/// The place that a dotted path names, made if only its last key is missing.
fn locate<'a>(spec: &'a mut Value, path: &str) -> Option<&'a mut Value> {
    let mut keys = path.split('.').peekable();
    if !matches!(keys.peek(), Some(&("profile" | "estimator"))) {
        return None;
    }
    let mut place = spec;
    while let Some(key) = keys.next() {
        let last = keys.peek().is_none();
        place = match place {
            Value::Object(map) => {
                if last && !map.contains_key(key) {
                    map.insert(key.to_owned(), Value::Null);
                }
                map.get_mut(key)?
            }
            Value::Array(items) => items.get_mut(key.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(place)
}

impl Experiment {
    fn read(spec: &Value, base: &Path, overrides: Overrides) -> Result<Self, Failure> {
        let root = Node::root_in(spec, base).object()?;
        let _ = root.optional("sweep");
        let or_override = |key, least, most, instead: Option<u64>| match (root.optional(key), instead) {
            (Some(node), instead) => node.integer(least, most).map(|given| instead.unwrap_or(given)),
            (None, Some(instead)) => Ok(instead),
            (None, None) => root.required(key).and_then(|node| node.integer(least, most)),
        };
        let samples = or_override("samples", 1, MOST_SAMPLES, overrides.samples)?;
        let seed = or_override("seed", 0, u64::MAX, overrides.seed)?;
        let experiment = Self {
            profile: ProfileSpec::read(&root.required("profile")?)?,
            estimator: EstimatorSpec::read(&root.required("estimator")?)?,
            samples,
            seed,
        };
        root.finish_root()?;
        Ok(experiment)
    }
}
