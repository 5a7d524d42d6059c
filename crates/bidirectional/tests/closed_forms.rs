//! Scenes whose radiance is known.

mod common;

use common::{diffuse, rectangle};
use fairflight_bidirectional::{Bidirectional, Exact, Found, Subpath, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_media::phase::{HenyeyGreenstein, Isotropic};
use fairflight_media::{Bounds, EmptySpace, Homogeneous};
use fairflight_paths::transport::{Emitters, MadeOf, World};
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_scene::surface::Sphere;
use fairflight_scene::{Background, Camera, Lights, Material, Shape, Source, Surface, Surfaces, Volume};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// False alarm of one check; there are about twenty.
const ALPHA: f64 = 1e-4;

fn agrees(name: &str, found: &Moments, expected: f64) {
    let verdict = judge(found, &Reference::exact(expected).with_mild_tails(), ALPHA);
    assert_eq!(verdict.sound, Some(true), "{name}: {}", verdict.reason);
}

#[test]
fn a_furnace_is_equally_bright_in_every_pixel_and_colour() {
    // A closed room that glows as much as it absorbs, with haze that absorbs nothing, a lamp, a mirror and glass in it: 1 everywhere.
    let glow = dvec3(0.3, 0.5, 0.8);
    let material = |emission: DVec3| Material::Diffuse { reflectance: DVec3::ONE - emission };
    let round = |center: DVec3, radius, material, emission| {
        let sphere = Shape::Sphere(Sphere::new(center, radius).unwrap());
        Surface::new(sphere, material, emission).unwrap()
    };
    let lamp = dvec3(0.7, 0.2, 0.4);
    let surfaces = Surfaces::new(vec![
        round(DVec3::ZERO, 1.0, material(glow), glow),
        round(dvec3(0.4, 0.2, 0.3), 0.2, Material::Mirror, DVec3::ZERO),
        round(dvec3(-0.4, -0.2, 0.3), 0.25, Material::Dielectric { ior: 1.5 }, DVec3::ZERO),
        round(dvec3(0.0, 0.4, 0.4), 0.2, material(lamp), lamp),
    ]);
    let lights = Lights { background: Background::dark(), sources: vec![] };
    let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
    let phase = HenyeyGreenstein::new(0.4).unwrap();
    let volume = Volume { medium: Homogeneous::new(0.4).unwrap(), bounds, albedo: DVec3::ONE, phase };
    let world: World<'_, MadeOf<_, _, _, _, Uniform, Regular>> = World::new(&volume, &surfaces, &lights);
    let camera = Camera::new(dvec3(0.0, 0.0, -0.6), DVec3::Z, DVec3::Y, 70.0, [2, 1]).unwrap();
    let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), camera.origin());

    let heuristic = Heuristic::Balance;
    let weigh =
        Weigh { world, camera: &camera, emitters: &emitters, thickness: Exact, heuristic, light_paths: 2.0 };
    let walking = Walking::new(Walk::new(Version::NonTerminating, Uniform::new(0.4).unwrap()));
    let mut integrator = Bidirectional::new(weigh, walking, Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(5));
    let mut moments = [[Moments::new(); 3]; 2];
    for _ in 0..60_000 {
        let mut image = [DVec3::ZERO; 2];
        for pixel in [[0, 0], [1, 0]] {
            integrator.trace_light(&mut light, &mut source);
            let within = [source.next_uniform(), source.next_uniform()];
            let index = |[column, _]: [u32; 2]| column as usize;
            image[index(pixel)] += integrator.radiance(&camera.ray(pixel, within), &light, &mut source);
            integrator.light_image(&light, &mut source, |pixel, value| image[index(pixel)] += value);
        }
        for (moments, found) in moments.iter_mut().zip(image) {
            for (moments, channel) in moments.iter_mut().zip(found.to_array()) {
                moments.push(channel);
            }
        }
    }
    assert_eq!(integrator.truncated(), 0);
    for (pixel, channels) in moments.iter().enumerate() {
        for (channel, moments) in channels.iter().enumerate() {
            agrees(&format!("pixel {pixel}, channel {channel}"), moments, 1.0);
        }
    }
}

/// The part of the light of a square lamp of radiance 1 and half width 1 at the height 2, that a point of a parallel floor receives
/// (Lambert): irradiance/π.
fn received(x: f64, z: f64) -> f64 {
    // Of the rectangle from above the point to a corner, odd in either side.
    let corner = |a: f64, b: f64| {
        let (p, q) = (a.hypot(2.0), b.hypot(2.0));
        (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
    };
    let along = |b: f64| corner(1.0 - x, b) - corner(-1.0 - x, b);
    along(1.0 - z) - along(-1.0 - z)
}

#[test]
fn each_strategy_alone_finds_the_light_of_a_lamp_on_a_floor() {
    let floor = rectangle([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], diffuse(0.5), 0.0);
    let lamp = rectangle([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.0), 1.0);
    let surfaces = Surfaces::new(vec![floor, lamp]);
    let lights = Lights { background: Background::dark(), sources: vec![] };
    let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
    let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
    let world: World<'_, MadeOf<_, _, _, _, Uniform, Regular>> = World::new(&volume, &surfaces, &lights);
    let camera = Camera::new(dvec3(0.6, 1.0, 0.0), dvec3(0.2, 0.0, 0.3), DVec3::Y, 80.0, [1, 1]).unwrap();
    let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), camera.origin());
    // The mean over the pixel by midpoints, whose error is that of their distance squared.
    const NODES: u32 = 200;
    let mut expected = 0.0;
    for (i, j) in (0..NODES).flat_map(|i| (0..NODES).map(move |j| (i, j))) {
        let within = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(NODES));
        let ray = camera.ray([0, 0], within);
        let point = ray.at(-ray.origin.y / ray.direction.y);
        expected += 0.5 * received(point.x, point.z) / f64::from(NODES * NODES);
    }

    let heuristic = Heuristic::Balance;
    let weigh =
        Weigh { world, camera: &camera, emitters: &emitters, thickness: Exact, heuristic, light_paths: 1.0 };
    let walking = Walking::new(Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap()));
    let mut integrator = Bidirectional::new(weigh, walking, Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(11));
    // Unweighted by t, and all of them weighted.
    let mut moments = [Moments::new(); 4];
    for _ in 0..200_000 {
        let mut sums = [0.0; 4];
        integrator.trace_light(&mut light, &mut source);
        let line = camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
        let mut add = |found: Found<f64>| {
            sums[found.strategy.eye as usize - 1] += found.value / found.weight;
            sums[3] += found.value;
        };
        integrator.strategies(&line, &light, &mut source, |_, found| add(found));
        for index in 0..light.steps.len() {
            if let Some((_, found)) = integrator.splat(&light, index, &mut source) {
                add(found);
            }
        }
        moments.iter_mut().zip(sums).for_each(|(moments, sum)| moments.push(sum));
    }
    for (name, moments) in ["t = 1", "t = 2", "t = 3", "weighted"].into_iter().zip(&moments) {
        agrees(name, moments, expected);
    }
}

/// A floor beside a wall, under a point light.
fn floor(wall: Option<Material<f64>>, lights: &[DVec3]) -> (Surfaces<f64>, Lights<f64>) {
    let mut surfaces =
        vec![rectangle([-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.6), 0.0)];
    surfaces
        .extend(wall.map(|wall| rectangle([-1.0, 0.0, -6.0], [0.0, 6.0, 0.0], [0.0, 0.0, 12.0], wall, 0.0)));
    let sources = lights.iter().map(|&at| Source::point(at, 10.0).unwrap()).collect();
    (Surfaces::new(surfaces), Lights { background: Background::dark(), sources })
}

#[test]
fn a_mirror_shows_a_floor_the_image_of_a_point_light_if_that_is_asked_for() {
    let (light, image) = (dvec3(-0.9, 0.5, 0.1), dvec3(-1.1, 0.5, 0.1));
    let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
    let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
    let camera = Camera::new(dvec3(-0.3, 0.9, 0.0), dvec3(-0.4, 0.0, 0.0), DVec3::Z, 45.0, [1, 1]).unwrap();
    let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
    let ray = |source: &mut Seeded| camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);

    let mirrored = floor(Some(Material::Mirror), &[light]);
    let world: World<'_, MadeOf<_, _, _, _, Uniform, Regular>> =
        World::new(&volume, &mirrored.0, &mirrored.1);
    let emitters = Emitters::new(&mirrored.1, &mirrored.0, world.enclosing_ball(), camera.origin());
    for (point_caustics, lights) in [(false, &[light][..]), (true, &[light, image][..])] {
        // Without a mirror, lit by the light and by its image behind the wall.
        let bare = floor(None, lights);
        let mut tracer =
            PathTracer::new(World::new(&volume, &bare.0, &bare.1), walk, Regular, Heuristic::Balance);
        let heuristic = Heuristic::Balance;
        let weigh = Weigh {
            world,
            camera: &camera,
            emitters: &emitters,
            thickness: Exact,
            heuristic,
            light_paths: 1.0,
        };
        let walking = Walking { point_caustics, ..Walking::new(walk) };
        let mut integrator = Bidirectional::new(weigh, walking, Regular);
        let mut light = Subpath::empty();
        let [mut source, mut other] = [1, 2].map(|stream| Seeded::new(derive_seed(9, stream)));
        let (mut unseen, mut scale) = (0, 0.0);
        let samples = 150_000;
        let found: Vec<f64> = (0..samples)
            .map(|_| {
                integrator.trace_light(&mut light, &mut source);
                unseen += u32::from(light.unseen.is_some());
                let mut sum = integrator.radiance(&ray(&mut source), &light, &mut source);
                integrator.light_image(&light, &mut source, |_, value| sum += value);
                let traced = tracer.radiance(&ray(&mut other), &mut other);
                scale += traced / f64::from(samples);
                sum - traced
            })
            .collect();
        let found: Moments = found.into_iter().map(|difference| scale + difference).collect();
        agrees(&format!("point_caustics {point_caustics}"), &found, scale);
        assert_eq!(unseen > 0, !point_caustics);
    }
}
