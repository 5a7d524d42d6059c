//! Pearson's test of counts against exact probabilities of cells, and when it holds its level.
//!
//! The law of the statistic Σ (count − expectation)²/expectation is chi-square in the limit only, and what converges last
//! is the tail in which tests of many checks at once reject. To exceed x by one cell of expectation m alone takes a count
//! of m(1 + y), y = √(x/m), which has the probability exp(−m((1 + y) ln(1 + y) − y)) up to a power of m, not the
//! exp(−x/2) of the normal law: larger by at most exp(x^{3/2}/(6√m)) (the next term of the series is negative). Other ways
//! to exceed x gain less, since the skewness of each cell counts with the third power of its share. We ask this factor to be
//! at most 3 at the critical x, which is m ≥ x³/(6 ln 3)² = x³/43.5, and divide the level by 4 for it and for the rest.
//! At a level of 1e-10 that is 2,030 for two cells and 17,200 for twenty.

use crate::goodness::GoodnessOfFit;
use crate::halving::quantile;
use crate::policy::POWER;
use statrs::function::gamma::gamma_ur;

/// Factor by which the tail of the statistic may exceed that of its limit.
const SAFETY: f64 = 4.0;

/// The part of [`SAFETY`] that is left to the skewness of a cell.
const SKEWNESS: f64 = 3.0;

/// Greatest deviation from 1 of the sum of the probabilities.
const SUM_TOLERANCE: f64 = 1e-9;

/// P(chi-square with `degrees_of_freedom` > x).
///
/// Relative error below 1e-12 for up to a thousand degrees, out to 1e-100: for x beyond the mean statrs takes the
/// continued fraction of the upper tail, no complement.
#[must_use]
pub fn chi_square_upper_tail(degrees_of_freedom: usize, x: f64) -> f64 {
    debug_assert!(degrees_of_freedom > 0 && x >= 0.0, "{degrees_of_freedom} degrees at {x}");
    if x <= 0.0 {
        return 1.0;
    }
    // Where the tail leaves the range of numbers.
    if x > 2000.0 + 10.0 * degrees_of_freedom as f64 {
        return 0.0;
    }
    gamma_ur(0.5 * degrees_of_freedom as f64, 0.5 * x)
}

/// The x with P(chi-square > x) = `tail`, from above to a relative 1e-12.
fn upper_quantile(degrees_of_freedom: usize, tail: f64) -> f64 {
    quantile(degrees_of_freedom as f64, |x| chi_square_upper_tail(degrees_of_freedom, x) <= tail)
}

/// Tests `counts` of independent samples against the exact `probabilities` of their cells, with a false alarm of at most
/// `alpha`.
///
/// Neighbouring cells are pooled until each is expected often enough for the limit law to hold at `alpha`: order them so
/// that neighbours belong together. `detectable` is the relative deviation of the probability of one (pooled) cell, all
/// others shrinking or growing in proportion, at worst over the cells. As in [`judge`](crate::judge()), agreement needs power:
/// with a detectable deviation of [`MAX_DETECTABLE_RELATIVE_BIAS`](crate::MAX_DETECTABLE_RELATIVE_BIAS) or more, or with one cell left, nothing is accepted.
/// Relative errors of the probabilities must be small against 1/√N.
///
/// A count where the probability is zero: unsound. No samples, or probabilities that are none: not testable.
#[must_use]
pub fn chi_square(counts: &[u64], probabilities: &[f64], alpha: f64) -> GoodnessOfFit {
    debug_assert!(alpha > 0.0 && alpha < 0.5, "a false alarm lies in (0, 1/2), found {alpha}");
    debug_assert_eq!(counts.len(), probabilities.len(), "every cell has a count and a probability");
    let total: f64 = probabilities.iter().sum();
    let is_law = probabilities.iter().all(|&p| p >= 0.0) && (total - 1.0).abs() <= SUM_TOLERANCE;
    if !is_law {
        return GoodnessOfFit::not_testable(format!("probabilities that add up to {total}"));
    }
    let n: u64 = counts.iter().sum();
    if n == 0 {
        return GoodnessOfFit::not_testable("no samples");
    }
    let impossible = counts.iter().zip(probabilities).position(|(&count, &p)| count > 0 && p == 0.0);
    if let Some(cell) = impossible {
        let count = counts[cell];
        return GoodnessOfFit::contradiction(format!("{count} samples in cell {cell}, which is impossible"));
    }
    let n = n as f64;
    let cells: Vec<(f64, f64)> =
        counts.iter().zip(probabilities).map(|(&count, &p)| (count as f64, n * p)).collect();
    let Some((pooled, critical)) = pool(&cells, alpha) else {
        return GoodnessOfFit::not_testable(format!("{n} samples fill one cell only"));
    };
    let degrees = pooled.len() - 1;
    let statistic: f64 = pooled.iter().map(|&(count, m)| (count - m) * (count - m) / m).sum();
    let p_value = (SAFETY * chi_square_upper_tail(degrees, statistic)).min(1.0);
    let scarcest = pooled.iter().map(|&(_, m)| m / n).fold(1.0, f64::min);
    let detectable = (detectable_noncentrality(degrees, critical) * (1.0 - scarcest) / (n * scarcest)).sqrt();
    GoodnessOfFit::decided(
        statistic,
        (p_value, alpha),
        detectable,
        &format!("chi-square = {statistic:.1}, {degrees} degrees of freedom, p = {p_value:.1e}"),
    )
}

/// The finest pooling of neighbours in which every cell is expected often enough for the number of cells, with the critical
/// statistic for that number or more; `None` if that is one cell.
fn pool(cells: &[(f64, f64)], alpha: f64) -> Option<(Vec<(f64, f64)>, f64)> {
    let mut finest: Option<(Vec<(f64, f64)>, f64)> = None;
    // Fewer cells have a smaller critical statistic and ask for less in each.
    for most in (2..=cells.len()).rev() {
        let critical = upper_quantile(most - 1, alpha / SAFETY);
        let pooled = pool_to(cells, critical.powi(3) / (6.0 * SKEWNESS.ln()).powi(2));
        let is_finer = finest.as_ref().is_none_or(|(finest, _)| pooled.len() > finest.len());
        if (2..=most).contains(&pooled.len()) && is_finer {
            finest = Some((pooled, critical));
        }
    }
    finest
}

/// Neighbours added up until each group is expected `least` times; what is left at the end joins the last group.
fn pool_to(cells: &[(f64, f64)], least: f64) -> Vec<(f64, f64)> {
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for &(count, expected) in cells {
        open = (open.0 + count, open.1 + expected);
        if open.1 >= least {
            pooled.push(open);
            open = (0.0, 0.0);
        }
    }
    match pooled.last_mut() {
        Some(last) => *last = (last.0 + open.0, last.1 + open.1),
        None => pooled.push(open),
    }
    pooled
}

/// The noncentrality λ from which on chi-square exceeds `critical` with probability [`POWER`] at least.
///
/// P(χ² ≤ d + λ − 2√((d + 2λ)t)) ≤ exp(−t) for d degrees (birge-2001 lemma 8.1); with y² = d + 2λ it is a quadratic
/// equation. A deviation from p to q has λ = N Σ (q − p)²/p.
fn detectable_noncentrality(degrees_of_freedom: usize, critical: f64) -> f64 {
    let (d, t) = (degrees_of_freedom as f64, -(1.0 - POWER).ln());
    let y = 2.0 * t.sqrt() + (4.0 * t + 2.0 * critical - d).max(0.0).sqrt();
    (0.5 * (y * y - d)).max(0.0)
}

#[cfg(test)]
#[path = "chi_square_tests.rs"]
mod tests;
