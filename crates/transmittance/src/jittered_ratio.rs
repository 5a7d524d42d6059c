//! Jittered ratio tracking: one stratum after another, each with a random alternating series that never leaves \[0, 1\].

use crate::jittered_law::theory_of;
use crate::{ClosedForm, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_media::{
    BoundCell, BoundedInCells, Epsilon, EpsilonError, Extinction, Majorant, RayQuadrature, Tolerance,
};
use fairflight_sources::UniformSource;

/// Ratio tracking on strata of the optical thickness ε in the majorant, with one point in each, rarely more.
///
/// In a stratum of the width h let R = ∫ σ_t, x_1, x_2, … independent uniform points, e = majorant · h ≤ ε ≤ 1 its optical
/// thickness in the majorant, and r_k = σ_t(x_k)/majorant, so that E\[e r_k\] = R. The order N has P(N ≥ k) = e^{k−1}/k!, and
///
/// > F = 1 − e r_1 (1 − r_2 (1 − r_3 (… (1 − r_N)))),   T̂ = Π F over the strata.
///
/// **Law.** The term of order k has the expectation (−R)^k e^{−(k−1)}, and is counted with the probability e^{k−1}/k!: E\[F\] =
/// Σ (−R)^k/k! = exp(−R). Strata are independent. With 0 ≤ σ_t ≤ majorant each bracket lies in \[0, 1\], in floating point as
/// well, hence F in \[1 − e, 1\] and T̂ in \[0, 1\]: no estimate is ever negative, none exceeds 1.
///
/// **Moments.** Those of F follow from the moments of r in the stratum by a recursion over the orders (`jittered_law.rs`), those of
/// the product from [`crate::FactorLaw`]. What remains of ratio tracking's ∫ σ_t²/majorant is the variance *within* strata, and
/// that of the order, about e³ r⁴/2.
///
/// **Cost.** (exp(e) − 1)/e look-ups for each of ⌈majorant · length/ε⌉ strata: 1.72 for each unit of optical thickness in the
/// majorant at ε = 1, 2.59 at 1/2, 4.5 at 1/4.
///
/// **Source.** Ours; no publication of it was found. Block-Poisson estimators (quiroz-2021) are the nearest relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JitteredRatio {
    pub(crate) epsilon: Epsilon,
}

/// [`JitteredRatio`] between the bounds of each cell: the minorant is the control, and a cell is cut into
/// ⌈(majorant − minorant) · width/ε⌉ strata.
///
/// **Law.** As there, times exp(−∫ minorant): an estimate lies in \[0, exp(−∫ minorant)\]. Where majorant = minorant nothing is
/// looked up, and the bounds must hold.
///
/// **Cost.** (exp(e) − 1)/e look-ups for each stratum, at least one for each cell whose bounds differ: very many thin cells are
/// a waste here, as they are not for [`crate::ResidualCells`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JitteredRatioInCells {
    pub(crate) epsilon: Epsilon,
}

impl JitteredRatio {
    /// The estimator with strata of the optical thickness `epsilon` \[1\] in the majorant, or a little less.
    ///
    /// # Errors
    /// If `epsilon` is not in (0, 1\].
    pub fn new(epsilon: f64) -> Result<Self, EpsilonError> {
        Epsilon::new(epsilon).map(|epsilon| Self { epsilon })
    }

    /// The greatest optical thickness of a stratum in the majorant \[1\].
    #[must_use]
    pub fn epsilon(&self) -> f64 {
        self.epsilon.get()
    }

    /// The whole profile as one cell.
    pub(crate) fn cell<F: Majorant>(field: &F) -> BoundCell {
        BoundCell { to: field.length(), minorant: 0.0, majorant: field.majorant() }
    }
}

impl JitteredRatioInCells {
    /// The estimator with strata of the optical thickness `epsilon` \[1\] in what a cell can vary by, or a little less.
    ///
    /// # Errors
    /// If `epsilon` is not in (0, 1\].
    pub fn new(epsilon: f64) -> Result<Self, EpsilonError> {
        Epsilon::new(epsilon).map(|epsilon| Self { epsilon })
    }

    /// The greatest optical thickness of a stratum in the range of its cell \[1\].
    #[must_use]
    pub fn epsilon(&self) -> f64 {
        self.epsilon.get()
    }
}

/// Strata of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strata {
    /// Number of the strata; 0 where there is nothing to look up.
    pub(crate) count: f64,
    /// The width of each \[length\].
    pub(crate) width: f64,
    /// range · width, at most ε.
    pub(crate) thickness: f64,
}

impl Strata {
    #[inline]
    pub(crate) fn of(cell: &BoundCell, from: f64, epsilon: Epsilon) -> Self {
        let width = cell.to - from;
        let thickness = cell.range() * width;
        let count = epsilon.strata(thickness);
        if count == 0.0 {
            return Self { count, width, thickness: 0.0 };
        }
        // The quotient may exceed ε by a rounding, and F leave [0, 1] with it.
        Self { count, width: width / count, thickness: (thickness / count).min(epsilon.get()) }
    }
}

/// Multiplies `product` by F of each stratum of the cell that begins at `from`.
#[inline]
fn multiply_cell<F: Extinction>(
    product: &mut SignedProduct,
    field: &F,
    (from, cell, epsilon): (f64, &BoundCell, Epsilon),
    source: &mut impl UniformSource,
) {
    let strata = Strata::of(cell, from, epsilon);
    // Rounding may carry the last point of a cell to its end, where σ_t may jump to what the next cell bounds.
    let last = cell.to.next_down();
    for i in 0..strata.count as u64 {
        // One variate for the order: the product runs down to 0, so that 0 is no endless series either.
        let u = source.next_uniform();
        let (mut order, mut at_least) = (1.0, 0.5 * strata.thickness);
        while u < at_least {
            order += 1.0;
            at_least *= strata.thickness / (order + 1.0);
        }
        // From the innermost bracket outwards: no term is ever stored, and none leaves [0, 1].
        let mut bracket = 1.0;
        let mut r = 0.0;
        while order > 0.0 {
            bracket = 1.0 - r * bracket;
            let s = from + (i as f64 + source.next_uniform()) * strata.width;
            r = (field.sigma_t(s.min(last)) - cell.minorant) / cell.range();
            order -= 1.0;
        }
        product.multiply(1.0 - strata.thickness * (r * bracket));
    }
}

impl<F: Majorant> TransmittanceEstimator<F> for JitteredRatio {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut product = SignedProduct::ONE;
        multiply_cell(&mut product, field, (0.0, &Self::cell(field), self.epsilon), source);
        product.times_exp(0.0)
    }

    /// True between 0 and the majorant. (Beyond them the mean would still be right, the range of the estimates not.)
    #[inline]
    fn admits(&self, field: &F, _s: f64, sigma_t: f64) -> bool {
        (0.0..=field.majorant()).contains(&sigma_t)
    }
}

impl<F: BoundedInCells> TransmittanceEstimator<F> for JitteredRatioInCells {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut product = SignedProduct::ONE;
        let (mut minorant_thickness, mut from) = (0.0, 0.0);
        for cell in field.bound_cells() {
            minorant_thickness += cell.minorant * (cell.to - from);
            multiply_cell(&mut product, field, (from, cell, self.epsilon), source);
            from = cell.to;
        }
        product.times_exp(-minorant_thickness)
    }

    /// True between the bounds of the cell. (Beyond them the mean would still be right, the range of the estimates not.)
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        field.cells_admit(s, sigma_t)
    }
}

impl<F: Majorant> ClosedForm<F> for JitteredRatio {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let cell = Self::cell(quadrature.field());
        let cells: &[BoundCell] = if cell.to > 0.0 { &[cell] } else { &[] };
        theory_of(cells, self.epsilon, quadrature, tolerance)
    }
}

impl<F: BoundedInCells> ClosedForm<F> for JitteredRatioInCells {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let cells = quadrature.field().bound_cells().to_vec();
        theory_of(&cells, self.epsilon, quadrature, tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Bounded, Constant, Counted, InCells, PiecewiseConstant, PiecewiseLinear};
    use fairflight_sources::{LARGEST_VARIATE, Scripted, Seeded};

    fn cell(to: f64, minorant: f64, majorant: f64) -> BoundCell {
        BoundCell { to, minorant, majorant }
    }

    #[test]
    fn a_stratum_is_the_nested_product() {
        // One stratum of length 1: e = 1, r = σ_t = s.
        let ramp = PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
        let estimate =
            |u: &[f64]| JitteredRatio::new(1.0).unwrap().estimate(&ramp, &mut Scripted::new(u.to_vec()));
        // P(N ≥ 2) = 1/2, P(N ≥ 3) = 1/6: the first variate says the order, the others are points, the innermost first.
        assert_eq!(estimate(&[0.5, 0.25]), 0.75);
        assert_eq!(estimate(&[0.49, 0.5, 0.25]), 1.0 - 0.25 * (1.0 - 0.5));
        assert_eq!(estimate(&[0.16, 0.75, 0.5, 0.25]), 1.0 - 0.25 * (1.0 - 0.5 * (1.0 - 0.75)));
    }

    #[test]
    fn strata_are_as_many_as_needed_and_no_thicker_than_epsilon() {
        for (thickness, epsilon) in [(20.0, 0.5), (20.0, 0.3), (1e-9, 1.0), (0.7, 0.1), (3.0, 1.0)] {
            let strata = Strata::of(&cell(2.0, 0.0, thickness), 1.0, Epsilon::new(epsilon).unwrap());
            assert!(strata.thickness <= epsilon && strata.count >= 1.0);
            assert!((strata.count * strata.thickness / thickness - 1.0).abs() < 1e-12);
            assert!((strata.count - 1.0) * epsilon < thickness * (1.0 + 1e-12));
            // Who asks for it is told the same.
            assert_eq!(JitteredRatio::new(epsilon).unwrap().epsilon(), epsilon);
            assert_eq!(JitteredRatioInCells::new(epsilon).unwrap().epsilon(), epsilon);
        }
        let half = Epsilon::new(0.5).unwrap();
        assert_eq!(Strata::of(&cell(2.0, 0.25, 0.25), 1.0, half).count, 0.0);
        assert_eq!(Strata::of(&cell(0.0, 0.0, 1.0), 0.0, half).count, 0.0);
    }

    #[test]
    fn no_estimate_leaves_the_unit_interval() {
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        let full = Constant::new(2.0, 3.0).unwrap();
        let cells =
            InCells::new(&tent, [cell(0.5, 0.0, 1.0), cell(2.0, 0.5, 2.0), cell(3.0, 0.0, 1.0)]).unwrap();
        for epsilon in [1.0, 0.7, 1e-3] {
            let (whole, in_cells) =
                (JitteredRatio::new(epsilon).unwrap(), JitteredRatioInCells::new(epsilon).unwrap());
            let mut source = Seeded::new(3);
            for _ in 0..2000 {
                for estimate in [whole.estimate(&tent, &mut source), whole.estimate(&full, &mut source)] {
                    assert!((0.0..=1.0).contains(&estimate), "{estimate}");
                }
                let most = (-0.75_f64).exp();
                assert!((0.0..=most).contains(&in_cells.estimate(&cells, &mut source)));
            }
        }
    }

    #[test]
    fn the_ends_of_the_lattice() {
        let full = Constant::new(1.0, 1.0).unwrap();
        let estimate = |variate: f64| {
            let counted = Counted::new(&full);
            let mut source = Scripted::new(vec![variate; 400]);
            (JitteredRatio::new(1.0).unwrap().estimate(&counted, &mut source), counted.lookups())
        };
        assert_eq!(estimate(LARGEST_VARIATE), (0.0, 1));
        let (value, lookups) = estimate(0.0);
        assert!((value == 0.0 || value == 1.0) && lookups < 200, "{value}, {lookups}");
    }

    #[test]
    fn nothing_to_meet_costs_nothing() {
        let empty = Bounded::new(Constant::new(0.0, 1e300).unwrap(), 0.0).unwrap();
        assert_eq!(JitteredRatio::new(0.5).unwrap().estimate(&empty, &mut Scripted::new([])), 1.0);
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![3.0, 0.25]).unwrap();
        let known = InCells::new(&steps, [cell(1.0, 3.0, 3.0), cell(2.0, 0.25, 0.25)]).unwrap();
        let estimate = JitteredRatioInCells::new(0.5).unwrap().estimate(&known, &mut Scripted::new([]));
        assert_eq!(estimate, (-3.25_f64).exp());
    }
}
