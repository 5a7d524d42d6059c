//! An estimator of transmittance of any kind, prepared anew for each ray of a scene.

use super::{AnyControl, Beyond};
use crate::Failure;
use crate::spec::{ControlSpec, EstimatorSpec, SamplingSpec};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle};
use fairflight_media::{Bounded, Constant, Domain, Extinction, Medium, Ray, Vacuum, Violation, Watched};
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

/// What is the same for all rays.
#[derive(Clone, Debug)]
pub enum RayEstimator {
    /// 1 if the flight escapes, else 0.
    Woodcock {
        /// The claimed majorant.
        majorant: f64,
    },
    /// Both particles leave a collision.
    DoubleParticle(RayTracking<DoubleParticle>),
    /// At most one does.
    SingleParticle(RayTracking<SingleParticle>),
    /// raab-2008 algorithm 2.
    LineIntegral {
        /// The claimed majorant.
        majorant: f64,
        /// The estimator.
        estimator: LineIntegral,
    },
    /// The biased baseline.
    RayMarching(RayMarching),
    /// One of those beyond the source papers that do not depend on the ray.
    Beyond(Beyond),
}

/// Tracking without its profile.
#[derive(Clone, Debug)]
pub struct RayTracking<M> {
    model: M,
    control: RayControl,
    sigma_samp: f64,
}

/// A control without its profile.
#[derive(Clone, Copy, Debug)]
enum RayControl {
    None,
    Constant(f64),
    Explorers(usize),
}

impl RayEstimator {
    /// The estimator of a spec whose key is `key`.
    ///
    /// # Errors
    /// If a parameter is not lawful, or is given along one ray.
    pub fn build(spec: &EstimatorSpec, key: &str) -> Result<Self, Failure> {
        let refuse =
            |what: &str, error: &dyn std::fmt::Display| Failure::refused(format!("{key}.{what}: {error}"));
        // The reader of a scene has refused these with the same words.
        let one_ray = |what: &str| refuse(what, &"is given along one ray, but a scene has many");
        let sigma_samp = |sampling: &SamplingSpec| match *sampling {
            SamplingSpec::Constant(value) => Ok(value),
            SamplingSpec::PiecewiseConstant { .. } => Err(one_ray("sigma_samp")),
        };
        let control = |control: &ControlSpec| match *control {
            ControlSpec::None => Ok(RayControl::None),
            ControlSpec::Constant(sigma_main) => Ok(RayControl::Constant(sigma_main)),
            ControlSpec::Explorers { count } => Ok(RayControl::Explorers(count)),
            ControlSpec::PiecewiseLinear { .. } => Err(one_ray("control")),
        };
        Ok(match spec {
            EstimatorSpec::Woodcock { majorant } => Self::Woodcock { majorant: *majorant },
            EstimatorSpec::DoubleParticle { sampling, control: main } => Self::DoubleParticle(RayTracking {
                // The albedo does not enter: only the transmitted particle is followed.
                model: DoubleParticle { albedo: Albedo::default() },
                control: control(main)?,
                sigma_samp: sigma_samp(sampling)?,
            }),
            EstimatorSpec::SingleParticle { version, albedo, sampling, control: main } => {
                Self::SingleParticle(RayTracking {
                    model: SingleParticle { version: *version, albedo: *albedo },
                    control: control(main)?,
                    sigma_samp: sigma_samp(sampling)?,
                })
            }
            EstimatorSpec::LineIntegral { majorant, splits } => Self::LineIntegral {
                majorant: *majorant,
                estimator: LineIntegral::new(*splits).map_err(|error| refuse("splits", &error))?,
            },
            EstimatorSpec::Beyond(spec) => Self::Beyond(Beyond::for_all_rays(spec, key)?),
            EstimatorSpec::RayMarching { steps, offset } => {
                Self::RayMarching(RayMarching::new(*steps, *offset).map_err(|error| refuse("steps", &error))?)
            }
        })
    }

    /// One worker's estimator; the first look-up that it is not defined for is left in `unlawful`.
    #[must_use]
    pub fn worker<'a>(&'a self, unlawful: &'a Cell<Option<Unlawful>>) -> RayWorker<'a> {
        let kind = match self {
            Self::DoubleParticle(tracking) => Some(tracking.control),
            Self::SingleParticle(tracking) => Some(tracking.control),
            Self::Woodcock { .. } | Self::LineIntegral { .. } | Self::RayMarching(_) | Self::Beyond(_) => {
                None
            }
        };
        let control = match kind {
            Some(RayControl::Explorers(count)) => AnyControl::Explorers(
                Explorers::through(&Vacuum::new(0.0), count).expect("the spec has at least 2 explorers"),
            ),
            _ => AnyControl::None(Vacuum::new(0.0)),
        };
        RayWorker { estimator: self, control, unlawful }
    }
}

/// An estimator with the control of the ray at hand.
#[derive(Debug)]
pub struct RayWorker<'a> {
    estimator: &'a RayEstimator,
    control: AnyControl,
    unlawful: &'a Cell<Option<Unlawful>>,
}

impl<M: Medium> RayTransmittance<M> for RayWorker<'_> {
    // One copy per medium, and not one in each integrator: a call per ray costs nothing, five estimators in each of dozens of
    // integrators cost minutes of compilation.
    #[inline(never)]
    fn estimate<S: UniformSource + ?Sized>(&mut self, ray: &Ray<&M>, source: &mut S) -> f64 {
        let Self { estimator, control, unlawful } = self;
        let bounded = |majorant| Bounded::new(ray, majorant).expect("the spec has a majorant of at least 0");
        match estimator {
            RayEstimator::Woodcock { majorant } => {
                watched(ray, bounded(*majorant), &Woodcock, unlawful, source)
            }
            RayEstimator::DoubleParticle(tracking) => tracking.estimate(ray, control, unlawful, source),
            RayEstimator::SingleParticle(tracking) => tracking.estimate(ray, control, unlawful, source),
            RayEstimator::LineIntegral { majorant, estimator } => {
                watched(ray, bounded(*majorant), estimator, unlawful, source)
            }
            RayEstimator::RayMarching(estimator) => watched(ray, ray, estimator, unlawful, source),
            RayEstimator::Beyond(estimator) => watched(ray, ray, estimator, unlawful, source),
        }
    }
}

impl<K: fairflight_collision::CollisionModel + Copy> RayTracking<K> {
    #[inline]
    fn estimate<M: Medium, S: UniformSource + ?Sized>(
        &self,
        ray: &Ray<&M>,
        control: &mut AnyControl,
        unlawful: &Cell<Option<Unlawful>>,
        source: &mut S,
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
        watched(ray, ray, &tracking, unlawful, source)
    }
}

/// One estimate on `field`, which is `ray` with what is claimed of it.
#[inline]
fn watched<M, F, E, S>(
    ray: &Ray<&M>,
    field: F,
    estimator: &E,
    unlawful: &Cell<Option<Unlawful>>,
    source: &mut S,
) -> f64
where
    M: Medium,
    F: Extinction + Copy,
    E: TransmittanceEstimator<F>,
    for<'w> E: TransmittanceEstimator<Watched<F, Admitted<'w, F, E>>>,
    S: UniformSource + ?Sized,
{
    let watched = Watched::new(field, Admitted { field, estimator });
    let estimate = estimator.estimate(&watched, source);
    if let Some(Violation { s, sigma_t }) = watched.violation()
        && unlawful.get().is_none()
    {
        unlawful.set(Some(Unlawful { point: ray.world_point(s), sigma_t }));
    }
    estimate
}

struct Admitted<'a, F, E> {
    field: F,
    estimator: &'a E,
}

impl<F: Extinction, E: TransmittanceEstimator<F>> Domain for Admitted<'_, F, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        self.estimator.admits(&self.field, s, sigma_t)
    }
}
