//! An integrator of any kind, compiled for the medium that it meets.

use super::beam_radiance::BeamRadiancePlan;
use super::bidirectional::BidirectionalPlan;
use super::metropolis::{ChainStarts, Learning, MetropolisPlan};
use super::path_tracer::PathTracerPlan;
use super::single_scattering::SingleScatteringPlan;
use super::transport::{Stage, TransportPlan, VplPlan};
use super::{AnyPhase, SpaceSampling, Tally, WalkPlan};
use crate::Failure;
use crate::estimator::{InScene, Preparation, Shadow, Unlawful};
use crate::spec::{Adaptation, IntegratorSpec, Particles, ThicknessSpec, TransmittanceSpec};
use fairflight_media::{Line, LineThickness};
use fairflight_paths::{Attenuation, Integrator, LineSplitting, ParticleTracer, Ratio};
use fairflight_scene::{Camera, Spectrum, Volume};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::{LineIntegral, Regular, Starts};
use std::ops::ControlFlow;

/// The volume of a scene whose medium has one type.
pub type SceneVolume<'s, M, C> = Volume<M, &'s AnyPhase, C>;

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

/// Columns and rows of pixels, and the number of estimates of each.
type Pixels<'a> = (&'a [[u32; 2]], u32);

/// Callback that is told the number of a pixel with each estimate, until it breaks.
type Take<'a, C> = dyn FnMut(usize, C) -> ControlFlow<()> + 'a;

/// An integrator on a medium, for one tile: one call per camera ray, and what happens below is compiled for the types of the scene.
pub trait TileIntegrator<C> {
    /// Draws one estimate \[radiance\] for a ray whose direction has unit length.
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C;

    /// The same with the variates of a point.
    ///
    /// # Panics
    /// If the integrator takes no points, to which the plan gives none.
    fn radiance_by_point(&mut self, line: &Line, source: &mut dyn UniformSource) -> C {
        let _ = (line, source);
        unreachable!("it takes no points")
    }

    /// Draws one estimate for each of `lines`, of pixels that use each other's paths; unless the integrator says otherwise, of each by itself.
    fn radiances(&mut self, lines: &[Line], radiances: &mut [C], source: &mut Seeded) {
        for (line, radiance) in lines.iter().zip(radiances) {
            *radiance = self.radiance(line, source);
        }
    }

    /// Draws estimates of pixels, each from a stream of its own: one pixel after the other unless the integrator says otherwise, those of one in order.
    fn pixels(&mut self, camera: &Camera, work: Pixels<'_>, sources: &mut [Seeded], take: &mut Take<'_, C>) {
        let (pixels, samples) = work;
        for (i, (pixel, source)) in pixels.iter().zip(sources).enumerate() {
            for _ in 0..samples {
                let within = [source.next_uniform(), source.next_uniform()];
                if take(i, self.radiance(&camera.ray(*pixel, within), source)).is_break() {
                    return;
                }
            }
        }
    }

    /// Events that were counted so far.
    fn counts(&self) -> Counts;

    /// Takes what was found since the last call and is no estimate along a ray of this tile.
    fn splatted(&mut self) -> Splatted<C> {
        Splatted::none()
    }

    /// The part of the estimate, in words, that made it infinite or no number, where that is known.
    fn culprit(&self) -> Option<String> {
        None
    }
}

/// Light that an integrator found for any pixel, and by what it found all light.
#[derive(Clone, Debug, PartialEq)]
pub struct Splatted<C> {
    /// Column and row of a pixel, and the radiance to be added to its sample of this pass.
    pub splats: Vec<([u32; 2], C)>,
    /// Contributions by strategy, those of the samples along camera rays included.
    pub tally: Tally,
    /// Number of light paths.
    pub light_paths: u64,
    /// The sum over them of the power that was not followed, since no other integrator would see it.
    pub unseen_power: f64,
}

impl<C> Splatted<C> {
    /// Nothing.
    pub fn none() -> Self {
        Self { splats: Vec::new(), tally: Tally::none(), light_paths: 0, unseen_power: 0.0 }
    }
}

/// Events of an integrator that an image tells of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Walks that were cut: each is a bias.
    pub truncated: u64,
    /// Flights that were not lawful for the integrator: each is a bias.
    pub unlawful: u64,
    /// Compensation vertices that were tried.
    pub compensation_tried: u64,
    /// Compensation vertices that lay where something was lost.
    pub compensation_inside: u64,
}

/// An integrator of any kind.
pub type AnyIntegrator<'s, C> = Box<dyn TileIntegrator<C> + 's>;

/// An integrator of one type, and how its counts are asked for.
struct Compiled<I> {
    integrator: I,
    counts: fn(&I) -> Counts,
}

/// The same of one that takes points: one more copy of it is compiled for them.
struct ByPoints<I>(Compiled<I>);

impl<C: Spectrum, I: Integrator<C>> TileIntegrator<C> for ByPoints<I> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        self.0.radiance(line, source)
    }
    fn radiance_by_point(&mut self, line: &Line, mut source: &mut dyn UniformSource) -> C {
        self.0.integrator.radiance(line, &mut source)
    }
    fn counts(&self) -> Counts {
        TileIntegrator::<C>::counts(&self.0)
    }
}

impl<C: Spectrum, I: Integrator<C>> TileIntegrator<C> for Compiled<I> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        // In registers while it changes.
        let mut own = source.clone();
        let radiance = self.integrator.radiance(line, &mut own);
        *source = own;
        radiance
    }
    fn counts(&self) -> Counts {
        (self.counts)(&self.integrator)
    }
}

/// A particle tracer, whose pixels are drawn in lanes.
struct InLanes<'s, M, C>(ParticleTracer<'s, M, &'s AnyPhase, C, SpaceSampling<'s>>);

impl<M: LineThickness, C: Spectrum> TileIntegrator<C> for InLanes<'_, M, C> {
    fn radiance(&mut self, line: &Line, source: &mut Seeded) -> C {
        self.0.radiance(line, source)
    }
    /// Pixel beside pixel; whatever `take` says, all of them.
    fn pixels(&mut self, camera: &Camera, work: Pixels<'_>, sources: &mut [Seeded], take: &mut Take<'_, C>) {
        self.0.trace(camera, work, sources, |pixel, radiance| {
            let _ = take(pixel, radiance);
        });
    }
    fn counts(&self) -> Counts {
        Counts::cut(self.0.truncated())
    }
}

/// An integrator with its counts.
pub(super) fn counting<'s, C: Spectrum, I: Integrator<C> + 's>(
    integrator: I,
    counts: fn(&I) -> Counts,
) -> AnyIntegrator<'s, C> {
    Box::new(Compiled { integrator, counts })
}

/// An integrator that takes points, with its counts.
pub(super) fn by_points<'s, C: Spectrum, I: Integrator<C> + 's>(
    integrator: I,
    counts: fn(&I) -> Counts,
) -> AnyIntegrator<'s, C> {
    Box::new(ByPoints(Compiled { integrator, counts }))
}

/// An integrator that counts nothing.
pub(super) fn plain<'s, C: Spectrum>(integrator: impl Integrator<C> + 's) -> AnyIntegrator<'s, C> {
    counting(integrator, |_| Counts::default())
}

impl Counts {
    /// Walks that were cut, and nothing else.
    pub(super) fn cut(truncated: u64) -> Self {
        Self { truncated, ..Self::default() }
    }
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
