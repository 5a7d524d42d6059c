//! Small scenes of which every density is a product of a few numbers.

mod common;

use common::{Scene, ball, diffuse, rectangle};
use fairflight_bidirectional::{Bidirectional, Exact, LightEnd, Site, Strategy, Subpath, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Medium, PhaseFunction};
use fairflight_paths::transport::{Emitters, Light};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::{Background, Camera, Lights, Material, Source, Surface, Surfaces, Volume};
use fairflight_sources::Scripted;
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// A floor of reflectance 1/2, seen from (3, 4, 0) by a camera of one pixel, 2 · 2 in size at the distance 1.
fn floor<M: Medium>(medium: M, source: Source<f64>) -> Scene<M> {
    let square = rectangle([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], diffuse(0.5), 0.0);
    scene(medium, vec![square], vec![source])
}

fn scene<M: Medium>(medium: M, surfaces: Vec<Surface<f64>>, sources: Vec<Source<f64>>) -> Scene<M> {
    Scene {
        light_paths_per_pixel: 1.0,
        camera: Camera::new(dvec3(3.0, 4.0, 0.0), DVec3::ZERO, DVec3::Y, 90.0, [1, 1]).unwrap(),
        volume: Volume {
            medium,
            bounds: Bounds::aligned_box(DVec3::splat(-20.0), DVec3::splat(20.0)).unwrap(),
            albedo: 0.8,
            phase: HenyeyGreenstein::new(0.3).unwrap(),
        },
        surfaces: Surfaces::new(surfaces),
        lights: Lights { background: Background::dark(), sources },
        walk: Walk::new(Version::NonTerminating, Uniform::new(0.1).unwrap()),
    }
}

/// What the strategies of the path camera, origin, light find: s = 1, and t = 1 of two light paths.
fn at_origin(scene: &Scene<EmptySpace>, script: &[f64]) -> [(f64, f64); 2] {
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
    let weigh = Weigh { light_paths: 2.0, ..weigh };
    let mut integrator = Bidirectional::new(weigh, Walking::new(scene.walk), Regular);
    let mut light = Subpath::empty();
    // Roulette ends either subpath behind the floor.
    integrator.trace_light(&mut light, &mut Scripted::new([script, &[0.9][..]].concat()));
    assert!((light.steps[0].node.place.position).length() < 1e-14);
    let mut found = Vec::new();
    let line = scene.camera.ray([0, 0], [0.5, 0.5]);
    let mut source = Scripted::new([0.9]);
    integrator.strategies(&line, &Subpath::empty(), &mut source, |_, one| found.push(one));
    let [next_event] = found[..] else { panic!("{found:?}") };
    assert_eq!(next_event.strategy, Strategy { light: 1, eye: 2 });
    let (pixel, splat) = integrator.splat(&light, 0, &mut Scripted::new([])).unwrap();
    assert_eq!((pixel, splat.strategy), ([0, 0], Strategy { light: 2, eye: 1 }));
    [next_event, splat].map(|one| (one.value / one.weight, one.weight))
}

fn near((value, weight): (f64, f64), expected: (f64, f64)) {
    assert!((value / expected.0 - 1.0).abs() < 1e-13, "{value} {expected:?}");
    assert!((weight / expected.1 - 1.0).abs() < 1e-13, "{weight} {expected:?}");
}

/// Per pixel sample, of the origin: cosine 0.8 at the distance 5, of 4 pixel areas of the plane at the distance 1.
const DRAWN: f64 = 0.8 / (25.0 * 4.0);

#[test]
fn a_floor_under_a_point_light() {
    let source = Source::point(dvec3(0.0, 2.0, 0.0), 8.0).unwrap();
    // The light path goes down: a cosine of −1 with the axis z would be u = 1; towards −y it is u = 1/2, v = 3/4.
    let [next_event, splat] = at_origin(&floor(EmptySpace, source), &[0.5, 0.5, 0.75, 0.5, 0.5, 0.5]);
    let lit = 1.0 / (16.0 * PI);
    let sum = DRAWN + 2.0 * lit;
    near(next_event, (0.5 * FRAC_1_PI * 8.0 * lit, DRAWN / sum));
    near(splat, (8.0 * 0.5 * FRAC_1_PI * DRAWN / 2.0, 2.0 * lit / sum));
}

#[test]
fn a_floor_under_parallel_light() {
    let source = Source::directional(DVec3::NEG_Y, 3.0).unwrap();
    let scene = floor(EmptySpace, source);
    // From the middle of the disc that covers the ball about the floor.
    let [next_event, splat] = at_origin(&scene, &[0.5, 0.5, 0.5, 0.5, 0.0, 0.5]);
    let disc = scene.emitters::<Regular>().disc();
    assert!((disc / (PI * 162.0) - 1.0).abs() < 1e-14);
    let sum = DRAWN + 2.0 / disc;
    near(next_event, (0.5 * FRAC_1_PI * 3.0, DRAWN / sum));
    near(splat, (3.0 * disc * 0.5 * FRAC_1_PI * DRAWN / 2.0, 2.0 / disc / sum));
}

#[test]
fn a_collision_has_the_density_of_its_distance() {
    // At the origin in haze of 0.1, lit from (0, 2, 0): sigma_t times the transmittances of 5 and of 2, which belong to one edge each.
    let source = Source::point(dvec3(0.0, 2.0, 0.0), 8.0).unwrap();
    let scene = scene(Homogeneous::new(0.1).unwrap(), vec![], vec![source]);
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let place = weigh.place_in_medium(DVec3::ZERO);
    assert_eq!((place.site, place.survival), (Site::Medium { sigma_t: 0.1 }, 0.8));
    let end = LightEnd::new(&scene.world::<Regular>(), &emitters, Light::Source(0), DVec3::Y);
    let (eye, light) = (weigh.first_of_eye(place), weigh.first_of_light(&end, place));
    assert!((eye.ln_forward - ((0.01f64 * 0.1).ln() - 0.5)).abs() < 1e-14);
    assert!((light.ln_forward - ((0.1 / (16.0 * PI)).ln() - 0.2)).abs() < 1e-14);
    let odds = (eye.ln_forward - light.ln_forward).exp();
    assert!((weigh.at_light(&eye, &end).sampled - odds / (1.0 + odds)).abs() < 1e-14);
    assert!((weigh.light_image(&light) - 1.0 / (1.0 + odds)).abs() < 1e-14);
    assert_eq!(weigh.at_light(&eye, &end).met, 0.0);
}

#[test]
fn three_strategies_of_a_lamp_in_haze() {
    // A lamp of the area 4, two above the origin: chosen with 1/4, met with q p D/r², or from it with D/(2π) on each side.
    let lamp = rectangle([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.0), 1.0);
    let scene = scene(Homogeneous::new(0.1).unwrap(), vec![lamp], vec![]);
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let eye = weigh.first_of_eye(weigh.place_in_medium(DVec3::ZERO));
    let end = LightEnd::new(&scene.world::<Regular>(), &emitters, Light::Surface(0), dvec3(0.0, 2.0, 0.0));
    let (t, phase) = ((-0.2f64).exp(), scene.volume.phase.eval(dvec3(-0.6, -0.8, 0.0).dot(DVec3::Y)));
    let drawn = 0.01 * 0.1 * (-0.5f64).exp();
    let [sampled, met, started] =
        [drawn / 4.0, drawn * 0.8 * phase * t / 4.0, 0.25 / (2.0 * PI) * 0.1 * t / 4.0];
    let sum = sampled + met + started;
    let found = weigh.at_light(&eye, &end);
    assert!((found.sampled - sampled / sum).abs() < 1e-14 && (found.met - met / sum).abs() < 1e-14);
}

#[test]
fn glass_is_passed_with_the_ratio_of_its_indices() {
    let glass = ball(DVec3::ZERO, 1.0, Material::Dielectric { ior: 1.5 }, 0.0);
    let scene = scene(EmptySpace, vec![glass], vec![Source::point(4.0 * DVec3::Z, 1.0).unwrap()]);
    let emitters = scene.emitters::<Regular>();
    let weigh = scene.weigh::<Regular, _>(&emitters, Heuristic::Balance, Exact);
    let ratios = |subpath: &Subpath<f64>| -> Vec<f64> {
        let of = |step: &fairflight_bidirectional::Step<f64>| match step.node.place.site {
            Site::Smooth { ratio, .. } => ratio,
            Site::Medium { .. } | Site::Diffuse { .. } => 0.0,
        };
        subpath.steps.iter().map(of).collect()
    };
    let mut subpath = Subpath::empty();
    let line = scene.camera.ray([0, 0], [0.5, 0.5]);
    let walking = Walking::new(scene.walk);
    // In and out again; reflected; cut.
    weigh.walk_from_eye(&walking, &line, &mut subpath, &mut Scripted::new([0.5, 0.5]));
    let [enter, leave] = ratios(&subpath)[..] else { panic!("{subpath:?}") };
    assert!((enter - 1.5).abs() < 1e-15 && (leave - 1.0 / 1.5).abs() < 1e-15);
    assert!(subpath.escape.is_some() && !subpath.is_cut);
    weigh.walk_from_eye(&walking, &line, &mut subpath, &mut Scripted::new([0.0]));
    assert_eq!(ratios(&subpath), [1.0]);
    let short = Walking { max_vertices: 1, ..walking };
    weigh.walk_from_eye(&short, &line, &mut subpath, &mut Scripted::new([0.5]));
    assert!(subpath.is_cut && subpath.escape.is_none());
    // Straight from a point light it is followed only if that is asked for.
    let down = [0.5, 1.0 - f64::EPSILON, 0.5, 0.5, 0.5, 0.5, 0.5];
    weigh.walk_from_light(&walking, &mut subpath, &mut Scripted::new(down));
    assert_eq!((subpath.steps.len(), subpath.unseen), (0, Some(1.0)));
    let all = Walking { point_caustics: true, ..walking };
    weigh.walk_from_light(&all, &mut subpath, &mut Scripted::new([&down[..], &[0.5]].concat()));
    assert_eq!((subpath.steps.len(), subpath.unseen), (2, None));
}

#[test]
fn nothing_shines_and_nothing_is_there() {
    let scene = scene(EmptySpace, vec![], vec![]);
    let emitters: Emitters<f64> = scene.emitters::<Regular>();
    let weigh = scene.weigh(&emitters, Heuristic::Balance, Exact);
    let mut integrator = Bidirectional::new(weigh, Walking::new(scene.walk), Regular);
    let mut light = Subpath::empty();
    integrator.trace_light(&mut light, &mut Scripted::new([]));
    assert!(light.start.is_none() && light.steps.is_empty());
    let line = scene.camera.ray([0, 0], [0.5, 0.5]);
    assert_eq!(integrator.radiance(&line, &light, &mut Scripted::new([])), 0.0);
}
