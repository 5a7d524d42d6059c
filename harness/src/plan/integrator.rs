//! An integrator of any kind, instantiated over the medium that it meets.

use super::single_scattering::SingleScatteringPlan;
use super::{RayEstimator, Unlawful};
use crate::Failure;
use crate::spec::{
    Collisions, EstimatorSpec, IntegratorSpec, Particles, RayEstimatorSpec, SamplingFieldSpec,
    SingleScatteringSpec, TracerSpec,
};
use fairflight_collision::{Albedo, CollisionModel, SingleParticle};
use fairflight_media::{LineThickness, Medium, PhaseFunction};
use fairflight_paths::{Attenuation, ExpectedValue, Integrator, ParticleTracer, Uniform, Walk};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_transmittance::Regular;
use std::cell::Cell;

/// An integrator whose parameters are checked.
#[derive(Debug)]
pub enum IntegratorPlan {
    /// The background seen through the medium.
    Transmittance(RayEstimator),
    /// The same in closed form.
    RegularTransmittance,
    /// Importons.
    ParticleTracer {
        /// How they walk.
        walk: Walk<Uniform>,
        /// σ_samp.
        sigma_samp: f64,
        /// More are cut.
        max_collisions: u64,
    },
    /// Expectations in place of decisions.
    ExpectedValue,
    /// One scattering event per light.
    SingleScattering(SingleScatteringPlan),
}

/// An integrator, and what it has to say at the end of a tile.
pub trait TileIntegrator<C>: Integrator<C> {
    /// The number of walks that were cut: each is a bias.
    fn truncated(&self) -> u64 {
        0
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum> TileIntegrator<C> for ParticleTracer<'_, M, P, C, Uniform> {
    fn truncated(&self) -> u64 {
        Self::truncated(self)
    }
}
impl<M, P, C, T> TileIntegrator<C> for Attenuation<'_, M, P, C, T> where Self: Integrator<C> {}
impl<M, P, C> TileIntegrator<C> for ExpectedValue<'_, M, P, C> where Self: Integrator<C> {}

/// Something to be done with an integrator.
pub trait IntegratorJob<C> {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run<I: TileIntegrator<C>>(self, integrator: I) -> Self::Output;
}

impl IntegratorPlan {
    /// The integrator of a spec.
    ///
    /// # Errors
    /// If a parameter is not lawful.
    pub fn build(spec: &IntegratorSpec) -> Result<Self, Failure> {
        match spec {
            IntegratorSpec::Transmittance { estimator: RayEstimatorSpec::Regular } => {
                Ok(Self::RegularTransmittance)
            }
            IntegratorSpec::Transmittance { estimator: RayEstimatorSpec::Sampled(estimator) } => {
                RayEstimator::build(estimator, "integrator.estimator").map(Self::Transmittance)
            }
            IntegratorSpec::ParticleTracer(tracer) => Self::tracer(tracer),
            IntegratorSpec::ExpectedValue => Ok(Self::ExpectedValue),
            IntegratorSpec::SingleScattering(spec) => {
                SingleScatteringPlan::build(spec).map(Self::SingleScattering)
            }
        }
    }

    fn tracer(spec: &TracerSpec) -> Result<Self, Failure> {
        let TracerSpec { version, sampling, colour, particles, max_collisions, .. } = *spec;
        if particles == Particles::Photons {
            return Err(not_yet("particles", "photons"));
        }
        if colour == Collisions::Separate {
            return Err(not_yet("colour", "separate"));
        }
        let SamplingFieldSpec::Uniform(sigma_samp) = sampling else {
            return Err(not_yet("sigma_samp", "a grid"));
        };
        let refuse = |error| Failure::refused(format!("integrator.sigma_samp: {error}"));
        let uniform = Uniform::new(sigma_samp).map_err(refuse)?;
        let walk = Walk::new(version, uniform).with_max_collisions(max_collisions);
        Ok(Self::ParticleTracer { walk, sigma_samp, max_collisions })
    }

    /// Does a job with the integrator inside, on a medium of which only look-ups are to be had. The first look-up that an
    /// estimator is not defined for is left in `unlawful`.
    ///
    /// # Errors
    /// If the integrator needs a closed form, or does not fit the lights.
    pub fn by_look_ups<'s, M, P, C, J>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure>
    where
        M: Medium,
        P: PhaseFunction,
        C: Spectrum,
        J: IntegratorJob<C>,
    {
        match self {
            Self::Transmittance(estimator) => {
                Ok(job.run(Attenuation::new(volume, lights, estimator.worker(unlawful))))
            }
            Self::ParticleTracer { walk, .. } => Ok(job.run(ParticleTracer::new(volume, lights, *walk))),
            Self::SingleScattering(plan) => plan.by_look_ups(volume, lights, unlawful, job),
            Self::RegularTransmittance => Err(needs_closed_form("estimator.kind: regular")),
            Self::ExpectedValue => Err(needs_closed_form("kind: expected_value")),
        }
    }

    /// The same on a medium whose optical thickness has a closed form.
    ///
    /// # Errors
    /// If the integrator does not fit the lights.
    pub fn by_closed_form<'s, M, P, C, J>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure>
    where
        M: LineThickness,
        P: PhaseFunction,
        C: Spectrum,
        J: IntegratorJob<C>,
    {
        match self {
            Self::RegularTransmittance => Ok(job.run(Attenuation::new(volume, lights, Regular))),
            Self::ExpectedValue => Ok(job.run(ExpectedValue::new(volume, lights))),
            Self::SingleScattering(plan) => plan.by_closed_form(volume, lights, unlawful, job),
            Self::Transmittance(_) | Self::ParticleTracer { .. } => {
                self.by_look_ups(volume, lights, unlawful, job)
            }
        }
    }

    /// Whether walks are defined where σ_t has this value; the estimators of transmittance watch their own look-ups.
    ///
    /// # Errors
    /// If they are not.
    pub fn admits(&self, sigma_t: f64, albedo: f64) -> Result<(), Failure> {
        match self {
            Self::ParticleTracer { walk, sigma_samp, .. } => {
                let albedo = Albedo::new(albedo.min(1.0)).map_err(Failure::refused)?;
                let r = sigma_t / sigma_samp;
                if (SingleParticle { version: walk.version(), albedo }).admits(r) {
                    return Ok(());
                }
                Err(Failure::refused(format!(
                    "integrator.version: terminating needs 0 <= r <= 2/(1 + albedo), but r = sigma_t/sigma_samp = {r} \
                     where sigma_t = {sigma_t}"
                )))
            }
            Self::ExpectedValue if sigma_t < 0.0 => Err(Failure::refused(format!(
                "integrator.kind: expected_value needs sigma_t of at least 0, but sigma_t = {sigma_t} was met"
            ))),
            Self::SingleScattering(plan) => plan.admits(sigma_t),
            _ => Ok(()),
        }
    }

    /// Why a look-up was not lawful for an estimator of transmittance.
    #[must_use]
    pub fn explain(&self, Unlawful { point, sigma_t }: Unlawful) -> Failure {
        let at = format!("sigma_t = {sigma_t} at [{}, {}, {}]", point.x, point.y, point.z);
        Failure::refused(match self {
            Self::Transmittance(
                RayEstimator::Woodcock { majorant } | RayEstimator::LineIntegral { majorant, .. },
            ) => format!("integrator.estimator.majorant: {majorant} is none, since {at}"),
            Self::SingleScattering(_) => format!("integrator.shadow (or estimator): not defined for {at}"),
            _ => format!("integrator.estimator: not defined for {at}"),
        })
    }
}

impl IntegratorSpec {
    /// What is biased by design, if anything is.
    #[must_use]
    pub fn biased_baseline(&self) -> Option<&'static str> {
        let is_biased = |estimator: &RayEstimatorSpec| matches!(estimator, RayEstimatorSpec::Sampled(spec) if EstimatorSpec::is_biased_baseline(spec));
        let biased = match self {
            Self::Transmittance { estimator } => is_biased(estimator),
            Self::SingleScattering(SingleScatteringSpec { estimator, shadow, .. }) => {
                is_biased(estimator) || shadow.as_ref().is_some_and(is_biased)
            }
            Self::ParticleTracer(_) | Self::ExpectedValue => false,
        };
        biased.then_some("ray_marching is a biased baseline")
    }
}

pub(super) fn needs_closed_form(what: &str) -> Failure {
    Failure::refused(format!(
        "integrator.{what} needs a medium whose optical thickness has a closed form: homogeneous, analytic_cosine or vdb"
    ))
}

fn not_yet(key: &str, what: &str) -> Failure {
    Failure::refused(format!("integrator.{key}: {what} comes with a later version"))
}
