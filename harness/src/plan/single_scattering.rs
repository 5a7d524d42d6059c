//! Single scattering with an estimator of any kind that gives transmittance at every distance.

use super::integrator::{admits_majorant, needs_closed_form};
use super::{IntegratorJob, TileIntegrator};
use crate::Failure;
use crate::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, LineIntegralSpec, SamplingSpec, Shadow,
    SingleParticleSpec, Unlawful,
};
use crate::spec::{SingleScatteringSpec, Strategy};
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_media::{LineThickness, Medium, PhaseFunction, Ray};
use fairflight_paths::single_scattering::{
    Heuristic, LineSampled, Marching, Primary, Sampling, SamplingError, SharedExplorers, SingleScattering,
    Technique, Tracked,
};
use fairflight_paths::{Integrator, RayTransmittance};
use fairflight_scene::{Lights, Spectrum, Volume};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Explorers, Interaction, LineIntegral, Offset, RayMarching, Regular, Starts};
use std::cell::Cell;

/// Single scattering whose parameters are checked.
#[derive(Debug)]
pub struct SingleScatteringPlan {
    sampling: Sampling,
    samples: u32,
    primary: PrimaryPlan,
    shadow: Shadow,
    /// Explorers of the scattering-driven technique, and of the control where there is one.
    explorers: usize,
    /// Rays that share them.
    shared: u32,
}

/// Transmittance of the camera ray.
#[derive(Clone, Copy, Debug)]
enum PrimaryPlan {
    Regular,
    Double { sigma_samp: f64, control: bool },
    Single { model: SingleParticle, sigma_samp: f64, control: bool },
    Line { majorant: f64, line: LineIntegral, starts: Starts },
    Marching { steps: u32, offset: Offset, shadow: RayMarching },
}

/// Explorers of the scattering-driven technique where the estimator has none: a look-up each per ray.
const EXPLORERS: usize = 16;

impl SingleScatteringPlan {
    /// Single scattering of a spec.
    ///
    /// # Errors
    /// If the estimator does not give transmittance at every distance, or a parameter is not lawful.
    pub(super) fn build(spec: &SingleScatteringSpec) -> Result<Self, Failure> {
        let (shadow, key) = match &spec.shadow {
            Some(shadow) => (shadow, "integrator.shadow"),
            None => (&spec.estimator, "integrator.estimator"),
        };
        let count = explorers_of(&spec.estimator)?;
        Ok(Self {
            sampling: sampling(spec.sampling, spec.heuristic),
            samples: spec.samples_per_ray,
            primary: PrimaryPlan::build(spec, count.is_some())?,
            shadow: shadow.kind().for_all_rays(key)?,
            explorers: count.unwrap_or(EXPLORERS),
            shared: spec.shared_explorers,
        })
    }

    /// Whether the walk of the camera ray is defined where σ_t has this value.
    pub(super) fn admits(&self, range: (f64, f64)) -> Result<(), Failure> {
        if let PrimaryPlan::Line { majorant, .. } = self.primary {
            return admits_majorant("integrator.estimator.majorant", majorant, range);
        }
        [range.0, range.1].into_iter().try_for_each(|sigma_t| self.admits_value(sigma_t))
    }

    fn admits_value(&self, sigma_t: f64) -> Result<(), Failure> {
        match self.primary {
            // With a control only versions that are defined everywhere are accepted.
            PrimaryPlan::Single { model, sigma_samp, control: false }
                if !model.admits(sigma_t / sigma_samp) =>
            {
                Err(Failure::refused(format!(
                    "integrator.estimator.version: terminating needs 0 <= r <= 2/(1 + albedo), but r = \
                     sigma_t/sigma_samp = {} where sigma_t = {sigma_t}",
                    sigma_t / sigma_samp
                )))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn by_look_ups<'s, M: Medium, P: PhaseFunction, C: Spectrum, J: IntegratorJob<C>>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        let shadow = self
            .shadow
            .by_look_ups(unlawful)
            .ok_or_else(|| needs_closed_form("shadow (or estimator): regular"))?;
        self.tracked(volume, lights, shadow, job)
    }

    pub(super) fn by_closed_form<'s, M: LineThickness, P: PhaseFunction, C: Spectrum, J: IntegratorJob<C>>(
        &'s self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        unlawful: &'s Cell<Option<Unlawful>>,
        job: J,
    ) -> Result<J::Output, Failure> {
        let shadow = self.shadow.by_closed_form(unlawful);
        match self.primary {
            PrimaryPlan::Regular => self.with(volume, lights, Regular, shadow, job),
            _ => self.tracked(volume, lights, shadow, job),
        }
    }

    /// What needs look-ups only, whatever the shadow rays do.
    fn tracked<'s, M: Medium, P: PhaseFunction, C: Spectrum, T: RayTransmittance<M>, J: IntegratorJob<C>>(
        &self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        shadow: T,
        job: J,
    ) -> Result<J::Output, Failure> {
        let refuse = |error| Failure::refused(format!("integrator.estimator.sigma_samp: {error}"));
        let explorers = |wanted: bool| wanted.then(|| self.explorers()).transpose();
        match self.primary {
            PrimaryPlan::Regular => Err(needs_closed_form("estimator.kind: regular")),
            PrimaryPlan::Double { sigma_samp, control } => {
                let model = DoubleParticle { albedo: Albedo::default() };
                let walk = Tracked::new(model, sigma_samp, explorers(control)?).map_err(refuse)?;
                self.with(volume, lights, AnyTracked::Double(walk), shadow, job)
            }
            PrimaryPlan::Single { model, sigma_samp, control } => {
                let walk = Tracked::new(model, sigma_samp, explorers(control)?).map_err(refuse)?;
                self.with(volume, lights, AnyTracked::Single(walk), shadow, job)
            }
            PrimaryPlan::Line { majorant, line, starts } => {
                Ok(job.run(LineSampled::new(volume, lights, (line, starts, majorant), shadow)))
            }
            PrimaryPlan::Marching { steps, offset, shadow } => {
                Ok(job.run(Marching::new(volume, lights, (steps, offset), shadow)))
            }
        }
    }

    fn with<
        's,
        M: Medium,
        P: PhaseFunction,
        C: Spectrum,
        W: Primary<M>,
        T: RayTransmittance<M>,
        J: IntegratorJob<C>,
    >(
        &self,
        volume: &'s Volume<M, P, C>,
        lights: &'s Lights<C>,
        walk: W,
        shadow: T,
        job: J,
    ) -> Result<J::Output, Failure> {
        let asked = (self.sampling, self.samples);
        SingleScattering::new(volume, lights, asked, walk, shadow, self.explorers()?)
            .map(|integrator| job.run(integrator))
            .map_err(|error| {
                let key = if error == SamplingError::NoSamples { "samples_per_ray" } else { "sampling" };
                Failure::refused(format!("integrator.{key}: {error}"))
            })
    }

    fn explorers(&self) -> Result<SharedExplorers, Failure> {
        SharedExplorers::new(self.explorers, self.shared)
            .map_err(|error| Failure::refused(format!("integrator.estimator.control: {error}")))
    }
}

impl PrimaryPlan {
    fn build(spec: &SingleScatteringSpec, control: bool) -> Result<Self, Failure> {
        let rate = |sampling: &SamplingSpec| match *sampling {
            SamplingSpec::Constant(sigma_samp) => Ok(sigma_samp),
            SamplingSpec::PiecewiseConstant { .. } => {
                Err(Failure::refused("integrator.estimator.sigma_samp: must be a number"))
            }
        };
        match &spec.estimator {
            EstimatorSpec::Regular(_) => Ok(Self::Regular),
            EstimatorSpec::DoubleParticle(DoubleParticleSpec { sigma_samp, .. }) => {
                Ok(Self::Double { sigma_samp: rate(sigma_samp)?, control })
            }
            EstimatorSpec::SingleParticle(SingleParticleSpec { version, albedo, sigma_samp, .. }) => {
                if control && *version == Version::Terminating {
                    return Err(Failure::refused(
                        "integrator.estimator.version: terminating is not defined where the control exceeds the \
                         extinction; with explorers non_terminating or adaptive is allowed",
                    ));
                }
                let model = SingleParticle { version: *version, albedo: *albedo };
                Ok(Self::Single { model, sigma_samp: rate(sigma_samp)?, control })
            }
            EstimatorSpec::RayMarching(marching) => {
                own_points(spec.sampling, "ray_marching")?;
                let shadow = match &spec.shadow {
                    None => marching,
                    Some(EstimatorSpec::RayMarching(shadow)) => shadow,
                    Some(_) => {
                        return Err(Failure::refused(
                            "integrator.shadow.kind: must be ray_marching as the estimator is",
                        ));
                    }
                };
                let shadow = RayMarching::new(shadow.steps, shadow.offset())
                    .map_err(|error| Failure::refused(format!("integrator.estimator.steps: {error}")))?;
                Ok(Self::Marching { steps: marching.steps, offset: marching.offset(), shadow })
            }
            EstimatorSpec::LineIntegral(LineIntegralSpec { majorant, splits }) => {
                own_points(spec.sampling, "line_integral")?;
                let line = LineIntegral::new(*splits)
                    .map_err(|error| Failure::refused(format!("integrator.estimator.splits: {error}")))?;
                Ok(Self::Line { majorant: *majorant, line, starts: spec.starts })
            }
            _ => Err(Failure::refused(
                "integrator.estimator.kind: must be regular, double_particle, single_particle, line_integral or \
                 ray_marching for single_scattering, which asks for transmittance at every distance",
            )),
        }
    }
}

/// Some estimators scatter at points of their own.
fn own_points(sampling: Strategy, name: &str) -> Result<(), Failure> {
    if sampling == Strategy::Attenuation {
        return Ok(());
    }
    Err(Failure::refused(format!(
        "integrator.sampling: must be attenuation, since {name} scatters at points of its own"
    )))
}

/// The explorers of an estimator's control, if it has one.
fn explorers_of(estimator: &EstimatorSpec) -> Result<Option<usize>, Failure> {
    let (EstimatorSpec::DoubleParticle(DoubleParticleSpec { control, .. })
    | EstimatorSpec::SingleParticle(SingleParticleSpec { control, .. })) = estimator
    else {
        return Ok(None);
    };
    match control {
        ControlSpec::None(_) => Ok(None),
        ControlSpec::Explorers(explorers) => Ok(Some(explorers.count as usize)),
        ControlSpec::Constant(_) | ControlSpec::PiecewiseLinear(_) => Err(Failure::refused(
            "integrator.estimator.control.kind: must be none or explorers for single_scattering",
        )),
    }
}

fn sampling(strategy: Strategy, heuristic: Heuristic) -> Sampling {
    use Technique::{Attenuation, Scattering, Source};
    match strategy {
        Strategy::Attenuation => Sampling::One(Attenuation),
        Strategy::AttenuationResampled => Sampling::AttenuationResampled,
        Strategy::Source => Sampling::One(Source),
        Strategy::Scattering => Sampling::One(Scattering),
        Strategy::SourceAndScattering => Sampling::Two(Source, Scattering, heuristic),
        Strategy::AttenuationAndSource => Sampling::Two(Attenuation, Source, heuristic),
        Strategy::AttenuationAndScattering => Sampling::Two(Attenuation, Scattering, heuristic),
    }
}

/// Tracking of the camera ray with either model: one branch per question, and half of the integrators to compile.
#[derive(Debug)]
enum AnyTracked {
    Double(Tracked<DoubleParticle>),
    Single(Tracked<SingleParticle>),
}

impl<M: Medium> Primary<M> for AnyTracked {
    fn trace(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) {
        match self {
            Self::Double(walk) => walk.trace(ray, source),
            Self::Single(walk) => walk.trace(ray, source),
        }
    }
    fn transmittance(&self, ray: &Ray<&M>, s: f64) -> f64 {
        match self {
            Self::Double(walk) => walk.transmittance(ray, s),
            Self::Single(walk) => walk.transmittance(ray, s),
        }
    }
    fn interactions(&self) -> &[Interaction] {
        match self {
            Self::Double(walk) => Primary::<M>::interactions(walk),
            Self::Single(walk) => Primary::<M>::interactions(walk),
        }
    }
    fn transmittance_before(&self, index: usize) -> f64 {
        match self {
            Self::Double(walk) => Primary::<M>::transmittance_before(walk, index),
            Self::Single(walk) => Primary::<M>::transmittance_before(walk, index),
        }
    }
    fn intensity(&self) -> f64 {
        match self {
            Self::Double(walk) => Primary::<M>::intensity(walk),
            Self::Single(walk) => Primary::<M>::intensity(walk),
        }
    }
    fn fitted(&self) -> Option<&Explorers> {
        match self {
            Self::Double(walk) => Primary::<M>::fitted(walk),
            Self::Single(walk) => Primary::<M>::fitted(walk),
        }
    }
}

impl<M, P, C, W, T> TileIntegrator<C> for SingleScattering<'_, M, P, C, W, T> where Self: Integrator<C> {}
impl<M, P, C> TileIntegrator<C> for Marching<'_, M, P, C> where Self: Integrator<C> {}
impl<M, P, C, T> TileIntegrator<C> for LineSampled<'_, M, P, C, T> where Self: Integrator<C> {}
