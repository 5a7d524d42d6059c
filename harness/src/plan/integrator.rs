//! An integrator of any kind, instantiated over the medium that it meets.

use super::single_scattering::SingleScatteringPlan;
use super::transport::{AmongSurfaces, PathTracerPlan, Stage, VplPlan};
use super::{SpaceSampling, WalkPlan};
use crate::Failure;
use crate::estimator::{RayEstimator, Shadow, Unlawful};
use crate::field::AnyMedium;
use crate::spec::{IntegratorSpec, Particles, TransmittanceSpec};
use fairflight_media::{Bounds, LineThickness, Medium, PhaseFunction};
use fairflight_paths::{Attenuation, Integrator, LineSplitting, ParticleTracer, Ratio};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_transmittance::{LineIntegral, Regular, Starts};
use std::cell::Cell;

/// An integrator whose parameters are checked.
#[derive(Debug)]
pub enum IntegratorPlan {
    /// The background seen through the medium.
    Transmittance(RayEstimator),
    /// The same in closed form.
    RegularTransmittance,
    /// Importons.
    ParticleTracer(WalkPlan),
    /// Photons, which are not drawn pixel by pixel; here is the background, attenuated by ratio tracking at the same rate.
    PhotonTracer(WalkPlan),
    /// raab-2008 section 3.1.
    LineSplitting {
        /// How each flight goes on.
        walk: WalkPlan,
        /// The flights.
        line: LineIntegral,
        /// Of their first steps.
        starts: Starts,
        /// The claimed majorant.
        majorant: f64,
    },
    /// One scattering event per light.
    SingleScattering(SingleScatteringPlan),
    /// Paths from the camera, among surfaces.
    PathTracer(PathTracerPlan),
    /// Virtual point lights, among surfaces.
    Vpl(Box<VplPlan>),
}

/// An integrator, and what it has to say at the end of a tile.
pub trait TileIntegrator<C>: Integrator<C> {
    /// The number of walks that were cut: each is a bias.
    fn truncated(&self) -> u64 {
        0
    }

    /// How many compensation vertices were tried, and how many of them counted.
    fn compensation_vertices(&self) -> (u64, u64) {
        (0, 0)
    }
}

impl<M: Medium, P: PhaseFunction, C: Spectrum> TileIntegrator<C>
    for ParticleTracer<'_, M, P, C, SpaceSampling<'_>>
{
    fn truncated(&self) -> u64 {
        Self::truncated(self)
    }
}
impl<M: Medium, P: PhaseFunction, C: Spectrum> TileIntegrator<C>
    for LineSplitting<'_, M, P, C, SpaceSampling<'_>>
{
    fn truncated(&self) -> u64 {
        Self::truncated(self)
    }
}
impl<M, P, C, T> TileIntegrator<C> for Attenuation<'_, M, P, C, T> where Self: Integrator<C> {}

/// Something to be done with an integrator.
pub trait IntegratorJob<C> {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run<I: TileIntegrator<C>>(self, integrator: I) -> Self::Output;
}

impl IntegratorPlan {
    /// The integrator of a spec in a medium.
    ///
    /// # Errors
    /// If a parameter is not lawful.
    pub fn build(spec: &IntegratorSpec, medium: &AnyMedium, bounds: &Bounds) -> Result<Self, Failure> {
        match spec {
            IntegratorSpec::Transmittance(TransmittanceSpec { estimator }) => {
                Ok(match estimator.kind().for_all_rays("integrator.estimator")? {
                    Shadow::Regular => Self::RegularTransmittance,
                    Shadow::Sampled(estimator) => Self::Transmittance(estimator),
                })
            }
            IntegratorSpec::ParticleTracer(tracer) => {
                let walk = WalkPlan::build(&tracer.walk, medium, bounds)?;
                Ok(match tracer.particles {
                    Particles::Importons => Self::ParticleTracer(walk),
                    Particles::Photons => Self::PhotonTracer(walk),
                })
            }
            IntegratorSpec::LineSplitting(spec) => Ok(Self::LineSplitting {
                walk: WalkPlan::build(&spec.walk, medium, bounds)?,
                line: LineIntegral::new(spec.splits)
                    .map_err(|error| Failure::refused(format!("integrator.splits: {error}")))?,
                starts: spec.starts,
                majorant: spec.majorant,
            }),
            IntegratorSpec::SingleScattering(spec) => {
                SingleScatteringPlan::build(spec).map(Self::SingleScattering)
            }
            IntegratorSpec::PathTracer(spec) => {
                PathTracerPlan::build(spec, medium, bounds).map(Self::PathTracer)
            }
            IntegratorSpec::Vpl(spec) => {
                VplPlan::build(spec, medium, bounds).map(|plan| Self::Vpl(Box::new(plan)))
            }
        }
    }

    /// The walks of an integrator that has some.
    #[must_use]
    pub fn walk(&self) -> Option<&WalkPlan> {
        match self {
            Self::ParticleTracer(walk) | Self::PhotonTracer(walk) | Self::LineSplitting { walk, .. } => {
                Some(walk)
            }
            Self::PathTracer(plan) => Some(&plan.transport.walk),
            Self::Vpl(plan) => Some(&plan.transport.walk),
            Self::Transmittance(_) | Self::RegularTransmittance | Self::SingleScattering(_) => None,
        }
    }

    /// Whether the pixels of a pass share a batch that is prepared for it: a pass is then of one sample per pixel.
    #[must_use]
    pub fn draws_in_batches(&self) -> bool {
        match self {
            Self::Transmittance(_)
            | Self::RegularTransmittance
            | Self::ParticleTracer(_)
            | Self::PhotonTracer(_)
            | Self::LineSplitting { .. }
            | Self::SingleScattering(_)
            | Self::PathTracer(_) => false,
            Self::Vpl(_) => true,
        }
    }

    /// Does a job with the integrator inside, on a medium of which only look-ups are to be had. The first look-up that an
    /// estimator is not defined for is left in `unlawful`.
    ///
    /// # Errors
    /// If the integrator needs a closed form, or does not fit the lights.
    pub fn by_look_ups<'s, M: Medium, P: PhaseFunction, C: Spectrum, J: IntegratorJob<C>>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        stage: Stage<'s, C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        match self {
            Self::SingleScattering(plan) => plan.by_look_ups(volume, stage.lights, unlawful, job),
            Self::PathTracer(plan) => plan.by_look_ups(volume, stage, unlawful, job),
            Self::Vpl(plan) => plan.by_look_ups(volume, stage, unlawful, job),
            _ => self.on_any_medium(volume, stage.lights, unlawful, job),
        }
    }

    /// The same on a medium whose optical thickness has a closed form.
    ///
    /// # Errors
    /// If the integrator does not fit the lights.
    pub fn by_closed_form<'s, M: LineThickness, P: PhaseFunction, C: Spectrum, J: IntegratorJob<C>>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        stage: Stage<'s, C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        if M::IS_EMPTY {
            // Only integrators that know surfaces have anything to do: all others see the background.
            return Ok(match self {
                Self::PathTracer(plan) => plan.by_closed_form(volume, stage, unlawful, job),
                Self::Vpl(plan) => plan.by_closed_form(volume, stage, unlawful, job),
                _ => job.run(Attenuation::new(volume, stage.lights, Regular)),
            });
        }
        match self {
            Self::RegularTransmittance => Ok(job.run(Attenuation::new(volume, stage.lights, Regular))),
            Self::SingleScattering(plan) => plan.by_closed_form(volume, stage.lights, unlawful, job),
            Self::PathTracer(plan) => Ok(plan.by_closed_form(volume, stage, unlawful, job)),
            Self::Vpl(plan) => Ok(plan.by_closed_form(volume, stage, unlawful, job)),
            _ => self.on_any_medium(volume, stage.lights, unlawful, job),
        }
    }

    /// Integrators that are the same whatever is known of the medium; one copy of each per medium.
    fn on_any_medium<'s, M: Medium, P: PhaseFunction, C: Spectrum, J: IntegratorJob<C>>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        match self {
            Self::Transmittance(estimator) => {
                Ok(job.run(Attenuation::new(volume, lights, estimator.worker(unlawful))))
            }
            Self::ParticleTracer(walk) => Ok(job.run(ParticleTracer::new(volume, lights, walk.walk()))),
            Self::PhotonTracer(walk) => {
                Ok(job.run(Attenuation::new(volume, lights, Ratio(*walk.walk().sampling()))))
            }
            Self::LineSplitting { walk, line, starts, majorant } => {
                let asked = (*line, *starts, *majorant);
                Ok(job.run(LineSplitting::new(volume, lights, walk.walk(), asked)))
            }
            Self::RegularTransmittance | Self::SingleScattering(_) | Self::PathTracer(_) | Self::Vpl(_) => {
                Err(needs_closed_form("estimator.kind: regular"))
            }
        }
    }

    /// Whether walks are defined where σ_t lies in this range; the estimators of transmittance watch their own look-ups.
    ///
    /// # Errors
    /// If they are not.
    pub fn admits(&self, (lowest, highest): (f64, f64), albedo: f64) -> Result<(), Failure> {
        match self {
            Self::ParticleTracer(walk) | Self::PhotonTracer(walk) => walk.admits((lowest, highest), albedo),
            Self::LineSplitting { walk, majorant, .. } => {
                admits_majorant("integrator.majorant", *majorant, (lowest, highest))?;
                walk.admits((lowest, highest), albedo)
            }
            Self::SingleScattering(plan) => plan.admits((lowest, highest)),
            Self::PathTracer(plan) => plan.transport.walk.admits((lowest, highest), albedo),
            Self::Vpl(plan) => plan.transport.walk.admits((lowest, highest), albedo),
            Self::Transmittance(_) | Self::RegularTransmittance => Ok(()),
        }
    }

    /// Why a look-up was not lawful for an estimator of transmittance.
    #[must_use]
    pub fn explain(&self, Unlawful { point, sigma_t }: Unlawful) -> Failure {
        let at = format!("sigma_t = {sigma_t} at [{}, {}, {}]", point.x, point.y, point.z);
        let majorant = match self {
            Self::Transmittance(estimator) => estimator.collision_majorant(),
            _ => None,
        };
        Failure::refused(match (self, majorant) {
            (_, Some(majorant)) => format!("integrator.estimator.majorant: {majorant} is none, since {at}"),
            (Self::SingleScattering(_), _) => {
                format!("integrator.shadow (or estimator): not defined for {at}")
            }
            _ => format!("integrator.estimator: not defined for {at}"),
        })
    }
}

pub(super) fn needs_closed_form(what: &str) -> Failure {
    Failure::refused(format!(
        "integrator.{what} needs a medium whose optical thickness has a closed form: homogeneous, analytic_cosine or vdb"
    ))
}

/// Whether a claimed majorant is one.
pub(super) fn admits_majorant(
    key: &str,
    majorant: f64,
    (lowest, highest): (f64, f64),
) -> Result<(), Failure> {
    if lowest < 0.0 {
        return Err(Failure::refused(format!("{key}: needs sigma_t of at least 0, but {lowest} was met")));
    }
    if highest > majorant {
        return Err(Failure::refused(format!(
            "{key}: {majorant} is none, since sigma_t = {highest} was met"
        )));
    }
    Ok(())
}
