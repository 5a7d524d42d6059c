//! Closed forms on the ray of szirmay-kalos-2017 eq. 21 along z, against the same sums written down independently (numpy, midpoint
//! rule with 2·10⁶ points, three digits).

use crate::{ClosedForm, JitteredRatio, JitteredRatioInCells, ResidualCells, Theory, Tracking, theory_on};
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::{
    AnalyticCosine, BoundCell, Breakpoints, Clip, Extinction, InCells, Majorant, OpticalThickness,
    PiecewiseConstant, Ray, Vacuum,
};
use glam::DVec3;

fn seed_ray() -> Ray<AnalyticCosine> {
    let clip = AnalyticCosine::default_bounds().clip(DVec3::ZERO, DVec3::Z, None).unwrap();
    Ray::new(AnalyticCosine::new(1.0).unwrap(), &clip.unwrap_or_else(|| Clip::empty(DVec3::ZERO, DVec3::Z)))
}

/// 20 equal cells with the least and the greatest of very many values in each: an extreme inside is missed by some 1e-8.
fn cells(ray: &Ray<AnalyticCosine>) -> Vec<BoundCell> {
    const POINTS: i32 = 20_000;
    let bounds = |i: i32| {
        let values = (0..=POINTS).map(|j| ray.sigma_t(f64::from(i) + f64::from(j) / f64::from(POINTS)));
        let (minorant, majorant) =
            values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        BoundCell { to: f64::from(i + 1), minorant, majorant }
    };
    (0..20).map(bounds).collect()
}

fn theory<F: Breakpoints + OpticalThickness + Copy>(field: F, estimator: &impl ClosedForm<F>) -> Theory {
    let borders: Vec<f64> = (1..20).map(f64::from).collect();
    theory_on(field, estimator, &borders)
}

/// Relative variance and look-ups, to half a unit of the last digit that was written down.
fn check(theory: &Theory, variance: (f64, f64), lookups: (f64, f64)) {
    let found = (theory.relative_central[0], theory.lookups);
    assert!((found.0 - variance.0).abs() <= variance.1, "{found:?}, variance {}", variance.0);
    assert!((found.1 - lookups.0).abs() <= lookups.1, "{found:?}, lookups {}", lookups.0);
    assert!((theory.log_relative_variance - found.0.ln()).abs() < 1e-9);
}

#[test]
fn in_cells_with_exact_bounds() {
    let ray = seed_ray();
    let cells = cells(&ray);
    let field = InCells::new(&ray, cells.as_slice()).unwrap();
    assert!((field.majorant() - 0.956).abs() < 5e-4);

    let edges = std::iter::once(0.0).chain(cells.iter().map(|cell| cell.to)).collect();
    let majorants = cells.iter().map(|cell| cell.majorant).collect();
    let sampling = PiecewiseConstant::new(edges, majorants).unwrap();
    let model = DoubleParticle { albedo: Albedo::default() };
    let ratio_tracking = Tracking::new(model, Vacuum::new(20.0), sampling);
    check(&theory(field, &ratio_tracking), (12.3, 0.05), (6.7, 0.05));

    check(&theory(field, &ResidualCells::default()), (6.54, 0.005), (6.0, 0.05));
    check(&theory(field, &JitteredRatioInCells::new(0.5).unwrap()), (0.269, 5e-4), (28.4, 0.05));
    check(&theory(field, &JitteredRatioInCells::new(0.25).unwrap()), (0.0619, 5e-5), (41.2, 0.05));
}

#[test]
fn with_one_majorant() {
    let ray = seed_ray();
    assert_eq!(ray.majorant(), 1.0);
    check(&theory(ray, &JitteredRatio::new(0.5).unwrap()), (0.272, 5e-4), (51.9, 0.05));
    // exp(e) − 1 for each of 20/e strata.
    let lookups = 20.0 * 0.25_f64.exp_m1() / 0.0625;
    assert!((theory(ray, &JitteredRatio::new(0.25).unwrap()).lookups - lookups).abs() < 1e-10);
}
