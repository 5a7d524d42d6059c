//! The law of adaptive ratio tracking: variance and look-ups as solutions of Volterra equations along the ray.
//!
//! **Derivation.** Behind a look-up at x the rate r is fixed, a function r(x) of that place, until the next one at y. (1) As long
//! as there is none, what is still to come has the expectation exp((r − μ)(y − x)) T(y, S), by (4) of
//! [`AdaptiveRatio`](crate::AdaptiveRatio), and a look-up multiplies it by n/r, n = μ − σ_t(y). Jumps of a martingale are not
//! correlated: with ν(x) = Var(behind x)/T(x, S)², and N(y) = ∫_0^y n,
//!
//! > ν(x) = ∫_x^S r exp(r (y − x) − 2 (N(y) − N(x))) ((n/r − 1)² + (n/r)² ν(y)) dy,   r = r(x),
//!
//! of which every term is positive. Var/T² is its right side at x = 0 with the first rate, μ. (2) Look-ups: λ(x) = ∫_x^S r exp(−r (y − x))
//! (1 + λ(y)) dy.
//!
//! **Solution.** Backwards over cells between the places where σ_t is not smooth, by collocation at Gauss nodes: the rest of a cell is
//! integrated through the polynomial of its own nodes, later cells by their Gauss rule. Cells are halved until the variance
//! stands; what the last halving changed is the error.

use fairflight_elementary::exp;
use fairflight_media::Extinction;

/// Gauss–Legendre on \[0, 1\], five points.
const ORDER: usize = 5;
const POINTS: [(f64, f64); ORDER] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Optical thickness of a cell in μ, before any halving.
const DEPTH: f64 = 1.0;

/// A grid of more cells is not tried: pairs of nodes are what a solution costs.
const MOST_CELLS: usize = 1200;

/// Law of one estimate, as far as it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AdaptiveLaw {
    /// Var/T².
    pub(crate) variance: f64,
    /// Change of the variance by the last halving of the cells.
    pub(crate) error: f64,
    /// Expected look-ups.
    pub(crate) lookups: f64,
}

/// The law for the majorant `mu` > 0 and rates of at least `floor` · μ, on a field that is smooth between `borders`; `None` where cells
/// would be too many, or the variance is beyond the range of numbers.
pub(crate) fn solve<F: Extinction>(field: &F, borders: &[f64], mu: f64, floor: f64) -> Option<AdaptiveLaw> {
    const RELATIVE: f64 = 1e-9;
    let coarsest = grid(field.length(), borders, DEPTH / mu)?;
    let mut last = Solution::on(field, &coarsest, mu, floor);
    let mut cells = coarsest;
    loop {
        cells = cells
            .iter()
            .flat_map(|&(from, width)| [(from, 0.5 * width), (from + 0.5 * width, 0.5 * width)])
            .collect();
        let next = Solution::on(field, &cells, mu, floor);
        let error = (next.variance - last.variance).abs();
        if !next.variance.is_finite() {
            return None;
        }
        if error <= RELATIVE * next.variance || 2 * cells.len() > MOST_CELLS {
            return Some(AdaptiveLaw { variance: next.variance, error, lookups: next.lookups });
        }
        last = next;
    }
}

/// Cells of at most this width between the borders; `None` if they are too many.
fn grid(length: f64, borders: &[f64], width: f64) -> Option<Vec<(f64, f64)>> {
    let (mut cells, mut from) = (Vec::new(), 0.0);
    for &to in borders.iter().chain([&length]).filter(|&&to| to > 0.0) {
        let count = ((to - from) / width).ceil().max(1.0);
        if cells.len() as f64 + count > 0.5 * MOST_CELLS as f64 {
            return None;
        }
        let width = (to - from) / count;
        cells.extend((0..count as u32).map(|i| (from + f64::from(i) * width, width)));
        from = to;
    }
    Some(cells)
}

/// A place of the grid.
#[derive(Clone, Copy)]
struct Node {
    s: f64,
    /// μ − σ_t, its integral up to here, and the rate behind a look-up here.
    null: f64,
    grown: f64,
    rate: f64,
    /// The weight in the Gauss rule.
    weight: f64,
    /// ν and λ.
    variance: f64,
    lookups: f64,
}

/// ν and λ at the start.
struct Solution {
    variance: f64,
    lookups: f64,
}

impl Solution {
    fn on<F: Extinction>(field: &F, cells: &[(f64, f64)], mu: f64, floor: f64) -> Self {
        let until = integrals();
        let mut grown = 0.0;
        let mut nodes: Vec<Node> = Vec::with_capacity(ORDER * cells.len());
        for &(from, width) in cells {
            let null = POINTS.map(|(point, _)| mu - field.sigma_t(from + point * width));
            for (i, (point, weight)) in POINTS.into_iter().enumerate() {
                let up_to_here: f64 = (0..ORDER).map(|j| until[i][j] * null[j]).sum();
                nodes.push(Node {
                    s: from + point * width,
                    null: null[i],
                    grown: grown + width * up_to_here,
                    rate: null[i].max(floor * mu),
                    weight: weight * width,
                    variance: 0.0,
                    lookups: 0.0,
                });
            }
            grown += width * POINTS.iter().zip(null).map(|((_, weight), null)| weight * null).sum::<f64>();
        }
        for (cell, &(_, width)) in cells.iter().enumerate().rev() {
            let (before, later) = nodes.split_at_mut(ORDER * (cell + 1));
            let own = &mut before[ORDER * cell..];
            let [variances, lookups] = collocated(own, later, |i, j| width * (POINTS[j].1 - until[i][j]));
            for ((node, variance), lookups) in own.iter_mut().zip(variances).zip(lookups) {
                (node.variance, node.lookups) = (variance, lookups);
            }
        }
        let start =
            Node { s: 0.0, null: 0.0, grown: 0.0, rate: mu, weight: 0.0, variance: 0.0, lookups: 0.0 };
        let [variance, lookups] = start.beyond(&nodes);
        Self { variance, lookups }
    }
}

impl Node {
    /// The kernels of ν and λ from here to `other`: that of what is known, and that of what comes behind.
    fn kernels(&self, other: &Self) -> [[f64; 2]; 2] {
        let (distance, ratio) = (other.s - self.s, other.null / self.rate);
        let of_variance = self.rate * exp(self.rate * distance - 2.0 * (other.grown - self.grown));
        let of_lookups = self.rate * exp(-self.rate * distance);
        [[of_variance * (ratio - 1.0) * (ratio - 1.0), of_variance * ratio * ratio], [of_lookups, of_lookups]]
    }

    /// Contribution of later nodes to ν and λ.
    fn beyond(&self, later: &[Self]) -> [f64; 2] {
        later.iter().fold([0.0; 2], |[variance, lookups], other| {
            let [[jump, goes_on], [once, again]] = self.kernels(other);
            [
                variance + other.weight * (jump + goes_on * other.variance),
                lookups + other.weight * (once + again * other.lookups),
            ]
        })
    }
}

/// ν and λ at the nodes of one cell, whose own part is integrated with `rest(i, j)`.
fn collocated(own: &[Node], later: &[Node], rest: impl Fn(usize, usize) -> f64) -> [[f64; ORDER]; 2] {
    let mut sides: [[f64; ORDER]; 2] = [[0.0; ORDER]; 2];
    let mut matrices = [[[0.0; ORDER]; ORDER]; 2];
    for (i, node) in own.iter().enumerate() {
        let beyond = node.beyond(later);
        for k in 0..2 {
            sides[k][i] = beyond[k];
            matrices[k][i][i] = 1.0;
        }
        for (j, other) in own.iter().enumerate() {
            for (k, [known, behind]) in node.kernels(other).into_iter().enumerate() {
                sides[k][i] += rest(i, j) * known;
                matrices[k][i][j] -= rest(i, j) * behind;
            }
        }
    }
    let [first, second] = matrices;
    [eliminate(first, sides[0]), eliminate(second, sides[1])]
}

/// Solves by elimination: the matrices are near the identity.
fn eliminate(mut matrix: [[f64; ORDER]; ORDER], mut side: [f64; ORDER]) -> [f64; ORDER] {
    for k in 0..ORDER {
        let pivot = matrix[k];
        for i in (0..ORDER).filter(|&i| i != k) {
            let factor = matrix[i][k] / pivot[k];
            for (value, of_pivot) in matrix[i].iter_mut().zip(pivot).skip(k) {
                *value -= factor * of_pivot;
            }
            side[i] -= factor * side[k];
        }
    }
    std::array::from_fn(|k| side[k] / matrix[k][k])
}

/// ∫_0^{ξ_i} of the Lagrange polynomial of ξ_j: the Gauss rule is exact for it.
fn integrals() -> [[f64; ORDER]; ORDER] {
    let polynomial = |j: usize, t: f64| -> f64 {
        (0..ORDER).filter(|&k| k != j).map(|k| (t - POINTS[k].0) / (POINTS[j].0 - POINTS[k].0)).product()
    };
    std::array::from_fn(|i| {
        let end = POINTS[i].0;
        std::array::from_fn(|j| POINTS.iter().map(|(t, weight)| end * weight * polynomial(j, end * t)).sum())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use fairflight_media::{Constant, PiecewiseConstant};

    #[test]
    fn a_constant_medium_varies_until_its_first_collision() {
        // Behind it r = n: no jump. Before it (1 − n/μ)² μ ∫ exp((μ − 2n) y) dy.
        let (sigma, mu, length) = (0.4, 1.0, 3.0);
        let n = mu - sigma;
        let exact = mu * (n / mu - 1.0_f64).powi(2) * f64::exp_m1((mu - 2.0 * n) * length) / (mu - 2.0 * n);
        let law = solve(&Constant::new(sigma, length).unwrap(), &[], mu, 0.1).unwrap();
        assert_relative_eq!(law.variance, exact, max_relative = 1e-10);
        // The first look-up at the rate μ, all others at n: ∫ μ exp(−μ y) (1 + n (S − y)) dy.
        let first = -f64::exp_m1(-mu * length);
        let later = n * (length - first / mu);
        assert_relative_eq!(law.lookups, first + later, max_relative = 1e-10);
    }

    /// With a floor of 1 and no σ_t below 0 the rate is μ throughout: ratio tracking, Var/T² = exp(∫ σ_t²/μ) − 1, μS look-ups.
    #[test]
    fn at_a_floor_of_one_it_is_ratio_tracking() {
        let field = PiecewiseConstant::new(vec![0.0, 1.0, 1.001, 4.0], vec![0.8, 1.4, 0.2]).unwrap();
        let exact = (0.64 + 0.001 * 1.96 + 2.999 * 0.04_f64).exp_m1();
        let law = solve(&field, &[1.0, 1.001], 1.0, 1.0).unwrap();
        assert_relative_eq!(law.variance, exact, max_relative = 1e-9);
        assert_relative_eq!(law.lookups, 4.0, max_relative = 1e-9);
        assert!(law.error < 1e-9 * exact);
    }

    #[test]
    fn what_would_take_too_many_cells_is_not_tried() {
        assert_eq!(solve(&Constant::new(1.0, 1.0).unwrap(), &[], 1e6, 0.1), None);
    }
}
