//! Woodcock tracking: tentative flights through a majorant (raab-2008 algorithm 1, woodcock-1965).

use crate::theory::{Moments, lookups_of_a_walk};
use crate::{ClosedForm, Flight, FreeFlight};
use fairflight_media::{Extinction, InvertOpticalThickness, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Flies through the majorant, and accepts a collision at s with probability σ_t(s)/majorant(s).
///
/// raab-2008 algorithm 1 with a majorant that may vary along the ray, so that cells with majorants of their own cost no
/// restart at their borders: the tentative flight is inverted across them.
///
/// **Law.** Tentative collisions are a Poisson process of rate majorant(s); keeping each with probability σ_t/majorant
/// leaves one of rate σ_t, whose first point has the density σ_t T. Every weight is 1.
///
/// **Moments.** E\[weight^k; collided\] = 1 − T, E\[weight^k; escaped\] = T, whatever the majorant.
///
/// **Cost.** ∫ majorant(s) T(s) ds look-ups: one per tentative collision, until one is accepted. A flight that passes the
/// virtual extinction ν = ∫ (majorant − σ_t) makes a Poisson number of mean ν of them, and one more where it collides.
///
/// **Domain.** 0 ≤ σ_t(s) ≤ majorant(s) everywhere. Above the majorant too few flights collide: a bias.
///
/// The printed algorithm takes −log(rand()), infinite at 0, and accepts at `ratio ≥ rand()`, which can collide in empty
/// space; here −ln(1 − u), and a collision only where `u < ratio`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Woodcock<R> {
    majorant: R,
}

impl<R: InvertOpticalThickness> Woodcock<R> {
    /// Woodcock tracking through `majorant`, which covers the profile to be sampled and no more.
    pub fn new(majorant: R) -> Self {
        Self { majorant }
    }

    /// The majorant along the ray.
    pub fn majorant(&self) -> &R {
        &self.majorant
    }
}

impl<F: Extinction, R: InvertOpticalThickness> FreeFlight<F> for Woodcock<R> {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        debug_assert_eq!(field.length(), self.majorant.length(), "prepared for another profile");
        let mut s = 0.0;
        while let Some(next) = self.majorant.invert(s, source.next_exponential()) {
            s = next;
            // The majorant where the tentative collision is, not where the flight began.
            if source.next_uniform() * self.majorant.sigma_t(s) < field.sigma_t(s) {
                return Flight::Collided { distance: s, weight: 1.0 };
            }
        }
        Flight::Escaped { weight: 1.0 }
    }

    #[inline]
    fn admits(&self, _field: &F, s: f64, sigma_t: f64) -> bool {
        (0.0..=self.majorant.sigma_t(s)).contains(&sigma_t)
    }
}

impl<F: Extinction, R: InvertOpticalThickness> ClosedForm<F> for Woodcock<R> {
    fn lookups(&self, quadrature: &mut RayQuadrature<F>, tolerance: Tolerance) -> Option<Moments> {
        let rates = |s: f64, sigma_t: f64| [sigma_t, self.majorant.sigma_t(s) - sigma_t];
        Some(lookups_of_a_walk(quadrature, tolerance, &rates))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Constant, PiecewiseConstant};
    use fairflight_sources::Scripted;

    /// u with −ln(1 − u) = depth.
    fn variate(depth: f64) -> f64 {
        -(-depth).exp_m1()
    }

    #[test]
    fn the_majorant_of_the_cell_that_was_reached_decides() {
        let field = Constant::new(0.5, 2.0).unwrap();
        let majorant = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![2.0, 0.5]).unwrap();
        let woodcock = Woodcock::new(majorant);
        // The first step ends at 1.5, where the majorant is tight: a collision for every variate.
        let flight = woodcock.sample(&field, &mut Scripted::new([variate(2.25), 0.999]));
        assert!((flight.distance().unwrap() - 1.5).abs() < 1e-15, "{flight:?}");
        // At 0.5 the ratio is 1/4.
        let sample = |u: f64| woodcock.sample(&field, &mut Scripted::new([variate(1.0), u, variate(3.0)]));
        assert!(sample(0.25_f64.next_down()).distance().is_some());
        assert_eq!(sample(0.25), Flight::Escaped { weight: 1.0 });
    }

    #[test]
    fn nothing_collides_in_empty_space() {
        let empty = Constant::new(0.0, 1.0).unwrap();
        let woodcock = Woodcock::new(Constant::new(1.0, 1.0).unwrap());
        let flight = woodcock.sample(&empty, &mut Scripted::new([0.5, 0.0, 0.5]));
        assert_eq!(flight, Flight::Escaped { weight: 1.0 });
    }

    #[test]
    fn expected_look_ups_of_a_constant_field() {
        let field = Constant::new(0.5, 2.0).unwrap();
        let mut quadrature = RayQuadrature::new(field, &[]);
        let woodcock = Woodcock::new(Constant::new(2.0, 2.0).unwrap());
        // 2 ∫ exp(−s/2) ds over 2.
        let exact = 4.0 * -(-1.0_f64).exp_m1();
        let found = woodcock.lookups(&mut quadrature, Tolerance::TIGHT).unwrap();
        assert!((found[0] - exact).abs() < 1e-12);
        // Without matter the number is Poisson of mean 4.
        let mut empty = RayQuadrature::new(Constant::new(0.0, 2.0).unwrap(), &[]);
        let found = woodcock.lookups(&mut empty, Tolerance::TIGHT).unwrap();
        assert!((found[0] - 4.0).abs() < 1e-12 && (found[1] - 20.0).abs() < 1e-11);
    }

    #[test]
    fn it_admits_what_lies_between_nothing_and_its_majorant() {
        let woodcock = Woodcock::new(Constant::new(2.0, 1.0).unwrap());
        let field = Constant::new(1.0, 1.0).unwrap();
        let admitted = [-0.1, 0.0, 2.0, 2.1, f64::NAN].map(|sigma_t| woodcock.admits(&field, 0.5, sigma_t));
        assert_eq!(admitted, [false, true, true, false, false]);
    }
}
