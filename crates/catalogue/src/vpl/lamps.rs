//! Light of a lamp that one point reflects, without a random number.

use fairflight_stats::Reference;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A rectangle of radiance `radiance` seen by a point of a diffuse surface through an absorbing medium:
/// ρ/π · L_e ∫ e^{−σ_t r} cos θ cos θ'/r² dA (raab-2008 eq. 5), by the midpoint rule, whose error is that of half the resolution.
#[must_use]
pub fn reflected_rectangle(
    (corner, edge_u, edge_v): (DVec3, DVec3, DVec3),
    (point, normal, reflectance): (DVec3, DVec3, f64),
    (radiance, sigma_t): (f64, f64),
) -> Reference {
    let area = edge_u.cross(edge_v);
    let integral = |n: u32| {
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let mut sum = 0.0;
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let offset = corner + middle(i) * edge_u + middle(j) * edge_v - point;
            let squared = offset.length_squared();
            let cosines = normal.dot(offset).max(0.0) * area.dot(offset).abs() / squared;
            sum += cosines / squared * (-sigma_t * squared.sqrt()).exp();
        }
        reflectance * FRAC_1_PI * radiance * sum / f64::from(n * n)
    };
    let (coarse, fine) = (integral(128), integral(256));
    Reference { error: (fine - coarse).abs(), ..Reference::exact(fine) }
}

/// A sphere of radiance `radiance` above the horizon of a diffuse surface, nothing between: ρ L_e (R/d)² cos θ.
#[must_use]
pub fn reflected_sphere(
    (center, radius): (DVec3, f64),
    (point, normal, reflectance): (DVec3, DVec3, f64),
    radiance: f64,
) -> f64 {
    let offset = center - point;
    let distance = offset.length();
    debug_assert!(normal.dot(offset) >= radius, "the sphere sinks below the horizon");
    reflectance * radiance * (radius / distance).powi(2) * normal.dot(offset) / distance
}
