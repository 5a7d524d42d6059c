//! The estimators that walk between bounds in cells, and jittered ratio tracking on one majorant.

use super::media::{LAWFUL, analytic_cosine, voxels};
use super::specimen::{Specimen, SpecimenField};
use super::{Check, Law};
use fairflight_freeflight::HIGHEST_MOMENT;
use fairflight_laws::lookups::{self, LookupLaw};
use fairflight_laws::{Run, scores};
use fairflight_media::{
    AnalyticCosine, BoundCell, BoundGrid, BoundedInCells, BoxBounds, Extinction, InCells, IntervalBounds,
    Majorant, OpticalThickness, PiecewiseConstant, PiecewiseLinear, Ray,
};
use fairflight_transmittance::{JitteredRatio, JitteredRatioInCells, ResidualCells};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// Estimates of a quick run; more where closed moments ask for them.
const SAMPLES: u64 = 50_000;

/// All checks between bounds in cells.
pub(super) fn checks() -> Vec<Check> {
    let bump =
        PiecewiseLinear::new(vec![0.0, 1.0, 1.5, 2.5, 4.0], vec![0.1, 0.1, 1.8, 0.3, 0.0]).expect(LAWFUL);
    let cells = bump.equal_cells(6);
    let mut checks = on("bump", bump, cells);

    // Noise that no cell resolves: 60 steps in 7 cells.
    let edges = (0..=60_u32).map(|i| f64::from(i) / 12.0).collect();
    let noise = (0..60_u32).map(|i| 0.05 * f64::from(i * i * 7 % 31)).collect();
    let noise = PiecewiseConstant::new(edges, noise).expect(LAWFUL);
    let cells = noise.equal_cells(7);
    checks.extend(on("noise", noise, cells));

    let ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let grid = BoundGrid::build(ray.medium(), AnalyticCosine::default_bounds().corners(), [20, 20, 20]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    checks.extend(on("eq21_seed_ray", ray, cells));

    let ray = voxels();
    let corners = (DVec3::ZERO, dvec3(5.0, 5.0, 5.0));
    let grid = BoundGrid::build(ray.medium(), corners, [5, 5, 5]);
    let cells = along(&grid.expect(LAWFUL), &ray);
    checks.extend(on("voxels", ray, cells));
    checks
}

/// The cells of a ray.
fn along<M: BoxBounds>(grid: &BoundGrid, ray: &Ray<M>) -> Vec<BoundCell> {
    let mut cells = Vec::new();
    grid.cells_along(ray.local_line(), ray.length(), &mut cells);
    cells
}

/// The estimators of this file on `field` in `cells`.
fn on<F: SpecimenField + OpticalThickness>(
    name: &'static str,
    field: F,
    cells: Vec<BoundCell>,
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
        move |specimen: &Specimen<InCells<F, Vec<BoundCell>>>, run| {
            let estimator = JitteredRatio::new(epsilon).expect(LAWFUL);
            let cell =
                BoundCell { to: specimen.field.length(), minorant: 0.0, majorant: specimen.field.majorant() };
            let lookups = in_strata(&[cell], epsilon);
            specimen.examine(&estimator, &[], |unit| scores::in_cells(0.0, unit), lookups, run)
        }
    };
    let jittered_in_cells = |epsilon: f64| {
        move |specimen: &Specimen<InCells<F, Vec<BoundCell>>>, run| {
            let estimator = JitteredRatioInCells::new(epsilon).expect(LAWFUL);
            let main = minorant_thickness(&specimen.field);
            let lookups = in_strata(specimen.field.bound_cells(), epsilon);
            specimen.examine(&estimator, &[], |unit| scores::in_cells(main, unit), lookups, run)
        }
    };
    vec![
        add(&specimen, "residual_cells", residual(1.0)),
        add(&specimen, "residual_cells_rate_2", residual(2.0)),
        add(&specimen, "jittered_ratio_1", jittered(1.0)),
        add(&specimen, "jittered_ratio_0.3", jittered(0.3)),
        add(&specimen, "jittered_ratio_in_cells_1", jittered_in_cells(1.0)),
        add(&specimen, "jittered_ratio_in_cells_0.25", jittered_in_cells(0.25)),
    ]
}

/// The look-ups of jittered ratio tracking: in each stratum of the optical thickness e the order N of its series, P(N ≥ k) =
/// e^(k − 1)/k!, k ≥ 1. Strata are as many in a cell as none is thicker than `epsilon`.
fn in_strata(cells: &[BoundCell], epsilon: f64) -> LookupLaw {
    let (mut whole, mut from) = ([0.0; HIGHEST_MOMENT], 0.0);
    for cell in cells {
        let thickness = cell.range() * (cell.to - std::mem::replace(&mut from, cell.to));
        if thickness <= 0.0 {
            continue;
        }
        let count = (thickness / epsilon).ceil().max(1.0);
        let stratum = order_moments(thickness / count);
        whole = (0..count as u64).fold(whole, |whole, _| lookups::sum(&whole, &stratum));
    }
    LookupLaw::Moments(whole)
}

/// E\[N^k\], k = 1 … 8, of the order of one stratum; for e ≤ 1 orders from 30 on have a probability below 1/30! = 4e-33.
fn order_moments(e: f64) -> [f64; HIGHEST_MOMENT] {
    let mut moments = [0.0; HIGHEST_MOMENT];
    let mut reached = 1.0;
    for order in 1..30 {
        let next = reached * e / f64::from(order + 1);
        for (i, moment) in moments.iter_mut().enumerate() {
            *moment += (reached - next) * f64::from(order).powi(i as i32 + 1);
        }
        reached = next;
    }
    moments
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
    run: impl Fn(&Specimen<F>, Run) -> fairflight_laws::CheckResult + Send + Sync + 'static,
) -> Check {
    let (id, medium) = (format!("cells/{}/{name}", specimen.name), specimen.name);
    let specimen = Arc::clone(specimen);
    let kind = if name.starts_with("residual") { "residual_cells" } else { "jittered_ratio" };
    let (words, medium) = (name.replace('_', " "), medium.replace('_', " "));
    Check::new(id, Law::Transmittance, words, medium, SAMPLES, move |arguments| run(&specimen, arguments))
        .about([kind])
}
