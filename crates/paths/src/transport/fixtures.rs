//! Small scenes for tests, in which everything can be computed by hand.

use super::{MadeOf, World};
use crate::Uniform;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Line, LineThickness};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Background, Lights, Material, Segment, Shape, Source, Surface, Surfaces, Volume};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};

/// The parts of a [`World`].
pub(crate) struct Scene<M> {
    pub(crate) volume: Volume<M, HenyeyGreenstein, f64>,
    pub(crate) surfaces: Surfaces<f64>,
    pub(crate) lights: Lights<f64>,
}

/// Albedo of the medium of [`hazy`].
pub(crate) const ALBEDO: f64 = 0.5;

/// The world of a scene.
type SceneWorld<'s, M> = World<'s, MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>>;

impl<M: LineThickness> Scene<M> {
    pub(crate) fn world(&self) -> SceneWorld<'_, M> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }
}

fn scene<M>(medium: M, surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<M> {
    let bounds = Bounds::aligned_box(DVec3::splat(-10.0), DVec3::splat(10.0)).unwrap();
    let volume = Volume { medium, bounds, albedo: ALBEDO, phase: HenyeyGreenstein::new(0.3).unwrap() };
    let lights = Lights { background: Background::dark(), sources };
    Scene { volume, surfaces: Surfaces::new(surfaces), lights }
}

pub(crate) fn vacuum(surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<EmptySpace> {
    scene(EmptySpace, surfaces, sources)
}

/// Homogeneous within 10 of the origin along each axis.
pub(crate) fn hazy(
    sigma_t: f64,
    surfaces: Vec<Surface<f64>>,
    sources: Vec<Source<f64>>,
) -> Scene<Homogeneous> {
    scene(Homogeneous::new(sigma_t).unwrap(), surfaces, sources)
}

/// A square of the edge 2·`half` about the z axis at the height `z`; its outer side is up.
pub(crate) fn square(z: f64, half: f64, material: Material<f64>, emission: f64) -> Surface<f64> {
    let corner = dvec3(-half, -half, z);
    let shape = Rectangle::new(corner, 2.0 * half * DVec3::X, 2.0 * half * DVec3::Y).unwrap();
    Surface::new(Shape::Rectangle(shape), material, emission).unwrap()
}

pub(crate) fn ball(center: DVec3, radius: f64, material: Material<f64>, emission: f64) -> Surface<f64> {
    Surface::new(Shape::Sphere(Sphere::new(center, radius).unwrap()), material, emission).unwrap()
}

pub(crate) fn diffuse(reflectance: f64) -> Material<f64> {
    Material::Diffuse { reflectance }
}

/// An endless ray from a point in space.
pub(crate) fn ray(origin: DVec3, direction: DVec3) -> Segment {
    let line = Line { origin, direction: direction.normalize() };
    Segment { line, length: f64::INFINITY, from: None, to: None }
}
