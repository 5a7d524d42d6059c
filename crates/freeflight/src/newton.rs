//! Numerical inversion of an optical thickness in closed form (szirmay-kalos-2017 eq. 4).

use crate::root::crossing;
use crate::theory::Moments;
use crate::{ClosedForm, Flight, FreeFlight};
use fairflight_media::{Extinction, OpticalThickness, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Solves τ(0, s) = −ln(1 − u) for s by Newton's method, τ′ = σ_t, inside a bracket that is halved where Newton fails.
///
/// **Law.** That of [`crate::Inversion`]: the density σ_t T itself, every weight is 1. The distance solves the equation
/// to the rounding of s and of τ; where s is the number nearest to the root the error of the law is that of τ.
///
/// **Moments.** E\[weight^k; collided\] = 1 − T, E\[weight^k; escaped\] = T.
///
/// **Cost.** One look-up and one closed form per step; no closed form of their number. Along eq. 21's sphere a collision
/// takes 9.4 steps on average, half of them at most 8, none of a million more than 65: the long ones end where σ_t nearly
/// vanishes, the rounding of τ hides the root, and halving is all that is left. No look-up for a flight that escapes.
///
/// **Domain.** σ_t ≥ 0: τ does not decrease. σ_t = 0 on a stretch is admitted; no flight ends inside it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Newton;

impl Newton {
    /// The distance at which the optical thickness from the start is `depth`, below the `total` of the profile.
    #[inline]
    #[must_use]
    pub fn invert<F: OpticalThickness>(&self, field: &F, depth: f64, total: f64) -> f64 {
        let length = field.length();
        // Exact for a constant field.
        let guess = length * (depth / total);
        crossing(0.0, length, guess, |s| (field.optical_thickness(0.0, s) - depth, field.sigma_t(s)))
    }
}

impl<F: OpticalThickness> FreeFlight<F> for Newton {
    #[inline]
    fn sample(&self, field: &F, source: &mut impl UniformSource) -> Flight {
        let depth = source.next_exponential();
        let total = field.optical_thickness(0.0, field.length());
        let inside = depth < total;
        Flight::unweighted(inside.then(|| self.invert(field, depth, total)))
    }

    #[inline]
    fn admits(&self, _field: &F, _s: f64, sigma_t: f64) -> bool {
        sigma_t >= 0.0
    }
}

impl<F: Extinction> ClosedForm<F> for Newton {
    fn lookups(&self, _quadrature: &mut RayQuadrature<F>, _tolerance: Tolerance) -> Option<Moments> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Inversion;
    use fairflight_media::{AnalyticCosine, Clip, Constant, Counted, PiecewiseConstant, Ray};
    use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};
    use glam::DVec3;

    /// szirmay-kalos-2017 eq. 21 along the axis of its sphere.
    fn seed_ray() -> Ray<AnalyticCosine> {
        let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap();
        Ray::new(
            AnalyticCosine::new(1.0).unwrap(),
            &clip.unwrap_or_else(|| Clip::empty(DVec3::ZERO, DVec3::Z)),
        )
    }

    #[test]
    fn the_thickness_at_the_distance_is_the_depth_asked_for() {
        let field = seed_ray();
        let total = field.optical_thickness(0.0, field.length());
        let mut source = Seeded::new(4);
        for _ in 0..2000 {
            let u = source.next_uniform();
            let depth = -(1.0 - u).ln();
            match Newton.sample(&field, &mut Scripted::new([u])) {
                Flight::Collided { distance, weight } => {
                    assert_eq!(weight, 1.0);
                    // A few roundings of scale · length, as the closed form says, and one of the distance.
                    let error = field.optical_thickness(0.0, distance) - depth;
                    assert!(error.abs() < 16.0 * f64::EPSILON * field.length(), "u = {u}: {error}");
                }
                Flight::Escaped { .. } => assert!(depth >= total),
            }
        }
    }

    #[test]
    fn it_agrees_with_the_closed_inverse_across_empty_cells() {
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 5.0, 6.0], vec![0.0, 0.7, 0.0, 2.0]).unwrap();
        for i in 0..1000 {
            let u = f64::from(i) / 1000.0;
            let [ours, exact] = [
                Newton.sample(&steps, &mut Scripted::new([u])),
                Inversion.sample(&steps, &mut Scripted::new([u])),
            ];
            match (ours.distance(), exact.distance()) {
                (Some(ours), Some(exact)) => assert!((ours - exact).abs() < 1e-14, "u = {u}: {ours} {exact}"),
                (ours, exact) => assert_eq!(ours, exact),
            }
        }
    }

    #[test]
    fn a_flight_takes_few_look_ups_and_none_where_it_escapes() {
        let field = Counted::new(seed_ray());
        let mut source = Seeded::new(1);
        let n = 10_000;
        for _ in 0..n {
            let before = field.lookups();
            if Newton.sample(&field, &mut source).distance().is_none() {
                assert_eq!(field.lookups(), before);
            }
        }
        let mean = field.lookups() as f64 / f64::from(n);
        assert!((2.0..12.0).contains(&mean), "{mean}");
    }

    #[test]
    fn ends_of_the_lattice_and_empty_profiles() {
        for variate in [0.0, LARGEST_VARIATE] {
            let mut source = Scripted::new([variate; 3]);
            let flight = Newton.sample(&seed_ray(), &mut source);
            assert!(flight.distance().is_none_or(|s| (0.0..20.0).contains(&s)), "{flight:?}");
            for empty in [Constant::new(0.0, 1e300).unwrap(), Constant::new(1.0, 0.0).unwrap()] {
                assert_eq!(Newton.sample(&empty, &mut source), Flight::Escaped { weight: 1.0 });
            }
        }
    }
}
