//! The estimators that walk between bounds in cells, and jittered ratio tracking on one majorant.

use super::media::{LAWFUL, analytic_cosine, voxels};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use crate::lookups::LookupLaw;
use crate::{Run, scores};
use fairflight_media::{
    AnalyticCosine, BoundCell, BoundGrid, BoundedInCells, BoxBounds, Extinction, InCells, IntervalBounds,
    OpticalThickness, PiecewiseConstant, PiecewiseLinear, Ray,
};
use fairflight_transmittance::{JitteredRatio, JitteredRatioInCells, ResidualCells};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// Estimates of a quick run; and of one with few strata, whose look-ups have a skewed law of which only the mean is known.
const SAMPLES: u64 = 50_000;
const FEW_STRATA: u64 = 150_000;

/// All checks between bounds in cells.
pub(super) fn in_cells() -> Vec<Check> {
    let bump =
        PiecewiseLinear::new(vec![0.0, 1.0, 1.5, 2.5, 4.0], vec![0.1, 0.1, 1.8, 0.3, 0.0]).expect(LAWFUL);
    let cells = bump.equal_cells(6);
    let mut checks = on("bump", bump, cells, FEW_STRATA);

    // Noise that no cell resolves: 60 steps in 7 cells.
    let edges = (0..=60_u32).map(|i| f64::from(i) / 12.0).collect();
    let noise = (0..60_u32).map(|i| 0.05 * f64::from(i * i * 7 % 31)).collect();
    let noise = PiecewiseConstant::new(edges, noise).expect(LAWFUL);
    let cells = noise.equal_cells(7);
    checks.extend(on("noise", noise, cells, SAMPLES));

    let ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let grid = BoundGrid::build(ray.medium(), AnalyticCosine::default_bounds().corners(), [20, 20, 20]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    checks.extend(on("eq21_seed_ray", ray, cells, SAMPLES));

    let ray = voxels();
    let corners = (DVec3::ZERO, dvec3(5.0, 5.0, 5.0));
    let grid = BoundGrid::build(ray.medium(), corners, [5, 5, 5]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    checks.extend(on("voxels", ray, cells, FEW_STRATA));
    checks
}

/// The cells of a ray.
fn along<M: BoxBounds>(grid: &BoundGrid, ray: &Ray<M>) -> Vec<BoundCell> {
    let mut cells = Vec::new();
    grid.cells_along(ray.local_line(), ray.length(), &mut cells);
    cells
}

/// The estimators of this file on `field` in `cells`, those in jittered cells with `samples` estimates.
fn on<F: SpecimenField + OpticalThickness>(
    name: &'static str,
    field: F,
    cells: Vec<BoundCell>,
    samples: u64,
) -> Vec<Check> {
    let specimen = Arc::new(Specimen::closed(name, InCells::new(field, cells).expect(LAWFUL)));
    let residual = |rate: f64| {
        move |specimen: &Specimen<_>, run| {
            let estimator = ResidualCells::new(rate).expect(LAWFUL);
            let main = minorant_thickness(&specimen.field);
            specimen.examine(&estimator, &[], |unit| scores::in_cells(main, unit), LookupLaw::Poisson, run)
        }
    };
    let jittered = |epsilon: f64| {
        move |specimen: &Specimen<_>, run| {
            let estimator = JitteredRatio::new(epsilon).expect(LAWFUL);
            specimen.examine(&estimator, &[], |unit| scores::in_cells(0.0, unit), LookupLaw::MeanOnly, run)
        }
    };
    let jittered_in_cells = |epsilon: f64| {
        move |specimen: &Specimen<_>, run| {
            let estimator = JitteredRatioInCells::new(epsilon).expect(LAWFUL);
            let main = minorant_thickness(&specimen.field);
            specimen.examine(&estimator, &[], |unit| scores::in_cells(main, unit), LookupLaw::MeanOnly, run)
        }
    };
    vec![
        add(&specimen, "residual_cells", SAMPLES, residual(1.0)),
        add(&specimen, "residual_cells_rate_2", SAMPLES, residual(2.0)),
        add(&specimen, "jittered_ratio_1", SAMPLES, jittered(1.0)),
        add(&specimen, "jittered_ratio_0.3", SAMPLES, jittered(0.3)),
        add(&specimen, "jittered_ratio_in_cells_1", samples, jittered_in_cells(1.0)),
        add(&specimen, "jittered_ratio_in_cells_0.25", samples, jittered_in_cells(0.25)),
    ]
}

/// ∫ of the minorants.
fn minorant_thickness<F: BoundedInCells>(field: &F) -> f64 {
    let mut from = 0.0;
    let thickness = |cell: &BoundCell| cell.minorant * (cell.to - std::mem::replace(&mut from, cell.to));
    field.bound_cells().iter().map(thickness).sum()
}

fn add<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    name: &str,
    samples: u64,
    run: impl Fn(&Specimen<F>, Run) -> crate::CheckResult + Send + Sync + 'static,
) -> Check {
    let (id, medium) = (format!("cells/{}/{name}", specimen.name), specimen.name);
    let specimen = Arc::clone(specimen);
    let (words, medium) = (name.replace('_', " "), medium.replace('_', " "));
    Check::new(id, Law::Transmittance, words, medium, samples, move |arguments| run(&specimen, arguments))
}
