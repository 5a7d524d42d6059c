//! The lens mutation by Lai: smooth vertices behind the first ones are kept.

use super::coordinates::Made;
use super::proposal::Proposal;
use super::{PathState, PathVertex, PathWorld, StepSizes, Towards};
use crate::Mutation;
use fairflight_sources::UniformSource;
use std::fmt;

/// Lens mutation that moves the image alone (antwerpen-2011 section 6.3, after Lai).
///
/// ```text
/// move x_1's image on the film, and find x_1 along the ray through it
/// at a vertex that is not smooth:  connect with the next one
///                                  if that is smooth: reflect or refract there, and go on through smooth vertices; else end
/// ```
///
/// **Coordinates** are the point of the film, distances in the medium, and the *places* of the smooth vertices that are kept. Such a place has the measure
/// of area: G of the edge to it stays, with the cosines at both of its ends, where the lens mutation's direction leaves D(x) alone. Behind it everything is
/// found along directions again.
///
/// Does not fit a path without a smooth vertex behind one that is not, before the first pair of neighbours to be connected: that is left to [`Lens`](super::Lens).
pub struct LaiLens<'w> {
    world: &'w dyn PathWorld,
    sizes: StepSizes,
}

impl<'w> LaiLens<'w> {
    /// Keeps distances in the medium.
    pub fn new(world: &'w dyn PathWorld, sizes: StepSizes) -> Self {
        Self { world, sizes }
    }
}

impl fmt::Debug for LaiLens<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("LaiLens").field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl Mutation<PathState> for LaiLens<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let first = (1..=x.len()).find(|&i| !x.vertices[i].is_smooth())?;
        if !x.vertices.get(first + 1).is_some_and(PathVertex::is_smooth) {
            return None;
        }
        let mut proposal = Proposal::new(self.world, (x, y), None, source);
        let mut at = proposal.extend_from_film(&self.sizes)?;
        let mut edges = x.len();
        while at < x.len() {
            proposal.connect(at)?;
            if !x.vertices[at + 1].is_smooth() {
                edges = at + 1;
                break;
            }
            let onwards = proposal.pass_kept(at + 1)?;
            at = proposal.extend_on(at + 1, Towards::Light, onwards)?;
        }
        // Edges behind a vertex that is not smooth are connections: of the first of them the vertex was found, the others lead to kept places.
        let made =
            |i: usize| if i == 0 || x.vertices[i].is_smooth() { Made::FromEye } else { Made::Connected };
        proposal.ln_ratio(0..edges, made)
    }
}

impl Proposal<'_> {
    /// Reflects or refracts at a smooth vertex that is kept, for the edge that now leads to it. Returns the direction behind it.
    fn pass_kept(&mut self, at: usize) -> Option<glam::DVec3> {
        let incident = self.y.edges[at - 1].direction;
        let continuation = self.y.pass(self.world, at, incident)?;
        self.y.vertices[at].site = continuation.site;
        Some(continuation.direction)
    }
}
