//! Moments of walks whose factors are independent, and of strata.

use super::quadrature::{integrate, nodes};
use super::{Moments, transmittance};
use crate::Profile;

/// Event at a point of a walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Collision {
    /// Rate of points \[1/length\].
    pub(crate) rate: f64,
    /// The probability that the walk goes on.
    pub(crate) goes_on: f64,
    /// The weight with which it does.
    pub(crate) weight: f64,
}

impl Collision {
    /// A walk that always goes on, with this weight.
    pub(crate) fn always(rate: f64, weight: f64) -> Self {
        Self { rate, goes_on: 1.0, weight }
    }
}

/// The moments of exp(`log_main`) Π W over a Poisson process, and 0 where a walk has ended: E\[T^k\] = exp(k `log_main` + ∫ rate (E\[W^k\] − 1))
/// (szirmay-kalos-2017 eq. 16 for every k). A control ends walks too, at the rate `control`, and looks nothing up.
pub(crate) fn product(
    of: &'static str,
    profile: Profile,
    breaks: &[f64],
    (log_main, control): (f64, f64),
    at: impl Fn(f64, f64) -> Collision,
) -> Moments {
    let collision = |s: f64| at(s, profile.at(&s));
    let raw = std::array::from_fn(|i| {
        let k = i as i32 + 1;
        let grown = integrate(breaks, |s| {
            let Collision { rate, goes_on, weight } = collision(s);
            rate * (goes_on * weight.powi(k) - 1.0)
        });
        libm::exp(f64::from(k) * log_main + grown - control * profile.length())
    });
    let lookups = integrate(breaks, |s| {
        let mut before: Vec<f64> = breaks.iter().copied().filter(|at| *at < s).collect();
        before.push(s);
        let ended = integrate(&before, |s| {
            let Collision { rate, goes_on, .. } = collision(s);
            rate * (1.0 - goes_on) + control
        });
        collision(s).rate * libm::exp(-ended)
    });
    Moments::of_raw(of, raw, Some(lookups))
}

/// An estimate, or the score of a flight, that is 1 with the probability T and else 0.
pub(crate) fn coin(of: &'static str, profile: Profile) -> Moments {
    Moments { lookups: None, ..Moments::of_raw(of, [transmittance(profile, 1.0); 4], None) }
}

/// Binomial coefficients up to 4.
const BINOMIALS: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// E\[(1 − f b)^n\] from the moments of f and of b, which are independent.
fn one_less(f: [f64; 5], b: [f64; 5]) -> [f64; 5] {
    std::array::from_fn(|n| (0..=n).map(|i| BINOMIALS[n][i] * (-1.0_f64).powi(i as i32) * f[i] * b[i]).sum())
}

/// Moments of jittered ratio tracking over cells [from, to, minorant, majorant] with strata of at most ε.
///
/// With b_k the bracket behind the k-th point, 1 − r b_(k+1) if there is one more, which has the probability e/(k + 1), else 1: E\[b_k^n\] follows
/// from E\[b_(k+1)^i\] and the moments of r in the stratum; F = 1 − e r b_1.
pub(crate) fn strata(profile: Profile, cells: impl Iterator<Item = [f64; 4]>, epsilon: f64) -> Moments {
    let (mut raw, mut lookups, mut control) = ([1.0; 4], 0.0, 0.0);
    for [from, to, minorant, majorant] in cells {
        control += minorant * (to - from);
        let thickness = (majorant - minorant) * (to - from);
        let count = if thickness > 0.0 { (thickness / epsilon).ceil().max(1.0) } else { 0.0 };
        for stratum in 0..count as u32 {
            let (width, e) = ((to - from) / count, (thickness / count).min(epsilon));
            let start = from + f64::from(stratum) * width;
            let mut breaks = vec![start, start + width];
            breaks.extend(profile.s.iter().filter(|s| start < **s && **s < start + width));
            breaks.sort_by(f64::total_cmp);
            let of_ratio: [f64; 5] = std::array::from_fn(|n| {
                let ratio = |s: f64| (profile.at(&s) - minorant) / (majorant - minorant);
                let sum: f64 =
                    nodes(&breaks, 1).iter().map(|(s, weight)| weight * ratio(*s).powi(n as i32)).sum();
                sum / width
            });
            let mut bracket = [1.0; 5];
            for k in (1..40).rev() {
                let more = e / f64::from(k + 1);
                let deeper = one_less(of_ratio, bracket);
                bracket = std::array::from_fn(|n| (1.0 - more) + more * deeper[n]);
            }
            let scaled = std::array::from_fn(|n| e.powi(n as i32) * of_ratio[n]);
            let factor = one_less(scaled, bracket);
            raw = std::array::from_fn(|i| raw[i] * factor[i + 1]);
            // Σ_k P(N ≥ k) = Σ e^(k−1)/k!.
            lookups += libm::expm1(e) / e;
        }
    }
    let raw = std::array::from_fn(|i| raw[i] * libm::exp(-(i as f64 + 1.0) * control));
    Moments::of_raw("transmittance", raw, Some(lookups))
}
