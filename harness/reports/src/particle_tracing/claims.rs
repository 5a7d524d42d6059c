//! S5 and S6 of the ledger, and the findings of the report.

use super::equal_cost::EqualCost;
use super::versions::{Sweep, Versions};
use crate::measured::with_range;
use crate::speed_against_error::Speed;
use fairflight_document::{Claim, ClaimVerdict};

/// S5: beyond the greatest extinction the variance does not fall, look-ups grow, and the best figure of merit is below it.
///
/// Criterion: of the adaptive version, (1) the error at twice the greatest extinction is at least half of that at it, while from 0.8
/// to 1 it falls by more than that; (2) look-ups grow from each sampling extinction to the next; (3) 0.8 is within the range that
/// cannot be told from the optimum, and 1 is not; where both are, it is not testable. The lighting of the paper is not printed: the claim
/// holds under a condition if it does under one of two.
pub(super) fn s5(even: &Versions, sun: &Versions) -> Claim {
    let parts = |versions: &Versions| {
        let adaptive = &versions.sweeps[0];
        let error = |sigma: f64| adaptive.at(sigma).map_or(f64::NAN, |point| point.squared_error.value);
        let stops = error(2.0) > 0.5 * error(1.0);
        let grows = adaptive.points.windows(2).all(|pair| pair[0].lookups < pair[1].lookups);
        (stops && grows, is_below_the_greatest(adaptive.optimum().1))
    };
    let (even_shape, even_optimum) = parts(even);
    let (sun_shape, sun_optimum) = parts(sun);
    let verdict = match (even_shape && sun_shape, even_optimum, sun_optimum) {
        (true, Some(true), Some(true)) => ClaimVerdict::Holds,
        (true, Some(true), _) | (true, _, Some(true)) => ClaimVerdict::HoldsUnder,
        (true, Some(false), Some(false)) | (false, ..) => ClaimVerdict::DoesNotHold,
        (true, ..) => ClaimVerdict::NotTestable,
    };
    let words = |versions: &Versions| {
        let adaptive = &versions.sweeps[0];
        let (best, range) = adaptive.optimum();
        let ratio = |a: f64, b: f64| {
            let value = |sigma| adaptive.at(sigma).map_or(f64::NAN, |p| p.squared_error.value);
            value(a) / value(b)
        };
        format!(
            "optimum at {} ({} to {} not separable), MSE(0.8)/MSE(1) = {:.2}, MSE(1)/MSE(2) = {:.2}",
            best.sigma_samp,
            range[0],
            range[1],
            ratio(0.8, 1.0),
            ratio(1.0, 2.0)
        )
    };
    Claim::new(
        ("S5", "szirmay-kalos-2017 fig. 6"),
        "Beyond the greatest extinction the variance stops falling while look-ups grow; the best figure of merit is at about 0.8, below it",
        format!("even environment: {}; sky with a sun: {}", words(even), words(sun)),
        (
            verdict,
            "The optimum depends on what lights the medium: a variance that comes from the light and not from the energies pays for \
             no look-ups. The paper's environment is not printed.",
        ),
    )
}

/// Verdict on an optimum at about 0.8, below 1, by the range that cannot be told from it; none where that has both.
fn is_below_the_greatest(range: [f64; 2]) -> Option<bool> {
    let [eight_tenths, one] = [0.8, 1.0].map(|x| (range[0]..=range[1]).contains(&x));
    (!(eight_tenths && one)).then_some(eight_tenths)
}

/// S6: in noise the best sampling extinction is slightly below that of the larger dense regions.
///
/// Criterion: the optimum lies below 1, the greatest extinction, and 0.6 or a value not more than a third below it cannot be told
/// from it.
pub(super) fn s6(noise: &EqualCost) -> Claim {
    let (best, range) = noise.optimum();
    let below = best.sigma_samp < 1.0;
    let near = noise
        .points
        .iter()
        .filter(|point| (0.4..=0.6).contains(&point.sigma_samp))
        .any(|point| (range[0]..=range[1]).contains(&point.sigma_samp));
    Claim::new(
        ("S6", "szirmay-kalos-2017 fig. 7"),
        "Twelve octaves of Perlin noise at 500 look-ups per pixel: the best σ_samp is slightly below the extinction of the larger \
         dense regions (about 0.6)",
        format!(
            "least RMSE {} at σ_samp = {}; {} to {} not separable",
            best.rmse.words(4),
            best.sigma_samp,
            range[0],
            range[1]
        ),
        (ClaimVerdict::of(below && near), "Our noise has its 99.9 % quantile at 0.63 and its bound at 1."),
    )
}

/// The findings, in words.
pub(super) fn summary(even: &Versions, sun: &Versions, noise: &EqualCost, speed: &Speed) -> Vec<String> {
    let optimum = |sweep: &Sweep| {
        let (best, range) = sweep.optimum();
        format!("{} at {}", sweep.name, with_range(best.sigma_samp, range))
    };
    let all = |versions: &Versions| versions.sweeps.iter().map(optimum).collect::<Vec<_>>().join(", ");
    let (best, range) = noise.optimum();
    let fastest = speed.fastest();
    vec![
        format!(
            "Best figure of merit on eq. 21, even environment: {}. Sky with a sun: {}.",
            all(even),
            all(sun)
        ),
        format!("Best σ_samp in Perlin noise at equal cost: {}.", with_range(best.sigma_samp, range)),
        format!(
            "Fastest on eq. 21 in an even environment: {}, 1/(MSE · CPU s) = {}.",
            fastest.name,
            fastest.per_second.words(0)
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_told_apart_decides_nothing() {
        let found = [[0.7, 0.9], [1.0, 1.0], [0.86, 1.2], [0.65, 2.0]].map(is_below_the_greatest);
        assert_eq!(found, [Some(true), Some(false), Some(false), None]);
    }
}
