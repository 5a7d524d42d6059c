//! Passes of an image: what its pixels share, and what they add to each other.

use super::{IntegratorPlan, TransportPlan};
use crate::spec::ReuseSpec;

impl IntegratorPlan {
    /// True if the pixels of a pass share virtual point lights, photons or paths, or light each other: a pass is then of one sample per
    /// pixel.
    #[must_use]
    pub fn draws_in_batches(&self) -> bool {
        matches!(self, Self::Vpl(_)) || self.splats() || self.correlation().is_some()
    }

    /// What pixels of a pass share beside virtual point lights and light images, in words.
    #[must_use]
    pub fn correlation(&self) -> Option<&'static str> {
        match self {
            Self::PathTracer(plan) if plan.reuse.is_some() => {
                Some("pixels of a group share paths: the standard error is that of the means of passes")
            }
            Self::BeamRadiance(_) => Some(
                "pixels of a pass share a map of photons: the standard error is that of the means of passes, each with a map of its own; \
                 MSE and errors are those of the variance, the bias is not in them",
            ),
            _ => None,
        }
    }

    /// The light paths whose photons an integrator asks, and how they fly.
    #[must_use]
    pub fn photons(&self) -> Option<(u32, &TransportPlan)> {
        match self {
            Self::PathTracer(plan) => plan.photons().map(|paths| (paths, &plan.transport)),
            Self::BeamRadiance(plan) => Some((plan.photons, &plan.transport)),
            _ => None,
        }
    }

    /// True if all passes share what is prepared for the first: whatever it is, the expectation of a sample is the same.
    #[must_use]
    pub fn keeps_its_batch(&self) -> bool {
        matches!(self, Self::PathTracer(_))
    }

    /// Pixels of a group that uses the paths of all, along rows and columns, and from one to the next.
    #[must_use]
    pub fn groups(&self) -> Option<ReuseSpec> {
        if let Self::PathTracer(plan) = self { plan.reuse.clone() } else { None }
    }

    /// Independent images that chains or photons make all at once, and how many, at most one for each sample of a pixel; none of an integrator that draws
    /// pixel by pixel.
    #[must_use]
    pub fn replicas(&self) -> Option<u32> {
        /// Photons of one replica share an image, and one photon lights many pixels: only replicas tell a variance.
        const OF_PHOTONS: u32 = 16;
        match self {
            Self::PhotonTracer(_) => Some(OF_PHOTONS),
            Self::Metropolis(plan) => Some(plan.replicas),
            _ => None,
        }
    }

    /// True if it draws chains, whose images may end after any replica.
    #[must_use]
    pub fn is_of_chains(&self) -> bool {
        matches!(self, Self::Metropolis(_))
    }

    /// True if samples are not complete before all of their pass are drawn.
    #[must_use]
    pub fn splats(&self) -> bool {
        matches!(self, Self::Bidirectional(_))
    }
}
