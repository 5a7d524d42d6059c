//! Haze over a floor, with spheres in it: the scene of connections and of paths.

use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous};
use fairflight_paths::{Uniform, Walk};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Material, Shape, Surface, Surfaces, Volume};
use glam::{DVec3, dvec3};

/// Extinction of the haze \[1/length\].
pub(super) const SIGMA_T: f64 = 0.35;

pub(super) type Haze<M> = Volume<M, HenyeyGreenstein, f64>;

/// A box of a medium.
pub(super) fn haze<M>(medium: M) -> Haze<M> {
    let bounds = Bounds::aligned_box(dvec3(-2.5, -1.0, -2.5), dvec3(2.5, 2.0, 2.5)).expect("a box");
    Volume { medium, bounds, albedo: 0.98, phase: HenyeyGreenstein::new(0.3).expect("within ±1") }
}

pub(super) fn homogeneous(sigma_t: f64) -> Homogeneous {
    Homogeneous::new(sigma_t).expect("finite")
}

/// A floor, a wall, three spheres and a lamp.
pub(super) fn spheres() -> Surfaces<f64> {
    let diffuse = Material::Diffuse { reflectance: 0.6 };
    let surface = |shape, emission| Surface::new(shape, diffuse, emission).expect("lawful");
    let rectangle = |corner, u, v| Shape::Rectangle(Rectangle::new(corner, u, v).expect("not flat"));
    let sphere = |center, radius| Shape::Sphere(Sphere::new(center, radius).expect("not empty"));
    Surfaces::new(vec![
        surface(rectangle(dvec3(-2.5, -1.0, -2.5), 5.0 * DVec3::X, 5.0 * DVec3::Z), 0.0),
        surface(rectangle(dvec3(-2.5, -1.0, 2.5), 5.0 * DVec3::X, 3.0 * DVec3::Y), 0.0),
        surface(sphere(dvec3(-0.95, -0.4, 0.4), 0.6), 0.0),
        surface(sphere(dvec3(0.15, -0.55, -0.5), 0.45), 0.0),
        surface(sphere(dvec3(1.15, -0.4, 0.3), 0.6), 0.0),
        surface(sphere(dvec3(0.2, 1.5, 0.2), 0.25), 30.0),
    ])
}

/// Flights at the extinction of the haze.
pub(super) fn walk() -> Walk<Uniform> {
    Walk::new(Version::NonTerminating, Uniform::new(SIGMA_T).expect("positive"))
}
