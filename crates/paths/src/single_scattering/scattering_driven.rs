//! Distances along a ray that mimic transmittance times extinction, from a fitted extinction.

use fairflight_elementary::{exp, exp_m1, ln_1p};
use fairflight_transmittance::Explorers;

/// The density of the first collision in a piecewise linear extinction through explorers, mixed with a uniform one.
///
/// > pdf(s) = (1 − d) σ_f(s) exp(−∫_0^s σ_f) / (1 − exp(−∫_0^S σ_f)) + d/S,   d = 0.1
///
/// σ_f is the fit where that is positive, else 0. A fit may vanish where the medium does not: the uniform part is what keeps the
/// density positive wherever the integrand is, and no score above 1/d of what uniform sampling would give.
#[derive(Clone, Debug, Default)]
pub struct ScatteringDriven {
    values: Vec<f64>,
    depth: Vec<f64>,
    spacing: f64,
    length: f64,
    /// 1 − exp(−∫ σ_f): the probability of a collision; 0 for an empty fit, which leaves the uniform part alone.
    collides: f64,
}

/// The share of the uniform part.
const DEFENSIVE: f64 = 0.1;

impl ScatteringDriven {
    /// Takes the fit of another ray, of `length` > 0. Allocates only if it has more points than the ones before.
    pub fn refit(&mut self, explorers: &Explorers, length: f64) {
        self.values.clear();
        self.values.extend(explorers.points().map(|(_, sigma_t)| sigma_t.max(0.0)));
        self.length = length;
        self.spacing = length / (self.values.len() - 1) as f64;
        self.depth.clear();
        self.depth.push(0.0);
        for i in 1..self.values.len() {
            let trapezoid = 0.5 * self.spacing * (self.values[i - 1] + self.values[i]);
            self.depth.push(self.depth[i - 1] + trapezoid);
        }
        self.collides = -exp_m1(-self.depth[self.depth.len() - 1]);
    }

    fn share_of_uniform(&self) -> f64 {
        if self.collides > 0.0 { DEFENSIVE } else { 1.0 }
    }

    /// The distance of the variate `u` \[length\].
    #[must_use]
    pub fn sample(&self, u: f64) -> f64 {
        let uniform = self.share_of_uniform();
        if u < uniform {
            return u / uniform * self.length;
        }
        let v = (u - uniform) / (1.0 - uniform);
        let target = -ln_1p(-v * self.collides);
        let piece = self.depth[1..].partition_point(|&depth| depth <= target).min(self.values.len() - 2);
        // d = a t + (b − a) t²/(2h) solved for t: 2 d/(a + √(a² + 2 d (b − a)/h)) does not cancel.
        let (a, b) = (self.values[piece], self.values[piece + 1]);
        let rest = (target - self.depth[piece]).max(0.0);
        let root = (a * a + 2.0 * rest * (b - a) / self.spacing).max(0.0).sqrt();
        let t = if a + root > 0.0 { 2.0 * rest / (a + root) } else { 0.0 };
        (piece as f64 * self.spacing + t.min(self.spacing)).min(self.length)
    }

    /// The density at `s` \[1/length\].
    #[must_use]
    pub fn pdf_distance(&self, s: f64) -> f64 {
        let uniform = self.share_of_uniform();
        let mut pdf = uniform / self.length;
        if self.collides > 0.0 {
            let piece = ((s / self.spacing) as usize).min(self.values.len() - 2);
            let t = s - piece as f64 * self.spacing;
            let (a, b) = (self.values[piece], self.values[piece + 1]);
            let sigma = a + (b - a) * (t / self.spacing);
            let depth = self.depth[piece] + 0.5 * t * (a + sigma);
            pdf += (1.0 - uniform) * sigma * exp(-depth) / self.collides;
        }
        pdf
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{PiecewiseLinear, Tolerance, adaptive_integral};

    fn technique(values: Vec<f64>) -> ScatteringDriven {
        let positions = (0..values.len()).map(|i| i as f64).collect::<Vec<_>>();
        let count = values.len();
        let length = (count - 1) as f64;
        let field = PiecewiseLinear::new(positions, values).unwrap();
        let mut technique = ScatteringDriven::default();
        technique.refit(&Explorers::through(&field, count).unwrap(), length);
        technique
    }

    #[test]
    fn samples_follow_the_density() {
        for values in
            [vec![0.0, 2.0, 0.0, 0.0, 1.0], vec![1.0, 1.0, 1.0], vec![0.5, -0.5, 3.0], vec![0.0, 0.0]]
        {
            let technique = technique(values.clone());
            let breaks: Vec<f64> = (1..values.len()).map(|i| i as f64).collect();
            let total = adaptive_integral(technique.length, &breaks, Tolerance::TIGHT, |s| {
                [technique.pdf_distance(s)]
            });
            assert!((total.value[0] - 1.0).abs() < 1e-9, "{values:?}: {total:?}");
            // Mean distance by the density and by many equidistant variates.
            let mean = adaptive_integral(technique.length, &breaks, Tolerance::TIGHT, |s| {
                [s * technique.pdf_distance(s)]
            });
            let n = 200_000;
            let sampled = (0..n).map(|i| technique.sample((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>()
                / f64::from(n);
            assert!((sampled - mean.value[0]).abs() < 1e-5 * technique.length, "{values:?}");
        }
    }
}
