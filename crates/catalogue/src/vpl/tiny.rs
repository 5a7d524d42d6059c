//! Small scenes for [`Local`], one for each kind of pair of vertices.

use super::local::Local;
use crate::checks::paths::LAWFUL;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous};
use fairflight_paths::transport::{Lobe, Vertex};
use fairflight_scene::surface::Rectangle;
use fairflight_scene::{Background, Lights, Material, Shape, Source, Surface, Surfaces, Volume};
use fairflight_vpl::Vpl;
use glam::{DVec3, dvec3};

/// σ_t of the tiny scenes \[1/length\].
pub(crate) const SIGMA_T: f64 = 4.0;
/// d = 1/2, two mean free paths: most vertices lie within the region, and the estimates have mild tails.
const BOUND: f64 = 4.0;
const REFLECTANCE: f64 = 0.7;
const MEAN_COSINE: f64 = 0.4;

/// A point of the medium.
fn in_medium(position: DVec3, incident: DVec3) -> Vertex {
    Vertex { position, lobe: Lobe::Phase { incident: incident.normalize() } }
}

/// A point of the rectangle `surface`.
fn on(surface: usize, normal: DVec3, position: DVec3) -> Vertex {
    Vertex { position, lobe: Lobe::Diffuse { normal, surface } }
}

fn light(vertex: Vertex, power: f64) -> Vpl<f64> {
    Vpl { vertex, incident: DVec3::NEG_Z, power, bounce: 1 }
}

/// A scene without surfaces yet.
fn scene(sigma_t: f64, y: Vertex, vpls: Vec<Vpl<f64>>) -> Local {
    Local {
        volume: Volume {
            medium: Homogeneous::new(sigma_t).expect(LAWFUL),
            // A medium that is none lies elsewhere, so that nothing is placed in it.
            bounds: Bounds::sphere(if sigma_t > 0.0 { DVec3::ZERO } else { 90.0 * DVec3::Y }, 20.0)
                .expect(LAWFUL),
            albedo: 0.9,
            phase: HenyeyGreenstein::new(MEAN_COSINE).expect(LAWFUL),
        },
        mean_cosine: MEAN_COSINE,
        surfaces: Surfaces::new(Vec::new()),
        lights: Lights {
            background: Background::dark(),
            sources: vec![Source::point(dvec3(0.5, 0.6, 0.5), 15.0).expect(LAWFUL)],
        },
        vpls,
        y,
        bound: BOUND,
    }
}

fn with(scene: Local, rectangles: &[Rectangle]) -> Local {
    let material = Material::Diffuse { reflectance: REFLECTANCE };
    let all =
        rectangles.iter().map(|&shape| Surface::new(Shape::Rectangle(shape), material, 0.0).expect(LAWFUL));
    Local { surfaces: Surfaces::new(all.collect()), ..scene }
}

/// The plane z = 0 as far as anybody sees.
fn floor() -> Rectangle {
    Rectangle::new(dvec3(-5.0, -5.0, 0.0), 10.0 * DVec3::X, 10.0 * DVec3::Y).expect(LAWFUL)
}

/// The plane x = −0.1.
fn wall() -> Rectangle {
    Rectangle::new(dvec3(-0.1, -5.0, 0.0), 10.0 * DVec3::Y, 10.0 * DVec3::Z).expect(LAWFUL)
}

/// Everything in the medium, one light or two.
pub(crate) fn medium(lights: usize) -> Local {
    let near = light(in_medium(dvec3(0.2, 0.1, 0.25), DVec3::X), 1.0);
    let far = light(in_medium(dvec3(-0.35, 0.3, -0.2), dvec3(0.0, 1.0, 1.0)), 0.6);
    let mut vpls = vec![near, far];
    vpls.truncate(lights);
    scene(SIGMA_T, in_medium(DVec3::ZERO, dvec3(0.3, 0.2, 1.0)), vpls)
}

/// The same with an isotropic medium.
pub(crate) fn isotropic(lights: usize) -> Local {
    isotropically(medium(lights))
}

/// [`above_floor`] with an isotropic medium.
pub(crate) fn isotropic_above_floor() -> Local {
    isotropically(above_floor())
}

fn isotropically(mut scene: Local) -> Local {
    scene.mean_cosine = 0.0;
    scene.volume.phase = HenyeyGreenstein::new(0.0).expect(LAWFUL);
    scene
}

/// The point on a floor, both lights in the medium.
pub(crate) fn above_floor() -> Local {
    let vpls = vec![
        light(in_medium(dvec3(0.1, 0.1, 0.3), DVec3::X), 1.0),
        light(in_medium(dvec3(-0.3, 0.3, 0.15), DVec3::Y), 0.6),
    ];
    with(scene(SIGMA_T, on(0, DVec3::Z, DVec3::ZERO), vpls), &[floor()])
}

/// The point in the medium above a floor, one light on it.
pub(crate) fn near_floor(sigma_t: f64) -> Local {
    let vpls = vec![
        light(on(0, DVec3::Z, dvec3(0.25, 0.1, 0.0)), 1.0),
        light(in_medium(dvec3(-0.3, 0.1, 0.35), DVec3::Y), 0.6),
    ];
    with(scene(sigma_t, in_medium(dvec3(0.0, 0.0, 0.2), -DVec3::Z), vpls), &[floor()])
}

/// The point on a floor beside a wall, one light on each of them, and a medium between, or nothing.
pub(crate) fn corner(sigma_t: f64) -> Local {
    let vpls = vec![
        light(on(1, DVec3::X, dvec3(-0.1, 0.05, 0.2)), 1.0),
        light(on(0, DVec3::Z, dvec3(0.1, -0.1, 0.0)), 0.6),
    ];
    with(scene(sigma_t, on(0, DVec3::Z, DVec3::ZERO), vpls), &[floor(), wall()])
}
