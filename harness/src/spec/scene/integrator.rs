//! What estimates a pixel.

use super::{PathTracerSpec, VplSpec};
use crate::Failure;
use crate::estimator::{EstimatorSpec, VersionWord};
use crate::reader::rule::one_of;
use crate::reader::{Node, Object, Rule};
use fairflight_collision::Version;
use fairflight_paths::{Grid, Heuristic};
use fairflight_transmittance::Starts;

/// An integrator with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum IntegratorSpec {
    /// The background seen through the medium; no scattering.
    Transmittance {
        /// Of the transmittance.
        estimator: EstimatorSpec,
    },
    /// szirmay-kalos-2017 section 4.1.
    ParticleTracer(TracerSpec),
    /// raab-2008 section 3.1: several first collisions per camera ray, each continued by a walk.
    LineSplitting {
        /// The walks.
        walk: WalkSpec,
        /// A claim about the medium.
        majorant: f64,
        /// Flights per camera ray.
        splits: u32,
        /// Of their first steps.
        starts: Starts,
    },
    /// szirmay-kalos-2017 section 4.3.
    SingleScattering(SingleScatteringSpec),
    /// raab-2008 section 4.1, among surfaces.
    PathTracer(PathTracerSpec),
    /// raab-2008 section 4.2, engelhardt-2013.
    Vpl(Box<VplSpec>),
}

/// Single scattering with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleScatteringSpec {
    /// Where on the ray the scattering point is chosen.
    pub sampling: Strategy,
    /// Of the transmittance along the camera's ray.
    pub estimator: EstimatorSpec,
    /// Scattering points per ray, light and technique.
    pub samples_per_ray: u32,
    /// How techniques are combined.
    pub heuristic: Heuristic,
    /// Of the flights of `line_integral`.
    pub starts: Starts,
    /// Of the transmittance to the lights; without it, the camera ray's.
    pub shadow: Option<EstimatorSpec>,
    /// How many neighbouring pixels share one fitted control.
    pub shared_explorers: u32,
}

/// Particle tracing with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct TracerSpec {
    /// How they walk.
    pub walk: WalkSpec,
    /// From where.
    pub particles: Particles,
}

/// A walk with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkSpec {
    /// How the probabilities of a collision are chosen.
    pub version: Version,
    /// σ_samp in space.
    pub sampling: SamplingFieldSpec,
    /// What is decided once for all channels.
    pub colour: Collisions,
    /// More collisions of one particle are cut off, a bias; by default none are.
    pub max_collisions: u64,
    /// Whether a walk may be run that has no second moment.
    pub allow_supercritical: bool,
}

/// A sampling extinction in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplingFieldSpec {
    /// The same everywhere.
    Uniform(f64),
    /// The greatest extinction that the medium declares.
    FromMedium,
    /// One value per cell of a grid over the bounds of the medium, fitted to it.
    Grid {
        /// Cells along x, y and z.
        cells: [u32; 3],
        /// In front of what the medium has there.
        factor: f64,
        /// No value is lower \[1/length\].
        floor: f64,
    },
}

/// Whether the channels of a colour share a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collisions {
    /// One walk for all channels.
    Shared,
    /// One walk per channel.
    Separate,
}

/// What walks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Particles {
    /// From the camera.
    Importons,
    /// From the lights.
    Photons,
}

/// How the scattering point of single scattering is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategy {
    /// By the transmittance that one walk estimated.
    Attenuation,
    /// The same, with a walk of its own for each point.
    AttenuationResampled,
    /// By the light that arrives.
    Source,
    /// By the extinction.
    Scattering,
    /// Two of them combined.
    SourceAndScattering,
    /// Two of them combined.
    AttenuationAndSource,
    /// Two of them combined.
    AttenuationAndScattering,
}

impl Strategy {
    const NAMES: [(&'static str, Self); 7] = [
        ("attenuation", Self::Attenuation),
        ("attenuation_resampled", Self::AttenuationResampled),
        ("source", Self::Source),
        ("scattering", Self::Scattering),
        ("source_and_scattering", Self::SourceAndScattering),
        ("attenuation_and_source", Self::AttenuationAndSource),
        ("attenuation_and_scattering", Self::AttenuationAndScattering),
    ];
}

/// More points per ray or pixels per control are a slip of the keyboard.
const MOST: u64 = 1_000_000;
/// More cells take minutes to fit.
const MOST_CELLS: u64 = 1 << 24;

impl IntegratorSpec {
    /// The walks of an integrator that has some.
    #[must_use]
    pub fn walk(&self) -> Option<&WalkSpec> {
        match self {
            Self::ParticleTracer(tracer) => Some(&tracer.walk),
            Self::LineSplitting { walk, .. } => Some(walk),
            Self::PathTracer(spec) => Some(&spec.transport.walk),
            Self::Vpl(spec) => Some(&spec.transport.walk),
            Self::Transmittance { .. } | Self::SingleScattering(_) => None,
        }
    }

    /// The walks of an integrator that has some, to be changed.
    pub fn walk_mut(&mut self) -> Option<&mut WalkSpec> {
        match self {
            Self::ParticleTracer(tracer) => Some(&mut tracer.walk),
            Self::LineSplitting { walk, .. } => Some(walk),
            Self::PathTracer(spec) => Some(&mut spec.transport.walk),
            Self::Vpl(spec) => Some(&mut spec.transport.walk),
            Self::Transmittance { .. } | Self::SingleScattering(_) => None,
        }
    }

    /// The name of an integrator that takes no account of surfaces.
    #[must_use]
    pub fn blind_to_surfaces(&self) -> Option<&'static str> {
        match self {
            Self::Transmittance { .. } => Some("transmittance"),
            Self::ParticleTracer(_) => Some("particle_tracer"),
            Self::LineSplitting { .. } => Some("line_splitting"),
            Self::SingleScattering(_) => Some("single_scattering"),
            Self::PathTracer(_) | Self::Vpl(_) => None,
        }
    }

    /// Reads `integrator`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let estimator = || EstimatorSpec::read_for_all_rays(&object.required("estimator")?);
        let integrator = match kind.text()? {
            "transmittance" => Self::Transmittance { estimator: estimator()? },
            "particle_tracer" => Self::ParticleTracer(TracerSpec::take_from(&object)?),
            "path_tracer" => Self::PathTracer(PathTracerSpec::take_from(&object)?),
            "vpl" => Self::Vpl(Box::new(VplSpec::take_from(&object)?)),
            "line_splitting" => Self::LineSplitting {
                walk: WalkSpec::take_from(&object)?,
                majorant: object.required("majorant")?.non_negative()?,
                splits: object.required("splits")?.integer(1, MOST)? as u32,
                starts: read_starts(&object)?,
            },
            "single_scattering" => Self::SingleScattering(SingleScatteringSpec {
                sampling: named(&object.required("sampling")?, &Strategy::NAMES)?,
                estimator: estimator()?,
                samples_per_ray: object.required("samples_per_ray")?.integer(1, MOST)? as u32,
                starts: read_starts(&object)?,
                heuristic: named_or(
                    &object,
                    "heuristic",
                    &[("balance", Heuristic::Balance), ("power", Heuristic::Power)],
                )?,
                shadow: object
                    .optional("shadow")
                    .map(|node| EstimatorSpec::read_for_all_rays(&node))
                    .transpose()?,
                shared_explorers: object
                    .optional("shared_explorers")
                    .map_or(Ok(1), |node| node.integer(1, MOST))? as u32,
            }),
            _ => {
                return Err(kind.refuse(
                    "must be transmittance, particle_tracer, line_splitting, single_scattering, path_tracer or vpl",
                ));
            }
        };
        object.finish()?;
        Ok(integrator)
    }
}

impl TracerSpec {
    fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let particles = [("importons", Particles::Importons), ("photons", Particles::Photons)];
        Ok(Self { walk: WalkSpec::take_from(object)?, particles: named_or(object, "particles", &particles)? })
    }
}

impl WalkSpec {
    fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let version = VersionWord::read(&object.required("version")?)?;
        Self::take_rest(object, version, SamplingFieldSpec::read(&object.required("sigma_samp")?)?)
    }

    fn take_rest(
        object: &Object<'_>,
        version: Version,
        sampling: SamplingFieldSpec,
    ) -> Result<Self, Failure> {
        let colours = [("shared", Collisions::Shared), ("separate", Collisions::Separate)];
        let most = object.optional("max_collisions");
        let allow = object.optional("allow_supercritical");
        Ok(Self {
            version,
            sampling,
            colour: named_or(object, "colour", &colours)?,
            max_collisions: most.map_or(Ok(u64::MAX), |node| node.integer(1, u64::MAX))?,
            allow_supercritical: allow.map_or(Ok(false), |node| node.boolean())?,
        })
    }
}

impl WalkSpec {
    /// The walk of an integrator that knows surfaces, the same where version and sampling extinction may be left out: non-terminating, at the greatest extinction of the medium.
    pub(super) fn take_with_defaults(object: &Object<'_>) -> Result<Self, Failure> {
        let version = object.optional("version").map(|node| VersionWord::read(&node));
        let sampling = object.optional("sigma_samp").map(|node| SamplingFieldSpec::read(&node));
        let version = version.unwrap_or(Ok(Version::NonTerminating))?;
        Self::take_rest(object, version, sampling.unwrap_or(Ok(SamplingFieldSpec::FromMedium))?)
    }
}

impl SamplingFieldSpec {
    fn read(node: &Node<'_>) -> Result<Self, Failure> {
        if !node.is_object() {
            return node.positive().map(Self::Uniform).map_err(|_| {
                node.refuse("must be a number above 0, or an object of cells, factor and floor")
            });
        }
        let object = node.object()?;
        let cells = object.required("cells")?;
        let numbers = cells.integers(1, Grid::MOST_CELLS as u32)?;
        if numbers.iter().map(|&count| u64::from(count)).product::<u64>() > MOST_CELLS {
            return Err(cells.refuse(format!("must be at most {MOST_CELLS} cells altogether")));
        }
        let field = Self::Grid {
            cells: numbers,
            factor: object.required("factor")?.positive()?,
            floor: object.required("floor")?.positive()?,
        };
        object.finish()?;
        Ok(field)
    }
}

fn read_starts(object: &Object<'_>) -> Result<Starts, Failure> {
    named_or(object, "starts", &[("equidistant", Starts::Equidistant), ("independent", Starts::Independent)])
}

/// One of some names.
pub(super) fn named<T: Copy>(node: &Node<'_>, names: &[(&str, T)]) -> Result<T, Failure> {
    let text = node.text()?;
    names.iter().find(|(name, _)| *name == text).map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<&str> = names.iter().map(|&(name, _)| name).collect();
        node.refuse(format!("must be {}", one_of(&names)))
    })
}

/// One of some names, the first where the key is absent.
pub(super) fn named_or<T: Copy>(
    object: &Object<'_>,
    key: &'static str,
    names: &[(&str, T)],
) -> Result<T, Failure> {
    object.optional(key).map_or(Ok(names[0].1), |node| named(&node, names))
}
