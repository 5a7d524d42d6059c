//! Transmittance of edges where it has no closed form: null collisions as part of the state.

use super::EdgeTransmittance;
use fairflight_elementary::ln_1p;
use fairflight_media::{Extinction, Medium, Ray};
use fairflight_sources::UniformSource;

/// Null collisions of a majorant μ ≥ σ_t, which belong to an edge as long as that is not changed.
///
/// The state is a path x with a set N of points on each edge, and its target is
///
/// ```text
/// f^(x, N) = f(x)/T · Π (1 − σ_t/μ) over N,   with respect to points at the rate μ
/// ```
///
/// of which f is the marginal, since the mean of the product over such points is T (ratio tracking). A mutation draws points of the edges that it makes at
/// the rate μ, and keeps those of the others: its ratio is that of f^, the densities of points cancel.
///
/// **Start.** A path that was found with the weight f/p has points whose law, given the path, is f^: the rate μ with the density Π (1 − σ_t/μ), that is
/// the rate μ − σ_t. These are the null collisions that a flight of Woodcock's met on its way through, whichever strategy found the path and whatever it
/// drew itself. Points at the rate μ, as for an edge that is made, would be a bias: the state would be fainter than its weight says.
///
/// Only the product is needed, and kept. **Assumes** μ ≥ σ_t everywhere: else factors are negative, and there is no target. Paths with weights of either sign are
/// for chains in primary sample space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NullCollisions {
    majorant: f64,
}

/// A rate that does not bound the extinction, so that walks would be signed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "null collisions need a finite majorant above 0 of an extinction that knows its bound: found {majorant}, the bound is {bound:?}"
)]
pub struct NoMajorant {
    /// The rate given \[1/length\].
    pub majorant: f64,
    /// The bound of the medium, where it knows one \[1/length\].
    pub bound: Option<f64>,
}

impl NullCollisions {
    /// Null collisions of `medium` at the rate `majorant`.
    ///
    /// # Errors
    /// If that is not positive and finite, lies below the bound of the medium, or the medium has none.
    pub fn new(medium: &impl Medium, majorant: f64) -> Result<Self, NoMajorant> {
        let bound = medium.upper_bound();
        let bounds = majorant > 0.0 && majorant.is_finite() && bound.is_some_and(|bound| bound <= majorant);
        if bounds { Ok(Self { majorant }) } else { Err(NoMajorant { majorant, bound }) }
    }

    /// Σ ln(1 − σ_t/μ) over points at the rate μ of which `keep` sees σ_t/μ.
    fn ln_product<M: Medium>(
        &self,
        ray: &Ray<&M>,
        source: &mut dyn UniformSource,
        keep: impl Fn(f64, &mut dyn UniformSource) -> bool,
    ) -> f64 {
        let (mut sum, mut s) = (0.0, 0.0);
        loop {
            s += source.next_exponential() / self.majorant;
            if s >= ray.length() {
                return sum;
            }
            let ratio = ray.sigma_t(s) / self.majorant;
            debug_assert!((0.0..=1.0).contains(&ratio), "the majorant is none: σ_t/μ = {ratio}");
            if keep(ratio, source) {
                sum += ln_1p(-ratio);
            }
        }
    }
}

impl<M: Medium> EdgeTransmittance<M> for NullCollisions {
    fn ln_transmittance(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64 {
        self.ln_product(ray, source, |_, _| true)
    }

    fn ln_found(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64 {
        self.ln_product(ray, source, |ratio, source| source.next_uniform() >= ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Line, OpticalThickness};
    use fairflight_sources::{Scripted, Seeded};
    use glam::DVec3;

    #[test]
    fn a_rate_below_the_extinction_is_refused() {
        let medium = Homogeneous::new(2.0).unwrap();
        assert!(NullCollisions::new(&medium, 2.0).is_ok());
        for majorant in [1.9, 0.0, f64::NAN, f64::INFINITY] {
            let refused = NullCollisions::new(&medium, majorant).unwrap_err();
            assert_eq!(refused.bound, Some(2.0));
        }
    }

    #[test]
    fn edges_that_are_made_keep_all_points_and_edges_that_were_found_those_that_passed() {
        let medium = Homogeneous::new(1.0).unwrap();
        let line = Line { origin: DVec3::ZERO, direction: DVec3::X };
        let clip = Bounds::sphere(DVec3::ZERO, 2.0).unwrap().clip_inside(line);
        let ray = Ray::new(&medium, &clip);
        let nulls = NullCollisions::new(&medium, 4.0).unwrap();
        // Steps of ln 2/4 and of 3 ln 2/4, then one that leaves.
        let script = [0.5, 0.875, 1.0 - 1e-12];
        assert_eq!(nulls.ln_transmittance(&ray, &mut Scripted::new(script)), 2.0 * 0.75f64.ln());
        let kept = nulls.ln_found(&ray, &mut Scripted::new([0.5, 0.25, 0.875, 0.24, 1.0 - 1e-12]));
        assert_eq!(kept, 0.75f64.ln());
    }

    #[test]
    fn the_means_are_the_transmittance_and_its_second_moment_over_it() {
        // E over the rate μ − σ of the product is E over the rate μ of its square, over T.
        let medium = AnalyticCosine::new(1.5).unwrap();
        let line = Line { origin: DVec3::ZERO, direction: DVec3::new(0.6, 0.0, 0.8) };
        let clip = Bounds::sphere(DVec3::ZERO, 1.2).unwrap().clip_inside(line);
        let ray = Ray::new(&medium, &clip);
        let t = (-ray.optical_thickness(0.0, ray.length())).exp();
        let nulls = NullCollisions::new(&medium, 1.2 * medium.upper_bound().unwrap()).unwrap();
        let mut source = Seeded::new(5);
        let n = 100_000;
        let (mut made, mut squares, mut found) = (0.0, 0.0, 0.0);
        for _ in 0..n {
            let product = nulls.ln_transmittance(&ray, &mut source).exp();
            made += product / f64::from(n);
            squares += product * product / f64::from(n);
            found += nulls.ln_found(&ray, &mut source).exp() / f64::from(n);
        }
        // Products lie in (0, 1): standard errors of at most 0.0016 each.
        assert!((made - t).abs() < 0.008, "{made} {t}");
        assert!((found - squares / t).abs() < 0.008 * (1.0 + 1.0 / t), "{found} {}", squares / t);
    }
}
