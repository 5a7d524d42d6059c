//! Small scenes for tests, in which everything can be computed by hand.

use crate::LocalMean;
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, LineThickness};
use fairflight_paths::transport::{Lobe, MadeOf, Vertex, World};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::surface::Rectangle;
use fairflight_scene::{Background, Lights, Material, Shape, Source, Surface, Surfaces, Volume};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Gather, Term, Vpl};
use glam::{DVec3, dvec3};

pub(crate) struct Scene<M> {
    pub(crate) volume: Volume<M, HenyeyGreenstein, f64>,
    pub(crate) surfaces: Surfaces<f64>,
    pub(crate) lights: Lights<f64>,
}

pub(crate) type SceneGather<'s, M> =
    Gather<'s, MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>>;

/// Extinction of the haze \[1/length\].
pub(crate) const SIGMA_T: f64 = 0.5;
pub(crate) const ALBEDO: f64 = 0.75;
/// Reflectance of each surface \[1\].
pub(crate) const REFLECTANCE: f64 = 0.5;

impl<M: LineThickness> Scene<M> {
    pub(crate) fn gather<'s>(&'s self, vpls: &'s [Vpl<f64>], bound: f64) -> SceneGather<'s, M> {
        let world = World::new(&self.volume, &self.surfaces, &self.lights);
        let walk = Walk::new(Version::Terminating, Uniform::new(SIGMA_T).unwrap());
        let (term, heuristic) = (Term::Bounded(bound), Heuristic::Balance);
        Gather { world, vpls, term, heuristic, walk, shadow: Regular }
    }
}

/// σ̄_t that is the same everywhere, whatever the medium is.
pub(crate) fn mean(sigma_t: f64) -> LocalMean {
    LocalMean::of(&Homogeneous::new(sigma_t).unwrap(), &bounds(), [1; 3], 1)
}

fn bounds() -> Bounds {
    Bounds::aligned_box(DVec3::splat(-10.0), DVec3::splat(10.0)).unwrap()
}

fn scene<M>(medium: M, surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<M> {
    let phase = HenyeyGreenstein::new(0.3).unwrap();
    let volume = Volume { medium, bounds: bounds(), albedo: ALBEDO, phase };
    let lights = Lights { background: Background::dark(), sources };
    Scene { volume, surfaces: Surfaces::new(surfaces), lights }
}

pub(crate) fn vacuum(surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<EmptySpace> {
    scene(EmptySpace, surfaces, sources)
}

/// Homogeneous within 10 of the origin along each axis.
pub(crate) fn hazy(surfaces: Vec<Surface<f64>>) -> Scene<Homogeneous> {
    scene(Homogeneous::new(SIGMA_T).unwrap(), surfaces, vec![])
}

/// A wide square across the z axis at the height `z`.
pub(crate) fn square(z: f64, material: Material<f64>) -> Surface<f64> {
    let shape = Rectangle::new(dvec3(-9.0, -9.0, z), 18.0 * DVec3::X, 18.0 * DVec3::Y).unwrap();
    Surface::new(Shape::Rectangle(shape), material, 0.0).unwrap()
}

/// A diffuse floor at 0 and a diffuse ceiling at `height`.
pub(crate) fn room(height: f64) -> Vec<Surface<f64>> {
    [0.0, height].map(|z| square(z, Material::Diffuse { reflectance: REFLECTANCE })).to_vec()
}

/// A vertex of the floor at the origin, facing up.
pub(crate) fn on_floor() -> Vertex {
    Vertex { position: DVec3::ZERO, lobe: Lobe::Diffuse { normal: DVec3::Z, surface: 0 } }
}

pub(crate) fn in_medium(position: DVec3, incident: DVec3) -> Vertex {
    Vertex { position, lobe: Lobe::Phase { incident } }
}
