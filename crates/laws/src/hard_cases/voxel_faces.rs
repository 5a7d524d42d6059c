//! Row 10: rays in faces, along axes, through edges and corners of voxels.

use super::{HardCase, LAWFUL, Outcome};
use crate::DenseLattice;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{Bounds, Constant, OpticalThickness, PiecewiseConstant, Ray, Voxels};
use fairflight_sources::{Scripted, Seeded};
use fairflight_transmittance::{Explorers, Tracking, TransmittanceEstimator};
use glam::{DAffine3, DVec3, dvec3};

/// An affine function, which trilinear interpolation reproduces: ∫ along a segment is length times the value in its middle.
fn affine(p: DVec3) -> f64 {
    0.1 + 0.05 * p.x + 0.02 * p.y + 0.03 * p.z
}

fn through(origin: DVec3, direction: DVec3) -> Outcome {
    let lattice = DenseLattice::of([5, 5, 5], |[x, y, z]| affine(dvec3(x as f64, y as f64, z as f64)));
    let voxels = Voxels::new(&lattice, DAffine3::IDENTITY, 1.0).expect(LAWFUL);
    let bounds = Bounds::aligned_box(DVec3::ZERO, DVec3::splat(4.0)).expect(LAWFUL);
    let clip = match bounds.clip(origin, direction, None) {
        Ok(Some(clip)) => clip,
        Ok(None) => return Outcome::said(false, "the ray misses"),
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let ray = Ray::new(voxels, &clip);
    let exact = (-clip.length * affine(clip.line.at(0.5 * clip.length))).exp();
    let closed = (-ray.optical_thickness(0.0, clip.length)).exp();
    // Two explorers see all of an affine field: the walk has no variance but rounding.
    let control = Explorers::through(&ray, 2).expect(LAWFUL);
    let sampling = Constant::new(1.0, clip.length).expect(LAWFUL);
    let walk = Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling)
        .estimate(&ray, &mut Seeded::new(10));
    let outcome = Outcome::value(walk, exact, 1e-13);
    Outcome { passes: outcome.passes && (closed / exact - 1.0).abs() <= 1e-13, ..outcome }
}

/// An interaction exactly on a discontinuity sees one side or the other, never neither.
fn discontinuity() -> Outcome {
    let field = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.25, 0.75]).expect(LAWFUL);
    let sampling = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![0.5, 1.0]).expect(LAWFUL);
    let model = DoubleParticle { albedo: Albedo::default() };
    let walk = Tracking::new(model, field.clone(), sampling);
    // 1 − exp(−0.5): the first collision is where the cells meet, up to rounding; the next would be beyond.
    let ours = walk.estimate(&field, &mut Scripted::new([-(-0.5_f64).exp_m1(), 0.9]));
    Outcome::value(ours, (-1.0_f64).exp(), 0.0)
}

pub(super) fn cases() -> Vec<HardCase> {
    let rays: [(&str, DVec3, DVec3); 8] = [
        ("along x, negative zeros", dvec3(-1.0, 1.5, 2.5), dvec3(1.0, -0.0, -0.0)),
        ("against z", dvec3(1.5, 0.5, 9.0), dvec3(0.0, -0.0, -1.0)),
        ("in the plane of faces", dvec3(-1.0, 2.0, 1.3), dvec3(1.0, 0.0, 0.25)),
        ("in the boundary plane", dvec3(-1.0, 4.0, 1.3), dvec3(1.0, 0.0, 0.25)),
        ("along an edge", dvec3(2.0, 3.0, -2.0), DVec3::Z),
        ("along an edge of the bounds", dvec3(4.0, 4.0, -2.0), DVec3::Z),
        ("through edges", dvec3(-1.0, -1.0, 0.5), dvec3(1.0, 1.0, 0.0)),
        ("through corners", DVec3::splat(-1.0), DVec3::ONE),
    ];
    let mut cases: Vec<HardCase> = rays
        .into_iter()
        .map(|(title, origin, direction)| {
            HardCase::deterministic(
                10,
                format!("a ray through voxels {title}"),
                "thickness in closed form, double particle with explorers",
                "exp(-length * value in the middle): the values are affine",
                "1e-13 relative",
                move || through(origin, direction),
            )
        })
        .collect();
    cases.push(HardCase::deterministic(
        10,
        "a collision at a discontinuity",
        "double particle with the field as control",
        "exp(-1)",
        "exact",
        discontinuity,
    ));
    cases
}
