//! A point at which light is scattered.

use fairflight_media::{Line, PhaseFunction};
use fairflight_scene::{Segment, cosine_hemisphere};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A point of the medium or of a diffuse surface, seen from one direction.
///
/// The share that is scattered (albedo, reflectance) is not part of it: f of raab-2008 eq. 6 is [`eval`](Self::eval) times that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Place of the vertex.
    pub position: DVec3,
    /// Distribution of the directions into which it scatters.
    pub lobe: Lobe,
}

/// Distribution of the directions into which a vertex scatters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Lambert, into the half space of the normal: 1/π per projected solid angle.
    Diffuse {
        /// Normal of unit length, on the side from where the path came.
        normal: DVec3,
        /// The surface.
        surface: usize,
    },
    /// The phase function of the medium.
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

    /// The segment that leaves the vertex along `direction`, up to `length`.
    #[inline]
    #[must_use]
    pub fn leave(&self, direction: DVec3, length: f64) -> Segment {
        Segment { line: Line { origin: self.position, direction }, length, from: self.surface(), to: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::HenyeyGreenstein;
    use glam::dvec3;

    fn forward() -> HenyeyGreenstein {
        HenyeyGreenstein::new(0.6).unwrap()
    }

    #[test]
    fn a_surface_scatters_evenly_and_into_its_half_space() {
        let vertex = Vertex { position: DVec3::ONE, lobe: Lobe::Diffuse { normal: DVec3::Z, surface: 7 } };
        let slanted = dvec3(0.6, 0.0, 0.8);
        assert_eq!(vertex.surface(), Some(7));
        assert_eq!(vertex.eval(&forward(), slanted), FRAC_1_PI);
        assert_eq!(vertex.cosine(slanted), 0.8);
        assert_eq!(vertex.cosine(-slanted), 0.0);
        assert_eq!(vertex.pdf_solid_angle(&forward(), slanted), 0.8 * FRAC_1_PI);
        assert_eq!(vertex.pdf_solid_angle(&forward(), -slanted), 0.0);
        // The cosine of cosine_hemisphere is √(1 − u).
        let direction = vertex.sample(&forward(), 0.36, 0.2);
        assert!((direction.z - 0.8).abs() < 1e-15);
        let leaving = vertex.leave(slanted, 3.0);
        assert_eq!((leaving.line.origin, leaving.from, leaving.to), (DVec3::ONE, Some(7), None));
        assert_eq!((leaving.line.direction, leaving.length), (slanted, 3.0));
    }

    #[test]
    fn a_point_of_the_medium_scatters_by_the_angle_to_where_the_light_came_from() {
        let incident = dvec3(0.0, 0.6, -0.8);
        let vertex = Vertex { position: DVec3::ZERO, lobe: Lobe::Phase { incident } };
        assert_eq!(vertex.surface(), None);
        for direction in [DVec3::X, DVec3::Z, incident, -incident] {
            let phase = forward().eval(incident.dot(direction));
            assert_eq!(vertex.eval(&forward(), direction), phase);
            assert_eq!(vertex.cosine(direction), 1.0);
            assert_eq!(vertex.pdf_solid_angle(&forward(), direction), phase);
        }
        let sample = forward().sample(incident, 0.3, 0.9);
        let direction = vertex.sample(&forward(), 0.3, 0.9);
        assert_eq!(direction, sample.direction);
        let density = vertex.pdf_solid_angle(&forward(), direction);
        assert!((density / sample.pdf_solid_angle - 1.0).abs() < 1e-14);
        assert_eq!(vertex.leave(DVec3::X, f64::INFINITY).from, None);
    }
}
