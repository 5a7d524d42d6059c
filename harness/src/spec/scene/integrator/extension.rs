//! Extensions of a path tracer: how a path chooses its directions, and whose paths a pixel uses.

use super::MOST;
use super::vpl::MOST_LIGHT_PATHS;
use crate::reader::Node;
use crate::reader::rule::{Rule, Whole};
use crate::{Failure, keys, kind, registry};
use fairflight_paths::extend::OwnShare;
use serde_json::{Value, json};
use std::num::NonZeroU32;

registry! {
    /// A choice of directions.
    ExtensionSpec as "extension" {
        Guided(GuidedSpec),
        Resampled(ResampledSpec),
    }
}

kind! {
    /// Directions from where photons came (jensen-1995), mixed with those that a vertex chooses itself.
    GuidedSpec = "guided" {
        /// Light paths that leave photons, before the first pixel.
        photons: u32 as Whole<1, MOST_LIGHT_PATHS>,
        /// Photons that a vertex asks.
        nearest: NonZeroU32 as Whole<1, MOST> = NonZeroU32::new(50).unwrap(),
        /// Cells of equal measure in which they are counted.
        cells: NonZeroU32 as Whole<1, MOST> = NonZeroU32::new(64).unwrap(),
        /// The share of directions that a vertex chooses itself, above 0: none weighs more than 1 over it.
        own_share: OwnShare as Share = usual_share(),
    }
}

kind! {
    /// One of several directions, kept for the light that it would meet were there no medium (talbot-2005).
    ResampledSpec = "resampled" {
        /// Directions that are tried.
        candidates: NonZeroU32 as Whole<1, MOST>,
        /// The share of directions that are kept whatever they meet, above 0: none weighs more than 1 over it.
        own_share: OwnShare as Share = usual_share(),
    }
}

keys! {
    /// Pixels that use each other's paths (bekaert-2002).
    pub ReuseSpec {
        /// Pixels of a group along rows and columns.
        tile: u32 as Whole<2, 8>,
        /// Pixels from one of a group to the next, along rows and columns.
        spacing: u32 as Whole<1, 32> = 4,
    }
}

fn usual_share() -> OwnShare {
    OwnShare::new(0.3).expect("0.3 is a share")
}

/// A share above 0 and at most 1.
#[derive(Debug)]
pub(super) struct Share;

impl Rule<OwnShare> for Share {
    fn read(node: &Node<'_>) -> Result<OwnShare, Failure> {
        OwnShare::new(node.number()?).map_err(|_| node.refuse("must be above 0 and at most 1"))
    }
    fn written(share: &OwnShare) -> Value {
        json!(share.get())
    }
    fn schema() -> Value {
        json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 })
    }
}
