//! Row 16: anisotropies next to 0 and to ±1.

use super::{HardCase, LAWFUL, Outcome};
use fairflight_media::phase::{HenyeyGreenstein, Schlick};
use fairflight_media::{PhaseFunction, Tolerance, adaptive_integral};
use std::f64::consts::TAU;

/// Names, values, and the mean cosine of Schlick's function: mpmath with 60 digits, of 1/k − (1 − k²) artanh(k)/k².
const ANISOTROPIES: [(&str, f64, f64); 4] = [
    ("0", 0.0, 0.0),
    ("1e-7", 1e-7, 6.66666666666668e-8),
    ("1e-4", 1e-4, 6.666_666_680_000_001e-5),
    ("0.999999", 0.999_999, 0.999_986_491_321_998_1),
];

/// Relative, for a mean cosine that is not 0.
const TOLERANCE: f64 = 1e-12;

/// Checks that every cosine solves the distribution to the rounding of the cosine and of the distribution itself.
///
/// # Errors
/// If a cosine does not; the first is named.
fn inverts(phase: &impl PhaseFunction, distribution: impl Fn(f64) -> f64) -> Result<(), String> {
    for i in 0..1000 {
        let u = f64::from(i) / 1000.0;
        let cosine = phase.sample_cosine(u);
        // Half a rounding of the cosine moves the distribution by the density there.
        let granted = 4.0 * f64::EPSILON * (1.0 + TAU * phase.eval(cosine));
        let found = distribution(cosine);
        if found.is_nan() || (found - u).abs() > granted {
            return Err(format!("u = {u} gives {cosine}, where the distribution is {found}"));
        }
    }
    Ok(())
}

/// The mean cosine as stated, after that of the drawn cosines, ∫ μ(u) du, was found to be the same.
fn mean_cosine(phase: &impl PhaseFunction, exact: f64, inverts: Result<(), String>) -> Outcome {
    if let Err(broken) = inverts {
        return Outcome::said(false, broken);
    }
    let drawn = adaptive_integral(1.0, &[], Tolerance::TIGHT, |u| [phase.sample_cosine(u)]).value[0];
    if (drawn - exact).abs() > TOLERANCE {
        return Outcome::said(false, format!("the drawn cosines have the mean {drawn}"));
    }
    Outcome::value(phase.mean_cosine(), exact, TOLERANCE)
}

fn henyey_greenstein(g: f64) -> Outcome {
    let phase = HenyeyGreenstein::new(g).expect(LAWFUL);
    // (1 − g²)/(2g) (1/r − 1/(1 + g)), r² = 1 + g² − 2gμ, with 2g divided out: (1 − g)(1 + μ)/(r(1 + g + r)).
    let distribution = |cosine: f64| {
        let back = (1.0 - g) * (1.0 - g) * (1.0 + cosine);
        let r = (0.5 * (back + (1.0 + g) * (1.0 + g) * (1.0 - cosine))).sqrt();
        (1.0 - g) * (1.0 + cosine) / (r * (1.0 + g + r))
    };
    mean_cosine(&phase, g, inverts(&phase, distribution))
}

fn schlick(k: f64, exact: f64) -> Outcome {
    let phase = Schlick::new(k).expect(LAWFUL);
    let distribution = |cosine: f64| {
        let back = (1.0 - k) * (1.0 + cosine);
        back / (back + (1.0 + k) * (1.0 - cosine))
    };
    mean_cosine(&phase, exact, inverts(&phase, distribution))
}

pub(super) fn cases() -> Vec<HardCase> {
    const HOW_NEAR: &str = "1e-12, and every cosine solves its distribution to rounding";
    let mut cases = Vec::new();
    for (name, size, mean) in ANISOTROPIES {
        for (sign, factor) in [("", 1.0), ("-", -1.0)] {
            if size == 0.0 && factor < 0.0 {
                continue;
            }
            let (g, mean) = (factor * size, factor * mean);
            cases.push(HardCase::deterministic(
                16,
                format!("Henyey-Greenstein, g = {sign}{name}"),
                "phase function",
                "mean cosine g",
                HOW_NEAR,
                move || henyey_greenstein(g),
            ));
            cases.push(HardCase::deterministic(
                16,
                format!("Schlick, k = {sign}{name}"),
                "phase function",
                format!("mean cosine {mean:e}: 60 digits of the closed form"),
                HOW_NEAR,
                move || schlick(g, mean),
            ));
        }
    }
    cases
}
