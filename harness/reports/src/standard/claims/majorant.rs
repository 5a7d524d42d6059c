//! S2 and S3: what the single particle model gains from a sampling extinction above the majorant.
//!
//! Criterion of S2: closed forms at and above the majorant agree to 1e-6, and the measured variance at the greatest measured
//! sampling extinction is within 4 standard errors of that at the majorant, on every medium where both are tested. Of S3: the closed-form
//! variance falls towards its bound from above and reaches it within 1 %, and the measured one is within 4 standard errors.

use super::case::{Case, closed, single, with_error};
use super::{Evidence, SIGMAS, claim};
use crate::standard::result::{Series, SweepMeasurement, SweepPoint};
use fairflight_collision::Version;
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::parallel::try_in_parallel;

pub(super) fn s2(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let (mut closed_spread, mut parts) = (0.0_f64, Vec::new());
    let (mut compared, mut off) = (0, 0);
    for (medium, subject) in evidence.media.iter().zip(evidence.subjects) {
        for curve in medium.sweeps.iter().filter(|curve| curve.series == Series::Terminating) {
            let above: Vec<&SweepPoint> = curve
                .points
                .iter()
                .filter(|point| point.sigma_samp >= subject.majorant * (1.0 - 1e-9))
                .collect();
            let closed: Vec<f64> = above.iter().filter_map(|point| point.log10_relative_variance).collect();
            let spread = |values: &[f64]| {
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
                    - values.iter().copied().fold(f64::INFINITY, f64::min)
            };
            if closed.len() > 1 {
                closed_spread = closed_spread.max(spread(&closed) * std::f64::consts::LN_10);
            }
            let Some(ends) = Ends::of(&above) else { continue };
            let Ends { ratio, error, testable, factor } = ends;
            let note = if testable { "" } else { ", not testable at this N" };
            parts.push(format!(
                "{} at albedo {}, {factor:.1}x: {}{note}",
                medium.id,
                curve.albedo.unwrap_or_default(),
                with_error(ratio, 1.96 * error)
            ));
            if testable {
                compared += 1;
                off += usize::from((ratio - 1.0).abs() > SIGMAS * error);
            }
        }
    }
    let verdict = if closed_spread > 1e-6 || off > 0 {
        ClaimVerdict::DoesNotHold
    } else if compared == 0 {
        ClaimVerdict::NotTestable
    } else {
        ClaimVerdict::Holds
    };
    let text = format!(
        "Closed forms from the majorant to 8 times the majorant differ by at most {closed_spread:.1e} relatively. Measured \
         variance at the greatest measured sampling extinction, in majorants, over that at the majorant: {}.",
        parts.join("; ")
    );
    Ok(claim(
        "S2",
        "Terminating version: the variance does not fall when the sampling extinction rises above the majorant (eq. 19).",
        text,
        verdict,
        "Only the look-ups grow: there is no reason to sample above the majorant with the terminating version.",
    ))
}

/// Measured variance at the last measured point over that at the first.
struct Ends {
    ratio: f64,
    error: f64,
    /// True if both are tested.
    testable: bool,
    /// Ratio of the sampling extinctions.
    factor: f64,
}

impl Ends {
    fn of(above: &[&SweepPoint]) -> Option<Self> {
        let mut found = above.iter().filter_map(|point| Some((point.sigma_samp, point.measured.as_ref()?)));
        let (at_first, first) = found.next()?;
        let (at_last, last) = found.next_back()?;
        let relative_error = |found: &SweepMeasurement| {
            (found.relative_variance_interval[1] - found.relative_variance) / 1.96 / found.relative_variance
        };
        let ratio = last.relative_variance / first.relative_variance;
        Some(Self {
            ratio,
            error: ratio * relative_error(first).hypot(relative_error(last)),
            testable: first.testable && last.testable,
            factor: at_last / at_first,
        })
    }
}

pub(super) fn s3(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let subject = evidence.analytic();
    let seconds = evidence.effort.claim_seconds;
    let albedos = [0.5, 0.9];
    // From r of at most 1 down. Near the limit a walk takes thousands of look-ups, and its closed form must do.
    let factors = [1.0, 8.0, 64.0];
    let limit = 512.0;
    let spec = |albedo: f64, factor: f64| single(Version::NonTerminating, albedo, subject.majorant * factor);
    let cases = try_in_parallel(albedos.len() * factors.len(), &|i| {
        let (albedo, factor) = (albedos[i / factors.len()], factors[i % factors.len()]);
        let seed = evidence.seed(format_args!("S3/{albedo}/{factor}"));
        Case::measure(&subject.profile, spec(albedo, factor)?, seed, seconds, subject.lookup_nanoseconds)
    })?;
    let mut parts = Vec::new();
    let (mut reached, mut above, mut agrees) = (true, true, true);
    for (albedo, cases) in albedos.iter().zip(cases.chunks(factors.len())) {
        // ∫ a |sigma_diff| = a tau without control.
        let bound = (albedo * subject.facts.optical_thickness).exp_m1();
        let ratios: Vec<String> = factors
            .iter()
            .zip(cases)
            .map(|(factor, case)| {
                let measured = with_error(case.measured / bound, 1.96 * case.error / bound);
                format!("{factor}x: {:.4} (measured {measured})", case.closed / bound)
            })
            .collect();
        let near = closed(&subject.profile, spec(*albedo, limit)?)?;
        let falling: Vec<f64> = cases.iter().map(|case| case.closed).chain([near]).collect();
        above &= falling.windows(2).all(|pair| pair[1] < pair[0] && pair[1] > bound);
        reached &= near < 1.01 * bound;
        agrees &= cases.iter().all(|case| case.z().abs() < SIGMAS);
        parts.push(format!("albedo {albedo}: {}, {limit}x: {:.4}", ratios.join(", "), near / bound));
    }
    let verdict = ClaimVerdict::of(above && reached && agrees);
    Ok(claim(
        "S3",
        "Non-terminating version: the variance introduction density has the lower bound abs(sigma_diff) times albedo as r \
         goes to 0 (eq. 20).",
        format!(
            "Var/T² over its bound exp(a tau) - 1 on the ray of eq. 21, sampling extinction in units of the majorant: {}.",
            parts.join("; ")
        ),
        verdict,
        "More look-ups cannot buy less variance than that; at albedo 0 the bound is 0 and the version is the double \
         particle model.",
    ))
}
