//! The propagation mutation: another distance of a vertex in the medium.

use super::coordinates::Made;
use super::proposal::Proposal;
use super::{PathState, PathVertex, PathWorld, StepSizes, Towards};
use crate::Mutation;
use fairflight_sources::UniformSource;
use std::fmt;

/// Propagation mutation (antwerpen-2011 section 6.4, after Pauly): moves a vertex in the medium along one of its edges.
///
/// ```text
/// choose x_i among all vertices in the medium
/// scale its distance from the neighbour on one side, the camera, the light or another vertex
/// connect it with the neighbour on the other side
/// ```
///
/// **Coordinate** is ln r along the edge: J = r³ in the measure of volume, of which 1/r² of G cancels two, and r remains. G of the connection stays; towards the
/// camera that is the whole importance. f_s changes at x_i and at the neighbour to which it is connected. As many vertices lie in the medium of the proposal: the
/// probability of the choice cancels.
///
/// Does not fit where the neighbour to be connected is smooth, or the other one is infinitely far.
pub struct Propagation<'w> {
    world: &'w dyn PathWorld,
    sizes: StepSizes,
    anchor: Towards,
}

impl<'w> Propagation<'w> {
    /// Moves vertices along the edge to their neighbour on that side.
    pub fn new(world: &'w dyn PathWorld, sizes: StepSizes, anchor: Towards) -> Self {
        Self { world, sizes, anchor }
    }
}

impl fmt::Debug for Propagation<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { sizes, anchor, .. } = self;
        formatter
            .debug_struct("Propagation")
            .field("sizes", sizes)
            .field("anchor", anchor)
            .finish_non_exhaustive()
    }
}

impl Mutation<PathState> for Propagation<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let at = x.choose_vertex(PathVertex::is_in_medium, source)?;
        let (anchor, other, edge, towards) = match self.anchor {
            Towards::Eye => (at - 1, at + 1, at - 1, Towards::Light),
            Towards::Light => (at + 1, at - 1, at, Towards::Eye),
        };
        if x.vertices[other].is_smooth() || x.edges[edge].length == f64::INFINITY {
            return None;
        }
        let direction = x.edges[edge].direction * if towards == Towards::Light { 1.0 } else { -1.0 };
        let mut proposal = Proposal::new(self.world, (x, y), Some(self.sizes.stretch), source);
        proposal.extend(anchor, towards, direction)?;
        let connected = 2 * at - 1 - edge;
        proposal.connect(connected)?;
        let found = if towards == Towards::Light { Made::FromEye } else { Made::FromLight };
        proposal.ln_ratio(at - 1..at + 1, |i| if i == edge { found } else { Made::Connected })
    }
}
