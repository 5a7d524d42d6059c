//! Row 11: a small feature at a large ray parameter.

use super::judging::judge_walk;
use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Bounds, Homogeneous, OpticalThickness, PiecewiseConstant, Ray, Vacuum};
use fairflight_sources::Seeded;
use fairflight_transmittance::{Tracking, TransmittanceEstimator};
use glam::{DVec3, dvec3};

const FAR: f64 = 1e6;
const SIZE: f64 = 1e-3;

/// σ_t = 1000 in bounds of size 1e-3 around the origin, seen from 1e6 away.
fn in_space(bounds: Bounds, direction: DVec3, tolerance: f64) -> Outcome {
    let direction = direction.normalize();
    let clip = match bounds.clip(-FAR * direction, direction, None) {
        Ok(Some(clip)) => clip,
        Ok(None) => return Outcome::said(false, "the ray misses"),
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let ray = Ray::new(Homogeneous::new(1.0 / SIZE).expect(LAWFUL), &clip);
    let tau = ray.optical_thickness(0.0, clip.length);
    let control = constant(1.0 / SIZE, clip.length);
    let model = DoubleParticle { albedo: Albedo::default() };
    let walk = Tracking::new(model, control, control).estimate(&ray, &mut Seeded::new(11));
    let outcome = Outcome::value(walk, (-1.0_f64).exp(), tolerance);
    Outcome { passes: outcome.passes && (tau - 1.0).abs() <= tolerance, ..outcome }
}

/// A profile: nothing for 1e6, then σ_t on about 1e-3, as wide as the two edges are apart as numbers.
fn profile() -> PiecewiseConstant {
    let edges = vec![0.0, FAR, FAR + SIZE, FAR + 1.0];
    PiecewiseConstant::new(edges, vec![0.0, 1.0 / SIZE, 0.0]).expect(LAWFUL)
}

pub(super) fn cases() -> Vec<HardCase> {
    let cube = || Bounds::aligned_box(DVec3::splat(-0.5 * SIZE), DVec3::splat(0.5 * SIZE)).expect(LAWFUL);
    let ball = || Bounds::sphere(DVec3::ZERO, 0.5 * SIZE).expect(LAWFUL);
    vec![
        HardCase::deterministic(
            11,
            "a box of 1e-3 seen from 1e6, along an axis",
            "clipped ray, double particle",
            "exp(-1)",
            "1e-12: the input is exact",
            move || in_space(cube(), DVec3::X, 1e-12),
        )
        .about(["double_particle"]),
        HardCase::deterministic(
            11,
            "a ball of 1e-3 seen from 1e6, obliquely",
            "clipped ray, double particle",
            "exp(-1)",
            "1e-7: the conditioning of the input",
            move || in_space(ball(), dvec3(0.3, -0.7, 0.64), 1e-7),
        )
        .about(["double_particle"]),
        HardCase::deterministic(
            11,
            "a profile with a feature of 1e-3 at 1e6",
            "double particle with the field as control",
            "exp(-1000 (edge difference)), exact by Sterbenz's lemma",
            "1e-12",
            || {
                let field = profile();
                let width = (FAR + SIZE) - FAR;
                let rate = PiecewiseConstant::new(vec![0.0, FAR, FAR + 1.0], vec![0.0, 10.0]).expect(LAWFUL);
                let model = DoubleParticle { albedo: Albedo::default() };
                let walk = Tracking::new(model, field.clone(), rate);
                Outcome::value(walk.estimate(&field, &mut Seeded::new(11)), (-width / SIZE).exp(), 1e-12)
            },
        )
        .about(["double_particle"]),
        HardCase::statistical(
            11,
            "a profile with a feature of 1e-3 at 1e6, no control",
            "double particle, sigma_samp 2000 on the feature",
            "exp(-1000 (edge difference))",
            100_000,
            |run| {
                let edges = vec![0.0, FAR, FAR + SIZE, FAR + 1.0];
                let rate = PiecewiseConstant::new(edges, vec![0.0, 2.0 / SIZE, 0.0]).expect(LAWFUL);
                let model = DoubleParticle { albedo: Albedo::default() };
                judge_walk(&profile(), &Tracking::new(model, Vacuum::new(FAR + 1.0), rate), run)
            },
        )
        .about(["double_particle"]),
    ]
}
