//! A point at which light is scattered.

use fairflight_media::{Line, PhaseFunction};
use fairflight_scene::{Segment, cosine_hemisphere};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A point of the medium or of a diffuse surface, seen from one direction.
///
/// How much is scattered (albedo, reflectance) is not part of it: f of raab-2008 eq. 6 is [`eval`](Self::eval) times that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where.
    pub position: DVec3,
    /// Whereto.
    pub lobe: Lobe,
}

/// How a vertex distributes what it scatters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Lambert, into the half space of the normal: 1/π per projected solid angle.
    Diffuse {
        /// Of unit length, on the side from where the path came.
        normal: DVec3,
        /// The surface.
        surface: usize,
    },
    /// By the phase function of the medium.
    Phase {
        /// The direction in which the path arrived, of unit length.
        incident: DVec3,
    },
}

impl Vertex {
    /// The surface that the vertex lies on.
    #[inline]
    #[must_use]
    pub fn surface(&self) -> Option<usize> {
        match self.lobe {
            Lobe::Diffuse { surface, .. } => Some(surface),
            Lobe::Phase { .. } => None,
        }
    }

    /// BRDF or phase function towards `direction`, without reflectance or albedo \[1/sr\].
    #[inline]
    #[must_use]
    pub fn eval<P: PhaseFunction>(&self, phase: &P, direction: DVec3) -> f64 {
        match self.lobe {
            Lobe::Diffuse { .. } => FRAC_1_PI,
            Lobe::Phase { incident } => phase.eval(incident.dot(direction)),
        }
    }

    /// The factor of the geometric term at this end (raab-2008 eq. 8): the cosine on a surface, 0 behind it; 1 in the medium.
    #[inline]
    #[must_use]
    pub fn cosine(&self, direction: DVec3) -> f64 {
        match self.lobe {
            Lobe::Diffuse { normal, .. } => normal.dot(direction).max(0.0),
            Lobe::Phase { .. } => 1.0,
        }
    }

    /// A direction with the density [`pdf_solid_angle`](Self::pdf_solid_angle) = eval · cosine: a sample weighs 1.
    #[inline]
    #[must_use]
    pub fn sample<P: PhaseFunction>(&self, phase: &P, u: f64, v: f64) -> DVec3 {
        match self.lobe {
            Lobe::Diffuse { normal, .. } => cosine_hemisphere(normal, u, v),
            Lobe::Phase { incident } => phase.sample(incident, u, v).direction,
        }
    }

    /// The density of [`sample`](Self::sample) \[1/sr\].
    #[inline]
    #[must_use]
    pub fn pdf_solid_angle<P: PhaseFunction>(&self, phase: &P, direction: DVec3) -> f64 {
        self.eval(phase, direction) * self.cosine(direction)
    }

    /// What leaves the vertex along `direction`, up to `length`.
    #[inline]
    #[must_use]
    pub fn leave(&self, direction: DVec3, length: f64) -> Segment {
        Segment { line: Line { origin: self.position, direction }, length, from: self.surface(), to: None }
    }
}
