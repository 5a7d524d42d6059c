//! Quadrature by Gauss and Legendre.

use crate::Profile;

/// Nodes of a panel.
const NODES: usize = 12;

/// Nodes and weights on \[−1, 1\], by Newton's method on the recursion of Legendre's polynomials.
fn rule() -> [(f64, f64); NODES] {
    let n = NODES as f64;
    std::array::from_fn(|i| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=NODES {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Nodes and weights of so many panels between each two breaks.
pub(crate) fn nodes(breaks: &[f64], panels: u32) -> Vec<(f64, f64)> {
    let rule = rule();
    let mut nodes = Vec::new();
    for pair in breaks.windows(2) {
        let width = (pair[1] - pair[0]) / f64::from(panels);
        for panel in 0..panels {
            let middle = pair[0] + (f64::from(panel) + 0.5) * width;
            nodes.extend(rule.iter().map(|(x, weight)| (middle + 0.5 * width * x, 0.5 * width * weight)));
        }
    }
    nodes
}

/// The integral between the first and the last break of a function that is smooth between any two.
pub(crate) fn integrate(breaks: &[f64], mut f: impl FnMut(f64) -> f64) -> f64 {
    nodes(breaks, 3).into_iter().map(|(x, weight)| weight * f(x)).sum()
}

/// The nodes of a profile, further distances, and the places where σ_t takes one of these values: in order.
pub(crate) fn breaks_at(profile: Profile, further: &[f64], values: &[f64]) -> Vec<f64> {
    let mut breaks: Vec<f64> = profile.s.iter().chain(further).copied().collect();
    for i in 1..profile.s.len() {
        let (a, b) = (profile.sigma_t[i - 1], profile.sigma_t[i]);
        let share = values.iter().map(|value| (value - a) / (b - a)).filter(|t| (0.0..=1.0).contains(t));
        breaks.extend(share.map(|t| profile.s[i - 1] + t * (profile.s[i] - profile.s[i - 1])));
    }
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_integrated() {
        let integral = integrate(&[0.0, 1.0, 3.0], |x| x.powi(7));
        assert!((integral / (3.0_f64.powi(8) / 8.0) - 1.0).abs() < 1e-14, "{integral}");
    }
}
