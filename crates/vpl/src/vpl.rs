//! A virtual point light.

use fairflight_media::PhaseFunction;
use fairflight_paths::transport::{Lobe, Vertex};
use glam::DVec3;

/// A vertex of a light path, at which the light that it carries is scattered once more.
///
/// engelhardt-2013 section 3.2 stores incident radiance and scattering function apart; here `power` is what is scattered, so that
/// the reflectance (or the albedo, where the paper stores σ_s for a density that this one has divided by) is inside. What the
/// vertex knows of its scattering function is its [`Lobe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vpl<C> {
    /// Place and distribution of directions of the light.
    pub vertex: Vertex,
    /// The direction in which the light arrived, of unit length.
    pub incident: DVec3,
    /// The power that it scatters, a share of all light paths; of either sign where the walk has weights of either sign.
    pub power: C,
    /// Number of the vertex on the light path: 1 for what a light source lit.
    pub bounce: u32,
}

impl<C> Vpl<C> {
    /// The intensity along `direction` per power and, on a surface, per cosine \[1/sr\].
    #[inline]
    pub fn eval<P: PhaseFunction>(&self, phase: &P, direction: DVec3) -> f64 {
        self.vertex.eval(phase, direction)
    }

    /// True if it lies in the medium.
    #[must_use]
    pub fn is_in_medium(&self) -> bool {
        matches!(self.vertex.lobe, Lobe::Phase { .. })
    }
}
