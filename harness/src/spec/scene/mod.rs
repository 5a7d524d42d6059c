//! A scene and how it is to be rendered: the spec of `harness render`.

mod camera;
mod colour;
mod integrator;
mod light;
mod phase;
mod surface;
mod volume;

pub use colour::ColourSpec;
pub use integrator::{
    Adaptation, BeamRadianceSpec, BidirectionalSpec, ClampSpec, Collisions, ComponentSpec,
    EnergyRedistributionSpec, ExtensionSpec, GuidedSpec, IntegratorKind, IntegratorSpec, LineSplittingSpec,
    MetropolisSpec, MutationKind, Over, Particles, PathTracerSpec, ResampledSpec, ReuseSpec, Sampler,
    SamplerSpec, SamplingFieldSpec, SingleScatteringSpec, StagesSpec, StepsSpec, Strategy, ThicknessSpec,
    TracerSpec, TransmittanceSpec, TransportSpec, VplSpec, WalkSpec,
};
pub use light::{DirectionalSpec, EnvironmentMapSpec, EnvironmentSpec, LightSpec, PointSpec};
pub use phase::{PhaseKind, PhaseSpec};
pub use surface::{MaterialSpec, RectangleSpec, ShapeKind, ShapeSpec, SphereSpec, SurfaceSpec};
pub use volume::VolumeSpec;

use super::{Request, refuse_other};
use crate::Failure;
use crate::reader::{Node, json};
use fairflight_scene::Camera;
use serde_json::Value;
use std::path::Path;

/// A scene as given.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpec {
    /// The camera.
    pub camera: Camera,
    /// The medium; without it, vacuum.
    pub medium: Option<VolumeSpec>,
    /// The lights that are no surfaces.
    pub lights: Vec<LightSpec>,
    /// The surfaces, which may emit light.
    pub surfaces: Vec<SurfaceSpec>,
    /// The estimator of a pixel.
    pub integrator: IntegratorSpec,
    /// Estimates per pixel.
    pub samples_per_pixel: u32,
    /// The seed of all variates.
    pub seed: u64,
}

/// Options of the command line that take the place of keys of the spec.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneOverrides {
    /// `--samples-per-pixel`
    pub samples_per_pixel: Option<u32>,
    /// `--seed`
    pub seed: Option<u64>,
}

/// The parts of a scene in which a key may be swept.
const PARTS: [&str; 5] = ["camera", "medium", "lights", "surfaces", "integrator"];

impl Request<SceneSpec> {
    /// Reads a whole scene or a sweep of them; paths of files in it are relative to the folder `base`.
    ///
    /// # Errors
    /// If it is not JSON, or a key is missing, unknown or of the wrong kind.
    pub fn scenes_in(text: &str, base: &Path, overrides: SceneOverrides) -> Result<Self, Failure> {
        let spec = json::parse(text)?;
        refuse_other("camera", "scene", &Node::root(&spec).object()?)?;
        Self::of(&spec, &PARTS, |point| SceneSpec::read(point, base, overrides))
    }
}

impl SceneSpec {
    /// Reads a whole scene; paths of files in it are relative to the working directory.
    ///
    /// # Errors
    /// If it is not JSON, or a key is missing, unknown or of the wrong kind.
    pub fn parse(text: &str, overrides: SceneOverrides) -> Result<Self, Failure> {
        Self::parse_in(text, Path::new(""), overrides)
    }

    /// Reads a whole scene; paths of files in it are relative to the folder `base`.
    ///
    /// # Errors
    /// If it is not JSON, a key is missing, unknown or of the wrong kind, or it is a sweep.
    pub fn parse_in(text: &str, base: &Path, overrides: SceneOverrides) -> Result<Self, Failure> {
        match Request::scenes_in(text, base, overrides)? {
            Request::Single(scene) => Ok(*scene),
            Request::Sweep(_) => Err(Failure::refused("sweep: one scene is needed here, without this key")),
        }
    }

    fn read(spec: &Value, base: &Path, overrides: SceneOverrides) -> Result<Self, Failure> {
        let root = Node::root_in(spec, base).object()?;
        let allow_gain = root.optional("allow_gain").map_or(Ok(false), |node| node.boolean())?;
        let camera = camera::read(&root.required("camera")?)?;
        let medium = root.optional("medium").map(|node| VolumeSpec::read(&node, allow_gain)).transpose()?;
        let lights =
            root.required("lights")?.items()?.iter().map(LightSpec::read).collect::<Result<_, _>>()?;
        let surfaces = root.optional("surfaces").map_or(Ok(Vec::new()), |node| node.items())?;
        let surfaces = surfaces.iter().map(|node| SurfaceSpec::read(node, allow_gain));
        let surfaces = surfaces.collect::<Result<Vec<_>, _>>()?;
        let integrator = root.required("integrator")?;
        integrator::refuse_for_walks(&integrator)?;
        let integrator = IntegratorSpec::read(&integrator)?;
        let or_override = |key, least, most, instead: Option<u64>| match (root.optional(key), instead) {
            (Some(node), instead) => node.integer(least, most).map(|given| instead.unwrap_or(given)),
            (None, Some(instead)) => Ok(instead),
            (None, None) => root.required(key).and_then(|node| node.integer(least, most)),
        };
        let most = u64::from(u32::MAX);
        let samples = or_override("samples_per_pixel", 1, most, overrides.samples_per_pixel.map(u64::from))?;
        let seed = or_override("seed", 0, u64::MAX, overrides.seed)?;
        let _ = root.optional("sweep");
        root.finish_root()?;
        Ok(Self { camera, medium, lights, surfaces, integrator, samples_per_pixel: samples as u32, seed })
    }

    /// True if one channel is enough: no light, no surface and no albedo has a colour. The colours of environment maps are not known here.
    #[must_use]
    pub fn is_gray(&self) -> bool {
        self.medium.iter().all(|medium| medium.albedo.is_gray())
            && self.lights.iter().filter_map(LightSpec::strength).all(ColourSpec::is_gray)
            && self.surfaces.iter().all(SurfaceSpec::is_gray)
    }
}
