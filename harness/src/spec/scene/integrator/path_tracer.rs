//! Path tracing among surfaces.

use super::extension::{ExtensionSpec, ReuseSpec};
use super::transport::TransportSpec;
use super::{IntegratorKind, MOST};
use crate::reader::Object;
use crate::reader::kind::Among;
use crate::reader::rule::{Nullable, Own, Whole};
use crate::{Failure, kind};
use std::num::NonZeroU32;

kind! {
    /// Paths from the camera with next-event estimation (raab-2008 section 4.1), among surfaces.
    PathTracerSpec = "path_tracer" {
        /// Longer paths are cut, a bias.
        max_vertices: u32 as Whole<1, MOST_VERTICES> = MOST_VERTICES as u32,
        /// The choice of directions; null for BRDF · cosine and phase function.
        extension: Option<ExtensionSpec> as Nullable<Own> = None,
        /// Points of each light that has an extent, of which one is kept for what it would add were nothing between (talbot-2005).
        light_candidates: NonZeroU32 as Whole<1, MOST> = NonZeroU32::MIN,
        /// Use of the paths of other pixels, in groups: { "tile": n, "spacing": m } of n · n pixels, m apart (4 by default); null for none.
        reuse: Option<ReuseSpec> as Nullable<Among> = None,
        /// The flights, connections and weights of paths.
        transport: TransportSpec as Among,
    }
    check PathTracerSpec::check
}

/// More vertices are never met but where nothing is absorbed.
pub(super) const MOST_VERTICES: u64 = 10_000;

impl PathTracerSpec {
    /// Paths of all lengths that travel like this.
    #[must_use]
    pub fn of_all_lengths(transport: TransportSpec) -> Self {
        let (extension, light_candidates, reuse) = (None, NonZeroU32::MIN, None);
        Self { transport, max_vertices: MOST_VERTICES as u32, extension, light_candidates, reuse }
    }

    fn check(&self, object: &Object<'_>) -> Result<(), Failure> {
        let without = if self.reuse.is_none() {
            return Ok(());
        } else if self.extension.is_some() {
            "extension: null, since paths of other pixels weigh by the densities of directions that vertices choose themselves"
        } else if self.light_candidates > NonZeroU32::MIN {
            "light_candidates: 1, since pixels share what is connected"
        } else if self.max_vertices < 2 {
            "max_vertices of at least 2: pixels share what is behind the first"
        } else {
            return Ok(());
        };
        Err(object.required("reuse")?.refuse(format!("needs {without}")))
    }
}

impl IntegratorKind for PathTracerSpec {
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.transport)
    }
    fn bias(&self) -> Option<&'static str> {
        super::of_a_baseline(self.transport.is_biased_baseline())
    }
}
