//! The media: from one number to noise, so that a mistake has somewhere to show.

use super::specimen::{Specimen, SpecimenField};
use super::{Check, exact};
use crate::estimators::ray_marching::jittered;
use crate::estimators::{double_particle, line_integral, ray_marching, single_particle, woodcock};
use fairflight_laws::DenseLattice;
use fairflight_media::{
    AnalyticCosine, Bounds, Clip, Constant, ExpressionProfile, FieldError, Medium, Perlin, PerlinParameters,
    PiecewiseConstant, PiecewiseLinear, Ray, Tolerance, Voxels,
};
use glam::{DAffine3, DVec3, dvec3};
use std::sync::Arc;

/// A medium that this file gets wrong would be a bug here, not a finding: its constructors are told so.
pub(crate) const LAWFUL: &str = "the catalogue's media are lawful";

/// Flights per line integral. Its theory costs an integral over the shift for each, hence fewer where cells are many.
const SPLITS: [u32; 3] = [1, 4, 16];

/// Every estimator on every medium that admits it.
pub(super) fn checks() -> Vec<Check> {
    let mut checks = Vec::new();

    let constant = Constant::new(0.7, 3.0).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("constant", constant));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 1.0, 0.5, 4));
    checks.push(jittered(&specimen));
    checks.extend(exact::variance_checks(&specimen));

    let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.5, 4.0], vec![1.2, 0.1, 0.6]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_constant", steps));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 1.2, 0.6, 9));
    checks.push(jittered(&specimen));
    checks.extend(single_particle::all_versions(&specimen, 1.2, &[0.0, 0.5, 0.9]));

    // Section 3.3: negative extinction.
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_constant_negative", signed));
    checks.extend(of_any_sign(&specimen, 1.5, 0.3, 9));
    checks.push(jittered(&specimen));
    checks.extend(single_particle::of_any_sign(&specimen, 1.5));

    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    let specimen = Arc::new(Specimen::closed("piecewise_linear", tent));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 1.5, 0.8, 5));
    checks.push(jittered(&specimen));

    let seed_ray = analytic_cosine(DVec3::ZERO, DVec3::Z);
    let specimen = Arc::new(Specimen::closed("eq21_seed_ray", seed_ray));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 1.0, 0.17, 17));
    checks.push(jittered(&specimen));
    checks.extend(single_particle::all_versions(&specimen, 1.0, &[0.5]));

    let oblique = analytic_cosine(dvec3(-9.0, 3.0, -4.0), dvec3(0.55, -0.2, 0.81));
    let specimen = Arc::new(Specimen::closed("eq21_oblique_ray", oblique));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 1.0, 0.17, 25));
    checks.push(jittered(&specimen));

    // 2 units of length: 4000 cells of the finest octave.
    let perlin = Perlin::new(PerlinParameters { offset: 0.4, scale: 1.2, ..PerlinParameters::default() })
        .expect(LAWFUL);
    let bounds = Bounds::aligned_box(dvec3(1.0, 1.0, 1.0), dvec3(3.0, 3.0, 3.0)).expect(LAWFUL);
    let ray = ray(Arc::new(perlin), bounds, dvec3(0.0, 1.5, 1.2), dvec3(1.0, 0.2, 0.3)).expect(LAWFUL);
    let mut specimen = Specimen::certified("perlin", ray, Tolerance::to(1e-8));
    specimen.frugality = 4;
    let specimen = Arc::new(specimen);
    checks.extend(of_positive(&specimen, &SPLITS[..2]));
    checks.extend(of_any_sign(&specimen, 1.0, 0.4, 9));

    let specimen = Arc::new(Specimen::closed("voxels", voxels()));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 0.6, 0.35, 7));
    checks.push(jittered(&specimen));

    let expression = ExpressionProfile::new("0.3 + 0.25*sin(7*s)*exp(-0.2*s)", 9.0, Some(0.6)).expect(LAWFUL);
    let specimen = Arc::new(Specimen::certified("expression", expression, Tolerance::TIGHT));
    checks.extend(of_positive(&specimen, &SPLITS));
    checks.extend(of_any_sign(&specimen, 0.6, 0.3, 17));
    checks.push(jittered(&specimen));
    checks
}

/// The estimators that need 0 ≤ σ_t ≤ the field's own majorant, the line integral with each of `splits`.
fn of_positive<F: SpecimenField>(specimen: &Arc<Specimen<F>>, splits: &[u32]) -> Vec<Check> {
    let mut checks = vec![woodcock::on(specimen)];
    checks.extend(line_integral::on(specimen, splits));
    checks
}

/// The estimators that admit values of any sign.
fn of_any_sign<F: SpecimenField>(
    specimen: &Arc<Specimen<F>>,
    majorant: f64,
    mean: f64,
    explorers: usize,
) -> Vec<Check> {
    let mut checks = double_particle::on(specimen, majorant, mean, explorers);
    checks.push(ray_marching::fixed(specimen));
    checks
}

/// szirmay-kalos-2017 eq. 21 in its sphere.
pub(crate) fn analytic_cosine(origin: DVec3, direction: DVec3) -> Ray<Arc<AnalyticCosine>> {
    let medium = Arc::new(AnalyticCosine::new(1.0).expect(LAWFUL));
    ray(medium, AnalyticCosine::default_bounds(), origin, direction).expect(LAWFUL)
}

/// Six voxels a side, values that follow no pattern.
pub(crate) fn voxels() -> Ray<Arc<Voxels<DenseLattice>>> {
    let lattice = DenseLattice::of([6, 6, 6], |[x, y, z]| 0.1 * ((7 * x + 5 * y + 11 * z) % 6 + 1) as f64);
    let medium = Arc::new(Voxels::new(lattice, DAffine3::IDENTITY, 1.0).expect(LAWFUL));
    let bounds = Bounds::aligned_box(DVec3::ZERO, DVec3::splat(5.0)).expect(LAWFUL);
    ray(medium, bounds, dvec3(-1.0, 0.7, 1.1), dvec3(1.0, 0.35, 0.45)).expect(LAWFUL)
}

fn ray<M: Medium>(medium: M, bounds: Bounds, origin: DVec3, direction: DVec3) -> Result<Ray<M>, FieldError> {
    let clip = bounds.clip(origin, direction, None)?.unwrap_or_else(|| Clip::empty(origin, direction));
    Ok(Ray::new(medium, &clip))
}
