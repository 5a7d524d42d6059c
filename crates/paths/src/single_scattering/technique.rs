//! Techniques that choose the points of the camera ray at which scattering is evaluated, and their combination.

use crate::Heuristic;

/// A way to choose distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// The interaction points of the walk that estimates transmittance: intensity σ_samp.
    Attenuation,
    /// The Cauchy distribution around the light: intensity n · pdf.
    Source,
    /// The first collision in a fitted extinction: intensity n · pdf.
    Scattering,
}

/// The sampling of a camera ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// One technique.
    One(Technique),
    /// As many interaction points as there are samples, chosen among all in proportion to their scores without the shadow ray
    /// (sampling importance resampling, talbot-2005).
    AttenuationResampled,
    /// Two techniques with MIS weights.
    Two(Technique, Technique, Heuristic),
}

impl Sampling {
    /// True if a technique takes part.
    #[must_use]
    pub fn uses(self, technique: Technique) -> bool {
        match self {
            Self::One(one) => one == technique,
            Self::AttenuationResampled => technique == Technique::Attenuation,
            Self::Two(first, second, _) => first == technique || second == technique,
        }
    }
}
