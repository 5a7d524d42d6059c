//! An integrator of any kind, compiled for the medium that it meets.

use super::WalkPlan;
use super::beam_radiance::BeamRadiancePlan;
use super::bidirectional::BidirectionalPlan;
use super::metropolis::{ChainStarts, Learning, MetropolisPlan};
use super::path_tracer::PathTracerPlan;
use super::single_scattering::SingleScatteringPlan;
use super::tile_integrator::{AnyIntegrator, Counts, InLanes, SceneVolume, by_points, counting, plain};
use super::transport::{Stage, TransportPlan, VplPlan};
use crate::Failure;
use crate::estimator::{InScene, Preparation, Shadow, Unlawful};
use crate::spec::{Adaptation, IntegratorSpec, Particles, ThicknessSpec, TransmittanceSpec};
use fairflight_media::LineThickness;
use fairflight_paths::{Attenuation, LineSplitting, ParticleTracer, Ratio};
use fairflight_scene::Spectrum;
use fairflight_transmittance::{LineIntegral, Regular, Starts};

/// An integrator whose parameters are checked.
#[derive(Debug)]
pub enum IntegratorPlan {
    /// The background seen through the medium.
    Transmittance(Shadow),
    /// Importons.
    ParticleTracer(WalkPlan),
    /// Photons, which are not drawn pixel by pixel; here is the background, attenuated by ratio tracking at the same rate.
    PhotonTracer(WalkPlan),
    /// raab-2008 section 3.1.
    LineSplitting {
        /// The walk by which each flight goes on.
        walk: WalkPlan,
        /// The flights.
        line: LineIntegral,
        /// The choice of the first steps of the flights.
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
    /// Paths from the camera and from lights, joined, among surfaces.
    Bidirectional(BidirectionalPlan),
    /// Photons beside camera rays, among surfaces.
    BeamRadiance(BeamRadiancePlan),
    /// Chains of paths, which are not drawn pixel by pixel; here is what they leave out.
    Metropolis(Box<MetropolisPlan>),
}

impl IntegratorPlan {
    /// The integrator of a spec in a scene.
    ///
    /// # Errors
    /// If a parameter is not lawful, or the medium has no closed form that the integrator needs.
    pub fn build(spec: &IntegratorSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let plan = Self::of(spec, scene)?;
        match plan.needs_closed_form() {
            Some(what) if !scene.medium.has_closed_form() => Err(Failure::refused(format!(
                "integrator.{what} needs a medium whose optical thickness has a closed form: homogeneous, analytic_cosine or vdb"
            ))),
            _ => Ok(plan),
        }
    }

    fn of(spec: &IntegratorSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let (medium, bounds) = (scene.medium, scene.bounds);
        match spec {
            IntegratorSpec::Transmittance(TransmittanceSpec { estimator, .. }) => {
                estimator.kind().for_all_rays(scene, "integrator.estimator").map(Self::Transmittance)
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
                SingleScatteringPlan::build(spec, scene).map(Self::SingleScattering)
            }
            IntegratorSpec::PathTracer(spec) => PathTracerPlan::build(spec, scene).map(Self::PathTracer),
            IntegratorSpec::Vpl(spec) => VplPlan::build(spec, scene).map(|plan| Self::Vpl(Box::new(plan))),
            IntegratorSpec::Bidirectional(spec) => {
                BidirectionalPlan::build(spec, scene).map(Self::Bidirectional)
            }
            IntegratorSpec::BeamRadiance(spec) => {
                BeamRadiancePlan::build(spec, scene).map(Self::BeamRadiance)
            }
            IntegratorSpec::Metropolis(spec) => {
                let learning =
                    Learning::of(spec.importance.as_ref(), spec.adaptation == Adaptation::Crosswise);
                let (samples, chains) = (spec.bootstrap, spec.chains);
                let starts = ChainStarts::Bootstrap { samples, chains, learning };
                MetropolisPlan::build(&spec.steps, starts, scene).map(|plan| Self::Metropolis(Box::new(plan)))
            }
            IntegratorSpec::EnergyRedistribution(spec) => {
                let (steps, chains, most) = (spec.chain_length, spec.chains_per_sample, spec.most_chains);
                let starts = ChainStarts::EverySample { steps, chains, most };
                MetropolisPlan::build(&spec.steps, starts, scene).map(|plan| Self::Metropolis(Box::new(plan)))
            }
        }
    }

    /// The look-ups that were made to prepare it: its estimator of transmittance, and local means.
    pub fn preparations(&self) -> impl Iterator<Item = &Preparation> {
        let shadow = match self {
            Self::Transmittance(shadow) => Some(shadow),
            Self::SingleScattering(plan) => Some(&plan.shadow),
            _ => self.transport().map(|transport| &transport.shadow),
        };
        let means = if let Self::Vpl(plan) = self { plan.means.as_ref() } else { None };
        shadow.and_then(Shadow::preparation).into_iter().chain(means)
    }

    /// The flights and connections of an integrator that knows surfaces.
    fn transport(&self) -> Option<&TransportPlan> {
        match self {
            Self::PathTracer(plan) => Some(&plan.transport),
            Self::Vpl(plan) => Some(&plan.transport),
            Self::Bidirectional(plan) => Some(&plan.transport),
            Self::BeamRadiance(plan) => Some(&plan.transport),
            Self::Metropolis(plan) => Some(plan.transport()),
            Self::Transmittance(_)
            | Self::ParticleTracer(_)
            | Self::PhotonTracer(_)
            | Self::LineSplitting { .. }
            | Self::SingleScattering(_) => None,
        }
    }

    /// The walks of an integrator that has some.
    #[must_use]
    pub fn walk(&self) -> Option<&WalkPlan> {
        match self {
            Self::ParticleTracer(walk) | Self::PhotonTracer(walk) | Self::LineSplitting { walk, .. } => {
                Some(walk)
            }
            _ => self.transport().map(|transport| &transport.walk),
        }
    }

    /// The integrator in a volume, for one tile.
    ///
    /// # Errors
    /// If the integrator does not fit the lights.
    pub fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> Result<AnyIntegrator<'s, C>, Failure> {
        let Stage { lights, unlawful, .. } = stage;
        if M::IS_EMPTY {
            // Only integrators that know surfaces have anything to do: all others see the background.
            return Ok(match self {
                Self::PathTracer(plan) => plan.on(volume, stage),
                Self::Vpl(plan) => plan.on(volume, stage),
                Self::Bidirectional(plan) => plan.on(volume, stage),
                Self::BeamRadiance(plan) => return plan.on(volume, stage),
                Self::Metropolis(plan) => plan.on(volume, stage),
                _ => by_points(Attenuation::new(volume, lights, Regular), |_| Counts::default()),
            });
        }
        Ok(match self {
            Self::Transmittance(shadow) => {
                by_points(Attenuation::new(volume, lights, shadow.worker(unlawful)), |_| Counts::default())
            }
            Self::ParticleTracer(walk) => Box::new(InLanes(ParticleTracer::new(volume, lights, walk.walk()))),
            Self::PhotonTracer(walk) => {
                plain(Attenuation::new(volume, lights, Ratio(*walk.walk().sampling())))
            }
            Self::LineSplitting { walk, line, starts, majorant } => {
                let asked = (*line, *starts, *majorant);
                let splitting = LineSplitting::new(volume, lights, walk.walk(), asked);
                counting(splitting, |splitting| Counts::cut(splitting.truncated()))
            }
            Self::SingleScattering(plan) => return plan.on(volume, stage),
            Self::PathTracer(plan) => plan.on(volume, stage),
            Self::Vpl(plan) => plan.on(volume, stage),
            Self::Bidirectional(plan) => plan.on(volume, stage),
            Self::BeamRadiance(plan) => return plan.on(volume, stage),
            Self::Metropolis(plan) => plan.on(volume, stage),
        })
    }

    /// The key whose value asks for a closed form of the optical thickness, if there is one.
    fn needs_closed_form(&self) -> Option<&'static str> {
        const ESTIMATOR: &str = "estimator.kind: regular";
        match self {
            Self::Transmittance(shadow) => shadow.is_regular().then_some(ESTIMATOR),
            Self::SingleScattering(plan) => plan.needs_closed_form(),
            Self::PathTracer(plan) if plan.reuse.is_some() => Some("reuse"),
            Self::Bidirectional(plan) if plan.thickness == ThicknessSpec::Exact => Some("thickness: exact"),
            _ => self.transport().and_then(|transport| transport.shadow.is_regular().then_some(ESTIMATOR)),
        }
    }

    /// Checks that walks are defined where σ_t lies in this range; the estimators of transmittance watch their own look-ups.
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
            _ => {
                self.transport().map_or(Ok(()), |transport| transport.walk.admits((lowest, highest), albedo))
            }
        }
    }

    /// Failure of a look-up that was not lawful for an estimator of transmittance.
    #[must_use]
    pub fn explain(&self, Unlawful { point, sigma_t }: Unlawful) -> Failure {
        let at = format!("sigma_t = {sigma_t} at [{}, {}, {}]", point.x, point.y, point.z);
        let majorant = match self {
            Self::Transmittance(Shadow::Sampled(estimator)) => estimator.collision_majorant(),
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

/// Checks that a claimed majorant is one.
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
