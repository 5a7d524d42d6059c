//! Profiles that several kinds are tried on.

use crate::checks::{LAWFUL, Specimen, analytic_cosine};
use fairflight_media::{AnalyticCosine, PiecewiseConstant, PiecewiseLinear, Ray};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// A tent, σ_t 0.1, 1.5, 0.2 at 0, 1, 3.
pub(super) fn tent() -> Arc<Specimen<PiecewiseLinear>> {
    let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.1, 1.5, 0.2]).expect(LAWFUL);
    Arc::new(Specimen::closed("piecewise_linear", tent))
}

/// Steps of both signs.
pub(super) fn signed() -> Arc<Specimen<PiecewiseConstant>> {
    let signed = PiecewiseConstant::new(vec![0.0, 1.0, 2.0, 3.5], vec![1.0, -0.5, 0.4]).expect(LAWFUL);
    Arc::new(Specimen::closed("piecewise_constant_negative", signed))
}

/// Sixty cells of a twentieth each, of values that follow no pattern: nothing that a dozen teeth resolve.
pub(super) fn rough_cells() -> Arc<Specimen<PiecewiseConstant>> {
    const CELLS: u32 = 60;
    let edges = (0..=CELLS).map(|i| f64::from(i) / 20.0).collect();
    // Multiples of a prime: three-digit noise.
    let values = (0..CELLS).map(|i| f64::from((i * i * 379 + i * 811) % 997) / 700.0).collect();
    Arc::new(Specimen::closed("rough_cells", PiecewiseConstant::new(edges, values).expect(LAWFUL)))
}

/// A bump of two slopes.
pub(super) fn bump() -> Arc<Specimen<PiecewiseLinear>> {
    let bump = PiecewiseLinear::new(vec![0.0, 0.5, 1.5], vec![0.1, 1.0, 0.2]).expect(LAWFUL);
    Arc::new(Specimen::closed("series/bump", bump))
}

/// Sixteen cells that follow no pattern, between 0.1 and 1.5.
pub(super) fn noise() -> Arc<Specimen<PiecewiseConstant>> {
    let edges = (0..=16).map(|i| 0.1 * f64::from(i)).collect();
    let values = (0..16_u32).map(|i| 0.1 + 0.2 * f64::from((7 * i * i + 5 * i) % 11 % 8)).collect();
    Arc::new(Specimen::closed("series/noise", PiecewiseConstant::new(edges, values).expect(LAWFUL)))
}

/// Thin steps of both signs.
pub(super) fn thin_signed() -> Arc<Specimen<PiecewiseConstant>> {
    let signed = PiecewiseConstant::new(vec![0.0, 0.4, 0.8, 1.2], vec![1.0, -0.2, 0.4]).expect(LAWFUL);
    Arc::new(Specimen::closed("series/signed", signed))
}

/// 3.9 units of szirmay-kalos-2017 eq. 21, near the surface of its sphere.
pub(super) fn chord() -> Arc<Specimen<Ray<Arc<AnalyticCosine>>>> {
    Arc::new(Specimen::closed("series/eq21_chord", analytic_cosine(dvec3(9.8, -3.0, 10.0), DVec3::Y)))
}

/// szirmay-kalos-2017 eq. 21 along the axis of its sphere.
pub(super) fn seed_ray() -> Arc<Specimen<Ray<Arc<AnalyticCosine>>>> {
    Arc::new(Specimen::closed("eq21_seed_ray", analytic_cosine(DVec3::ZERO, DVec3::Z)))
}

/// Checks of next flight, power series and their relatives: those that a function gives for a bump, noise, thin steps of both signs and a
/// chord of eq. 21.
macro_rules! on_series {
    ($on:ident) => {
        $crate::estimators::on_each!($on of profiles: bump, noise, thin_signed, chord)
    };
}
pub(super) use on_series;

/// Samples of a quick run on these, where all moments are known; where the shape is taken from the sample, which asks for a larger one;
/// and for what is most skewed: 1.6 times what the shape of a sample asks for at least ([`crate::checks::paths`]). The media are thin
/// for the same reason.
pub(super) const KNOWN: u64 = 80_000;
pub(super) const SAMPLED: u64 = 300_000;
pub(super) const SKEWED: u64 = 900_000;
