//! Rows 8 and 9: optical thicknesses from nothing to beyond the range of numbers, and a spike.

use super::judging::judge_walk;
use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_media::PiecewiseConstant;
use fairflight_sources::Seeded;
use fairflight_transmittance::{LineIntegral, Tracking, TransmittanceEstimator};

fn double_particle() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// Two set-ups without variance: the field as its own control, and a line integral in a majorant that is the field.
fn thickness(tau: f64) -> Outcome {
    let field = constant(tau, 1.0);
    let residual = Tracking::new(double_particle(), field, constant(3.0, 1.0));
    let walk = residual.estimate(&field, &mut Seeded::new(8));
    let line = LineIntegral::new(4).expect(LAWFUL).estimate(&field, &mut Seeded::new(8));
    let exact = (-tau).exp();
    let outcome = Outcome::value(walk, exact, 0.0);
    let passes = outcome.passes && line == exact;
    let ours = if exact == 0.0 { format!("0 (underflow of exp(-{tau}))") } else { outcome.ours };
    Outcome::said(passes, ours)
}

/// σ_t = 1e6 on 1e-6 of the ray.
fn spike() -> PiecewiseConstant {
    PiecewiseConstant::new(vec![0.0, 0.5, 0.500_001, 1.0], vec![0.0, 1e6, 0.0]).expect(LAWFUL)
}

pub(super) fn cases() -> Vec<HardCase> {
    let mut cases = Vec::new();
    for tau in [1e-12_f64, 1e-3, 1.0, 50.0, 700.0, 800.0, 1e6] {
        cases.push(
            HardCase::deterministic(
                8,
                format!("optical thickness {tau:e}"),
                "double particle with the field as control, line integral in the field as majorant",
                format!("exp(-tau) = {:e}", (-tau).exp()),
                "exact",
                move || thickness(tau),
            )
            .about(["double_particle", "line_integral"]),
        );
    }
    cases.push(
        HardCase::deterministic(
            9,
            "sigma_t = 1e6 on 1e-6 of the ray, as its own control",
            "double particle",
            "exp(-1)",
            "1e-10: the edges are rounded",
            || {
                let field = spike();
                let sampling = constant(10.0, 1.0);
                let walk = Tracking::new(double_particle(), field.clone(), sampling);
                Outcome::value(walk.estimate(&field, &mut Seeded::new(9)), (-1.0_f64).exp(), 1e-10)
            },
        )
        .about(["double_particle"]),
    );
    cases.push(
        HardCase::statistical(
            9,
            "sigma_t = 1e6 on 1e-6 of the ray, no control",
            "double particle, sigma_samp 4e6 on the spike and 0 elsewhere",
            "exp(-1)",
            100_000,
            |run| {
                let rate = PiecewiseConstant::new(vec![0.0, 0.5, 0.500_001, 1.0], vec![0.0, 4e6, 0.0]);
                let none = constant(0.0, 1.0);
                judge_walk(&spike(), &Tracking::new(double_particle(), none, rate.expect(LAWFUL)), run)
            },
        )
        .about(["double_particle"]),
    );
    cases
}
