//! Several first collisions per camera ray, each continued by a walk.

use super::walk::WalkSpec;
use super::{IntegratorKind, MOST};
use crate::reader::kind::Among;
use crate::reader::rule::{NonNegative, Whole};
use crate::{kind, words};
use fairflight_transmittance::Starts;

words! {
    /// The layout of the first steps of flights.
    pub(super) StartsWord for Starts {
        "equidistant" => Starts::Equidistant,
        "independent" => Starts::Independent,
    }
}

kind! {
    /// Several first collisions per camera ray, each continued by a walk (raab-2008 section 3.1).
    LineSplittingSpec = "line_splitting" {
        /// The walks of the particles.
        walk: WalkSpec as Among,
        /// An upper bound of σ_t \[1/length\].
        majorant: f64 as NonNegative,
        /// Flights per camera ray.
        splits: u32 as Whole<1, MOST>,
        /// The layout of their first steps.
        starts: Starts as StartsWord = Starts::Equidistant,
    }
}

impl IntegratorKind for LineSplittingSpec {
    fn walk(&self) -> Option<&WalkSpec> {
        Some(&self.walk)
    }
}
