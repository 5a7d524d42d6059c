//! The radiance that leaves a plane-parallel slab, without a random number: the doubling method (hansen-1971).
//!
//! Nothing here is shared with the walks: no flight, no phase function in code, no medium. What is solved is the equation of
//! transfer, averaged over the azimuth, at the nodes of a quadrature in μ.

use std::f64::consts::PI;

/// A slab of infinite extent.
#[derive(Clone, Debug, PartialEq)]
pub struct Slab {
    /// ∫ σ_t along its normal \[1\].
    pub optical_thickness: f64,
    /// σ_s/σ_t, above 1 for a gain.
    pub albedo: f64,
    /// β_l of 4π · phase function = Σ β_l P_l(cos θ): \[1\] for an isotropic one, \[1, 0, 1/2\] for Rayleigh's,
    /// (2l + 1) g^l for Henyey-Greenstein's.
    pub legendre: Vec<f64>,
}

/// Light on one side of a slab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lit {
    /// Radiance 1 from the whole half space; seen along the normal.
    Diffusely,
    /// Irradiance 1 along the normal; seen at μ = [`OBLIQUE`].
    Normally,
}

/// The cosine at which a slab that is lit along its normal is seen.
pub const OBLIQUE: f64 = 0.6;

/// The radiance that leaves a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Radiance on the side of the light.
    pub reflected: f64,
    /// Radiance on the other side; diffuse light that passed unscattered included.
    pub transmitted: f64,
    /// A bound of the error of both, measured.
    pub error: f64,
}

/// The weight of the two nodes that quadrature does not need, at which light comes and goes: small against every other.
const NEGLIGIBLE: f64 = 1e-10;

impl Slab {
    /// Solves with 8 nodes and 2^20 layers, and again with 16 and 2^21; the error is twice the difference. The first
    /// layer is right to first order, which makes that the error of the better one doubled.
    #[must_use]
    pub fn respond(&self, lit: Lit) -> Response {
        let ([reflected, transmitted], coarse) = (self.solve(lit, 16, 21), self.solve(lit, 8, 20));
        let error = (reflected - coarse[0]).abs().max((transmitted - coarse[1]).abs());
        Response { reflected, transmitted, error: 2.0 * error + NEGLIGIBLE }
    }

    fn solve(&self, lit: Lit, nodes: usize, doublings: i32) -> [f64; 2] {
        let mut mu: Vec<(f64, f64)> = gauss_legendre(nodes);
        mu.extend([(1.0, NEGLIGIBLE), (OBLIQUE, NEGLIGIBLE)]);
        let (normal, oblique) = (nodes, nodes + 1);
        let (mut reflection, mut transmission) = self.thin(&mu, doublings);
        for _ in 0..doublings {
            // Light that goes up and down between two equal layers: X = (1 − R R)⁻¹ T.
            let between = solve(identity_minus(&product(&reflection, &reflection)), transmission.clone());
            let up = product(&transmission, &product(&reflection, &between));
            reflection = reflection
                .iter()
                .zip(&up)
                .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect())
                .collect();
            transmission = product(&transmission, &between);
        }
        [reflection, transmission].map(|operator| match lit {
            Lit::Diffusely => operator[normal].iter().sum(),
            // ∫ I μ dω = 1 for the light of one node of weight w: 2π w I = 1.
            Lit::Normally => operator[oblique][normal] / (2.0 * PI * NEGLIGIBLE),
        })
    }

    /// A layer so thin that light is scattered once in it at most. The operators take radiances that come in at the nodes to radiances
    /// that leave; their weights are in them.
    fn thin(&self, mu: &[(f64, f64)], doublings: i32) -> (Matrix, Matrix) {
        let thickness = self.optical_thickness * 0.5_f64.powi(doublings);
        let legendre: Vec<Vec<f64>> =
            mu.iter().map(|&(mu, _)| polynomials(mu, self.legendre.len())).collect();
        let operator = |side: f64| -> Matrix {
            (0..mu.len())
                .map(|i| {
                    let passed = (-thickness / mu[i].0).exp();
                    (0..mu.len())
                        .map(|j| {
                            let (mut phase, mut sign) = (0.0, 1.0);
                            for (l, beta) in self.legendre.iter().enumerate() {
                                phase += sign * beta * legendre[i][l] * legendre[j][l];
                                sign *= side;
                            }
                            let direct = if i == j && side > 0.0 { passed } else { 0.0 };
                            direct + 0.5 * self.albedo * phase * mu[j].1 * (1.0 - passed)
                        })
                        .collect()
                })
                .collect()
        };
        (operator(-1.0), operator(1.0))
    }
}

type Matrix = Vec<Vec<f64>>;

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.iter()
        .map(|row| (0..b.len()).map(|j| row.iter().zip(b).map(|(x, other)| x * other[j]).sum()).collect())
        .collect()
}

fn identity_minus(a: &Matrix) -> Matrix {
    let one = |i: usize, j: usize| f64::from(u8::from(i == j));
    a.iter()
        .enumerate()
        .map(|(i, row)| row.iter().enumerate().map(|(j, x)| one(i, j) - x).collect())
        .collect()
}

/// a⁻¹ b by elimination. The matrices 1 − R R of a layer are diagonally dominant or nearly so: no pivots are needed.
fn solve(mut a: Matrix, mut b: Matrix) -> Matrix {
    let n = a.len();
    for k in 0..n {
        let (pivot_a, pivot_b) = (a[k].clone(), b[k].clone());
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k] / pivot_a[k];
            for j in 0..n {
                a[i][j] -= factor * pivot_a[j];
                b[i][j] -= factor * pivot_b[j];
            }
        }
    }
    for (k, row) in b.iter_mut().enumerate() {
        row.iter_mut().for_each(|x| *x /= a[k][k]);
    }
    b
}

/// P_0(x) … P_{n−1}(x).
fn polynomials(x: f64, n: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for l in 1..n as i32 {
        let (below, last) = (values[values.len() - 2], values[values.len() - 1]);
        values.push((f64::from(2 * l + 1) * x * last - f64::from(l) * below) / f64::from(l + 1));
    }
    values
}

/// Nodes and weights on \[0, 1\] by Newton's method.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..50 {
                let values = polynomials(x, n + 1);
                slope = n as f64 * (values[n - 1] - x * values[n]) / (1.0 - x * x);
                x -= values[n] / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn isotropic(optical_thickness: f64, albedo: f64) -> Slab {
        Slab { optical_thickness, albedo, legendre: vec![1.0] }
    }

    /// H(μ) of chandrasekhar-1960 for isotropic scattering, from its own integral equation, 1/H(μ) = √(1 − a) + (a/2) ∫ μ′H(μ′)/(μ + μ′) dμ′.
    fn h_function(albedo: f64, at: [f64; 2]) -> [f64; 2] {
        let nodes = gauss_legendre(64);
        let mut values = vec![1.0; nodes.len()];
        let step = |values: &[f64], mu: f64| {
            let sum: f64 = nodes.iter().zip(values).map(|((m, w), h)| w * m * h / (mu + m)).sum();
            1.0 / ((1.0 - albedo).sqrt() + 0.5 * albedo * sum)
        };
        for _ in 0..500 {
            values = nodes.iter().map(|&(mu, _)| step(&values, mu)).collect();
        }
        at.map(|mu| step(&values, mu))
    }

    #[test]
    fn a_thick_slab_reflects_as_a_half_space() {
        for albedo in [0.3, 0.9] {
            let response = isotropic(60.0, albedo).respond(Lit::Normally);
            let [normal, oblique] = h_function(albedo, [1.0, OBLIQUE]);
            // Chandrasekhar's law of diffuse reflection.
            let exact = albedo / (4.0 * PI) * normal * oblique / (1.0 + OBLIQUE);
            assert!(
                (response.reflected - exact).abs() < response.error + 1e-7,
                "{albedo}: {response:?} {exact}"
            );
            assert!(response.error < 1e-4, "{response:?}");
        }
    }

    #[test]
    fn nothing_is_lost_without_absorption() {
        for legendre in [
            vec![1.0],
            vec![1.0, 0.0, 0.5],
            (0..31).map(|l| f64::from(2 * l + 1) * 0.5_f64.powi(l)).collect(),
        ] {
            let slab = Slab { optical_thickness: 3.0, albedo: 1.0, legendre };
            let response = slab.respond(Lit::Diffusely);
            assert!(
                (response.reflected + response.transmitted - 1.0).abs() < 2.0 * response.error,
                "{response:?}"
            );
            assert!(response.error < 1e-3, "{response:?}");
        }
    }

    #[test]
    fn a_thin_slab_scatters_once() {
        let (tau, albedo) = (1e-4, 0.7);
        let response =
            Slab { optical_thickness: tau, albedo, legendre: vec![1.0, 0.0, 0.5] }.respond(Lit::Normally);
        // a ρ τ/μ with Rayleigh's phase function at the cosine ∓0.6.
        let exact = albedo * 3.0 / (16.0 * PI) * (1.0 + OBLIQUE * OBLIQUE) * tau / OBLIQUE;
        for found in [response.reflected, response.transmitted] {
            assert!((found / exact - 1.0).abs() < 1e-3, "{response:?} {exact}");
        }
    }
}
