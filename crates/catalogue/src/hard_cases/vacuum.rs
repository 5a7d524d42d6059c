//! Rows 1, 2 and 12: nothing on the ray, nothing of the ray, next to nothing of the ray.

use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Bounded, Bounds, Clip, Homogeneous, OpticalThickness, Ray, Vacuum};
use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};
use fairflight_transmittance::{LineIntegral, Tracking, TransmittanceEstimator, Woodcock};
use glam::{DVec3, dvec3};

/// The value that all of `values` have, or one that differs from `exact`.
fn common(values: &[f64], exact: f64) -> f64 {
    values.iter().copied().find(|value| *value != exact).unwrap_or(exact)
}

fn empty_ray() -> Outcome {
    let field = constant(0.0, 1e300);
    let bounded = Bounded::new(field, 0.0).expect(LAWFUL);
    let tracking = Tracking::new(DoubleParticle { albedo: Albedo::default() }, Vacuum::new(1e300), field);
    let line = LineIntegral::new(4).expect(LAWFUL);
    let values: Vec<f64> = [0.0, 0.5, LARGEST_VARIATE]
        .into_iter()
        .flat_map(|u| {
            let script = || Scripted::new([u; 2]);
            [
                tracking.estimate(&field, &mut script()),
                Woodcock.estimate(&bounded, &mut script()),
                line.estimate(&bounded, &mut script()),
            ]
        })
        .collect();
    Outcome::value(common(&values, 1.0), 1.0, 0.0)
}

/// The local majorant belongs to a dense region that this ray passes by.
fn beside_a_dense_region(majorant_thickness: f64) -> Outcome {
    const LENGTH: f64 = 2.0;
    let field = constant(0.0, LENGTH);
    let majorant = majorant_thickness / LENGTH;
    let bounded = Bounded::new(field, majorant).expect(LAWFUL);
    let sampling = constant(majorant, LENGTH);
    let tracking = Tracking::new(DoubleParticle { albedo: Albedo::default() }, Vacuum::new(LENGTH), sampling);
    let line = LineIntegral::new(4).expect(LAWFUL);
    let mut source = Seeded::new(2);
    let values: Vec<f64> = (0..10)
        .flat_map(|_| {
            [
                Woodcock.estimate(&bounded, &mut source),
                line.estimate(&bounded, &mut source),
                tracking.estimate(&field, &mut source),
            ]
        })
        .collect();
    // p_S + p_V, two roundings.
    let worst = values
        .iter()
        .copied()
        .fold(1.0, |worst: f64, v| if (v - 1.0).abs() > (worst - 1.0).abs() { v } else { worst });
    Outcome::value(worst, 1.0, f64::EPSILON)
}

/// A ray through the sphere of radius 10 around (0, 0, 10), σ_t = 0.5.
fn clipped(origin: DVec3, direction: DVec3, length: Option<f64>, exact: f64, tolerance: f64) -> Outcome {
    let bounds = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 10.0).expect(LAWFUL);
    let clip = match bounds.clip(origin, direction, length) {
        Ok(clip) => clip.unwrap_or_else(|| Clip::empty(origin, direction)),
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let ray = Ray::new(Homogeneous::new(0.5).expect(LAWFUL), &clip);
    let tau = ray.optical_thickness(0.0, clip.length);
    // The walk with the field as its control has no variance.
    let control = constant(0.5, clip.length);
    let tracking = Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, control);
    let walked = tracking.estimate(&ray, &mut Scripted::new([0.2, LARGEST_VARIATE]));
    let closed = Outcome::value((-tau).exp(), exact, tolerance);
    Outcome { passes: closed.passes && (walked - exact).abs() <= tolerance, ..closed }
}

/// Title, origin, direction, length of the ray, length inside, tolerance.
type Clipping = (&'static str, DVec3, DVec3, Option<f64>, f64, f64);

/// Rays and the sphere of radius 10 around (0, 0, 10).
pub(super) fn clips() -> [Clipping; 9] {
    [
        ("a segment of length 0", DVec3::ZERO, DVec3::Z, Some(0.0), 0.0, 0.0),
        ("a segment of length 0 inside", dvec3(0.0, 0.0, 4.0), DVec3::Z, Some(0.0), 0.0, 0.0),
        ("a ray that grazes the bounds", dvec3(-7.0, 10.0, 10.0), DVec3::X, None, 0.0, 0.0),
        ("a ray that misses the bounds", dvec3(-7.0, 10.5, 10.0), DVec3::X, None, 0.0, 0.0),
        ("an origin on the bounds, inwards", DVec3::ZERO, DVec3::Z, None, 20.0, 1e-15),
        ("an origin on the bounds, outwards", DVec3::ZERO, -DVec3::Z, None, 0.0, 0.0),
        ("an origin inside", dvec3(0.0, 0.0, 4.0), DVec3::Z, None, 16.0, 1e-15),
        ("an origin beyond", dvec3(0.0, 0.0, 20.5), DVec3::Z, None, 0.0, 0.0),
        ("a segment that ends before the bounds", dvec3(0.0, 0.0, -5.0), DVec3::Z, Some(4.0), 0.0, 0.0),
    ]
}

pub(super) fn cases() -> Vec<HardCase> {
    let mut cases = vec![
        HardCase::deterministic(
            1,
            "sigma_t = 0 on a ray of length 1e300, majorant and sigma_samp 0",
            "woodcock, double particle, line integral",
            "1 (nothing attenuates)",
            "exact",
            empty_ray,
        )
        .about(["woodcock", "double_particle", "line_integral"]),
    ];
    for thickness in [88.0, 745.0, 2000.0] {
        cases.push(
            HardCase::deterministic(
                2,
                format!("nothing on the ray, a majorant of optical thickness {thickness}"),
                "woodcock, double particle, line integral",
                "1 (nothing attenuates)",
                "one rounding",
                move || beside_a_dense_region(thickness),
            )
            .about(["woodcock", "double_particle", "line_integral"]),
        );
    }
    for (title, origin, direction, length, inside, tolerance) in clips() {
        let exact = f64::exp(-0.5 * inside);
        cases.push(
            HardCase::deterministic(
                12,
                title,
                "clipped ray, double particle",
                format!("exp(-0.5 * {inside}), the length inside by hand"),
                if tolerance == 0.0 { "exact" } else { "a few roundings" },
                move || clipped(origin, direction, length, exact, tolerance),
            )
            .about(["double_particle"]),
        );
    }
    cases
}
