//! The caustic mutation: another direction towards what the camera sees.

use super::coordinates::Made;
use super::proposal::Proposal;
use super::{PathState, PathWorld, StepSizes, Towards};
use crate::Mutation;
use fairflight_sources::UniformSource;
use std::fmt;

/// Caustic mutation (antwerpen-2011 section 6.3, algorithm 6), in media.
///
/// ```text
/// x_j is the second vertex from the camera that is not smooth, or the light
/// turn its direction towards the camera, and find x_(j−1) … x_1 along it, through smooth vertices between
/// connect x_1 with the camera
/// ```
///
/// **Coordinates** are the direction at x_j, and the distance of x_1 where that lies in the medium. f J keeps the cosine at x_j; of the camera it keeps the
/// whole importance, cos³ included, since x_1 is *not* found along a ray from the film: the correction that antwerpen-2011 names after algorithm 6.
///
/// Fits paths whose first vertex is not smooth, and not those from an infinitely far light to it.
pub struct Caustic<'w> {
    world: &'w dyn PathWorld,
    sizes: StepSizes,
}

impl<'w> Caustic<'w> {
    /// Keeps the distance in the medium.
    pub fn new(world: &'w dyn PathWorld, sizes: StepSizes) -> Self {
        Self { world, sizes }
    }
}

impl fmt::Debug for Caustic<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Caustic").field("sizes", &self.sizes).finish_non_exhaustive()
    }
}

impl Mutation<PathState> for Caustic<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let second = (2..=x.len()).find(|&i| !x.vertices[i].is_smooth())?;
        if x.vertices[1].is_smooth() {
            return None;
        }
        let mut proposal = Proposal::new(self.world, (x, y), None, source);
        proposal.turn_to_eye(second, &self.sizes)
    }
}

impl Proposal<'_> {
    /// Turns the direction at `at` towards the camera, finds vertices along it up to the first that is not smooth, and connects that with what is before it.
    /// Returns the ratio.
    pub(super) fn turn_to_eye(&mut self, at: usize, sizes: &StepSizes) -> Option<f64> {
        // An infinitely far end has no direction that could be turned about its place.
        if self.x.edges[at - 1].length == f64::INFINITY {
            return None;
        }
        let direction = sizes.turned(-self.x.edges[at - 1].direction, self.source);
        let found = self.extend_on(at, Towards::Eye, direction)?;
        if self.x.vertices[found - 1].is_smooth() {
            return None;
        }
        self.connect(found - 1)?;
        let made = |i| if i == found - 1 { Made::Connected } else { Made::FromLight };
        self.ln_ratio(found - 1..at, made)
    }
}
