//! Path tracing among surfaces.

use super::IntegratorKind;
use super::transport::TransportSpec;
use crate::kind;
use crate::reader::kind::Among;
use crate::reader::rule::Whole;

kind! {
    /// Paths from the camera with next-event estimation (raab-2008 section 4.1), among surfaces.
    PathTracerSpec = "path_tracer" {
        /// Longer paths are cut, a bias.
        max_vertices: u32 as Whole<1, MOST_VERTICES> = MOST_VERTICES as u32,
        /// The flights, connections and weights of paths.
        transport: TransportSpec as Among,
    }
}

/// More vertices are never met but where nothing is absorbed.
pub(super) const MOST_VERTICES: u64 = 10_000;

impl PathTracerSpec {
    /// Paths of all lengths that travel like this.
    #[must_use]
    pub fn of_all_lengths(transport: TransportSpec) -> Self {
        Self { transport, max_vertices: MOST_VERTICES as u32 }
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
