//! Phase functions: how matter redistributes the direction of a scattered particle.

mod error;
mod frame;
mod henyey_greenstein;
mod isotropic;
mod rayleigh;
mod schlick;
mod tabulated;

pub use error::PhaseError;
pub use henyey_greenstein::HenyeyGreenstein;
pub use isotropic::Isotropic;
pub use rayleigh::Rayleigh;
pub use schlick::Schlick;
pub use tabulated::Tabulated;

use glam::DVec3;

/// A phase function of the angle between the direction of travel before and after the collision.
///
/// `cosine` is that of the angle between the two directions of travel: 1 is straight on (forward), −1 is back. It is
/// symmetric under exchange and reversal of both, hence reciprocal.
///
/// **Law.** `eval` is nowhere negative and integrates to 1 over the sphere: 2π ∫ eval(μ) dμ over \[−1, 1\] = 1.
/// `sample_cosine(u)` for a uniform u in \[0, 1) has the density 2π eval(μ) per unit of cosine.
pub trait PhaseFunction {
    /// The phase function, which is also the density per solid angle of [`sample`](Self::sample) \[1/sr\].
    fn eval(&self, cosine: f64) -> f64;

    /// The cosine of the angle of deflection, by inversion of its distribution; increasing or decreasing in `u`, finite and
    /// within \[−1, 1\] for every `u` in \[0, 1).
    fn sample_cosine(&self, u: f64) -> f64;

    /// ∫ cosine · eval over the sphere \[1\], in \[−1, 1\].
    fn mean_cosine(&self) -> f64;

    /// Draws the direction after the collision of a particle that travels along the unit vector `incident`.
    #[inline]
    fn sample(&self, incident: DVec3, u: f64, v: f64) -> Scattered {
        let cosine = self.sample_cosine(u);
        let direction = frame::deflect(incident, cosine, std::f64::consts::TAU * v);
        Scattered { direction, weight: 1.0, pdf_solid_angle: self.eval(cosine) }
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The direction of travel after the collision, of unit length.
    pub direction: DVec3,
    /// Phase function / density \[1\]: 1, since all of them are sampled exactly.
    pub weight: f64,
    /// The density of the direction \[1/sr\].
    pub pdf_solid_angle: f64,
}

impl<P: PhaseFunction + ?Sized> PhaseFunction for &P {
    #[inline]
    fn eval(&self, cosine: f64) -> f64 {
        (**self).eval(cosine)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        (**self).sample_cosine(u)
    }
    fn mean_cosine(&self) -> f64 {
        (**self).mean_cosine()
    }
}
