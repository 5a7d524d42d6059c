//! Rooms and furnaces in which the whole recursion is checked.

use super::rooms::Room;
use crate::checks::paths::LAWFUL;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds, EmptySpace, Homogeneous, Line};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{
    Background, Geometry, Lights, Material, NoSurfaces, Shape, Source, Surface, Surfaces, Volume,
};
use glam::{DVec3, dvec3};

/// Reflectance of walls that glow, with an emission so that the radiance is [`GLOW`].
const REFLECTANCE: f64 = 0.3;
const EMISSION: f64 = 1.0;
/// Radiance of a room whose walls glow, in every direction.
pub(crate) const GLOW: f64 = EMISSION / (1.0 - REFLECTANCE);

pub(crate) fn phase() -> HenyeyGreenstein {
    HenyeyGreenstein::new(0.3).expect(LAWFUL)
}

/// A medium without absorption.
pub(crate) fn haze<M>(medium: M, bounds: Bounds) -> Volume<M, HenyeyGreenstein, f64> {
    Volume { medium, bounds, albedo: 1.0, phase: phase() }
}

pub(crate) fn homogeneous(sigma_t: f64) -> Homogeneous {
    Homogeneous::new(sigma_t).expect(LAWFUL)
}

/// Light from everywhere.
pub(crate) fn environment(constant: f64) -> Lights<f64> {
    Lights { background: Background { constant, maps: Vec::new() }, sources: Vec::new() }
}

/// A point light in the dark.
pub(crate) fn point_light(position: DVec3, power: f64) -> Lights<f64> {
    let sources = vec![Source::point(position, power).expect(LAWFUL)];
    Lights { background: Background::dark(), sources }
}

pub(crate) fn ball(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(center, radius).expect(LAWFUL))
}

pub(crate) fn rectangle(corner: DVec3, u: DVec3, v: DVec3) -> Shape {
    Shape::Rectangle(Rectangle::new(corner, u, v).expect(LAWFUL))
}

pub(crate) fn diffuse(shape: Shape, reflectance: f64, emission: f64) -> Surface<f64> {
    Surface::new(shape, Material::Diffuse { reflectance }, emission).expect(LAWFUL)
}

pub(crate) fn smooth(shape: Shape, material: Material<f64>) -> Surface<f64> {
    Surface::new(shape, material, 0.0).expect(LAWFUL)
}

/// A box of six walls, each of this reflectance and emission.
pub(crate) fn walls(reflectance: f64, emission: f64) -> Vec<Surface<f64>> {
    let (a, b) = (DVec3::splat(-1.0), DVec3::splat(1.0));
    let [x, y, z] = [2.0 * DVec3::X, 2.0 * DVec3::Y, 2.0 * DVec3::Z];
    [(a, x, y), (a, y, z), (a, z, x), (b, -x, -y), (b, -y, -z), (b, -z, -x)]
        .map(|(corner, u, v)| diffuse(rectangle(corner, u, v), reflectance, emission))
        .to_vec()
}

pub(crate) fn eye() -> Line {
    Line { origin: dvec3(0.1, 0.2, -0.3), direction: dvec3(0.3, -0.5, 0.6).normalize() }
}

pub(crate) type Glowing = Room<Surfaces<f64>, Homogeneous, HenyeyGreenstein>;

/// A sphere that glows, haze in all of it.
pub(crate) fn round() -> Glowing {
    Room {
        volume: haze(homogeneous(1.5), Bounds::sphere(DVec3::ZERO, 1.0).expect(LAWFUL)),
        surfaces: Surfaces::new(vec![diffuse(ball(DVec3::ZERO, 1.0), REFLECTANCE, EMISSION)]),
        lights: environment(0.0),
        eye: eye(),
    }
}

/// A ball of haze under an even sky, nothing else.
pub(crate) fn cloud() -> Room<NoSurfaces, Homogeneous, HenyeyGreenstein> {
    Room {
        volume: haze(homogeneous(1.5), Bounds::sphere(DVec3::ZERO, 1.0).expect(LAWFUL)),
        surfaces: NoSurfaces,
        lights: environment(1.0),
        eye: eye(),
    }
}

/// A white floor that the eye looks at and a white ball on it, under an even sky.
pub(crate) fn open<M>(medium: M) -> Room<Surfaces<f64>, M, HenyeyGreenstein> {
    let floor = rectangle(dvec3(-1.0, -0.5, -1.0), 2.0 * DVec3::Z, 2.0 * DVec3::X);
    Room {
        volume: haze(medium, Bounds::sphere(dvec3(0.0, -0.2, 0.1), 0.6).expect(LAWFUL)),
        surfaces: Surfaces::new(vec![
            diffuse(floor, 1.0, 0.0),
            diffuse(ball(dvec3(-0.3, -0.15, 0.3), 0.3), 1.0, 0.0),
        ]),
        lights: environment(1.0),
        eye: eye(),
    }
}

/// The same without a medium.
pub(crate) fn clear() -> Room<Surfaces<f64>, EmptySpace, HenyeyGreenstein> {
    open(EmptySpace)
}

/// The same with a medium, a mirror and a glass ball in it.
pub(crate) fn shiny() -> Room<Surfaces<f64>, Homogeneous, HenyeyGreenstein> {
    let mut room = open(homogeneous(1.5));
    let mut all = Geometry::<f64>::surfaces(&room.surfaces).to_vec();
    all.push(smooth(ball(dvec3(0.35, -0.2, 0.5), 0.2), Material::Mirror));
    all.push(smooth(ball(dvec3(0.25, -0.1, 0.0), 0.15), Material::Dielectric { ior: 1.5 }));
    room.surfaces = Surfaces::new(all);
    room
}

/// Gray walls, a lamp under the ceiling, and smoke by eq. 21 that absorbs.
pub(crate) fn smoky() -> Room<Surfaces<f64>, AnalyticCosine, HenyeyGreenstein> {
    let mut all = walls(0.6, 0.0);
    let lamp = rectangle(dvec3(-0.3, 0.9, -0.3), 0.7 * DVec3::X, 0.7 * DVec3::Z);
    all.push(diffuse(lamp, 0.0, 5.0));
    Room {
        volume: Volume {
            medium: AnalyticCosine::new(3.0).expect(LAWFUL),
            bounds: Bounds::sphere(DVec3::ZERO, 0.85).expect(LAWFUL),
            albedo: 0.8,
            phase: phase(),
        },
        surfaces: Surfaces::new(all),
        lights: environment(0.0),
        eye: eye(),
    }
}
