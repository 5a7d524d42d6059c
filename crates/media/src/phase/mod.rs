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

use fairflight_elementary::lanes::{LANES, Lanes};
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

    /// The phase function in all lanes, each with the bits of [`eval`](Self::eval).
    #[inline(always)]
    fn eval_lanes(&self, cosines: &Lanes) -> Lanes {
        let mut values = [0.0; LANES];
        for i in 0..LANES {
            values[i] = self.eval(cosines[i]);
        }
        values
    }

    /// The cosine of the angle of deflection, by inversion of its distribution; increasing or decreasing in `u`, finite and
    /// within \[−1, 1\] for every `u` in \[0, 1).
    fn sample_cosine(&self, u: f64) -> f64;

    /// The cosines of all lanes, each with the bits of [`sample_cosine`](Self::sample_cosine).
    #[inline(always)]
    fn sample_cosine_lanes(&self, u: &Lanes) -> Lanes {
        let mut cosines = [0.0; LANES];
        for i in 0..LANES {
            cosines[i] = self.sample_cosine(u[i]);
        }
        cosines
    }

    /// ∫ cosine · eval over the sphere \[1\], in \[−1, 1\].
    fn mean_cosine(&self) -> f64;

    /// Draws the direction after the collision of a particle that travels along the unit vector `incident`.
    #[inline]
    fn sample(&self, incident: DVec3, u: f64, v: f64) -> Scattered {
        let cosine = self.sample_cosine(u);
        let direction = frame::deflect(incident, cosine, v);
        Scattered { direction, weight: 1.0, pdf_solid_angle: self.eval(cosine) }
    }

    /// The directions of [`sample`](Self::sample) in all lanes.
    #[inline(always)]
    fn sample_lanes(&self, incident: &[Lanes; 3], u: &Lanes, v: &Lanes) -> [Lanes; 3] {
        frame::deflect_lanes(incident, &self.sample_cosine_lanes(u), v)
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
    #[inline(always)]
    fn eval_lanes(&self, cosines: &Lanes) -> Lanes {
        (**self).eval_lanes(cosines)
    }
    #[inline]
    fn sample_cosine(&self, u: f64) -> f64 {
        (**self).sample_cosine(u)
    }
    #[inline(always)]
    fn sample_cosine_lanes(&self, u: &Lanes) -> Lanes {
        (**self).sample_cosine_lanes(u)
    }
    fn mean_cosine(&self) -> f64 {
        (**self).mean_cosine()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{set_vector, vector};
    use crate::test_support::random;

    fn lanes_are_one(phase: &impl PhaseFunction) {
        let mut next = random(3);
        for _ in 0..100 {
            let (u, v) = (std::array::from_fn(|_| next()), std::array::from_fn(|_| next()));
            let mut incident = [[0.0; LANES]; 3];
            for lane in 0..LANES {
                let direction = DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5).normalize();
                set_vector(&mut incident, lane, direction);
            }
            let found = phase.sample_lanes(&incident, &u, &v);
            for lane in 0..LANES {
                let expected = phase.sample(vector(&incident, lane), u[lane], v[lane]).direction;
                assert_eq!(
                    vector(&found, lane).to_array().map(f64::to_bits),
                    expected.to_array().map(f64::to_bits)
                );
            }
        }
    }

    #[test]
    fn directions_of_lanes_are_those_of_one() {
        lanes_are_one(&Isotropic);
        lanes_are_one(&Rayleigh);
        for g in [-0.9, 0.0, 1e-7, 0.6, 0.999] {
            lanes_are_one(&HenyeyGreenstein::new(g).unwrap());
            lanes_are_one(&Schlick::new(g).unwrap());
        }
        lanes_are_one(&Tabulated::hazy_mie(33).unwrap());
    }
}
