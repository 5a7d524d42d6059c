//! An estimator of any kind, instantiated over the field that it meets.

use super::{AnyControl, AnyProfile, AnySampling, Beyond, Field, Knowledge};
use crate::Failure;
use crate::spec::EstimatorSpec;
use fairflight_collision::{CollisionModel, DoubleParticle, SingleParticle};
use fairflight_laws::Unit;
use fairflight_laws::scores::{self, Interval, Ranged};
use fairflight_media::{Bounded, Breakpoints, Counted, Domain, OpticalThickness, Watched};
use fairflight_stats::Scores;
use fairflight_transmittance::{
    ClosedForm, LineIntegral, RayMarching, Tracking, TransmittanceEstimator, Woodcock,
};

/// An estimator prepared for one profile.
#[derive(Clone, Debug)]
pub enum AnyEstimator {
    /// 1 if a flight escapes, else 0.
    Woodcock {
        /// The claimed majorant.
        majorant: f64,
    },
    /// Both particles leave a collision.
    DoubleParticle(Tracking<DoubleParticle, AnyControl, AnySampling>),
    /// At most one does.
    SingleParticle(Tracking<SingleParticle, AnyControl, AnySampling>),
    /// raab-2008 algorithm 2.
    LineIntegral {
        /// The claimed majorant.
        majorant: f64,
        /// The estimator.
        estimator: LineIntegral,
    },
    /// The biased baseline.
    RayMarching(RayMarching),
    /// One of those beyond the source papers.
    Beyond(Beyond),
}

/// What the harness asks of an estimator on a field: an estimate, its theory, and both watched and counted look-ups.
pub trait Estimator<G: Field>:
    Copy
    + Sync
    + TransmittanceEstimator<G>
    + ClosedForm<G>
    + TransmittanceEstimator<Watched<G, Lawful<G, Self>>>
    + TransmittanceEstimator<Counted<Watched<G, Lawful<G, Self>>>>
{
}

impl<G: Field, E> Estimator<G> for E where
    E: Copy
        + Sync
        + TransmittanceEstimator<G>
        + ClosedForm<G>
        + TransmittanceEstimator<Watched<G, Lawful<G, E>>>
        + TransmittanceEstimator<Counted<Watched<G, Lawful<G, E>>>>
{
}

/// The values of σ_t that are lawful for an estimator on a field about which a majorant is declared.
#[derive(Clone, Copy, Debug)]
pub struct Lawful<G, E> {
    /// The field.
    pub field: G,
    /// The estimator.
    pub estimator: E,
    /// The declared majorant, infinite without one.
    pub upper_bound: f64,
}

impl<G: Field, E: TransmittanceEstimator<G>> Domain for Lawful<G, E> {
    #[inline]
    fn admits(&self, s: f64, sigma_t: f64) -> bool {
        sigma_t <= self.upper_bound && self.estimator.admits(&self.field, s, sigma_t)
    }
}

/// Something to be done with an estimator on a field.
pub trait EstimatorJob {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run<G: Field, E: Estimator<G>>(self, field: G, estimator: E) -> Self::Output;
}

impl AnyEstimator {
    /// Prepares an estimator for a profile.
    ///
    /// # Errors
    /// If a parameter is not lawful there.
    pub fn build(spec: &EstimatorSpec, profile: &AnyProfile) -> Result<Self, Failure> {
        Ok(match spec {
            EstimatorSpec::Woodcock { majorant } => Self::Woodcock { majorant: *majorant },
            EstimatorSpec::DoubleParticle { sampling, control } => {
                let control = AnyControl::build(control, profile)?;
                let sampling = AnySampling::build(sampling, profile)?;
                // The albedo does not enter: only the transmitted particle is followed.
                let model = DoubleParticle { albedo: fairflight_collision::Albedo::default() };
                Self::DoubleParticle(Tracking::new(model, control, sampling))
            }
            EstimatorSpec::SingleParticle { version, albedo, sampling, control } => {
                let control = AnyControl::build(control, profile)?;
                let sampling = AnySampling::build(sampling, profile)?;
                let model = SingleParticle { version: *version, albedo: *albedo };
                Self::SingleParticle(Tracking::new(model, control, sampling))
            }
            EstimatorSpec::LineIntegral { majorant, splits } => Self::LineIntegral {
                majorant: *majorant,
                estimator: LineIntegral::new(*splits)
                    .map_err(|error| Failure::refused(format!("estimator.splits: {error}")))?,
            },
            EstimatorSpec::Beyond(spec) => Self::Beyond(Beyond::build(spec, profile)?),
            EstimatorSpec::RayMarching { steps, offset } => Self::RayMarching(
                RayMarching::new(*steps, *offset)
                    .map_err(|error| Failure::refused(format!("estimator.steps: {error}")))?,
            ),
        })
    }

    /// Does a job with the estimator inside, on `field`.
    ///
    /// # Errors
    /// If the claimed majorant is not lawful.
    pub fn with<F, J: EstimatorJob>(&self, field: &F, job: J) -> Result<J::Output, Failure>
    where
        for<'a> &'a F: Field,
    {
        let bounded = |majorant: f64| {
            Bounded::new(field, majorant)
                .map_err(|error| Failure::refused(format!("estimator.majorant: {error}")))
        };
        Ok(match self {
            Self::Woodcock { majorant } => job.run(bounded(*majorant)?, Woodcock),
            Self::DoubleParticle(estimator) => job.run(field, estimator),
            Self::SingleParticle(estimator) => job.run(field, estimator),
            Self::LineIntegral { majorant, estimator } => job.run(bounded(*majorant)?, *estimator),
            Self::RayMarching(estimator) => job.run(field, *estimator),
            Self::Beyond(estimator) => job.run(field, estimator),
        })
    }

    /// Which values an estimate can take, by what is known of the profile.
    #[must_use]
    pub fn scores(&self, profile: &AnyProfile, knowledge: &Knowledge, unit: Unit) -> Scores {
        let sigma_t = Interval {
            minimum: knowledge.lower_bound.unwrap_or(f64::NEG_INFINITY),
            maximum: knowledge.upper_bound.unwrap_or(f64::INFINITY),
        };
        let length = profile.length();
        match self {
            Self::Woodcock { .. } => scores::woodcock(unit),
            Self::DoubleParticle(tracking) => scores_of(tracking, sigma_t, length, unit),
            Self::SingleParticle(tracking) => scores_of(tracking, sigma_t, length, unit),
            Self::LineIntegral { majorant, .. } => scores::line_integral(majorant * length, unit),
            Self::RayMarching(_) => scores::ray_marching(sigma_t, length, unit),
            Self::Beyond(beyond) => beyond.scores(unit),
        }
    }

    /// Look-ups of the profile that preparing it cost.
    #[must_use]
    pub fn preparation_lookups(&self) -> u64 {
        match self {
            Self::DoubleParticle(tracking) => tracking.control().lookups(),
            Self::SingleParticle(tracking) => tracking.control().lookups(),
            Self::Woodcock { .. } | Self::LineIntegral { .. } | Self::RayMarching(_) | Self::Beyond(_) => 0,
        }
    }

    /// Where the control or the sampling extinction is not smooth.
    #[must_use]
    pub fn breakpoints(&self) -> Vec<f64> {
        let both = |control: &AnyControl, sampling: &AnySampling| {
            let mut breakpoints = control.breakpoints();
            breakpoints.extend(sampling.breakpoints());
            breakpoints
        };
        match self {
            Self::DoubleParticle(tracking) => both(tracking.control(), tracking.sampling()),
            Self::SingleParticle(tracking) => both(tracking.control(), tracking.sampling()),
            Self::Woodcock { .. } | Self::LineIntegral { .. } | Self::RayMarching(_) | Self::Beyond(_) => {
                Vec::new()
            }
        }
    }

    /// The majorant that the estimator claims, if it needs one.
    #[must_use]
    pub fn claimed_majorant(&self) -> Option<f64> {
        match self {
            Self::Woodcock { majorant } | Self::LineIntegral { majorant, .. } => Some(*majorant),
            Self::Beyond(beyond) => beyond.claimed_majorant(),
            Self::DoubleParticle(_) | Self::SingleParticle(_) | Self::RayMarching(_) => None,
        }
    }
}

fn scores_of<M: CollisionModel>(
    tracking: &Tracking<M, AnyControl, AnySampling>,
    sigma_t: Interval,
    length: f64,
    unit: Unit,
) -> Scores {
    let ratios = scores::ratio_range(sigma_t, tracking.control().range(), tracking.sampling().range());
    let main_thickness = tracking.control().optical_thickness(0.0, length);
    scores::tracking(tracking.model(), ratios, main_thickness, unit)
}
