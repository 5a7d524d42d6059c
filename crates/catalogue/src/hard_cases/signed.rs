//! Rows 3, 4 and 5: a sampling extinction below the extinction, and negative extinction.

use super::judging::judge_walk;
use super::{HardCase, Outcome};
use crate::profiles::{constant, unit_cells};
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_media::{Constant, Vacuum};
use fairflight_sources::Seeded;
use fairflight_transmittance::{Tracking, TransmittanceEstimator};

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// A walk with a constant sampling extinction over a length of 2.
fn walk<M: CollisionModel>(model: M, sampling: f64) -> Tracking<M, Vacuum, Constant> {
    Tracking::new(model, Vacuum::new(2.0), constant(sampling, 2.0))
}

pub(super) fn cases() -> Vec<HardCase> {
    vec![
        HardCase::statistical(
            3,
            "sigma_samp 0.5 below sigma_t 1, length 2",
            "double particle",
            "0.1353 = exp(-2)",
            200_000,
            |run| judge_walk(&constant(1.0, 2.0), &walk(double_particle(), 0.5), run),
        )
        .about(["double_particle"]),
        HardCase::statistical(
            3,
            "sigma_samp 0.5 below sigma_t 1, length 2, albedo 0",
            "single particle, adaptive",
            "0.1353 = exp(-2)",
            200_000,
            |run| {
                let model = SingleParticle { version: Version::Adaptive, albedo: Albedo::default() };
                judge_walk(&constant(1.0, 2.0), &walk(model, 0.5), run)
            },
        )
        .about(["single_particle"]),
        HardCase::statistical(
            4,
            "extinction 1 then -0.5, length 1 each",
            "double particle, sigma_samp 2",
            "0.6065 = exp(-0.5)",
            100_000,
            |run| judge_walk(&unit_cells(&[1.0, -0.5]), &walk(double_particle(), 2.0), run),
        )
        .about(["double_particle"]),
        HardCase::statistical(
            5,
            "extinction -0.5, length 2",
            "double particle, sigma_samp 2",
            "2.718 = exp(1)",
            100_000,
            |run| judge_walk(&constant(-0.5, 2.0), &walk(double_particle(), 2.0), run),
        )
        .about(["double_particle"]),
        HardCase::deterministic(
            5,
            "extinction -0.5, length 2, as its own control",
            "double particle, sigma_samp 1",
            "2.718 = exp(1)",
            "exact",
            || {
                let field = constant(-0.5, 2.0);
                let estimator = Tracking::new(double_particle(), field, constant(1.0, 2.0));
                Outcome::value(estimator.estimate(&field, &mut Seeded::new(5)), 1.0_f64.exp(), 0.0)
            },
        )
        .about(["double_particle"]),
    ]
}
