//! Rows 7, 13 and 20: probabilities next to zero, ratios at the ends of a domain, a million collisions.

use super::judging::judge_walk;
use super::{HardCase, LAWFUL, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_laws::collision;
use fairflight_media::{Counted, RayQuadrature, Tolerance, Vacuum};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{ClosedForm, Tracking, TransmittanceEstimator};

const VERSIONS: [Version; 3] = [Version::Terminating, Version::NonTerminating, Version::Adaptive];

fn albedo(a: f64) -> Albedo {
    Albedo::new(a).expect(LAWFUL)
}

/// Rounding leaves 1 − r = δ where it should be 0: weight and probability stay finite and in balance.
fn rounded_null(delta: f64) -> Outcome {
    for version in VERSIONS {
        for a in [0.0, 0.5, 1.0] {
            let model = SingleParticle { version, albedo: albedo(a) };
            let ratios = [1.0 - delta, 1.0, 1.0 + delta];
            if let Err(broken) = collision::check(&model, a, &ratios) {
                return Outcome::said(false, broken.to_string());
            }
            let finite = ratios.iter().all(|&r| {
                let branch = model.transmitted(r);
                branch.energy.is_finite() && branch.probability.is_finite()
            });
            if !finite {
                return Outcome::said(false, "a weight that is no number");
            }
        }
    }
    Outcome::said(true, "finite, mean weight 1 - r")
}

/// Var/T² of a constant profile against eq. 19 or 20, for all versions that admit the ratio.
fn variance_at(r: f64, a: f64) -> Outcome {
    // An optical thickness such that the variance is of order 1.
    let tau = 1.0 / r.max(1.0);
    let field = constant(tau, 1.0);
    let sampling = constant(tau / r, 1.0);
    // The variance introduction densities over σ_samp.
    let eq19 = if r <= 1.0 { r } else { r * (3.0 - 2.0 / r) };
    let eq20 = r.abs() * (r.abs() + a * (1.0 - r).abs());
    let mut text = String::new();
    let mut passes = true;
    for version in VERSIONS {
        let model = SingleParticle { version, albedo: albedo(a) };
        // r as the walk computes it.
        let ratio = tau / (tau / r);
        if !model.admits(ratio) {
            continue;
        }
        let terminates = match version {
            Version::Terminating => true,
            Version::NonTerminating => false,
            Version::Adaptive => r >= 1.0 && a * r + (r - 1.0) <= 1.0,
        };
        let exact = (tau / r * if terminates { eq19 } else { eq20 }).exp_m1();
        let estimator = Tracking::new(model, Vacuum::new(1.0), sampling);
        let theory = estimator.theory(&mut RayQuadrature::new(&field, &[]), tau, Tolerance::TIGHT);
        let ours = theory.relative_central[0];
        // Where r is at the end of the domain, eq. 19 and 20 agree, and so does whichever version rounding chose.
        passes &= (ours / exact - 1.0).abs() <= 1e-11;
        text = format!("Var/T^2 = {ours:.6e}");
    }
    Outcome::said(passes && !text.is_empty(), text)
}

/// Optical distances of exactly 1, and survival of every collision.
struct EvenlySpaced;

impl UniformSource for EvenlySpaced {
    fn next_uniform(&mut self) -> f64 {
        0.0
    }
    fn next_exponential(&mut self) -> f64 {
        1.0
    }
}

/// A million weights of 1 − 1e-3 underflow as a plain product, and the control of −1000 brings them back.
fn a_million_collisions(weight: f64) -> Outcome {
    const RATE: f64 = 1e6;
    // σ_t − σ_main = r · rate
    let r = 1.0 - weight;
    let main = -r * RATE;
    let field = Counted::new(constant(0.0, 1.0));
    let control = constant(main, 1.0);
    let model = DoubleParticle { albedo: Albedo::default() };
    let estimator = Tracking::new(model, control, constant(RATE, 1.0));
    let ours = estimator.estimate(&field, &mut EvenlySpaced);
    let n = field.lookups() as f64;
    let exact = (n * (-r).ln_1p() - main).exp();
    let plain = weight.powf(n);
    let outcome = Outcome::value(ours, exact, 1e-8);
    Outcome {
        ours: format!("{ours:.9} after {n} collisions (the plain product is {plain:e})"),
        passes: outcome.passes && n > 0.99 * RATE && (plain == 0.0 || plain.is_infinite()),
        ..outcome
    }
}

pub(super) fn cases() -> Vec<HardCase> {
    let mut cases = Vec::new();
    for delta in [1e-8, f64::EPSILON] {
        cases.push(
            HardCase::deterministic(
                7,
                format!("a null probability of {delta:e} left by rounding, or 0"),
                "single particle, all versions",
                "mean weight 1 - r; finite",
                "one rounding",
                move || rounded_null(delta),
            )
            .about(["single_particle"]),
        );
    }
    for a in [0.0, 0.5, 1.0] {
        for (name, r) in [("1", 1.0), ("2/(1+a)", 2.0 / (1.0 + a)), ("1e-9", 1e-9), ("1e3", 1e3)] {
            cases.push(
                HardCase::deterministic(
                    13,
                    format!("r = {name}, albedo {a}: variance"),
                    "single particle, all versions",
                    "szirmay-kalos-2017 eq. 19, 20",
                    "1e-11 relative",
                    move || variance_at(r, a),
                )
                .about(["single_particle"]),
            );
        }
    }
    for (name, r) in [("1", 1.0), ("2/(1+a)", 4.0 / 3.0), ("1e-9", 1e-9)] {
        let (tau, samples) = if r < 1e-3 { (1e-6, 2_000) } else { (1.0, 200_000) };
        cases.push(
            HardCase::statistical(
                13,
                format!("r = {name}, albedo 0.5: mean"),
                "single particle, non-terminating",
                format!("exp(-{tau:e})"),
                samples,
                move |run| {
                    let model = SingleParticle { version: Version::NonTerminating, albedo: albedo(0.5) };
                    let sampling = constant(tau / r, 1.0);
                    let estimator = Tracking::new(model, Vacuum::new(1.0), sampling);
                    judge_walk(&constant(tau, 1.0), &estimator, run)
                },
            )
            .about(["single_particle"]),
        );
    }
    cases.push(
        HardCase::deterministic(
            13,
            "r = 1e3, albedo 0.5: mean",
            "single particle, non-terminating",
            "exp(-1) = exp(sigma_samp (E[W] - 1)): the rare weight of -1500 shows in no feasible sample",
            "1e-12 relative",
            || {
                let branch =
                    SingleParticle { version: Version::NonTerminating, albedo: albedo(0.5) }.transmitted(1e3);
                Outcome::value((1e-3 * (branch.moment(1) - 1.0)).exp(), (-1.0_f64).exp(), 1e-12)
            },
        )
        .about(["single_particle"]),
    );
    for weight in [1.0 - 1e-3, 1.0 + 1e-3] {
        cases.push(
            HardCase::deterministic(
                20,
                format!("1e6 collisions of weight {weight} in one walk"),
                "double particle",
                "exp(n ln W + 1e6 (1 - W)), by logarithms",
                "1e-8 relative: 1e6 roundings",
                move || a_million_collisions(weight),
            )
            .about(["double_particle"]),
        );
    }
    cases
}
