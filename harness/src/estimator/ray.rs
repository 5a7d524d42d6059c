//! An estimator of transmittance of any kind, prepared anew for each ray of a scene.

use super::control::{ConstantControlSpec, ControlSpec, ExplorersSpec};
use super::erased::{AnyField, ByMajorant, Erased};
use super::in_grid::InGrid;
use super::{AnyControl, Preparation};
use fairflight_collision::{CollisionModel, DoubleParticle, SingleParticle};
use fairflight_media::{BoundCell, Constant, Domain, Extinction, Medium, Ray, Vacuum, Violation, Watched};
use fairflight_paths::RayTransmittance;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{
    Explorers, LineIntegral, RayMarching, Tracking, TransmittanceEstimator, Woodcock,
};
use glam::DVec3;
use std::cell::Cell;

/// A look-up that an estimator is not defined for, and where it was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unlawful {
    /// The point in space.
    pub point: DVec3,
    /// σ_t there \[1/length\].
    pub sigma_t: f64,
}

/// The part of an estimator that is the same for all rays, and what it cost to make it.
#[derive(Debug)]
pub struct RayEstimator {
    kind: RayKind,
    preparation: Option<Preparation>,
}

/// An estimator of any ray.
#[derive(Debug)]
pub(super) enum RayKind {
    /// Track length.
    Woodcock(ByMajorant<Woodcock>),
    /// Both particles leave a collision.
    DoubleParticle(RayTracking<DoubleParticle>),
    /// At most one does.
    SingleParticle(RayTracking<SingleParticle>),
    /// Flights that share one depth.
    LineIntegral(ByMajorant<LineIntegral>),
    /// The biased baseline.
    RayMarching(RayMarching),
    /// Bounds in cells, from a grid.
    InGrid(InGrid),
    /// Any other, compiled once.
    Erased(Box<dyn Erased>),
}

/// Tracking without its profile.
#[derive(Clone, Debug)]
pub(super) struct RayTracking<M> {
    model: M,
    control: RayControl,
    sigma_samp: f64,
}

/// A control without its profile.
#[derive(Clone, Copy, Debug)]
pub(super) enum RayControl {
    None,
    Constant(f64),
    Explorers(usize),
}

impl RayControl {
    /// The control of a spec; `None` for one that is given along one ray.
    pub(super) fn of(spec: &ControlSpec) -> Option<Self> {
        match spec {
            ControlSpec::None(_) => Some(Self::None),
            ControlSpec::Constant(ConstantControlSpec { sigma_main }) => Some(Self::Constant(*sigma_main)),
            ControlSpec::Explorers(ExplorersSpec { count }) => Some(Self::Explorers(*count as usize)),
            ControlSpec::PiecewiseLinear(_) => None,
        }
    }
}

impl<M> RayTracking<M> {
    pub(super) fn new(model: M, control: RayControl, sigma_samp: f64) -> Self {
        Self { model, control, sigma_samp }
    }
}

impl RayEstimator {
    pub(super) fn new(kind: RayKind) -> Self {
        Self { kind, preparation: None }
    }

    pub(super) fn after(self, preparation: Preparation) -> Self {
        Self { preparation: Some(preparation), ..self }
    }

    /// The look-ups that were made to prepare it for the scene.
    #[must_use]
    pub fn preparation(&self) -> Option<&Preparation> {
        self.preparation.as_ref()
    }

    /// The majorant below which it draws collisions by their probability.
    #[must_use]
    pub fn collision_majorant(&self) -> Option<f64> {
        match &self.kind {
            RayKind::Woodcock(estimator) => Some(estimator.majorant()),
            RayKind::LineIntegral(estimator) => Some(estimator.majorant()),
            _ => None,
        }
    }

    /// One worker's estimator; the first look-up that it is not defined for is left in `unlawful`.
    #[must_use]
    pub fn worker<'a>(&'a self, unlawful: &'a Cell<Option<Unlawful>>) -> RayWorker<'a> {
        let control = match &self.kind {
            RayKind::DoubleParticle(tracking) => Some(tracking.control),
            RayKind::SingleParticle(tracking) => Some(tracking.control),
            _ => None,
        };
        let control = match control {
            Some(RayControl::Explorers(count)) => AnyControl::Explorers(
                Explorers::through(&Vacuum::new(0.0), count).expect("the spec has at least 2 explorers"),
            ),
            _ => AnyControl::None(Vacuum::new(0.0)),
        };
        RayWorker { estimator: &self.kind, control, cells: Vec::new(), unlawful }
    }
}

/// An estimator with the control and the cells of the ray at hand.
#[derive(Debug)]
pub struct RayWorker<'a> {
    estimator: &'a RayKind,
    control: AnyControl,
    cells: Vec<BoundCell>,
    unlawful: &'a Cell<Option<Unlawful>>,
}

impl<M: Medium> RayTransmittance<M> for RayWorker<'_> {
    // One copy per medium, and not one in each integrator: a call per ray costs nothing, five estimators in each of dozens of
    // integrators cost minutes of compilation.
    #[inline(never)]
    fn estimate(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) -> f64 {
        let Self { estimator, control, cells, unlawful } = self;
        match estimator {
            RayKind::Woodcock(estimator) => watched(ray, estimator, unlawful, source),
            RayKind::DoubleParticle(tracking) => tracking.estimate(ray, control, unlawful, source),
            RayKind::SingleParticle(tracking) => tracking.estimate(ray, control, unlawful, source),
            RayKind::LineIntegral(estimator) => watched(ray, estimator, unlawful, source),
            RayKind::RayMarching(estimator) => watched(ray, estimator, unlawful, source),
            RayKind::InGrid(estimator) => estimator.estimate(ray, cells, unlawful, source),
            RayKind::Erased(estimator) => watched(ray, &Behind(&**estimator), unlawful, source),
        }
    }
}

/// An estimator behind a pointer.
#[derive(Clone, Copy)]
struct Behind<'a>(&'a dyn Erased);

impl<F: Extinction> TransmittanceEstimator<F> for Behind<'_> {
    #[inline]
    fn estimate(&self, field: &F, mut source: &mut impl UniformSource) -> f64 {
        self.0.estimate(field as AnyField<'_>, &mut source)
    }
    fn admits(&self, field: &F, s: f64, sigma_t: f64) -> bool {
        self.0.admits(field as AnyField<'_>, s, sigma_t)
    }
}

impl<K: CollisionModel + Copy> RayTracking<K> {
    #[inline]
    fn estimate<M: Medium>(
        &self,
        ray: &Ray<&M>,
        control: &mut AnyControl,
        unlawful: &Cell<Option<Unlawful>>,
        source: &mut impl UniformSource,
    ) -> f64 {
        let length = ray.length();
        let constant =
            |value| Constant::new(value, length).expect("the spec has finite numbers, and a ray a length");
        match (self.control, &mut *control) {
            (RayControl::Explorers(_), AnyControl::Explorers(explorers)) => explorers.refit(ray),
            (RayControl::Constant(value), control) => *control = AnyControl::Constant(constant(value)),
            (_, control) => *control = AnyControl::None(Vacuum::new(length)),
        }
        let tracking = Tracking::new(self.model, &*control, constant(self.sigma_samp));
        watched(ray, &tracking, unlawful, source)
    }
}

/// One estimate on a ray.
#[inline]
pub(super) fn watched<M: Medium, E>(
    ray: &Ray<&M>,
    estimator: &E,
    unlawful: &Cell<Option<Unlawful>>,
    source: &mut impl UniformSource,
) -> f64
where
    for<'r> E: TransmittanceEstimator<&'r Ray<&'r M>>,
    for<'r, 'w> E: TransmittanceEstimator<Watched<&'r Ray<&'r M>, Admitted<'w, &'r Ray<&'r M>, E>>>,
{
    let watched = Watched::new(ray, Admitted { field: ray, estimator });
    let estimate = estimator.estimate(&watched, source);
    if let Some(Violation { s, sigma_t }) = watched.violation()
        && unlawful.get().is_none()
    {
        unlawful.set(Some(Unlawful { point: ray.world_point(s), sigma_t }));
    }
    estimate
}

pub(super) struct Admitted<'a, F, E> {
    field: F,
    estimator: &'a E,
}

impl<F: Extinction, E: TransmittanceEstimator<F>> Domain for Admitted<'_, F, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.field, s, sigma_t)
    }
}
