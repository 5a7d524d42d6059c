//! A whole experiment: profile, estimator, samples, seed; or a sweep of them.

use super::{Request, refuse_other};
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
    /// The estimator of its transmittance.
    pub estimator: EstimatorSpec,
    /// The number of estimates.
    pub samples: u64,
    /// The seed of their variates.
    pub seed: u64,
}

/// Options of the command line that take the place of keys of the spec.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// `--samples`
    pub samples: Option<u64>,
    /// `--seed`
    pub seed: Option<u64>,
}

/// A thousand billion samples would take months.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

/// The parts of an experiment in which a key may be swept.
const PARTS: [&str; 2] = ["profile", "estimator"];

impl Request<Experiment> {
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
        refuse_other("profile", "experiment", &Node::root(&spec).object()?)?;
        Self::of(&spec, &PARTS, |point| Experiment::read(point, base, overrides))
    }
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
