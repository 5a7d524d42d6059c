//! Walks of particles.

use crate::estimator::VersionWord;
use crate::reader::Node;
use crate::reader::rule::{Flag, Own, Ruled, Whole};
use crate::{Failure, keys, words};
use fairflight_collision::Version;
use fairflight_paths::Grid;
use serde_json::{Value, json};

keys! {
    /// A walk with its parameters.
    pub WalkSpec {
        /// The rule of the probabilities of a collision.
        version: Version as VersionWord,
        /// The sampling extinction \[1/length\]: a number, or cells, factor and floor of a grid that is fitted to the medium.
        sigma_samp: SamplingFieldSpec as Own,
        /// One walk for all channels of a colour, or one for each.
        colour: Collisions as ColourWord = Collisions::Shared,
        /// More collisions of one particle are cut off, a bias; none are by default.
        max_collisions: u64 as Whole<1, { u64::MAX }> = u64::MAX,
        /// True to run a walk that has no second moment.
        allow_supercritical: bool as Flag = false,
    }
}

/// A sampling extinction in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplingFieldSpec {
    /// The same everywhere \[1/length\].
    Uniform(f64),
    /// The greatest extinction that the medium declares.
    FromMedium,
    /// One value per cell of a grid over the bounds of the medium, fitted to it.
    Grid {
        /// Cells along x, y and z.
        cells: [u32; 3],
        /// In front of what the medium has there.
        factor: f64,
        /// No value is lower \[1/length\].
        floor: f64,
    },
}

/// One walk for all channels of a colour, or one for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collisions {
    /// One walk for all channels.
    Shared,
    /// One walk per channel.
    Separate,
}

words! {
    /// One walk for all channels of a colour, or one for each.
    pub(super) ColourWord for Collisions {
        "shared" => Collisions::Shared,
        "separate" => Collisions::Separate,
    }
}

/// More cells take minutes to fit.
const MOST_CELLS: u64 = 1 << 24;

impl Ruled for SamplingFieldSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if !node.is_object() {
            return node.positive().map(Self::Uniform).map_err(|_| {
                node.refuse("must be a number above 0, or an object of cells, factor and floor")
            });
        }
        let object = node.object()?;
        let cells = object.required("cells")?;
        let numbers = cells.integers(1, Grid::MOST_CELLS as u32)?;
        if numbers.iter().map(|&count| u64::from(count)).product::<u64>() > MOST_CELLS {
            return Err(cells.refuse(format!("must be at most {MOST_CELLS} cells altogether")));
        }
        let field = Self::Grid {
            cells: numbers,
            factor: object.required("factor")?.positive()?,
            floor: object.required("floor")?.positive()?,
        };
        object.finish()?;
        Ok(field)
    }

    fn written(&self) -> Value {
        match self {
            Self::Uniform(value) => json!(value),
            Self::FromMedium => Value::Null,
            Self::Grid { cells, factor, floor } => {
                json!({ "cells": cells, "factor": factor, "floor": floor })
            }
        }
    }

    fn schema() -> Value {
        let cells = json!({ "type": "integer", "minimum": 1, "maximum": Grid::MOST_CELLS });
        let positive = json!({ "type": "number", "exclusiveMinimum": 0 });
        json!({ "anyOf": [
            positive,
            { "type": "object", "required": ["cells", "factor", "floor"], "additionalProperties": false, "properties": {
                "cells": { "type": "array", "items": cells, "minItems": 3, "maxItems": 3 },
                "factor": positive, "floor": positive,
            } },
        ] })
    }
}
