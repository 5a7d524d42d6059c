//! Single scattering with an estimator of any kind that gives transmittance at every distance.

use super::integrator::admits_majorant;
use super::tile_integrator::{AnyIntegrator, Counts, SceneVolume, by_points};
use super::transport::Stage;
use crate::Failure;
use crate::estimator::{
    ControlSpec, DoubleParticleSpec, EstimatorSpec, InScene, LineIntegralSpec, SamplingSpec, Shadow,
    SingleParticleSpec,
};
use crate::spec::{SingleScatteringSpec, Strategy};
use fairflight_collision::{Albedo, CollisionModel, DoubleParticle, SingleParticle, Version};
use fairflight_media::{LineThickness, Ray};
use fairflight_paths::single_scattering::{
    Heuristic, LineSampled, Marching, Primary, Sampling, SamplingError, SharedExplorers, SingleScattering,
    Technique, Tracked,
};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Explorers, Interaction, LineIntegral, Offset, RayMarching, Regular, Starts};

/// Single scattering whose parameters are checked.
#[derive(Debug)]
pub struct SingleScatteringPlan {
    sampling: Sampling,
    samples: u32,
    primary: PrimaryPlan,
    pub(super) shadow: Shadow,
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
    pub(super) fn build(spec: &SingleScatteringSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let (shadow, key) = match &spec.shadow {
            Some(shadow) => (shadow, "integrator.shadow"),
            None => (&spec.estimator, "integrator.estimator"),
        };
        let count = explorers_of(&spec.estimator)?;
        Ok(Self {
            sampling: sampling(spec.sampling, spec.heuristic),
            samples: spec.samples_per_ray,
            primary: PrimaryPlan::build(spec, count.is_some())?,
            shadow: shadow.kind().for_all_rays(scene, key)?,
            explorers: count.unwrap_or(EXPLORERS),
            shared: spec.shared_explorers,
        })
    }

    /// Checks that the walk of the camera ray is defined where σ_t has this value.
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

    /// The key whose value asks for a closed form of the optical thickness, if there is one.
    pub(super) fn needs_closed_form(&self) -> Option<&'static str> {
        if self.shadow.is_regular() {
            return Some("shadow (or estimator): regular");
        }
        matches!(self.primary, PrimaryPlan::Regular).then_some("estimator.kind: regular")
    }

    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        Stage { lights, unlawful, .. }: Stage<'s, C>,
    ) -> Result<AnyIntegrator<'s, C>, Failure> {
        let shadow = self.shadow.worker(unlawful);
        let refuse = |error| Failure::refused(format!("integrator.estimator.sigma_samp: {error}"));
        let explorers = |wanted: bool| wanted.then(|| self.explorers()).transpose();
        let primary = match self.primary {
            PrimaryPlan::Regular => AnyPrimary::Regular(Regular),
            PrimaryPlan::Double { sigma_samp, control } => {
                let model = DoubleParticle { albedo: Albedo::default() };
                AnyPrimary::Double(Tracked::new(model, sigma_samp, explorers(control)?).map_err(refuse)?)
            }
            PrimaryPlan::Single { model, sigma_samp, control } => {
                AnyPrimary::Single(Tracked::new(model, sigma_samp, explorers(control)?).map_err(refuse)?)
            }
            PrimaryPlan::Line { majorant, line, starts } => {
                let line = LineSampled::new(volume, lights, (line, starts, majorant), shadow);
                return Ok(by_points(line, |_| Counts::default()));
            }
            PrimaryPlan::Marching { steps, offset, shadow } => {
                let marching = Marching::new(volume, lights, (steps, offset), shadow);
                return Ok(by_points(marching, |_| Counts::default()));
            }
        };
        let asked = (self.sampling, self.samples);
        let integrator = SingleScattering::new(volume, lights, asked, primary, shadow, self.explorers()?);
        integrator.map(|it| by_points(it, |_| Counts::default())).map_err(|error| {
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

/// Transmittance of the camera ray of any kind: one branch per question, and a third of the integrators to compile.
#[derive(Debug)]
enum AnyPrimary {
    Regular(Regular),
    Double(Tracked<DoubleParticle>),
    Single(Tracked<SingleParticle>),
}

/// One expression of the transmittance inside, whatever its type.
macro_rules! of_any {
    ($any:expr, $primary:ident => $result:expr) => {
        match $any {
            AnyPrimary::Regular($primary) => $result,
            AnyPrimary::Double($primary) => $result,
            AnyPrimary::Single($primary) => $result,
        }
    };
}

impl<M: LineThickness> Primary<M> for AnyPrimary {
    fn trace(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) {
        of_any!(self, primary => Primary::<M>::trace(primary, ray, source));
    }
    fn transmittance(&self, ray: &Ray<&M>, s: f64) -> f64 {
        of_any!(self, primary => Primary::<M>::transmittance(primary, ray, s))
    }
    fn interactions(&self) -> &[Interaction] {
        of_any!(self, primary => Primary::<M>::interactions(primary))
    }
    fn transmittance_before(&self, index: usize) -> f64 {
        of_any!(self, primary => Primary::<M>::transmittance_before(primary, index))
    }
    fn intensity(&self) -> f64 {
        of_any!(self, primary => Primary::<M>::intensity(primary))
    }
    fn fitted(&self) -> Option<&Explorers> {
        of_any!(self, primary => Primary::<M>::fitted(primary))
    }
}
