//! Row 10: rays in faces, along axes, through edges and corners of voxels.

use super::by_kind::Profile;
use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::{constant, unit_cells};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::DenseLattice;
use fairflight_media::{
    BoundCell, BoundGrid, BoundedInCells, Bounds, Extinction, InCells, OpticalThickness, Ray, Voxels,
};
use fairflight_sources::{Scripted, Seeded};
use fairflight_transmittance::{
    Explorers, JitteredRatioInCells, ResidualCells, Tracking, TransmittanceEstimator,
};
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
    let sampling = constant(1.0, clip.length);
    let walk = Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling)
        .estimate(&ray, &mut Seeded::new(10));
    let outcome = Outcome::value(walk, exact, 1e-13);
    Outcome { passes: outcome.passes && (closed / exact - 1.0).abs() <= 1e-13, ..outcome }
}

/// The same ray in cells of a grid of bounds: they cover it, every look-up is within its cell, and none is wider than a box may be.
fn in_boxes(origin: DVec3, direction: DVec3) -> Outcome {
    let lattice = DenseLattice::of([5, 5, 5], |[x, y, z]| affine(dvec3(x as f64, y as f64, z as f64)));
    let voxels = Voxels::new(&lattice, DAffine3::IDENTITY, 1.0).expect(LAWFUL);
    let (min, max) = (DVec3::ZERO, DVec3::splat(4.0));
    let grid = BoundGrid::build(&voxels, (min, max), [4, 4, 4]).expect(LAWFUL);
    let clip = match Bounds::aligned_box(min, max).expect(LAWFUL).clip(origin, direction, None) {
        Ok(Some(clip)) => clip,
        Ok(None) => return Outcome::said(false, "the ray misses"),
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let ray = Ray::new(&voxels, &clip);
    let mut cells = Vec::new();
    grid.cells_along(ray.local_line(), clip.length, &mut cells);
    let field = match InCells::new(&ray, cells.as_slice()) {
        Ok(field) => field,
        Err(error) => return Outcome::said(false, error.to_string()),
    };
    let at = |i: u32| clip.length * f64::from(i) / 1000.0;
    let admitted = (0..=1000).map(at).all(|s| field.cells_admit(s, field.sigma_t(s)));
    // Between two opposite corners of a box the affine function varies by the sum of its slopes.
    let tight = cells.iter().all(|cell| cell.range() <= 0.1 + 1e-12);
    // Both estimators stay below the transmittance of the minorants, and above that of the majorants.
    let thickness = |bound: fn(&BoundCell) -> f64| -> f64 {
        let mut from = 0.0;
        cells.iter().map(|cell| bound(cell) * (cell.to - std::mem::replace(&mut from, cell.to))).sum()
    };
    let (low, high) = (thickness(|cell| cell.minorant), thickness(|cell| cell.majorant));
    let tau = ray.optical_thickness(0.0, clip.length);
    let mut source = Seeded::new(10);
    let estimates = [
        ResidualCells::default().estimate(&field, &mut source),
        JitteredRatioInCells::new(0.5).expect(LAWFUL).estimate(&field, &mut source),
    ];
    let bounded = estimates.iter().all(|estimate| (0.0..=(-low).exp()).contains(estimate));
    Outcome::said(
        admitted && tight && bounded && low <= tau && tau <= high,
        format!("{} cells, optical thickness {tau:.6} within [{low:.6}, {high:.6}]", cells.len()),
    )
}

/// An interaction exactly on a discontinuity sees one side or the other, never neither.
fn discontinuity() -> Outcome {
    let field = unit_cells(&[0.25, 0.75]);
    let sampling = unit_cells(&[0.5, 1.0]);
    let model = DoubleParticle { albedo: Albedo::default() };
    let walk = Tracking::new(model, field.clone(), sampling);
    // 1 − exp(−0.5): the first collision is where the cells meet, up to rounding; the next would be beyond.
    let ours = walk.estimate(&field, &mut Scripted::new([-(-0.5_f64).exp_m1(), 0.9]));
    Outcome::value(ours, (-1.0_f64).exp(), 0.0)
}

/// Rays that run where voxels meet.
fn rays() -> [(&'static str, DVec3, DVec3); 8] {
    [
        ("along x, negative zeros", dvec3(-1.0, 1.5, 2.5), dvec3(1.0, -0.0, -0.0)),
        ("against z", dvec3(1.5, 0.5, 9.0), dvec3(0.0, -0.0, -1.0)),
        ("in the plane of faces", dvec3(-1.0, 2.0, 1.3), dvec3(1.0, 0.0, 0.25)),
        ("in the boundary plane", dvec3(-1.0, 4.0, 1.3), dvec3(1.0, 0.0, 0.25)),
        ("along an edge", dvec3(2.0, 3.0, -2.0), DVec3::Z),
        ("along an edge of the bounds", dvec3(4.0, 4.0, -2.0), DVec3::Z),
        ("through edges", dvec3(-1.0, -1.0, 0.5), dvec3(1.0, 1.0, 0.0)),
        ("through corners", DVec3::splat(-1.0), DVec3::ONE),
    ]
}

/// The profiles of these rays, in the cells of a grid.
pub(super) fn profiles() -> Vec<(String, Profile)> {
    let profile = |(title, origin, direction): (&str, DVec3, DVec3)| {
        let lattice = DenseLattice::of([5, 5, 5], |[x, y, z]| affine(dvec3(x as f64, y as f64, z as f64)));
        let voxels = Voxels::new(lattice, DAffine3::IDENTITY, 1.0).expect(LAWFUL);
        let (min, max) = (DVec3::ZERO, DVec3::splat(4.0));
        let grid = BoundGrid::build(&voxels, (min, max), [4, 4, 4]).expect(LAWFUL);
        let clip = Bounds::aligned_box(min, max).expect(LAWFUL).clip(origin, direction, None).expect(LAWFUL);
        let ray = Ray::new(voxels, &clip.expect(LAWFUL));
        let mut cells = Vec::new();
        grid.cells_along(ray.local_line(), ray.length(), &mut cells);
        (title.to_owned(), Profile::voxels(ray, cells))
    };
    rays().map(profile).to_vec()
}

pub(super) fn cases() -> Vec<HardCase> {
    let grids = rays().map(|(title, origin, direction)| {
        HardCase::deterministic(
            10,
            format!("bounds in cells of a ray {title}"),
            "grid of bounds, residual and jittered ratio tracking in cells",
            "the cells cover the ray, and every value is within its cell",
            "exact",
            move || in_boxes(origin, direction),
        )
        .about(["residual_cells", "jittered_ratio"])
    });
    let mut cases: Vec<HardCase> = rays()
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
            .about(["double_particle"])
        })
        .collect();
    cases.extend(grids);
    cases.push(
        HardCase::deterministic(
            10,
            "a collision at a discontinuity",
            "double particle with the field as control",
            "exp(-1)",
            "exact",
            discontinuity,
        )
        .about(["double_particle"]),
    );
    cases
}
