//! Integrators that know surfaces: what is common to them, and virtual point lights.

use super::tile_integrator::{AnyIntegrator, Counts, SceneVolume, counting};
use super::{AnyPhase, Radiant, SpaceSampling, WalkPlan};
use crate::Failure;
use crate::estimator::{InScene, Preparation, Shadow, ShadowWorker, Unlawful};
use crate::spec::{ClampSpec, ComponentSpec, TransportSpec, VplSpec};
use fairflight_compensation::{Brightness, Compensation, CompensationOptions, LocalMean};
use fairflight_media::{EmptySpace, LineThickness};
use fairflight_paths::Heuristic;
use fairflight_paths::transport::{Emitters, MadeOf, Types, World};
use fairflight_photons::PhotonMap;
use fairflight_scene::{Camera, Geometry, Lights, Material, NoSurfaces, Spectrum, Surface, Surfaces};
use fairflight_vpl::{Component, Gather, Pairing, Term, Vpl, VplIntegrator};
use std::cell::Cell;

/// Parts of a scene that an integrator meets beside the medium.
#[derive(Debug)]
pub struct Stage<'s, C> {
    /// The lights that are no surfaces.
    pub lights: &'s Lights<C>,
    /// The surfaces, which may emit light.
    pub surfaces: &'s Surfaces<C>,
    /// The camera.
    pub camera: &'s Camera,
    /// All that emits light, from which light paths start.
    pub emitters: &'s Emitters<C>,
    /// The mean radiance of the image so far; `None` before the first pass.
    pub mean: Option<f64>,
    /// Photons, for an integrator that asks them.
    pub map: &'s PhotonMap<C>,
    /// Virtual point lights, for an integrator that gathers from them.
    pub vpls: &'s [Vpl<C>],
    /// The bound of their geometric term.
    pub bound: f64,
    /// Where the first look-up is left that an estimator of transmittance is not defined for.
    pub unlawful: &'s Cell<Option<Unlawful>>,
}

impl<C> Clone for Stage<'_, C> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<C> Copy for Stage<'_, C> {}

/// Flights, connections and weights of paths, with their parameters checked.
#[derive(Debug)]
pub struct TransportPlan {
    /// Flights.
    pub walk: WalkPlan,
    /// Transmittance of connections.
    pub(super) shadow: Shadow,
    pub(super) heuristic: Heuristic,
}

/// Virtual point lights whose parameters are checked.
#[derive(Debug)]
pub struct VplPlan {
    /// The flights and connections of light paths and eye rays.
    pub transport: TransportPlan,
    /// Light paths per set.
    pub light_paths: u32,
    /// Distance from the camera within which all virtual point lights are kept \[length\].
    pub keep_near: Option<f64>,
    /// The bound of the geometric term as given.
    pub clamp: ClampSpec,
    eye_samples: u32,
    compensation: Option<(CompensationOptions, LocalMean)>,
    /// What was looked up for the means.
    pub(super) means: Option<Preparation>,
    component: ComponentSpec,
}

impl TransportPlan {
    pub(super) fn build(spec: &TransportSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        const KEY: &str = "integrator.estimator";
        Ok(Self {
            walk: WalkPlan::build(&spec.walk, scene.medium, scene.bounds)?,
            shadow: match &spec.estimator {
                Some(estimator) => estimator.kind().for_all_rays(scene, KEY)?,
                None => Shadow::default_for(scene, KEY)?,
            },
            heuristic: spec.heuristic,
        })
    }
}

impl VplPlan {
    pub(super) fn build(spec: &VplSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        let cells = spec.local_mean_cells;
        let mut means = None;
        let compensation = spec.compensation.map(|options| {
            // Nothing is looked up where nothing is placed by it.
            let mean = if spec.means().is_some() {
                LocalMean::of(scene.medium, scene.bounds, [cells; 3], VplSpec::PROBES)
            } else {
                LocalMean::of(&EmptySpace, scene.bounds, [1; 3], 1)
            };
            means = spec.means().map(|_| Preparation {
                lookups: mean.lookups(),
                purpose: format!("local means of the extinction in {cells} x {cells} x {cells} cells"),
            });
            (options, mean)
        });
        Ok(Self {
            transport: TransportPlan::build(&spec.transport, scene)?,
            light_paths: spec.light_paths,
            eye_samples: spec.eye_samples,
            clamp: spec.clamp,
            compensation,
            means,
            keep_near: spec.keep_near,
            component: spec.component,
        })
    }
}

impl VplPlan {
    /// The bound of the geometric term in a scene whose emitters have this power together \[1/length²\].
    ///
    /// # Errors
    /// If it is to come from the scene, and nothing there has a radiance.
    pub fn bound<C: Spectrum>(
        &self,
        radiant: &Radiant<C>,
        phase: &AnyPhase,
        power: f64,
    ) -> Result<f64, Failure> {
        match self.clamp {
            ClampSpec::Unclamped => return Ok(f64::INFINITY),
            ClampSpec::Bound(bound) => return Ok(bound),
            ClampSpec::Scene => {}
        }
        let surfaces = Geometry::surfaces(&radiant.surfaces);
        let emitted = surfaces.iter().map(|surface| surface.emission.max_channel()).fold(0.0, f64::max);
        let radiance = emitted.max(radiant.lights.background.greatest());
        if power > 0.0 && radiance == 0.0 {
            return Err(Failure::refused(
                "integrator.clamp: scene needs a light with a radiance, but there are only lights of points and directions; \
                 allowed are a number and null",
            ));
        }
        let reflectance = |surface: &Surface<C>| match surface.material {
            Material::Diffuse { reflectance } => reflectance.max_channel(),
            Material::Mirror | Material::Dielectric { .. } => 0.0,
        };
        let brightness = Brightness {
            radiance,
            power,
            paths: u64::from(self.light_paths),
            reflectance: surfaces.iter().map(reflectance).fold(0.0, f64::max),
            scattering: radiant.albedo.max_channel() * phase.greatest(),
        };
        // Without light any bound will do.
        Ok(if power > 0.0 { brightness.bound() } else { f64::INFINITY })
    }
}

/// The types of a scene that has surfaces of the type G, or [`NoSurfaces`].
pub type Seen<'s, M, C, G> = MadeOf<C, M, &'s AnyPhase, G, SpaceSampling<'s>, ShadowWorker<'s>>;

impl VplPlan {
    pub(super) fn on<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &'s self,
        volume: &'s SceneVolume<'s, M, C>,
        stage: Stage<'s, C>,
    ) -> AnyIntegrator<'s, C> {
        let Stage { lights, surfaces, .. } = stage;
        // One with neither surfaces nor a medium is rare, and needs no code of its own.
        if !M::IS_EMPTY && Geometry::surfaces(surfaces).is_empty() {
            self.among(World::<Seen<'s, M, C, _>>::new(volume, &NoSurfaces, lights), stage)
        } else {
            self.among(World::<Seen<'s, M, C, _>>::new(volume, surfaces, lights), stage)
        }
    }

    fn among<'s, W: Types<Sampling = SpaceSampling<'s>, Shadow = ShadowWorker<'s>> + 's>(
        &'s self,
        world: World<'s, W>,
        stage: Stage<'s, W::Spectrum>,
    ) -> AnyIntegrator<'s, W::Spectrum> {
        let TransportPlan { walk, shadow, heuristic } = &self.transport;
        let (component, term) = match self.component {
            ComponentSpec::All => (Component::All, Term::Bounded(stage.bound)),
            ComponentSpec::Connections => (Component::Connections, Term::Bounded(stage.bound)),
            ComponentSpec::Correction => (Component::Correction, Term::Bounded(stage.bound)),
            ComponentSpec::Lost => (Component::Connections, Term::Excess(stage.bound)),
        };
        let (walk, shadow) = (walk.walk(), shadow.worker(stage.unlawful));
        let gather = Gather { world, vpls: stage.vpls, term, heuristic: *heuristic, walk, shadow };
        let correction = self.compensation.as_ref().map(|(options, mean)| Compensation::new(*options, mean));
        let pairing = correction.as_ref().map_or(Pairing::Every, Compensation::pairing);
        let integrator = VplIntegrator::new(gather, (self.eye_samples, pairing), correction);
        counting(integrator.component(component), |integrator| {
            let (compensation_tried, compensation_inside) =
                integrator.correction().as_ref().map_or((0, 0), Compensation::vertices);
            Counts { compensation_tried, compensation_inside, ..Counts::cut(integrator.truncated()) }
        })
    }
}
