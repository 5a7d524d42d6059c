//! The sampling extinction of an estimator on a profile.

use crate::Failure;
use crate::field::AnyProfile;
use crate::reader::Node;
use crate::reader::rule::Ruled;
use fairflight_laws::scores::{Interval, Ranged};
use fairflight_media::{
    Breakpoints, Constant, Extinction, InvertOpticalThickness, OpticalThickness, PiecewiseConstant,
};
use serde_json::{Value, json};

/// A sampling extinction as given \[1/length\].
#[derive(Clone, Debug, PartialEq)]
pub enum SamplingSpec {
    /// The same everywhere.
    Constant(f64),
    /// One value per cell.
    PiecewiseConstant {
        /// Borders of the cells \[length\].
        edges: Vec<f64>,
        /// The values.
        values: Vec<f64>,
    },
}

impl Ruled for SamplingSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        node.bare_or_object(
            "must be a number of at least 0, or an object of edges and values",
            |bare| bare.non_negative().map(Self::Constant),
            |object| {
                let edges = object.required("edges")?.numbers()?;
                let values = object.required("values")?;
                for value in values.items()? {
                    value.non_negative()?;
                }
                Ok(Self::PiecewiseConstant { edges, values: values.numbers()? })
            },
        )
    }

    fn written(&self) -> Value {
        match self {
            Self::Constant(value) => json!(value),
            Self::PiecewiseConstant { edges, values } => json!({ "edges": edges, "values": values }),
        }
    }

    fn schema() -> Value {
        json!({ "anyOf": [
            { "type": "number", "minimum": 0 },
            { "type": "object", "required": ["edges", "values"], "additionalProperties": false, "properties": {
                "edges": { "type": "array", "items": { "type": "number" }, "minItems": 2 },
                "values": { "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 1 },
            } },
        ] })
    }
}

/// σ_samp of any kind, on one profile.
#[derive(Clone, Debug)]
pub enum AnySampling {
    /// The same everywhere.
    Constant(Constant),
    /// One value per cell.
    PiecewiseConstant(PiecewiseConstant),
}

impl AnySampling {
    pub(super) fn build(spec: &SamplingSpec, profile: &AnyProfile) -> Result<Self, Failure> {
        let key = "estimator.sigma_samp";
        let refuse = |error: &dyn std::fmt::Display| Failure::refused(format!("{key}: {error}"));
        let length = profile.length();
        match spec {
            SamplingSpec::Constant(value) => {
                Ok(Self::Constant(Constant::new(*value, length).map_err(|error| refuse(&error))?))
            }
            SamplingSpec::PiecewiseConstant { edges, values } => {
                if edges.len() != values.len() + 1 {
                    return Err(refuse(&format!(
                        "edges needs one entry more than values, found {} and {}",
                        edges.len(),
                        values.len()
                    )));
                }
                let nodes = clipped_nodes("estimator.sigma_samp.edges", edges, profile)?;
                if length == 0.0 {
                    return Ok(Self::Constant(Constant::new(0.0, 0.0).map_err(|error| refuse(&error))?));
                }
                let entry = profile.entry_distance();
                // The cell that holds the middle of each clipped cell.
                let clipped = nodes.windows(2).map(|cell| {
                    let middle = 0.5 * (cell[0] + cell[1]) + entry;
                    let after = edges.partition_point(|&edge| edge <= middle);
                    values[after.clamp(1, values.len()) - 1]
                });
                let clipped = clipped.collect();
                let field = PiecewiseConstant::new(nodes, clipped).map_err(|error| refuse(&error))?;
                Ok(Self::PiecewiseConstant(field))
            }
        }
    }
}

/// Nodes that a person gave as distances from the ray's origin, as distances in the profile: 0, those strictly inside,
/// and its length.
///
/// # Errors
/// If they do not increase, or do not cover the profile.
pub(super) fn clipped_nodes(key: &str, given: &[f64], profile: &AnyProfile) -> Result<Vec<f64>, Failure> {
    if given.len() < 2 {
        return Err(Failure::refused(format!("{key}: needs at least 2 entries, found {}", given.len())));
    }
    if let Some(i) = given.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(Failure::refused(format!(
            "{key}.{}: must increase strictly, but {} follows {}",
            i + 1,
            given[i + 1],
            given[i]
        )));
    }
    let (entry, length) = (profile.entry_distance(), profile.length());
    let (first, last) = (given[0], given[given.len() - 1]);
    // Where a ray enters and leaves is computed with a few roundings of its distances: that much is not outside.
    let rounding = 8.0 * f64::EPSILON * (entry + length);
    if length > 0.0 && (first > entry + rounding || last < entry + length - rounding) {
        return Err(Failure::refused(format!(
            "{key}: must cover the whole profile, from {entry} to {}, found {first} to {last}",
            entry + length
        )));
    }
    let inside = given.iter().map(|node| node - entry).filter(|s| *s > rounding && *s < length - rounding);
    Ok(std::iter::once(0.0).chain(inside).chain([length]).collect())
}

impl Extinction for AnySampling {
    #[inline]
    fn sigma_t(&self, s: f64) -> f64 {
        match self {
            Self::Constant(sampling) => sampling.sigma_t(s),
            Self::PiecewiseConstant(sampling) => sampling.sigma_t(s),
        }
    }

    #[inline]
    fn length(&self) -> f64 {
        match self {
            Self::Constant(sampling) => sampling.length(),
            Self::PiecewiseConstant(sampling) => sampling.length(),
        }
    }
}

impl OpticalThickness for AnySampling {
    fn optical_thickness(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Constant(sampling) => sampling.optical_thickness(from, to),
            Self::PiecewiseConstant(sampling) => sampling.optical_thickness(from, to),
        }
    }
}

impl InvertOpticalThickness for AnySampling {
    #[inline]
    fn invert(&self, from: f64, depth: f64) -> Option<f64> {
        match self {
            Self::Constant(sampling) => sampling.invert(from, depth),
            Self::PiecewiseConstant(sampling) => sampling.invert(from, depth),
        }
    }
}

impl Breakpoints for AnySampling {
    fn breakpoints(&self) -> Vec<f64> {
        match self {
            Self::Constant(sampling) => sampling.breakpoints(),
            Self::PiecewiseConstant(sampling) => sampling.breakpoints(),
        }
    }
}

impl Ranged for AnySampling {
    fn range(&self) -> Interval {
        match self {
            Self::Constant(sampling) => sampling.range(),
            Self::PiecewiseConstant(sampling) => sampling.range(),
        }
    }
}
