//! Estimators behind a pointer.
//!
//! There are two dozen estimators beyond the source papers and nine types of fields, watched, counted or neither: instantiated for each
//! other they would be most of the program. Here each is compiled once, for a field behind a pointer: a look-up is then an indirect call,
//! which `cargo bench --bench lookups` measures.

use fairflight_media::{
    BoundCell, Bounded, BoundedInCells, Breakpoints, Extinction, InCells, RayQuadrature, Tolerance, Vacuum,
};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};

/// A field of any type: looked up through a pointer.
pub(super) type AnyField<'a> = &'a dyn Extinction;
/// The same where it also says where it is not smooth.
pub(super) type AnyPieces<'a> = &'a dyn Breakpoints;

/// An estimator of any type.
pub(super) trait Erased: std::fmt::Debug + Send + Sync {
    /// See [`TransmittanceEstimator::estimate`].
    fn estimate(&self, field: AnyField<'_>, source: &mut dyn UniformSource) -> f64;
    /// See [`TransmittanceEstimator::admits`].
    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool;
    /// See [`ClosedForm::theory`].
    fn theory(&self, quadrature: &RayQuadrature<AnyPieces<'_>>, tau: f64, tolerance: Tolerance) -> Theory;
}

/// An estimator that needs look-ups only.
#[derive(Debug)]
pub(super) struct ByLookups<E>(pub(super) E);

impl<E> Erased for ByLookups<E>
where
    E: std::fmt::Debug + Send + Sync,
    E: for<'a> TransmittanceEstimator<AnyField<'a>> + for<'a> ClosedForm<AnyPieces<'a>>,
{
    fn estimate(&self, field: AnyField<'_>, mut source: &mut dyn UniformSource) -> f64 {
        self.0.estimate(&field, &mut source)
    }

    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool {
        self.0.admits(&field, s, sigma_t)
    }

    fn theory(&self, quadrature: &RayQuadrature<AnyPieces<'_>>, tau: f64, tolerance: Tolerance) -> Theory {
        self.0.theory(&mut quadrature.with_field(*quadrature.field()), tau, tolerance)
    }
}

/// An estimator with the majorant that is claimed for it.
#[derive(Debug)]
pub(super) struct ByMajorant<E> {
    pub(super) estimator: E,
    pub(super) majorant: f64,
}

impl<E> ByMajorant<E> {
    fn bounded<F: Extinction>(&self, field: F) -> Bounded<F> {
        Bounded::new(field, self.majorant).expect("the plan has checked the majorant")
    }
}

impl<E> Erased for ByMajorant<E>
where
    E: std::fmt::Debug + Send + Sync,
    E: for<'a> TransmittanceEstimator<Bounded<AnyField<'a>>> + for<'a> ClosedForm<Bounded<AnyPieces<'a>>>,
{
    fn estimate(&self, field: AnyField<'_>, mut source: &mut dyn UniformSource) -> f64 {
        self.estimator.estimate(&self.bounded(field), &mut source)
    }

    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.bounded(field), s, sigma_t)
    }

    fn theory(&self, quadrature: &RayQuadrature<AnyPieces<'_>>, tau: f64, tolerance: Tolerance) -> Theory {
        let bounded = self.bounded(*quadrature.field());
        self.estimator.theory(&mut quadrature.with_field(bounded), tau, tolerance)
    }
}

/// An estimator with the cells that are claimed for it.
#[derive(Debug)]
pub(super) struct ByCells<E> {
    pub(super) estimator: E,
    /// Over nothing: the field comes with each estimate.
    pub(super) cells: InCells<Vacuum, Vec<BoundCell>>,
}

impl<E> Erased for ByCells<E>
where
    E: std::fmt::Debug + Send + Sync,
    E: for<'a> TransmittanceEstimator<InCells<AnyField<'a>, &'a [BoundCell]>>
        + for<'a> ClosedForm<InCells<AnyPieces<'a>, &'a [BoundCell]>>,
{
    fn estimate(&self, field: AnyField<'_>, mut source: &mut dyn UniformSource) -> f64 {
        self.estimator.estimate(&self.cells.with_field(field), &mut source)
    }

    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.cells.with_field(field), s, sigma_t)
    }

    fn theory(&self, quadrature: &RayQuadrature<AnyPieces<'_>>, tau: f64, tolerance: Tolerance) -> Theory {
        let mut quadrature = quadrature.with_field(self.cells.with_field(*quadrature.field()));
        let ends: Vec<f64> = self.cells.bound_cells().iter().map(|cell| cell.to).collect();
        quadrature.split_at(&ends);
        self.estimator.theory(&mut quadrature, tau, tolerance)
    }
}
