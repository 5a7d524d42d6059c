//! The greatest extinction on a ray.

use fairflight_harness::field::AnyProfile;
use fairflight_media::{RayQuadrature, Tolerance};

/// The greatest σ_t on a ray, where `observed` is known to occur: at the nodes that the truth was found with, at the borders between
/// panels (where an interpolation has its kinks), and at the top of the parabola through the greatest of these and its neighbours.
pub(super) fn maximum(profile: &AnyProfile, observed: f64) -> f64 {
    let field = profile.field();
    if let Some(maximum) = field.knowledge().maximum {
        return maximum;
    }
    let mut quadrature = RayQuadrature::new(field, &[]);
    quadrature.integrate(Tolerance::to(1e-9), |_, sigma_t| [sigma_t]);
    let borders = quadrature.borders().chain([0.0, field.length()]).map(|s| (s, field.sigma_t(s)));
    let mut points: Vec<(f64, f64)> = quadrature.nodes().chain(borders).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = (0..points.len()).max_by(|&i, &j| points[i].1.total_cmp(&points[j].1)).unwrap_or(0);
    let mut maximum = points[best].1.max(observed);
    if best > 0 && best + 1 < points.len() {
        let s = parabola_top(points[best - 1], points[best], points[best + 1]);
        if s > points[best - 1].0 && s < points[best + 1].0 {
            maximum = maximum.max(field.sigma_t(s));
        }
    }
    maximum
}

/// The extremum of the parabola through three points; NaN for a straight line.
fn parabola_top(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    let (left, right) = (b.0 - a.0, c.0 - b.0);
    let (fall, rise) = (b.1 - a.1, b.1 - c.1);
    b.0 - 0.5 * (left * left * rise - right * right * fall) / (left * rise + right * fall)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_of_a_parabola() {
        let f = |x: f64| (x, 3.0 - (x - 0.7).powi(2));
        assert!((parabola_top(f(0.0), f(0.5), f(2.0)) - 0.7).abs() < 1e-12);
    }
}
