//! The law of jittered ratio tracking in closed form: moments of all orders up to the 8th, stratum by stratum.
//!
//! **Derivation.** In a stratum of the optical thickness e in the range, let r have the mean z and the central moments d_i (over a
//! uniform point, by quadrature), and let B_k be the bracket at order k: with the probability p = e/k there is a k-th point, and
//!
//! > B_k = 1 − r B_{k+1}, else B_k = 1;   F = 1 − e r B_2.
//!
//! Points are independent, hence r and B_{k+1} are. With β_k = E\[B_k\] = 1 − p z β_{k+1} and q = z β_{k+1}, let
//! V = r B_{k+1} − q, of mean zero: with C = B_{k+1} − β_{k+1} and δ = r − z it is z C + δ (β_{k+1} + C), of which `compound` gives the
//! moments. Then B_k − β_k is p q with the probability 1 − p, else −(1 − p) q − V, so that
//!
//! > E\[(B_k − β_k)^n\] = (1 − p) (p q)^n + p (−1)^n Σ_j C(n, j) ((1 − p) q)^{n−j} E\[V^j\],
//!
//! from the order where p has no weight left down to 2, and F − exp(−R) = −e V at last. Everything is a deviation from a mean:
//! a small variance keeps its digits.

use crate::allowance::{Allowance, NODES};
use crate::factors::{BINOMIALS, FactorLaw, compound, powers};
use crate::jittered_ratio::Strata;
use crate::{HIGHEST_MOMENT, MOMENTS, Theory};
use fairflight_elementary::{exp, exp_m1};
use fairflight_media::{BoundCell, Epsilon, Extinction, RayQuadrature, Tolerance};

/// A stratum, or a cell without any (of the optical thickness 0).
struct Part {
    minorant: f64,
    range: f64,
    width: f64,
    thickness: f64,
}

/// Nodes of a stratum, each sampled once and evaluated twice, and as much again for its recursion.
const PER_STRATUM: f64 = 6.0 * NODES;

/// The law of the product over the strata of all `cells`, which cover the profile.
pub(crate) fn theory_of<F: Extinction>(
    cells: &[BoundCell],
    epsilon: Epsilon,
    quadrature: &mut RayQuadrature<F>,
    tolerance: Tolerance,
) -> Theory {
    let allowance = Allowance::usual();
    let (strata, expected) = count(cells, epsilon);
    if !allowance.has(PER_STRATUM * strata) {
        return Theory::without(allowance.unreached(2), expected);
    }
    let (parts, ends) = parts_of(cells, epsilon);
    let ratio = |i: usize, sigma_t: f64| (sigma_t - parts[i].minorant) / parts[i].range;
    let (means, _) = quadrature.integrate_parts(tolerance, &ends, |i, _, sigma_t| {
        [if parts[i].thickness > 0.0 { ratio(i, sigma_t) / parts[i].width } else { 0.0 }]
    });
    let (deviations, total) = quadrature.integrate_parts(tolerance, &ends, |i, _, sigma_t| {
        if parts[i].thickness == 0.0 {
            return [0.0; MOMENTS];
        }
        let delta = powers(ratio(i, sigma_t) - means[i][0]);
        std::array::from_fn(|n| delta[n + 2] / parts[i].width)
    });

    let (mut law, mut lookups) = (FactorLaw::ONE, 0.0);
    for (part, (mean, deviations)) in parts.iter().zip(means.iter().zip(&deviations)) {
        if part.thickness > 0.0 {
            law.multiply(&relative_moments(part.thickness, mean[0], deviations));
            lookups += exp_m1(part.thickness) / part.thickness;
        }
    }
    // dVar/Var = dS exp(S)/(exp(S) − 1), S = ln E[(T̂/T)²]; in a stratum dS is at most (e exp(e))² times the error of d_2.
    let greatest = parts.iter().map(|part| part.thickness * exp(part.thickness)).fold(0.0, f64::max);
    let error = greatest * greatest * total.error[0];
    Theory {
        relative_central: law.relative_central(),
        log_relative_variance: law.log_relative_variance(),
        relative_variance_error: if error == 0.0 { 0.0 } else { error / -exp_m1(-law.log_second()) },
        ..Theory::mean_only(lookups)
    }
}

/// The number of strata, a cell without any as one, and the expected look-ups.
fn count(cells: &[BoundCell], epsilon: Epsilon) -> (f64, f64) {
    let (mut strata, mut lookups, mut from) = (0.0, 0.0, 0.0);
    for cell in cells {
        let Strata { count, thickness, .. } = Strata::of(cell, from, epsilon);
        strata += count.max(1.0);
        if thickness > 0.0 {
            lookups += count * (exp_m1(thickness) / thickness);
        }
        from = cell.to;
    }
    (strata, lookups)
}

/// The strata of all cells, a cell without any as itself; and where each ends.
fn parts_of(cells: &[BoundCell], epsilon: Epsilon) -> (Vec<Part>, Vec<f64>) {
    let (mut parts, mut ends, mut from) = (Vec::new(), Vec::new(), 0.0);
    for cell in cells {
        let strata = Strata::of(cell, from, epsilon);
        for i in 1..=strata.count.max(1.0) as u64 {
            let Strata { width, thickness, .. } = strata;
            parts.push(Part { minorant: cell.minorant, range: cell.range(), width, thickness });
            ends.push(if i as f64 >= strata.count { cell.to } else { from + i as f64 * width });
        }
        from = cell.to;
    }
    (parts, ends)
}

/// E\[(F/E\[F\] − 1)^n\], n = 2 … 8, of a stratum of the optical thickness `e`, where r has the mean `z` and these central moments.
fn relative_moments(e: f64, z: f64, deviations: &[f64; MOMENTS]) -> [f64; MOMENTS] {
    let mut delta = [0.0; HIGHEST_MOMENT + 1];
    delta[0] = 1.0;
    delta[2..].copy_from_slice(deviations);

    // Orders beyond this one weigh e^(k−1)/k! < 1e-32, in units of the order 2 at least as little.
    let (mut order, mut weight) = (2.0, 1.0);
    while weight > 1e-32 {
        order += 1.0;
        weight *= e / order;
    }
    let mut central = [0.0; HIGHEST_MOMENT + 1];
    central[0] = 1.0;
    let mut mean = 1.0;
    while order >= 2.0 {
        let p = e / order;
        let q = z * mean;
        let v = compound(&central, z, mean, &delta);
        let (stays, goes) = (powers(p * q), powers((1.0 - p) * q));
        central = std::array::from_fn(|n| {
            let sum: f64 = (0..=n).map(|j| BINOMIALS[n][j] * goes[n - j] * v[j]).sum();
            (1.0 - p) * stays[n] + if n % 2 == 0 { p } else { -p } * sum
        });
        central[1] = 0.0;
        mean = 1.0 - p * q;
        order -= 1.0;
    }
    let v = compound(&central, z, mean, &delta);
    let unit = powers(-e * exp(e * z));
    std::array::from_fn(|i| unit[i + 2] * v[i + 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// E\[F^n\] of the coin r = 0 or 1 (probability 1 − z, z), by all sequences: r_1 = … = r_j = 1 and then a 0 or the end.
    fn coin(e: f64, z: f64, n: i32) -> f64 {
        let reached = |k: i32| (1..=k).fold(1.0, |p, i| p * if i == 1 { 1.0 } else { e / f64::from(i) });
        // After j ones in a row, of which the last is the last point or is followed by a 0.
        let value = |j: i32| if j % 2 == 0 { 1.0 } else { 1.0 - e };
        let mut moment = (1.0 - z) * value(0).powi(n);
        for j in 1..60 {
            let ones = z.powi(j) * (reached(j) - reached(j + 1) + reached(j + 1) * (1.0 - z));
            moment += ones * value(j).powi(n);
        }
        moment
    }

    fn raw(e: f64, z: f64, deviations: &[f64; MOMENTS], n: usize) -> f64 {
        let central = relative_moments(e, z, deviations);
        let sum: f64 = (2..=n).map(|k| BINOMIALS[n][k] * central[k - 2]).sum();
        (1.0 + sum) * (-e * z * n as f64).exp()
    }

    #[test]
    fn all_moments_of_a_coin() {
        for (e, z) in [(1.0, 0.3), (0.5, 0.8), (0.25, 0.05), (1.0, 1.0), (0.01, 0.5)] {
            let deviations: [f64; MOMENTS] = std::array::from_fn(|i| {
                let n = i as i32 + 2;
                z * (1.0_f64 - z).powi(n) + (1.0 - z) * (-z).powi(n)
            });
            assert_relative_eq!(coin(e, z, 1), (-e * z).exp(), max_relative = 1e-14);
            for n in 2..=8 {
                assert_relative_eq!(raw(e, z, &deviations, n), coin(e, z, n as i32), max_relative = 1e-13);
            }
        }
    }

    #[test]
    fn the_double_sum_over_orders() {
        // E[F²] = Σ_ab (−1)^(a+b) w_a w_b P_max(a,b) m_2^min m_1^|a−b|, for a uniform r: m_1 = e/2, m_2 = e²/3.
        for e in [1.0_f64, 0.5, 0.1] {
            let (m1, m2) = (0.5 * e, e * e / 3.0);
            let mut reached = vec![1.0, 1.0];
            (2..30).for_each(|k| reached.push(reached[k - 1] * e / k as f64));
            let weight = |k: usize| if k == 0 { 1.0 } else { e.powi(1 - k as i32) };
            let mut second = 0.0;
            for a in 0..20_usize {
                for b in 0..20_usize {
                    let (low, high) = (a.min(b), a.max(b));
                    let sign = if (a + b) % 2 == 0 { 1.0 } else { -1.0 };
                    let powers = m2.powi(low as i32) * m1.powi((high - low) as i32);
                    second += sign * weight(a) * weight(b) * reached[high] * powers;
                }
            }
            let uniform: [f64; MOMENTS] = std::array::from_fn(|i| {
                if i % 2 == 0 { 0.5_f64.powi(i as i32 + 2) / (i as f64 + 3.0) } else { 0.0 }
            });
            assert_relative_eq!(raw(e, 0.5, &uniform, 2), second, max_relative = 1e-13);
        }
    }

    #[test]
    fn a_tiny_variance_keeps_its_digits() {
        // r nearly constant at z: the variance is that of the order, p (1 − p) q² e² with p = e/2, q = z, to the lowest order in e.
        let (e, z) = (1e-9, 0.5);
        let variance = relative_moments(e, z, &[0.0; MOMENTS])[0];
        // V = z C, Var C = p(1 − p) q², q = z.
        assert_relative_eq!(variance, e * e * z.powi(4) * 0.5 * e, max_relative = 1e-8);
        let mut deviations = [0.0; MOMENTS];
        deviations[0] = 1e-6;
        let variance = relative_moments(e, z, &deviations)[0];
        assert_relative_eq!(variance, e * e * (1e-6 + 0.5 * e * z.powi(4)), max_relative = 1e-8);
    }
}
