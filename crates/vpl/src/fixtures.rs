//! Small scenes for tests, in which everything can be computed by hand.

use crate::{Gather, Term, Vpl};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, LineThickness};
use fairflight_paths::transport::{Lobe, MadeOf, Vertex, World};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Background, Lights, Material, Shape, Source, Spectrum, Surface, Surfaces, Volume};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};

/// The parts of a [`World`].
pub(crate) struct Scene<M, C> {
    pub(crate) volume: Volume<M, HenyeyGreenstein, C>,
    pub(crate) surfaces: Surfaces<C>,
    pub(crate) lights: Lights<C>,
}

/// The types of a scene.
pub(crate) type Hazy<M, C> = MadeOf<C, M, HenyeyGreenstein, Surfaces<C>, Uniform, Regular>;

impl<M: LineThickness, C: Spectrum> Scene<M, C> {
    pub(crate) fn world(&self) -> World<'_, Hazy<M, C>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }
}

impl<M: LineThickness> Scene<M, f64> {
    pub(crate) fn gather<'s>(&'s self, vpls: &'s [Vpl<f64>], term: Term) -> Gather<'s, Hazy<M, f64>> {
        let (world, heuristic) = (self.world(), Heuristic::Balance);
        Gather { world, vpls, term, heuristic, walk: walk(), shadow: Regular }
    }
}

/// Flights by the extinction of the haze itself.
pub(crate) fn walk() -> Walk<Uniform> {
    Walk::new(Version::Terminating, Uniform::new(0.5).unwrap())
}

fn scene<M, C: Spectrum>(medium: M, surfaces: Vec<Surface<C>>, sources: Vec<Source<C>>) -> Scene<M, C> {
    let bounds = Bounds::aligned_box(DVec3::splat(-10.0), DVec3::splat(10.0)).unwrap();
    let phase = HenyeyGreenstein::new(0.3).unwrap();
    let volume = Volume { medium, bounds, albedo: C::splat(0.5), phase };
    let lights = Lights { background: Background::dark(), sources };
    Scene { volume, surfaces: Surfaces::new(surfaces), lights }
}

pub(crate) fn vacuum<C: Spectrum>(
    surfaces: Vec<Surface<C>>,
    sources: Vec<Source<C>>,
) -> Scene<EmptySpace, C> {
    scene(EmptySpace, surfaces, sources)
}

/// Extinction 1/2 and albedo 1/2 within 10 of the origin along each axis.
pub(crate) fn hazy(surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<Homogeneous, f64> {
    scene(Homogeneous::new(0.5).unwrap(), surfaces, sources)
}

/// A square of the edge 2·`half` about the z axis at the height `z`; its outer side is up.
pub(crate) fn square<C: Spectrum>(z: f64, half: f64, material: Material<C>, emission: C) -> Surface<C> {
    let corner = dvec3(-half, -half, z);
    let shape = Rectangle::new(corner, 2.0 * half * DVec3::X, 2.0 * half * DVec3::Y).unwrap();
    Surface::new(Shape::Rectangle(shape), material, emission).unwrap()
}

pub(crate) fn ball<C: Spectrum>(
    center: DVec3,
    radius: f64,
    material: Material<C>,
    emission: C,
) -> Surface<C> {
    Surface::new(Shape::Sphere(Sphere::new(center, radius).unwrap()), material, emission).unwrap()
}

pub(crate) fn diffuse<C>(reflectance: C) -> Material<C> {
    Material::Diffuse { reflectance }
}

pub(crate) fn on_surface(position: DVec3, normal: DVec3, surface: usize) -> Vertex {
    Vertex { position, lobe: Lobe::Diffuse { normal, surface } }
}

pub(crate) fn in_medium(position: DVec3, incident: DVec3) -> Vertex {
    Vertex { position, lobe: Lobe::Phase { incident } }
}

pub(crate) fn vpl(vertex: Vertex, power: f64) -> Vpl<f64> {
    Vpl { vertex, incident: DVec3::NEG_Z, power, bounce: 1 }
}
