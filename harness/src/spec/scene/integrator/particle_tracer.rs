//! Particle tracing.

use super::IntegratorKind;
use super::walk::WalkSpec;
use crate::reader::kind::Among;
use crate::{kind, words};

kind! {
    /// Walks of particles (szirmay-kalos-2017 section 4.1).
    TracerSpec = "particle_tracer" {
        /// The walks.
        walk: WalkSpec as Among,
        /// The particles: from the camera, or from the lights.
        particles: Particles as ParticlesWord = Particles::Importons,
    }
}

/// The particles: from the camera, or from the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Particles {
    /// Particles from the camera.
    Importons,
    /// Particles from the lights.
    Photons,
}

words! {
    /// The particles: from the camera, or from the lights.
    pub(super) ParticlesWord for Particles {
        "importons" => Particles::Importons,
        "photons" => Particles::Photons,
    }
}

impl IntegratorKind for TracerSpec {
    fn walk(&self) -> Option<&WalkSpec> {
        Some(&self.walk)
    }
}
