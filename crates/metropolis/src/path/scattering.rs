//! The scattering mutation: another direction at a vertex.

use super::coordinates::Made;
use super::proposal::Proposal;
use super::{PathState, PathWorld, StepSizes, Towards};
use crate::Mutation;
use fairflight_sources::UniformSource;
use std::fmt;

/// Scattering mutation (antwerpen-2011 section 6.4, after Pauly): turns a direction in which light is scattered.
///
/// ```text
/// choose x_i among all vertices that scatter, in the medium or on diffuse surfaces
/// turn its direction to the light (or to the camera), and find vertices along it up to the first that is not smooth
/// connect that with the next one, unless it is the light
/// ```
///
/// **Coordinates** are the direction at x_i, and the distance where a vertex in the medium is found. f J keeps D at x_i, which is a cosine on a surface, and G of
/// the connection; towards the camera that is the whole importance. As many vertices scatter in the proposal: the probability of the choice cancels.
///
/// Does not fit where a smooth vertex, or the camera itself, would have to be connected or found.
pub struct Scattering<'w> {
    world: &'w dyn PathWorld,
    sizes: StepSizes,
    towards: Towards,
}

impl<'w> Scattering<'w> {
    /// Turns directions towards that end; keeps distances in the medium.
    pub fn new(world: &'w dyn PathWorld, sizes: StepSizes, towards: Towards) -> Self {
        Self { world, sizes, towards }
    }
}

impl fmt::Debug for Scattering<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { sizes, towards, .. } = self;
        formatter
            .debug_struct("Scattering")
            .field("sizes", sizes)
            .field("towards", towards)
            .finish_non_exhaustive()
    }
}

impl Mutation<PathState> for Scattering<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let at = x.choose_vertex(|vertex| !vertex.is_smooth(), source)?;
        let mut proposal = Proposal::new(self.world, (x, y), None, source);
        match self.towards {
            Towards::Eye => proposal.turn_to_eye(at, &self.sizes),
            Towards::Light => proposal.turn_to_light(at, &self.sizes),
        }
    }
}

impl Proposal<'_> {
    fn turn_to_light(&mut self, at: usize, sizes: &StepSizes) -> Option<f64> {
        let direction = sizes.turned(self.x.edges[at].direction, self.source);
        let found = self.extend_on(at, Towards::Light, direction)?;
        if found == self.x.len() {
            return self.ln_ratio(at..found, |_| Made::FromEye);
        }
        if self.x.vertices[found + 1].is_smooth() {
            return None;
        }
        self.connect(found)?;
        let made = |i| if i == found { Made::Connected } else { Made::FromEye };
        self.ln_ratio(at..found + 1, made)
    }
}
