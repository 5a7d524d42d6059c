//! The question: a medium, and the rays that matter in it.

use crate::cli::AdviseArguments;
use crate::comparison::{RaySet, chords};
use crate::field::MediumSpec;
use crate::field::{AnyMedium, AnyProfile, MediumLibrary};
use crate::input::Input;
use crate::reader::{Node, json};
use crate::result::Provenance;
use crate::spec::{IntegratorSpec, SceneOverrides, SceneSpec, VolumeSpec, refuse_other};
use crate::volume::Volume;
use crate::{Environment, Failure};
use fairflight_media::{Bounds, Medium, Tolerance};
use fairflight_scene::Camera;
use fairflight_sources::{Seeded, UniformSource, named_seed};
use std::io::Read;

/// Chords shorter than this share of the medium's extent say little.
const LEAST: f64 = 0.1;
/// Error of the transmittance of a ray that is granted, relative to its optical thickness: well below any variance that is
/// measured.
const TOLERANCE: f64 = 1e-7;
/// The stream that the rays are chosen from.
const RAYS: &str = "advise/rays";
/// Camera rays that are tried for one that meets the medium.
const TRIES: usize = 200;

/// Answer to a scene for which no advice is given.
const ALTERNATIVES: &str = "what a picture costs is not measured; advice is given for transmittance along rays: of --vdb FILE, or of \
    MEDIUM.json, which holds a medium as in an experiment";

/// A medium and how its rays are chosen.
pub(super) struct Question {
    /// Name of the medium in the answer.
    pub(super) name: String,
    /// The text that was read; none where the command line says all.
    input: Option<Input>,
    medium: AnyMedium,
    bounds: Bounds,
    camera: Option<Camera>,
    rays: usize,
    seed: u64,
    majorant: Option<f64>,
}

/// Checks that the picture of a scene is the background, attenuated: then estimates of transmittance along camera
/// rays are all that it costs.
///
/// # Errors
/// If light is scattered, or may be.
fn made_of_transmittance(scene: &SceneSpec, volume: &VolumeSpec) -> Result<(), Failure> {
    if volume.albedo.rgb().iter().any(|albedo| *albedo > 0.0) {
        return Err(Failure::refused(format!(
            "medium.albedo: this scene scatters light, and {ALTERNATIVES}"
        )));
    }
    match scene.integrator {
        IntegratorSpec::Transmittance(_) => Ok(()),
        _ => Err(Failure::refused(format!("integrator.kind: is not transmittance, and {ALTERNATIVES}"))),
    }
}

impl Question {
    pub(super) fn of(arguments: &AdviseArguments, stdin: &mut dyn Read) -> Result<Self, Failure> {
        let library = MediumLibrary::default();
        let question =
            |name: String, input: Option<Input>, spec: &MediumSpec, camera| -> Result<Self, Failure> {
                let (medium, bounds) =
                    spec.kind().build(&library, "medium").map_err(|failure| failure.within(&name))?;
                let &AdviseArguments { rays, seed, majorant, .. } = arguments;
                Ok(Self { name, input, medium, bounds, camera, rays: usize::from(rays), seed, majorant })
            };
        if let Some(file) = &arguments.vdb {
            let volume = Volume::new(file, &arguments.values);
            return question(file.display().to_string(), None, &volume.medium(), None);
        }
        let Some(file) = &arguments.medium else {
            return Err(Failure::refused("advise: give MEDIUM.json or --vdb FILE"));
        };
        let input = Input::read(file, stdin)?;
        let name = input.name();
        let in_file = |failure: Failure| failure.within(&name);
        let value = json::parse(input.text()).map_err(in_file)?;
        if value.get("camera").is_some() {
            let overrides = SceneOverrides { samples_per_pixel: Some(1), seed: Some(arguments.seed) };
            let scene = SceneSpec::parse_in(input.text(), input.folder(), overrides).map_err(in_file)?;
            let volume = scene.medium.as_ref().ok_or_else(|| {
                in_file(Failure::refused("medium: this scene has none, there is nothing to estimate"))
            })?;
            made_of_transmittance(&scene, volume).map_err(in_file)?;
            return question(name, Some(input), &volume.medium, Some(scene.camera));
        }
        let root = Node::root_in(&value, input.folder());
        root.object().and_then(|object| refuse_other("kind", "medium", &object)).map_err(in_file)?;
        let spec = MediumSpec::read(&root).map_err(in_file)?;
        question(name, Some(input), &spec, None)
    }

    /// Provenance of the answer to a question with this `seed`.
    ///
    /// # Errors
    /// If what was read is no JSON.
    pub(super) fn provenance(&self, environment: &Environment, seed: u64) -> Result<Provenance, Failure> {
        match &self.input {
            Some(input) => input.provenance(environment, seed),
            None => Ok(environment.provenance(seed)),
        }
    }

    /// The rays with their truth.
    pub(super) fn rays(&self) -> Result<RaySet, Failure> {
        let in_medium = |failure: Failure| failure.within(&self.name);
        let profiles = match &self.camera {
            Some(camera) => self.camera_rays(camera),
            None => chords(&self.medium, &self.bounds, self.rays, LEAST, named_seed(self.seed, RAYS)),
        }
        .map_err(in_medium)?;
        let majorant = match self.majorant {
            Some(majorant) => majorant,
            None => self.medium.upper_bound().ok_or_else(|| {
                in_medium(Failure::refused(
                    "medium: declares no majorant, which most estimators need; give `majorant` in it, or --majorant",
                ))
            })?,
        };
        let set = if majorant > 0.0 {
            RaySet::of(&self.name, profiles, majorant, Tolerance::to(TOLERANCE)).map_err(in_medium)?
        } else {
            RaySet { name: self.name.clone(), rays: Vec::new(), mean: 0.0 }
        };
        if set.rays.is_empty() {
            return Err(in_medium(Failure::refused(
                "medium: no ray meets anything to speak of, so that every estimator is as good as any other",
            )));
        }
        Ok(set)
    }

    /// Rays through random points of the image that meet the bounds.
    fn camera_rays(&self, camera: &Camera) -> Result<Vec<AnyProfile>, Failure> {
        let mut source = Seeded::new(named_seed(self.seed, RAYS));
        let [columns, rows] = camera.resolution();
        let mut profiles = Vec::new();
        for _ in 0..self.rays * TRIES {
            let pixel =
                [columns, rows].map(|side| ((source.next_uniform() * f64::from(side)) as u32).min(side - 1));
            let line = camera.ray(pixel, [source.next_uniform(), source.next_uniform()]);
            let clip = self
                .bounds
                .clip(line.origin, line.direction, None)
                .map_err(|error| Failure::refused(format!("camera: {error}")))?;
            if let Some(clip) = clip.filter(|clip| clip.length > 0.0) {
                profiles.push(AnyProfile::ray(&self.medium, &clip)?);
            }
            if profiles.len() == self.rays {
                break;
            }
        }
        Ok(profiles)
    }
}
