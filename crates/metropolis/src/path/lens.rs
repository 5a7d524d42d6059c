//! The lens mutation: another point of the film.

use super::coordinates::Made;
use super::proposal::Proposal;
use super::{PathState, PathWorld, StepSizes, Towards};
use crate::Mutation;
use fairflight_sources::UniformSource;
use std::fmt;

/// Lens mutation (antwerpen-2011 section 6.3, algorithm 7), in media.
///
/// ```text
/// move x_1's image on the film, and find x_1 along the ray through it
/// at a vertex that is not smooth:  if the next one is not, either: connect with that, and end
///                                  else turn the direction to it, and go on through smooth vertices
/// ```
///
/// **Coordinates** are the point of the film, each direction that is turned, and distances in the medium or their logarithms; f J has no cosine and no
/// 1/r² of what is found along them, and the cos³ of the camera cancels with its Jacobian. G stays of the connection alone, and f_s at its far end, which is
/// kept, changes with the direction. Which vertices change follows from the kinds of vertices alone, and those are kept: no probability of a choice enters.
///
/// A path that has no pair of neighbours to be connected is found anew up to the light, which must have extent.
pub struct Lens<'w> {
    world: &'w dyn PathWorld,
    sizes: StepSizes,
    scales: bool,
}

impl<'w> Lens<'w> {
    /// Keeps distances in the medium.
    pub fn new(world: &'w dyn PathWorld, sizes: StepSizes) -> Self {
        Self { world, sizes, scales: false }
    }

    /// Scales them.
    #[must_use]
    pub fn scaling(self) -> Self {
        Self { scales: true, ..self }
    }
}

impl fmt::Debug for Lens<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Lens")
            .field("sizes", &self.sizes)
            .field("scales", &self.scales)
            .finish_non_exhaustive()
    }
}

impl Mutation<PathState> for Lens<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let stretch = self.scales.then_some(self.sizes.stretch);
        let mut proposal = Proposal::new(self.world, (x, y), stretch, source);
        let mut at = proposal.extend_from_film(&self.sizes)?;
        while at < x.len() {
            if !x.vertices[at + 1].is_smooth() {
                proposal.connect(at)?;
                let made = |i| if i == at { Made::Connected } else { Made::FromEye };
                return proposal.ln_ratio(0..at + 1, made);
            }
            let direction = self.sizes.turned(x.edges[at].direction, proposal.source);
            at = proposal.extend_on(at, Towards::Light, direction)?;
        }
        proposal.ln_ratio(0..x.len(), |_| Made::FromEye)
    }
}

impl Proposal<'_> {
    /// Moves the image of x_1, and finds the vertices up to the first that is not smooth. Returns its index.
    pub(super) fn extend_from_film(&mut self, sizes: &StepSizes) -> Option<usize> {
        let camera = self.world.camera();
        let film = sizes.moved(self.x.film, self.source);
        let [columns, rows] = camera.resolution().map(f64::from);
        if !(0.0 <= film[0] && film[0] < columns && 0.0 <= film[1] && film[1] < rows) {
            return None;
        }
        self.y.film = film;
        self.extend_on(0, Towards::Light, camera.ray([0, 0], film).direction)
    }
}
