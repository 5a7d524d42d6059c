//! Residual ratio tracking between bounds in cells: what production renderers can always afford.

use crate::{ClosedForm, MOMENTS, ProductLaw, SignedProduct, Theory, TransmittanceEstimator};
use fairflight_elementary::exp_m1;
use fairflight_media::{BoundCell, BoundedInCells, RayQuadrature, Tolerance};
use fairflight_sources::UniformSource;

/// Tracking with the minorant of each cell as control and `rate` times its range, majorant − minorant, as sampling extinction.
///
/// > T̂ = exp(−∫ minorant) · Π_i (1 − (σ_t(x_i) − minorant) / (rate · range))
///
/// over a Poisson process of rate `rate` · range. It is [`crate::Tracking`] with the double particle model of
/// szirmay-kalos-2017 (residual ratio tracking, novak-2014) without any knowledge but the cells: cells whose bounds agree cost
/// nothing, also where they are dense.
///
/// **Law.** Unbiased where the range is positive, whatever the bounds are worth; where majorant = minorant they must hold. With
/// bounds that hold and `rate` ≥ 1 every factor lies in \[0, 1\], and an estimate in \[0, exp(−∫ minorant)\].
///
/// **Variance.** [`ProductLaw`] with J_j = ∫ S (−(σ_t − minorant)/S)^j ds, S = `rate` · range:
/// Var/T² = exp(∫ (σ_t − minorant)²/S) − 1. Tighter bounds lower the cost more than they raise the variance, and the product of
/// both may still grow: bounds in cells are no gain by themselves.
///
/// **Cost.** `rate` Σ_cells range · width look-ups, a Poisson variate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualCells {
    rate: f64,
}

/// Error of [`ResidualCells`] that cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RateError {
    /// No collision would ever happen, or infinitely many.
    #[error("rate must be positive and finite, found {found}")]
    NotPositive {
        /// The value given.
        found: f64,
    },
}

impl Default for ResidualCells {
    /// A rate of 1: the least for which no estimate is negative.
    fn default() -> Self {
        Self { rate: 1.0 }
    }
}

impl ResidualCells {
    /// The estimator that samples with `rate` \[1\] times the range of each cell.
    ///
    /// # Errors
    /// If `rate` is not positive and finite.
    pub fn new(rate: f64) -> Result<Self, RateError> {
        if rate > 0.0 && rate.is_finite() {
            Ok(Self { rate })
        } else {
            Err(RateError::NotPositive { found: rate })
        }
    }

    /// The rate of collisions over the range of a cell \[1\].
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.rate
    }
}

impl<F: BoundedInCells> TransmittanceEstimator<F> for ResidualCells {
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        let mut weight = SignedProduct::ONE;
        let (mut minorant_thickness, mut from) = (0.0, 0.0);
        // One free flight through all cells: what a cell does not use up of its depth is left for the next.
        let mut depth = source.next_exponential();
        for cell in field.bound_cells() {
            minorant_thickness += cell.minorant * (cell.to - from);
            let sampling = self.rate * cell.range();
            if sampling > 0.0 {
                let mut s = from;
                loop {
                    let next = s + depth / sampling;
                    if next >= cell.to {
                        depth = (depth - sampling * (cell.to - s)).max(0.0);
                        break;
                    }
                    s = next;
                    weight.multiply(1.0 - (field.sigma_t(s) - cell.minorant) / sampling);
                    depth = source.next_exponential();
                }
            }
            from = cell.to;
        }
        weight.times_exp(-minorant_thickness)
    }

    /// True between the bounds of the cell. (Beyond them the mean would still be right, the range of the estimates not.)
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        field.cells_admit(s, sigma_t)
    }
}

impl<F: BoundedInCells> ClosedForm<F> for ResidualCells {
    fn theory(&self, quadrature: &mut RayQuadrature<F>, _tau: f64, tolerance: Tolerance) -> Theory {
        let cells: Vec<BoundCell> = quadrature.field().bound_cells().to_vec();
        let ends: Vec<f64> = cells.iter().map(|cell| cell.to).collect();
        let (_, collisions) = quadrature.integrate_parts(tolerance, &ends, |i, _, sigma_t| {
            let sampling = self.rate * cells[i].range();
            if sampling == 0.0 {
                return [0.0; MOMENTS];
            }
            let ratio = (sigma_t - cells[i].minorant) / sampling;
            std::array::from_fn(|j| sampling * (-ratio).powi(j as i32 + 2))
        });
        let mut from = 0.0;
        let width = |cell: &BoundCell| cell.to - std::mem::replace(&mut from, cell.to);
        let widths: Vec<f64> = cells.iter().map(width).collect();
        let law = ProductLaw::new(collisions.value);
        Theory {
            relative_central: law.relative_central(),
            log_relative_variance: law.log_relative_variance(),
            // d Var / Var = dJ_2 exp(J_2) / (exp(J_2) − 1)
            relative_variance_error: collisions.error[0] / -exp_m1(-collisions.value[0]),
            ..Theory::mean_only(
                cells.iter().zip(widths).map(|(cell, width)| self.rate * cell.range() * width).sum(),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Tracking;
    use crate::test_support::seed_ray;
    use approx::assert_relative_eq;
    use fairflight_collision::{Albedo, DoubleParticle};
    use fairflight_media::{Counted, InCells, PiecewiseConstant, PiecewiseLinear};
    use fairflight_sources::{Scripted, Seeded};

    fn cell(to: f64, minorant: f64, majorant: f64) -> BoundCell {
        BoundCell { to, minorant, majorant }
    }

    #[test]
    fn it_is_residual_tracking_with_the_same_variates() {
        let tent = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0]).unwrap();
        let field =
            InCells::new(&tent, [cell(0.5, 0.0, 1.0), cell(2.0, 0.5, 2.0), cell(3.0, 0.0, 1.0)]).unwrap();
        let edges = || vec![0.0, 0.5, 2.0, 3.0];
        for rate in [0.7, 1.0, 2.0] {
            let control = PiecewiseConstant::new(edges(), vec![0.0, 0.5, 0.0]).unwrap();
            let sampling =
                PiecewiseConstant::new(edges(), [1.0, 1.5, 1.0].map(|r| rate * r).to_vec()).unwrap();
            let tracking = Tracking::new(
                DoubleParticle { albedo: Albedo::default() },
                control.clone(),
                sampling.clone(),
            );
            let ours = ResidualCells::new(rate).unwrap();
            for seed in 0..200 {
                let expected = tracking.estimate(&tent, &mut Seeded::new(seed));
                assert_relative_eq!(
                    ours.estimate(&field, &mut Seeded::new(seed)),
                    expected,
                    max_relative = 1e-12
                );
            }
            let mut quadrature = RayQuadrature::new(&field, &edges());
            let theory = ours.theory(&mut quadrature, 3.0, Tolerance::TIGHT);
            let expected = tracking.theory(&mut RayQuadrature::new(&tent, &edges()), 3.0, Tolerance::TIGHT);
            for (found, expected) in theory.relative_central.into_iter().zip(expected.relative_central) {
                assert_relative_eq!(found, expected, max_relative = 1e-10);
            }
            assert_relative_eq!(theory.lookups, expected.lookups, max_relative = 1e-10);
            // On few panels the variance is off, by no more than is stated.
            let coarse = Tolerance { most_panels: 1, ..Tolerance::TIGHT };
            let ray = InCells::new(seed_ray(), [cell(20.0, 0.0, 1.0)]).unwrap();
            let [found, exact] =
                [coarse, Tolerance::TIGHT].map(|t| ours.theory(&mut RayQuadrature::new(&ray, &[]), 10.0, t));
            let off = (found.relative_central[0] / exact.relative_central[0] - 1.0).abs();
            assert!(off <= found.relative_variance_error, "{off} {}", found.relative_variance_error);
        }
    }

    #[test]
    fn cells_whose_bounds_agree_cost_nothing() {
        let steps = PiecewiseConstant::new(vec![0.0, 1.0, 2.0], vec![800.0, 0.25]).unwrap();
        let field =
            Counted::new(InCells::new(&steps, [cell(1.0, 800.0, 800.0), cell(2.0, 0.25, 0.25)]).unwrap());
        let estimate = ResidualCells::default().estimate(&field, &mut Scripted::new([0.5]));
        assert_eq!((estimate, field.lookups()), ((-800.25_f64).exp(), 0));
        let theory = ResidualCells::default().theory(
            &mut RayQuadrature::new(field.field(), &[]),
            800.25,
            Tolerance::TIGHT,
        );
        assert_eq!((theory.lookups, theory.relative_central[0]), (0.0, 0.0));
    }

    #[test]
    fn a_rate_that_is_none_is_refused() {
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(ResidualCells::new(rate), Err(RateError::NotPositive { .. })));
        }
    }
}
