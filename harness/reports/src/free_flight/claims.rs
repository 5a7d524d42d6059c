//! R1, R2 and R3 of the ledger, and the findings of the report.

use super::splitting::Splitting;
use super::wavelengths::Wavelengths;
use crate::laws::Laws;
use fairflight_document::{Claim, ClaimVerdict};

/// R1: algorithm 1 samples the exact density in any bounded medium.
///
/// Criterion: every law of a Woodcock sampler holds, and each would have shown a relative bias of a tenth.
pub(super) fn r1(laws: &Laws) -> Claim {
    let woodcock: Vec<_> = laws.0.iter().filter(|(id, _)| id.contains("woodcock")).collect();
    let failed = woodcock.iter().filter(|(_, result)| result.holds == Some(false)).count();
    let held = woodcock.iter().filter(|(_, result)| result.holds == Some(true)).count();
    let flights: u64 = woodcock.iter().map(|(_, result)| result.samples).sum();
    let worst = woodcock.iter().filter_map(|(_, result)| result.detectable_relative_bias).fold(0.0, f64::max);
    let verdict = if failed > 0 {
        ClaimVerdict::DoesNotHold
    } else if held == woodcock.len() && worst < 0.1 {
        ClaimVerdict::Holds
    } else {
        ClaimVerdict::NotTestable
    };
    Claim::new(
        ("R1", "raab-2008 section 3"),
        "Algorithm 1 samples the exact distance density for any bounded medium",
        format!(
            "{held} of {} laws hold over {flights} flights; a relative bias of {worst:.2e} would have been found in the worst of them",
            woodcock.len()
        ),
        (
            verdict,
            "With −ln(1 − u) and a strict comparison, as corrected; the printed listing can divide by zero and collide in empty space.",
        ),
    )
}

/// R2: algorithm 2 beats independent starts at equal cost, and nears ray marching's smoothness as the medium becomes homogeneous.
///
/// Criterion: (1) in the homogeneous medium its noise is below that of independent starts by separate intervals, and nowhere above it;
/// (2) the ratio of its noise to that of jittered ray marching is least in the homogeneous medium.
pub(super) fn r2(splitting: &Splitting) -> Claim {
    let points = &splitting.points;
    let beats = points[0].equidistant.is_below(&points[0].independent)
        && points.iter().all(|point| !point.independent.is_below(&point.equidistant));
    let ratio = |i: usize| points[i].equidistant.value / points[i].marching.value;
    let nears = (1..points.len()).all(|i| ratio(0) < ratio(i));
    let words: Vec<String> = points
        .iter()
        .enumerate()
        .map(|(i, point)| {
            format!(
                "majorant/mean {:.2}: independent/equidistant {:.2}, equidistant/marching {:.2}",
                point.inhomogeneity,
                point.independent.value / point.equidistant.value,
                ratio(i)
            )
        })
        .collect();
    let verdict = match (beats, nears) {
        (true, true) => ClaimVerdict::Holds,
        (true, false) | (false, true) => ClaimVerdict::HoldsUnder,
        (false, false) => ClaimVerdict::DoesNotHold,
    };
    Claim::new(
        ("R2", "raab-2008 fig. 1, 2"),
        "Algorithm 2 beats independent starting points at equal cost, and nears ray marching's smoothness as the medium becomes homogeneous",
        format!("ratios of noise. {}", words.join("; ")),
        (
            verdict,
            "The first steps are all that is stratified: where most of them meet nothing, little of it is left. Towards the homogeneous \
             medium its noise falls, but that of ray marching falls further.",
        ),
    )
}

/// R3: the variance formula of two wavelengths, infinite from a factor of 2.
///
/// Criterion: no verdict against the formula, at least three ratios whose variance is tested, and sample variances beyond 2 that grow
/// at least twofold over 4000 times as many estimates. (The tail of a weight has the index σ₂/(σ₂ − σ₁), so that the sample variance of n
/// grows like n^(1 − 2σ₁/σ₂): fivefold at 2.5, sixtyfold at 4, and at 2 only like its logarithm.)
pub(super) fn r3(wavelengths: &Wavelengths) -> Claim {
    let against = wavelengths.points.iter().filter(|point| point.verdict.sound == Some(false)).count();
    let tested = wavelengths.points.iter().filter(|point| point.verdict.variance_p.is_some()).count();
    let grows = wavelengths
        .growing
        .iter()
        .filter(|(ratio, _)| *ratio > 2.0)
        .all(|(_, variances)| variances[variances.len() - 1] > 2.0 * variances[0]);
    let verdict = match (against, tested >= 3, grows) {
        (0, true, true) => ClaimVerdict::Holds,
        (0, true, false) => ClaimVerdict::HoldsUnder,
        (0, false, _) => ClaimVerdict::NotTestable,
        _ => ClaimVerdict::DoesNotHold,
    };
    let words: Vec<String> = wavelengths
        .points
        .iter()
        .filter(|point| point.verdict.variance_p.is_some() && point.closed_form > 0.0)
        .map(|point| {
            format!("{} at {}", format_args!("{:.4}", point.variance.value / point.closed_form), point.ratio)
        })
        .collect();
    Claim::new(
        ("R3", "raab-2008 section 3.2"),
        "Two wavelengths at once: variance 1/(2σ₁σ₂ − σ₂²) − 1/σ₁², infinite from σ₂ = 2σ₁ on",
        format!(
            "measured over formula, where testable: {}; beyond 2 the sample variance grows with the number of estimates: {}",
            words.join(", "),
            if grows { "yes" } else { "not in every case" }
        ),
        (
            verdict,
            "From a ratio of 4/3 on the fourth moment is infinite too: the variance is right and no sample of ours can test it.",
        ),
    )
}

/// The findings, in words.
pub(super) fn summary(laws: &Laws, splitting: &Splitting, wavelengths: &Wavelengths) -> Vec<String> {
    let held = laws.0.iter().filter(|(_, result)| result.holds == Some(true)).count();
    let first = &splitting.points[0];
    let last = &splitting.points[splitting.points.len() - 1];
    let gain = |point: &super::splitting::Point| point.independent.value / point.equidistant.value;
    let tested = wavelengths.points.iter().filter(|point| point.verdict.variance_p.is_some()).count();
    vec![
        format!("{held} of {} laws of free flight hold.", laws.0.len()),
        format!(
            "Equidistant starts lower the noise of algorithm 2 by a factor of {:.2} in a homogeneous medium and {:.2} in thin sheets \
             (majorant {:.1} times the mean).",
            gain(first),
            gain(last),
            last.inhomogeneity
        ),
        format!(
            "The variance of two wavelengths agrees with its formula at the {tested} ratios where it can be tested."
        ),
    ]
}
