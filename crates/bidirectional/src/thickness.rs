//! Optical thickness for weights: deterministic, and the same in both directions.

use fairflight_media::{Extinction, LineThickness, Medium, OpticalThickness, Ray};
use fairflight_media::{Line, PhaseFunction};
use fairflight_scene::{Spectrum, Volume};
use glam::DVec3;
use std::num::NonZeroU32;

/// An optical thickness for densities in weights (raab-2008 section 4.3).
///
/// **Law.** A function of the ray: no variate enters. Then weights are functions of the path, and any value makes them lawful; only
/// the variance tells a good one. Whereas a random transmittance in a weight that belongs to a random transmittance in the
/// contribution is a bias, however unbiased each is alone.
pub trait WeightThickness<M> {
    /// Along a ray in the medium \[1\].
    fn thickness(&self, ray: &Ray<&M>) -> f64;
}

/// The closed form, for a medium that has one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

impl<M: LineThickness> WeightThickness<M> for Exact {
    #[inline]
    fn thickness(&self, ray: &Ray<&M>) -> f64 {
        ray.optical_thickness(0.0, ray.length())
    }
}

/// The midpoint rule of so many nodes, one look-up each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Midpoint(pub NonZeroU32);

impl<M: Medium> WeightThickness<M> for Midpoint {
    #[inline]
    fn thickness(&self, ray: &Ray<&M>) -> f64 {
        let width = ray.length() / f64::from(self.0.get());
        (0..self.0.get()).map(|i| width * ray.sigma_t((f64::from(i) + 0.5) * width)).sum()
    }
}

/// 0: densities of directions and collisions, without what the way takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Neglected;

impl<M> WeightThickness<M> for Neglected {
    #[inline]
    fn thickness(&self, _ray: &Ray<&M>) -> f64 {
        0.0
    }
}

/// Optical thickness between two points: the ends in lexicographic order first, so that both directions evaluate the same numbers.
#[inline]
pub(crate) fn between<M: Medium, P: PhaseFunction, C: Spectrum>(
    volume: &Volume<M, P, C>,
    rule: &impl WeightThickness<M>,
    a: DVec3,
    b: DVec3,
) -> f64 {
    if M::IS_EMPTY {
        return 0.0;
    }
    let (from, to) = if a.to_array() <= b.to_array() { (a, b) } else { (b, a) };
    let offset = to - from;
    let length = offset.length();
    let line = Line { origin: from, direction: offset / length };
    volume.enter(&line, Some(length)).map_or(0.0, |ray| rule.thickness(&ray))
}

/// Optical thickness from a point to the end of the medium.
#[inline]
pub(crate) fn beyond<M: Medium, P: PhaseFunction, C: Spectrum>(
    volume: &Volume<M, P, C>,
    rule: &impl WeightThickness<M>,
    origin: DVec3,
    direction: DVec3,
) -> f64 {
    volume.enter(&Line { origin, direction }, None).map_or(0.0, |ray| rule.thickness(&ray))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::Isotropic;
    use fairflight_media::{AnalyticCosine, Bounds};
    use glam::dvec3;

    fn volume() -> Volume<AnalyticCosine, Isotropic, f64> {
        let medium = AnalyticCosine::new(1.5).unwrap();
        let bounds = Bounds::aligned_box(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
        Volume { medium, bounds, albedo: 0.5, phase: Isotropic }
    }

    #[test]
    fn both_directions_are_equal_to_the_last_bit() {
        let volume = volume();
        let nodes = |n| Midpoint(NonZeroU32::new(n).unwrap());
        // Inside, across the bounds, and all the way through them.
        let ends =
            [dvec3(0.1, -1.3, 0.7), dvec3(-1.9, 1.1, 0.3), dvec3(5.0, 0.4, -3.0), dvec3(-7.0, 1.0, 2.0)];
        let mut seen = 0.0;
        for a in ends {
            for b in ends.into_iter().filter(|&b| b != a) {
                let exact = between(&volume, &Exact, a, b);
                assert_eq!(exact, between(&volume, &Exact, b, a));
                for n in [1, 4, 256] {
                    let rule = nodes(n);
                    assert_eq!(between(&volume, &rule, a, b), between(&volume, &rule, b, a));
                }
                let fine = between(&volume, &nodes(4096), a, b);
                assert!((fine - exact).abs() < 1e-4, "{fine} {exact}");
                assert_eq!(between(&volume, &Neglected, a, b), 0.0);
                seen += exact;
            }
        }
        assert!(seen > 1.0, "{seen}");
    }

    #[test]
    fn an_endless_ray_ends_with_the_medium() {
        let volume = volume();
        let (origin, direction) = (dvec3(0.1, -1.3, 0.7), dvec3(0.0, 0.6, 0.8));
        let far = beyond(&volume, &Exact, origin, direction);
        assert!((far - between(&volume, &Exact, origin, origin + 10.0 * direction)).abs() < 1e-13);
        assert_eq!(beyond(&volume, &Exact, 9.0 * DVec3::X, DVec3::X), 0.0);
    }
}
