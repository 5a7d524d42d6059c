//! Row 21: variances that no sample shows.

use super::{HardCase, Outcome};
use crate::profiles::constant;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_laws::lookups::LookupLaw;
use fairflight_laws::transmittance::check;
use fairflight_laws::{Expectation, Run, Truth};
use fairflight_media::{RayQuadrature, Tolerance, Vacuum};
use fairflight_stats::Scores;
use fairflight_transmittance::{ClosedForm, Tracking};

/// σ_t = 1 on a length of 1 with σ_samp = 1/J: ∫ σ_diff²/σ_samp = J.
fn tail(j: f64, run: Run) -> Outcome {
    let field = constant(1.0, 1.0);
    let model = DoubleParticle { albedo: Albedo::default() };
    let sampling = constant(1.0 / j, 1.0);
    let estimator = Tracking::new(model, Vacuum::new(1.0), sampling);
    let theory = estimator.theory(&mut RayQuadrature::new(&field, &[]), 1.0, Tolerance::TIGHT);
    // eq. 16: ln(exp(J) − 1)
    let exact = j + (-(-j).exp()).ln_1p();
    let expected = Expectation {
        truth: Truth::closed_form(&field),
        theory,
        scores: Scores::Unbounded,
        lookups: LookupLaw::Poisson,
    };
    let ln = theory.log_relative_variance;
    match check(field, &estimator, &expected, run) {
        Ok(evidence) => Outcome::said(
            (ln / exact - 1.0).abs() <= 1e-12 && evidence.verdict.sound.is_none(),
            format!(
                "ln(Var/T^2) = {ln:.6}; {}, N needed {:.1e}",
                if evidence.verdict.sound.is_none() { "not testable at this N" } else { "judged" },
                evidence.verdict.samples_needed.unwrap_or(f64::NAN)
            ),
        ),
        Err(refusal) => Outcome::said(false, refusal.to_string()),
    }
}

pub(super) fn cases() -> Vec<HardCase> {
    [5.0, 20.0, 100.0, 2000.0]
        .into_iter()
        .map(|j| HardCase {
            tolerance: "1e-12 of the logarithm; the verdict \"not testable\"",
            ..HardCase::statistical(
                21,
                format!("a heavy tail: integral of sigma_diff^2/sigma_samp = {j}"),
                "double particle",
                format!("ln(Var/T^2) = ln(exp({j}) - 1), szirmay-kalos-2017 eq. 16"),
                10_000,
                move |run| tail(j, run),
            )
            .about(["double_particle"])
        })
        .collect()
}
