//! Estimators with what is claimed for them, and estimators behind a pointer.
//!
//! A claim (a majorant, bounds in cells) is a parameter of the estimator, not knowledge of the field: with it an estimator takes any field.

use fairflight_elementary::lanes::Lanes;
use fairflight_media::{
    BoundCell, Bounded, BoundedInCells, Extinction, FieldError, InCells, Majorant, RayQuadrature, Tolerance,
    Vacuum,
};
use fairflight_sources::{SeededLanes, UniformSource};
use fairflight_transmittance::lockstep::{Batches, Lockstep};
use fairflight_transmittance::{ClosedForm, Theory, TransmittanceEstimator};
use std::fmt::Debug;

/// An estimator with the majorant that is claimed for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ByMajorant<E> {
    estimator: E,
    /// Over nothing: the field comes with each estimate.
    claim: Bounded<Vacuum>,
}

impl<E> ByMajorant<E> {
    /// # Errors
    /// If no field can have that majorant.
    pub(super) fn new(estimator: E, majorant: f64) -> Result<Self, FieldError> {
        Bounded::new(Vacuum::new(0.0), majorant).map(|claim| Self { estimator, claim })
    }

    /// Another estimator with the same claim.
    pub(super) fn with<O>(self, estimator: O) -> ByMajorant<O> {
        ByMajorant { estimator, claim: self.claim }
    }

    pub(super) fn majorant(&self) -> f64 {
        self.claim.majorant()
    }
}

impl<F: Extinction, E: for<'a> TransmittanceEstimator<Bounded<&'a F>>> TransmittanceEstimator<F>
    for ByMajorant<E>
{
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.estimator.estimate(&self.claim.with_field(field), source)
    }
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.claim.with_field(field), s, sigma_t)
    }
}

impl<F: Extinction, E: for<'a> Lockstep<Bounded<&'a F>>> Lockstep<F> for ByMajorant<E> {
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        self.estimator.fill(&self.claim.with_field(field), source, batches);
    }
    #[inline(always)]
    fn admits_lanes(&self, field: &F, s: &Lanes, sigma_t: &Lanes) -> bool {
        self.estimator.admits_lanes(&self.claim.with_field(field), s, sigma_t)
    }
}

impl<F: Extinction + Copy, E: ClosedForm<Bounded<F>>> ClosedForm<F> for ByMajorant<E> {
    fn theory(&self, nodes: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let field = *nodes.field();
        let mut bounded = nodes.with_field(self.claim.with_field(field));
        let theory = self.estimator.theory(&mut bounded, tau, tolerance);
        *nodes = bounded.with_field(field);
        theory
    }
}

/// An estimator with the cells that are claimed for it, of its own or borrowed.
#[derive(Clone, Debug)]
pub(super) struct ByCells<E, C = Vec<BoundCell>> {
    pub(super) estimator: E,
    /// Over nothing: the field comes with each estimate.
    pub(super) cells: InCells<Vacuum, C>,
}

impl<
    F: Extinction,
    E: for<'a, 'b> TransmittanceEstimator<InCells<&'a F, &'b [BoundCell]>>,
    C: AsRef<[BoundCell]>,
> TransmittanceEstimator<F> for ByCells<E, C>
{
    #[inline]
    fn estimate(&self, field: &F, source: &mut impl UniformSource) -> f64 {
        self.estimator.estimate(&self.cells.with_field(field), source)
    }
    #[inline]
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.cells.with_field(field), s, sigma_t)
    }
}

impl<F: Extinction, E: for<'a, 'b> Lockstep<InCells<&'a F, &'b [BoundCell]>>, C: AsRef<[BoundCell]>>
    Lockstep<F> for ByCells<E, C>
{
    #[inline(always)]
    fn fill(&self, field: &F, source: &mut SeededLanes, batches: &mut Batches<'_, '_>) {
        self.estimator.fill(&self.cells.with_field(field), source, batches);
    }
}

impl<F: Extinction + Copy, E: for<'b> ClosedForm<InCells<F, &'b [BoundCell]>>> ClosedForm<F> for ByCells<E> {
    fn theory(&self, nodes: &mut RayQuadrature<F>, tau: f64, tolerance: Tolerance) -> Theory {
        let field = *nodes.field();
        let mut in_cells = nodes.with_field(self.cells.with_field(field));
        let ends: Vec<f64> = self.cells.bound_cells().iter().map(|cell| cell.to).collect();
        in_cells.split_at(&ends);
        let theory = self.estimator.theory(&mut in_cells, tau, tolerance);
        *nodes = in_cells.with_field(field);
        theory
    }
}

/// A field of any type: looked up through a pointer.
pub(super) type AnyField<'a> = &'a dyn Extinction;

/// An estimator of any type, compiled once: there are more estimators than a scene's shadow rays should be compiled for.
pub(super) trait Erased: Debug + Send + Sync {
    /// See [`TransmittanceEstimator::estimate`].
    fn estimate(&self, field: AnyField<'_>, source: &mut dyn UniformSource) -> f64;
    /// See [`TransmittanceEstimator::admits`].
    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool;
}

impl<E: Debug + Send + Sync + for<'a> TransmittanceEstimator<AnyField<'a>>> Erased for E {
    fn estimate(&self, field: AnyField<'_>, mut source: &mut dyn UniformSource) -> f64 {
        TransmittanceEstimator::estimate(self, &field, &mut source)
    }
    fn admits(&self, field: AnyField<'_>, s: f64, sigma_t: f64) -> bool {
        TransmittanceEstimator::admits(self, &field, s, sigma_t)
    }
}
