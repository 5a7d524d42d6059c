//! Moments of estimates that are functions of the random shifts of combs.

use super::quadrature::nodes;
use super::{Moments, transmittance};
use crate::Profile;

/// The optical thickness X(u) of a comb, and the shifts between which it is linear.
pub(crate) struct Shifts {
    profile: Profile,
    teeth: u32,
    matched: bool,
}

impl Shifts {
    /// A uniform comb, or one with matched ends.
    pub(crate) fn new(profile: Profile, teeth: u32, matched: bool) -> Self {
        Self { profile, teeth, matched }
    }

    /// X(u).
    pub(crate) fn thickness(&self, u: f64) -> f64 {
        let length = self.profile.length();
        let step = length / f64::from(self.teeth);
        let sum: f64 =
            (0..self.teeth).map(|j| self.profile.at(&((u + f64::from(j)) * step).min(length))).sum();
        let last = self.profile.sigma_t.len() - 1;
        let jump = if self.matched { self.profile.sigma_t[last] - self.profile.sigma_t[0] } else { 0.0 };
        step * (sum - jump * (u - 0.5))
    }

    /// The shifts at which a tooth stands on a node, and both ends.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        let teeth = f64::from(self.teeth);
        let fold = |s: &f64| (s / self.profile.length() * teeth).fract();
        let mut breaks: Vec<f64> = self.profile.s.iter().map(fold).collect();
        breaks.extend([0.0, 1.0]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// E\[f(u)^k\] of a function of one shift.
pub(crate) fn of_shifts(breaks: &[f64], mut f: impl FnMut(f64) -> f64) -> [f64; 4] {
    let mut raw = [0.0; 4];
    for (u, weight) in nodes(breaks, 2) {
        let value = f(u);
        for (i, moment) in raw.iter_mut().enumerate() {
            *moment += weight * value.powi(i as i32 + 1);
        }
    }
    raw
}

/// E\[f(X_1, X_2)^k\] of a function of two combs.
pub(crate) fn of_two_shifts(comb: &Shifts, f: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    let x: Vec<(f64, f64)> =
        nodes(&comb.breaks(), 1).into_iter().map(|(u, weight)| (comb.thickness(u), weight)).collect();
    let mut raw = [0.0; 4];
    for (x1, w1) in &x {
        for (x2, w2) in &x {
            for (i, moment) in raw.iter_mut().enumerate() {
                *moment += w1 * w2 * f(*x1, *x2).powi(i as i32 + 1);
            }
        }
    }
    raw
}

/// The greatest order that is summed: P(N ≥ 17) w² is below 1e-20.
const ORDERS: usize = 16;

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// E\[e_k(y) e_l(z)\] of the elementary symmetric sums of n independent pairs with the means b and b′ and E\[yz\] = c, for all k and l.
fn pairs(n: usize, c: f64, b: f64, b2: f64) -> Vec<Vec<f64>> {
    let mut table = vec![vec![0.0; n + 1]; n + 1];
    for (k, row) in table.iter_mut().enumerate() {
        for (l, entry) in row.iter_mut().enumerate() {
            for both in (k + l).saturating_sub(n)..=k.min(l) {
                let ways = factorial(n)
                    / (factorial(both)
                        * factorial(k - both)
                        * factorial(l - both)
                        * factorial(n + both - k - l));
                let powers = c.powi(both as i32) * b.powi((k - both) as i32) * b2.powi((l - both) as i32);
                *entry += ways * powers;
            }
        }
    }
    table
}

/// Σ_(k,l) w_k w_l t_kl/(C(N, k) C(N, l)).
fn weighed(n: usize, going_on: f64, entry: impl Fn(usize, usize) -> f64) -> f64 {
    let weight = |k: usize| {
        let binomial = factorial(n) / (factorial(k) * factorial(n - k));
        let own = if k == 0 { 1.0 } else { 0.5_f64.powi(k as i32 - 1) / going_on };
        own / binomial
    };
    let mut sum = 0.0;
    for k in 0..=n {
        for l in 0..=n {
            sum += weight(k) * weight(l) * entry(k, l);
        }
    }
    sum
}

/// Mean, variance and look-ups of unbiased ray marching with `going_on` = P.
///
/// Given N, T̂ = 1/(N + 1) Σ_j A_j, A_j = exp(−X_j) Σ_k w_k m_k({X_j − X_i}), so that E\[T̂²\] = (E\[A_1²\] + N E\[A_1 A_2\])/(N + 1). Given X_1 = x the
/// differences of A_1 are independent, with E\[y\] = x − τ and E\[y²\] = x² − 2xτ + E\[X²\]; given X_1 and X_2 those to the other N − 1 draws are pairs, with
/// E\[yz\] = x x′ − (x + x′) τ + E\[X²\], and the one between the two is a number.
pub(crate) fn second_moment(comb: &Shifts, going_on: f64) -> Moments {
    let x: Vec<(f64, f64)> =
        nodes(&comb.breaks(), 1).into_iter().map(|(u, weight)| (comb.thickness(u), weight)).collect();
    let tau: f64 = x.iter().map(|(x, weight)| weight * x).sum();
    let square: f64 = x.iter().map(|(x, weight)| weight * x * x).sum();
    let reached = |k: usize| if k == 0 { 1.0 } else { going_on * 2.0_f64.powi(k as i32 - 1) / factorial(k) };
    let (mut second, mut order) = (0.0, 0.0);
    for n in 0..=ORDERS {
        let probability = reached(n) - reached(n + 1);
        // N = 1 has the probability 0.
        if n == 1 {
            order += reached(1);
            continue;
        }
        if n > 0 {
            order += reached(n);
        }
        let mut sum = 0.0;
        for (x1, w1) in &x {
            let (b, c) = (x1 - tau, x1 * x1 - 2.0 * x1 * tau + square);
            let own = pairs(n, c, b, b);
            let mut given = libm::exp(-2.0 * x1) * weighed(n, going_on, |k, l| own[k][l]);
            if n > 0 {
                for (x2, w2) in &x {
                    let (b2, d) = (x2 - tau, x1 - x2);
                    let others = pairs(n - 1, x1 * x2 - (x1 + x2) * tau + square, b, b2);
                    let at =
                        |k: usize, l: usize| others.get(k).and_then(|row| row.get(l)).copied().unwrap_or(0.0);
                    let entry = |k: usize, l: usize| {
                        let less = |k: usize| k.checked_sub(1);
                        let first = less(k).map_or(0.0, |k| d * at(k, l));
                        let second = less(l).map_or(0.0, |l| -d * at(k, l));
                        let both = less(k).zip(less(l)).map_or(0.0, |(k, l)| -d * d * at(k, l));
                        at(k, l) + first + second + both
                    };
                    given += n as f64 * w2 * libm::exp(-x1 - x2) * weighed(n, going_on, entry);
                }
            }
            sum += w1 * given;
        }
        second += probability * sum / (n as f64 + 1.0);
    }
    let mean = transmittance(comb.profile, 1.0);
    let shared = if comb.matched { 2.0 } else { 0.0 };
    let lookups = shared + f64::from(comb.teeth) * (1.0 + order);
    Moments {
        of: "transmittance",
        mean,
        // Below rounding where the comb is exact.
        variance: Some(if second < mean * mean * (1.0 + 1e-9) { 0.0 } else { second - mean * mean }),
        fourth: None,
        lookups: Some(lookups),
    }
}
