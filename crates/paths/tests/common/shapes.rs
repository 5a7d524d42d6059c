//! Surfaces by their numbers alone.

use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Material, Shape, Surface};
use glam::DVec3;

pub fn diffuse(reflectance: f64) -> Material<f64> {
    Material::Diffuse { reflectance }
}

pub fn rectangle(
    corner: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    material: Material<f64>,
    emission: f64,
) -> Surface<f64> {
    let shape = Rectangle::new(corner.into(), u.into(), v.into()).unwrap();
    Surface::new(Shape::Rectangle(shape), material, emission).unwrap()
}

pub fn ball(center: DVec3, radius: f64, material: Material<f64>, emission: f64) -> Surface<f64> {
    Surface::new(Shape::Sphere(Sphere::new(center, radius).unwrap()), material, emission).unwrap()
}
