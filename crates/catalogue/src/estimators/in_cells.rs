//! Profiles with bounds in cells, and checks on them.

use crate::checks::{Check, LAWFUL, Law, Specimen, SpecimenField, analytic_cosine, voxels};
use fairflight_laws::{CheckResult, DenseLattice, Run};
use fairflight_media::{
    AnalyticCosine, BoundCell, BoundGrid, BoundedInCells, BoxBounds, Extinction, InCells, IntervalBounds,
    OpticalThickness, PiecewiseConstant, PiecewiseLinear, Ray, Voxels,
};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// Estimates of a quick run; more where closed moments ask for them.
const SAMPLES: u64 = 50_000;

/// A profile with its cells.
pub(super) type Celled<F> = Arc<Specimen<InCells<F, Vec<BoundCell>>>>;

fn celled<F: SpecimenField + OpticalThickness>(
    name: &'static str,
    field: F,
    cells: Vec<BoundCell>,
) -> Celled<F> {
    Arc::new(Specimen::closed(name, InCells::new(field, cells).expect(LAWFUL)))
}

pub(super) fn bump() -> Celled<PiecewiseLinear> {
    let bump =
        PiecewiseLinear::new(vec![0.0, 1.0, 1.5, 2.5, 4.0], vec![0.1, 0.1, 1.8, 0.3, 0.0]).expect(LAWFUL);
    let cells = bump.equal_cells(6);
    celled("bump", bump, cells)
}

/// Noise that no cell resolves: 60 steps in 7 cells.
pub(super) fn noise() -> Celled<PiecewiseConstant> {
    let edges = (0..=60_u32).map(|i| f64::from(i) / 12.0).collect();
    let noise = (0..60_u32).map(|i| 0.05 * f64::from(i * i * 7 % 31)).collect();
    let noise = PiecewiseConstant::new(edges, noise).expect(LAWFUL);
    let cells = noise.equal_cells(7);
    celled("noise", noise, cells)
}

pub(super) fn seed_ray() -> Celled<Ray<Arc<AnalyticCosine>>> {
    let ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let grid = BoundGrid::build(ray.medium(), AnalyticCosine::default_bounds().corners(), [20, 20, 20]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    celled("eq21_seed_ray", ray, cells)
}

pub(super) fn voxel_ray() -> Celled<Ray<Arc<Voxels<DenseLattice>>>> {
    let ray = voxels();
    let corners = (DVec3::ZERO, dvec3(5.0, 5.0, 5.0));
    let grid = BoundGrid::build(ray.medium(), corners, [5, 5, 5]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    celled("voxels", ray, cells)
}

/// Checks that a function gives for each of these.
macro_rules! on_all {
    ($on:ident) => {
        $crate::estimators::on_each!($on of in_cells: bump, noise, seed_ray, voxel_ray)
    };
}
pub(super) use on_all;

/// The cells of a ray.
fn along<M: BoxBounds>(grid: &BoundGrid, ray: &Ray<M>) -> Vec<BoundCell> {
    let mut cells = Vec::new();
    grid.cells_along(ray.local_line(), ray.length(), &mut cells);
    cells
}

/// ∫ of the minorants.
pub(super) fn minorant_thickness<F: BoundedInCells>(field: &F) -> f64 {
    let mut from = 0.0;
    let thickness = |cell: &BoundCell| cell.minorant * (cell.to - std::mem::replace(&mut from, cell.to));
    field.bound_cells().iter().map(thickness).sum()
}

/// A check of the law of transmittance, to be named after its medium and its estimator.
pub(super) fn add<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    run: impl Fn(&Specimen<F>, Run) -> CheckResult + Send + Sync + 'static,
) -> Check {
    let (id, medium) = (format!("cells/{}/{name}", specimen.name), specimen.name);
    let specimen = Arc::clone(specimen);
    let (words, medium) = (name.replace('_', " "), medium.replace('_', " "));
    Check::new(id, Law::Transmittance, words, medium, SAMPLES, move |arguments| run(&specimen, arguments))
}
