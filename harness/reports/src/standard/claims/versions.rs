//! S4: which version of the single particle model is better, for transmittance.
//!
//! Criterion: the claim holds if on a homogeneous slab the measured variance of the terminating version is below that of the
//! non-terminating one for r > 1 and above it for r < 1, and the adaptive one is above neither, by more than 4 standard
//! errors of the difference in at least one case and in no case the other way round. Variance times look-ups is given
//! beside it, from closed forms over a grid of albedos, ratios and thicknesses.

use super::case::{Case, homogeneous, single};
use super::{Evidence, SIGMAS, claim};
use fairflight_collision::Version;
use fairflight_document::{Claim, ClaimVerdict};
use fairflight_harness::Failure;
use fairflight_harness::parallel::try_in_parallel;
use fairflight_harness::plan::Plan;
use fairflight_harness::reference::{Truth, predict};
use fairflight_media::Tolerance;

const VERSIONS: [Version; 3] = [Version::Terminating, Version::NonTerminating, Version::Adaptive];
/// Optical thickness of the measured slab.
const THICKNESS: f64 = 1.5;
/// (albedo, r): all within the terminating version's domain r ≤ 2/(1 + a).
const CASES: [(f64, f64); 4] = [(0.0, 1.5), (0.0, 1.8), (0.5, 1.2), (0.5, 0.5)];

pub(super) fn s4(evidence: &Evidence<'_>) -> Result<Claim, Failure> {
    let slab = homogeneous(1.0, THICKNESS)?;
    let measured = try_in_parallel(CASES.len() * VERSIONS.len(), &|i| {
        let ((albedo, r), version) = (CASES[i / VERSIONS.len()], VERSIONS[i % VERSIONS.len()]);
        let seed = evidence.seed(format_args!("S4/{albedo}/{r}/{version:?}"));
        Case::measure(&slab, single(version, albedo, 1.0 / r)?, seed, evidence.effort.claim_seconds, 5.0)
    })?;

    let (mut parts, mut for_claim, mut against) = (Vec::new(), 0, 0);
    for ((albedo, r), versions) in CASES.iter().zip(measured.chunks(VERSIONS.len())) {
        let [terminating, non_terminating, adaptive] = versions else { continue };
        let (better, worse) =
            if *r > 1.0 { (terminating, non_terminating) } else { (non_terminating, terminating) };
        match separation(better, worse) {
            z if z < -SIGMAS => for_claim += 1,
            z if z > SIGMAS => against += 1,
            _ => {}
        }
        against += [terminating, non_terminating]
            .into_iter()
            .filter(|version| separation(adaptive, version) > SIGMAS)
            .count();
        parts.push(format!(
            "a = {albedo}, r = {r}: terminating {} at {:.2} look-ups, non-terminating {} at {:.2}, adaptive {} at {:.2}",
            terminating.text(),
            terminating.lookups,
            non_terminating.text(),
            non_terminating.lookups,
            adaptive.text(),
            adaptive.lookups,
        ));
    }
    let grid = grid()?;
    let text = format!(
        "Var/T² on a homogeneous slab of optical thickness {THICKNESS}: {}. Of {} closed forms with 1 < r < 2/(1 + a) \
         (a = 0 to 0.9, thickness 0.25 to 6) the terminating version has the lower variance in {}, the lower product of \
         variance and look-ups in {}; of {} with r < 1 the non-terminating one has the lower variance in {}, the lower \
         product in {}.",
        parts.join("; "),
        grid.above.points,
        grid.above.lower_variance,
        grid.above.lower_product,
        grid.below.points,
        grid.below.lower_variance,
        grid.below.lower_product,
    );
    let verdict = match (for_claim, against) {
        (_, 1..) => ClaimVerdict::DoesNotHold,
        (0, 0) => ClaimVerdict::NotTestable,
        _ => ClaimVerdict::Holds,
    };
    Ok(claim(
        "S4",
        "The terminating version is better for r > 1, the non-terminating one for r < 1, and the adaptive version is never \
         worse than either.",
        text,
        verdict,
        "For transmittance. Eq. 19 minus eq. 20 is sigma (r - 1)((2 - r)/r - a), not negative on the whole legal range \
         1 <= r <= 2/(1 + a): the sentence after eq. 20 contradicts both equations, and the adaptive version inherits the \
         larger variance there. For r < 1 it is right. What termination saves is look-ups, which the product above counts; \
         walks with scattering (fig. 6) are not covered here.",
    ))
}

/// (a − b) in standard errors of the difference.
fn separation(a: &Case, b: &Case) -> f64 {
    (a.measured - b.measured) / a.error.hypot(b.error)
}

#[derive(Clone, Copy, Default)]
struct Tally {
    points: usize,
    lower_variance: usize,
    lower_product: usize,
}

struct Grid {
    /// r > 1: counts of the terminating version.
    above: Tally,
    /// r < 1: counts of the non-terminating version.
    below: Tally,
}

/// Closed forms only, over homogeneous slabs.
fn grid() -> Result<Grid, Failure> {
    let mut grid = Grid { above: Tally::default(), below: Tally::default() };
    for albedo in [0.0, 0.3, 0.6, 0.9] {
        for thickness in [0.25, 0.5, 1.0, 2.0, 4.0, 6.0] {
            let slab = homogeneous(1.0, thickness)?;
            let truth = Truth::of(&slab, Tolerance::to(1e-9))?;
            for i in 1..8 {
                let part = f64::from(i) / 8.0;
                for (r, favoured) in [
                    (1.0 + part * (2.0 / (1.0 + albedo) - 1.0), Version::Terminating),
                    (part, Version::NonTerminating),
                ] {
                    let law = |version| -> Result<(f64, f64), Failure> {
                        let plan = Plan::on(slab.clone(), single(version, albedo, 1.0 / r)?, 0, 0)?;
                        let theory = predict(&slab, &plan.estimator, &truth, Tolerance::to(1e-9))?.theory;
                        let variance = theory.log_relative_variance.exp();
                        Ok((variance, variance * theory.lookups))
                    };
                    let (terminating, non) = (law(Version::Terminating)?, law(Version::NonTerminating)?);
                    let (tally, ours, other) = if favoured == Version::Terminating {
                        (&mut grid.above, terminating, non)
                    } else {
                        (&mut grid.below, non, terminating)
                    };
                    tally.points += 1;
                    tally.lower_variance += usize::from(ours.0 < other.0);
                    tally.lower_product += usize::from(ours.1 < other.1);
                }
            }
        }
    }
    Ok(grid)
}
