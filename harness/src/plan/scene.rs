//! A scene whose parts fit together.

use super::rays::rays_of;
use super::{AnyPhase, IntegratorPlan, PixelPoints, surfaces};
use crate::Failure;
use crate::estimator::InScene;
use crate::field::{AnyMedium, MediumLibrary};
use crate::image::Image;
use crate::spec::{
    Collisions, DirectionalSpec, EnvironmentMapSpec, EnvironmentSpec, LightSpec, PointSpec, SceneSpec,
};
use fairflight_media::Bounds;
use fairflight_scene::{Background, Camera, EnvironmentMap, Lights, SceneError, Source, Spectrum, Surfaces};
use glam::DVec3;

/// A scene that can be rendered.
#[derive(Debug)]
pub struct ScenePlan {
    /// The camera.
    pub camera: Camera,
    /// The extinction of the medium.
    pub medium: AnyMedium,
    /// The bounds of the medium.
    pub bounds: Bounds,
    /// The phase function of the medium.
    pub phase: AnyPhase,
    /// Albedo, lights and surfaces, in as many channels as they need.
    pub spectra: Spectra,
    /// The estimator of a pixel.
    pub integrator: IntegratorPlan,
    /// Point sets of each pixel; `None` where samples are independent.
    pub points: Option<PixelPoints>,
    /// Estimates per pixel.
    pub samples_per_pixel: u32,
    /// The seed of all variates.
    pub seed: u64,
}

/// A gray scene carries one channel.
#[derive(Debug)]
pub enum Spectra {
    /// One channel.
    Gray(Radiant<f64>),
    /// Red, green and blue.
    Colour(Radiant<DVec3>),
    /// Red, green and blue, each by itself.
    Separate(Box<[Radiant<f64>; 3]>),
}

/// Albedo, lights and surfaces: the parts of a scene that have a colour.
#[derive(Debug)]
pub struct Radiant<C> {
    /// σ_s/σ_t.
    pub albedo: C,
    /// The lights that are no surfaces.
    pub lights: Lights<C>,
    /// The surfaces, which may emit light.
    pub surfaces: Surfaces<C>,
}

impl ScenePlan {
    /// Builds the parts of a scene; reads the files that it names.
    ///
    /// # Errors
    /// If a file cannot be read, a parameter is not lawful, or the parts do not fit.
    pub fn of(spec: &SceneSpec, library: &MediumLibrary) -> Result<Self, Failure> {
        surfaces::check(spec)?;
        let (medium, bounds) = match &spec.medium {
            Some(volume) => volume.medium.kind().build(library, "medium")?,
            // A point, where nothing can be anyway.
            None => (AnyMedium::Empty, Bounds::sphere(DVec3::ZERO, 0.0).map_err(Failure::refused)?),
        };
        let phase = spec.medium.as_ref().map_or(
            Ok(AnyPhase::Isotropic(fairflight_media::phase::Isotropic)),
            |volume| {
                volume
                    .phase
                    .kind()
                    .build()
                    .map_err(|error| Failure::refused(format!("medium.phase: {error}")))
            },
        )?;
        let maps = read_maps(&spec.lights)?;
        let gray = spec.is_gray() && maps.iter().flatten().all(is_gray);
        let separate = spec.integrator.walk().is_some_and(|walk| walk.colour == Collisions::Separate);
        let channel = |k: usize| Radiant::build(spec, &maps, move |rgb: [f64; 3]| rgb[k]);
        let spectra = if gray {
            Spectra::Gray(channel(0)?)
        } else if separate {
            Spectra::Separate(Box::new([channel(0)?, channel(1)?, channel(2)?]))
        } else {
            Spectra::Colour(Radiant::build(spec, &maps, DVec3::from_array)?)
        };
        let scene = InScene {
            medium: &medium,
            spec: spec.medium.as_ref().map(|volume| &volume.medium),
            bounds: &bounds,
            rays: rays_of(spec, &bounds),
            media: library,
        };
        let integrator = IntegratorPlan::build(&spec.integrator, &scene)?;
        if let IntegratorPlan::Metropolis(plan) = &integrator {
            let pixels = spec.camera.resolution().map(u64::from).iter().product();
            plan.check(pixels, spec.samples_per_pixel)?;
        }
        Ok(Self {
            camera: spec.camera,
            medium,
            bounds,
            phase,
            spectra,
            integrator,
            points: PixelPoints::of(spec)?,
            samples_per_pixel: spec.samples_per_pixel,
            seed: spec.seed,
        })
    }
}

/// The picture of each light that is one.
fn read_maps(lights: &[LightSpec]) -> Result<Vec<Option<Image>>, Failure> {
    let read = |(i, light): (usize, &LightSpec)| match light {
        LightSpec::EnvironmentMap(EnvironmentMapSpec { file }) => {
            Image::read(file).map(Some).map_err(|failure| failure.within(format!("lights.{i}.file")))
        }
        _ => Ok(None),
    };
    lights.iter().enumerate().map(read).collect()
}

fn is_gray(map: &Image) -> bool {
    map.pixels().iter().all(|[r, g, b]| r == g && g == b)
}

impl<C: Spectrum> Radiant<C> {
    /// Builds the parts in the channels that `of` takes of red, green and blue.
    fn build(spec: &SceneSpec, maps: &[Option<Image>], of: impl Fn([f64; 3]) -> C) -> Result<Self, Failure> {
        let albedo = spec.medium.as_ref().map_or(C::ZERO, |volume| of(volume.albedo.rgb()));
        let mut lights = Lights { background: Background::dark(), sources: Vec::new() };
        for (i, (light, map)) in spec.lights.iter().zip(maps).enumerate() {
            let refuse = |error: SceneError| Failure::refused(format!("lights.{i}: {error}"));
            match (light, map) {
                (LightSpec::Environment(EnvironmentSpec { radiance }), _) => {
                    lights.background.constant += of(radiance.rgb());
                }
                (LightSpec::EnvironmentMap(EnvironmentMapSpec { file }), Some(map)) => {
                    let pixels = map.pixels().iter().map(|pixel| of(pixel.map(f64::from)));
                    let map = EnvironmentMap::new(map.width(), map.height(), pixels.collect());
                    let in_file = |error: SceneError| {
                        Failure::refused(format!("lights.{i}.file: {}: {error}", file.display()))
                    };
                    lights.background.maps.push(map.map_err(in_file)?);
                }
                (LightSpec::EnvironmentMap(_), None) => {}
                (LightSpec::Point(PointSpec { position, power }), _) => {
                    let light = Source::point(*position, of(power.rgb()));
                    lights.sources.push(light.map_err(refuse)?);
                }
                (LightSpec::Directional(DirectionalSpec { direction, irradiance }), _) => {
                    let light = Source::directional(*direction, of(irradiance.rgb()));
                    lights.sources.push(light.map_err(refuse)?);
                }
            }
        }
        Ok(Self { albedo, lights, surfaces: surfaces::build(&spec.surfaces, of)? })
    }
}
