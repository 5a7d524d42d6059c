//! Checks of maps from two variates: each draw has the density that is stated.

use super::{Check, LAWFUL, check};
use fairflight_laws::CheckResult;
use fairflight_laws::exact::decisions::expectation;
use fairflight_laws::exact::densities::{GRANTED, deviation};
use fairflight_laws::exact::{agree, greatest};
use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh, Schlick};
use fairflight_media::{Line, PhaseFunction};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Background, Camera, EnvironmentMap, Lights, Shape, Source, cosine_hemisphere};
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// Directions that no axis favours, and both poles.
const AXES: [DVec3; 4] = [DVec3::Z, DVec3::NEG_Z, dvec3(0.6, -0.48, 0.64), dvec3(-0.36, 0.48, -0.8)];

pub(super) fn checks() -> Vec<Check> {
    let shape = |name: &str, shape: Shape| {
        check(&format!("density/points of a {name}"), "points of a surface", "none", move || {
            let density = 1.0 / shape.area();
            agree(deviation(|u, v| Some(shape.sample_area(u, v).position), |_| density), GRANTED)
        })
    };
    let towards = |name: &str, shape: Shape, point: DVec3| {
        check(&format!("density/towards a {name}"), "directions towards a surface", "none", move || {
            seen(&shape, point)
        })
    };
    vec![
        phase("isotropic", Isotropic),
        phase("rayleigh", Rayleigh),
        phase("henyey_greenstein 0.5", HenyeyGreenstein::new(0.5).expect(LAWFUL)),
        phase("henyey_greenstein -0.8", HenyeyGreenstein::new(-0.8).expect(LAWFUL)),
        phase("schlick 0.7", Schlick::new(0.7).expect(LAWFUL)),
        check("density/cosine", "directions about a normal", "none", || {
            let of = |axis: DVec3| {
                let density = move |direction: DVec3| direction.dot(axis) * FRAC_1_PI;
                deviation(move |u, v| Some(cosine_hemisphere(axis, u, v)), density)
            };
            agree(greatest(AXES.map(of)), GRANTED)
        }),
        shape("rectangle", rectangle()),
        shape("sphere", sphere()),
        towards("rectangle", rectangle(), dvec3(-0.4, 1.7, 0.6)),
        towards("sphere", sphere(), dvec3(2.5, -1.0, 0.3)),
        towards("near sphere", sphere(), dvec3(1.2, 0.1, 0.3)),
        towards("sphere from inside", sphere(), dvec3(0.2, 0.1, 0.25)),
        check("density/environment map", "directions of an environment map", "none", pixels),
        check("density/photons", "photons of lights", "none", photons),
        check("density/camera", "rays through a pixel", "none", camera),
    ]
}

fn rectangle() -> Shape {
    let edges = (dvec3(2.0, 0.0, 0.5), dvec3(-0.25, 1.5, 1.0));
    Shape::Rectangle(Rectangle::new(dvec3(0.3, -0.2, 1.0), edges.0, edges.1).expect(LAWFUL))
}

fn sphere() -> Shape {
    Shape::Sphere(Sphere::new(dvec3(0.1, -0.3, 0.2), 0.9).expect(LAWFUL))
}

fn phase(name: &str, phase: impl PhaseFunction + Send + Sync + 'static) -> Check {
    check(&format!("density/{name}"), "phase function", "any", move || {
        let of = |axis: DVec3| {
            deviation(
                |u, v| Some(phase.sample(axis, u, v).direction),
                |direction| phase.eval(direction.dot(axis)),
            )
        };
        agree(greatest(AXES.map(of)), GRANTED)
    })
}

fn seen(shape: &Shape, point: DVec3) -> CheckResult {
    let density = |direction: DVec3| {
        let met = shape.intersect(&Line { origin: point, direction }, f64::INFINITY, false);
        met.map_or(f64::NAN, |distance| shape.pdf_towards(point, direction, distance))
    };
    let map = |u, v| shape.sample_towards(point, u, v).map(|sample| sample.direction);
    agree(deviation(map, density), GRANTED)
}

/// **Law.** A pixel is the mean over its area: the importance of a point, times its distance squared, is the density per solid angle of the
/// rays through the pixel.
fn camera() -> CheckResult {
    let (origin, distance) = (dvec3(1.0, 2.0, 3.0), 7.0);
    let camera =
        Camera::new(origin, dvec3(-4.0, 0.5, 9.0), dvec3(0.1, 1.0, 0.3), 65.0, [4, 3]).expect(LAWFUL);
    let density = |direction: DVec3| {
        let seen = camera.project(origin + distance * direction);
        seen.map_or(f64::NAN, |seen| seen.importance * distance * distance)
    };
    let of = |pixel| deviation(|u, v| Some(camera.ray(pixel, [u, v]).direction), density);
    agree(greatest([[0, 0], [2, 1], [3, 2]].map(of)), GRANTED)
}

/// A map of pixels that all differ.
fn map() -> EnvironmentMap<f64> {
    EnvironmentMap::new(5, 3, (1..=15).map(|i| f64::from(7 * i % 16)).collect()).expect(LAWFUL)
}

/// **Law.** Within each pixel the density is that of the map of the other two variates, times the probability of the pixel, found from
/// the decision itself.
fn pixels() -> CheckResult {
    let map = map();
    let of = |&radiance: &f64| {
        let is_this = |choice: f64| map.sample(choice, 0.5, 0.5).is_some_and(|(_, found)| found == radiance);
        // All variates of a pixel are neighbours: one of them is found where the sum begins.
        let probability = expectation(|choice| if is_this(choice) { 1.0 } else { 0.0 });
        let Some(choice) = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).find(|&choice| is_this(choice))
        else {
            return f64::NAN;
        };
        deviation(
            |u, v| map.sample(choice, u, v).map(|(direction, _)| direction),
            |direction| map.pdf_solid_angle(direction) / probability,
        )
    };
    agree(greatest(map.pixels().iter().map(of)), GRANTED)
}

/// **Law.** Photons leave a point in all directions alike, and a far light through all points of the disc alike; the power that one
/// carries is that of its light.
fn photons() -> CheckResult {
    let (center, radius) = (dvec3(1.0, -2.0, 0.5), 1.5);
    let disc = PI * radius * radius;
    let map = map();
    let far = map.flux() * disc;
    let lights = Lights {
        background: Background { constant: 0.7, maps: vec![map] },
        sources: vec![
            Source::point(DVec3::ONE, 3.0).expect(LAWFUL),
            Source::directional(dvec3(0.6, -0.48, 0.64), 2.0).expect(LAWFUL),
        ],
    };
    let emit = |index: usize, u: [f64; 5]| lights.emit(index, (center, radius), u);
    let direction = |index: usize| {
        deviation(|u, v| Some(emit(index, [u, v, 0.3, 0.4, 0.6])?.direction), |_| 1.0 / (4.0 * PI))
    };
    let origin =
        |index: usize| deviation(|u, v| Some(emit(index, [0.4, 0.7, 0.3, u, v])?.origin), |_| 1.0 / disc);
    let powers = [4.0 * PI * 0.7 * disc, far, 3.0, 2.0 * disc];
    let power = |(index, right): (usize, f64)| {
        let carried = emit(index, [0.4, 0.7, 0.3, 0.4, 0.6]).map_or(f64::NAN, |photon| photon.power);
        (carried / right - 1.0).abs().max((lights.power(index, radius) / right - 1.0).abs())
    };
    let deviations = [direction(0), direction(2), origin(0), origin(1), origin(3)];
    agree(greatest(deviations.into_iter().chain(powers.into_iter().enumerate().map(power))), GRANTED)
}
