//! The beam radiance estimate: its expectation is the radiance, smeared out across the ray, and told by quadrature.

#[path = "../../paths/tests/common/mod.rs"]
mod common;

use common::{ALPHA, Made, Scene, diffuse, rectangle};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, Line, Medium, PhaseFunction, Ray};
use fairflight_paths::transport::{MadeOf, World};
use fairflight_paths::{Heuristic, Integrator, PathTracer, RayTransmittance, Uniform, Walk};
use fairflight_photons::{BeamRadiance, NotARadius, PhotonMap, SurfaceLight};
use fairflight_scene::{Background, Lights, Material, Source, Surfaces, Volume};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Reference, judge};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Emitters, Ledger, LightPaths};
use glam::{DVec2, DVec3, dvec3};
use std::f64::consts::{PI, TAU};

const SEEDS: std::ops::Range<u64> = 1..2;

/// The map of one replica.
fn map(scene: &Scene<Homogeneous>, (paths, max_vertices): (u32, u32), source: &mut Seeded) -> PhotonMap<f64> {
    let world = scene.world();
    let emitters = Emitters::new(&scene.lights, &scene.surfaces, world.enclosing_ball(), scene.eye.origin);
    let light_paths = LightPaths::new(world, &emitters, scene.walk).with_max_vertices(max_vertices);
    let mut vpls = Vec::new();
    for _ in 0..paths {
        light_paths.trace(1.0 / f64::from(paths), &mut Ledger::empty(), source, |vpl| vpls.push(vpl));
    }
    PhotonMap::new(vpls)
}

/// Replicas of a check.
const REPLICAS: u64 = 3000;

/// Estimates from maps of their own, each the mean over rays.
fn replicas<const N: usize>(
    scene: &Scene<Homogeneous>,
    how: (u32, u32),
    seed: u64,
    lines: &[Line],
    mut estimate: impl FnMut(&PhotonMap<f64>, &Line, &mut Seeded) -> [f64; N],
) -> [Moments; N] {
    let mut moments = [Moments::new(); N];
    for replica in 0..REPLICAS {
        let mut source = Seeded::new(derive_seed(derive_seed(seed, 9), replica));
        let map = map(scene, how, &mut source);
        let mut sums = [0.0; N];
        for line in lines {
            let found = estimate(&map, line, &mut source);
            sums.iter_mut().zip(found).for_each(|(sum, found)| *sum += found / lines.len() as f64);
        }
        moments.iter_mut().zip(sums).for_each(|(moments, sum)| moments.push(sum));
    }
    moments
}

fn beam<'s>(
    scene: &'s Scene<Homogeneous>,
    map: &'s PhotonMap<f64>,
    radius: f64,
    surfaces: SurfaceLight,
) -> BeamRadiance<'s, Made<Homogeneous>> {
    BeamRadiance::new(scene.world(), (map, radius), scene.walk, Regular, Heuristic::Balance)
        .unwrap()
        .with_surfaces(surfaces)
}

fn holds(name: &str, moments: &Moments, expected: f64) -> Option<bool> {
    let verdict = judge(moments, &Reference::exact(expected).with_mild_tails(), ALPHA);
    // Shown where a test fails.
    println!("{name}: {}", verdict.reason);
    verdict.sound
}

/// A medium that absorbs nothing under a sky of 1, in which a mirror sends the ray aside onto a panel that glows as much as it absorbs: 1
/// everywhere, on both sides of mirror and panel, so that nothing is lost by smearing it out.
fn furnace() -> Scene<Homogeneous> {
    let surfaces = vec![
        rectangle([-1.0, -1.0, 0.0], [2.0, 0.0, 2.0], [0.0, 2.0, 0.0], Material::Mirror, 0.0),
        rectangle([1.5, -1.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.6), 0.4),
    ];
    let bounds = Bounds::aligned_box(DVec3::splat(-2.0), DVec3::splat(2.5)).unwrap();
    let phase = HenyeyGreenstein::new(0.4).unwrap();
    Scene {
        volume: Volume { medium: Homogeneous::new(SIGMA).unwrap(), bounds, albedo: 1.0, phase },
        surfaces: Surfaces::new(surfaces),
        lights: Lights { background: Background { constant: 1.0, maps: vec![] }, sources: vec![] },
        walk: Walk::new(Version::NonTerminating, Uniform::new(SIGMA).unwrap()),
        eye: Line { origin: dvec3(0.0, 0.0, -0.5), direction: DVec3::Z },
    }
}

const SIGMA: f64 = 0.5;

/// Rays beside each other, all of which are as bright.
fn beam_of_rays(eye: &Line) -> Vec<Line> {
    let grid = (0..16).map(|k| 0.2 * dvec3(f64::from(k % 4) - 1.5, f64::from(k / 4) - 1.5, 0.0));
    grid.map(|offset| Line { origin: eye.origin + offset, ..*eye }).collect()
}

#[test]
fn a_furnace_is_equally_bright_but_for_a_twin() {
    let scene = furnace();
    let none = PhotonMap::new([]);
    for seed in SEEDS {
        let found =
            replicas(&scene, (1000, u32::MAX), seed, &beam_of_rays(&scene.eye), |map, line, source| {
                let mut by =
                    |map, radius, surfaces| beam(&scene, map, radius, surfaces).radiance(line, source);
                let path = by(map, 0.4, SurfaceLight::Path);
                let rest = by(&none, 0.4, SurfaceLight::Path);
                // bre_sigma_s_twice: what is scattered is multiplied by σ_s.
                [path, by(map, 0.4, SurfaceLight::Map), SIGMA * (path - rest) + rest]
            });
        let holds = ["path", "map", "twin"].iter().zip(&found).map(|(name, found)| holds(name, found, 1.0));
        assert_eq!(holds.collect::<Vec<_>>(), [Some(true), Some(true), Some(false)]);
    }
}

const LIGHT: DVec3 = dvec3(0.8, 0.0, 2.0);
const POWER: f64 = 10.0;
const THICK: f64 = 0.7;
const ALBEDO: f64 = 0.8;
const LENGTH: f64 = 4.0;

/// A point light beside a ray that ends at a black wall.
fn beside() -> Scene<Homogeneous> {
    let wall = rectangle([-20.0, -20.0, LENGTH], [40.0, 0.0, 0.0], [0.0, 40.0, 0.0], diffuse(0.0), 0.0);
    let bounds = Bounds::aligned_box(DVec3::splat(-20.0), DVec3::splat(20.0)).unwrap();
    let phase = HenyeyGreenstein::new(0.3).unwrap();
    let source = Source::point(LIGHT, POWER).unwrap();
    Scene {
        volume: Volume { medium: Homogeneous::new(THICK).unwrap(), bounds, albedo: ALBEDO, phase },
        surfaces: Surfaces::new(vec![wall]),
        lights: Lights { background: Background::dark(), sources: vec![source] },
        walk: Walk::new(Version::Terminating, Uniform::new(THICK).unwrap()),
        eye: Line { origin: DVec3::ZERO, direction: DVec3::Z },
    }
}

/// Light that is scattered once, by midpoints along the ray and over a disc across it; the ray itself for a radius of 0.
fn smeared(radius: f64) -> f64 {
    let phase = HenyeyGreenstein::new(0.3).unwrap();
    let scattered = |at: DVec3| {
        let offset = at - LIGHT;
        let r = offset.length();
        let arriving = POWER / (4.0 * PI * r * r) * (-THICK * r).exp();
        (-THICK * at.z).exp() * ALBEDO * THICK * phase.eval(-offset.z / r) * arriving
    };
    let (steps, rings, turns) = if radius > 0.0 { (200, 16, 32) } else { (20_000, 1, 1) };
    let mut sum = 0.0;
    for (i, j, k) in (0..steps).flat_map(|i| (0..rings).flat_map(move |j| (0..turns).map(move |k| (i, j, k))))
    {
        let middle = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
        // Rings of equal area.
        let (off, (sin, cos)) = (radius * middle(j, rings).sqrt(), (TAU * middle(k, turns)).sin_cos());
        sum += scattered(dvec3(off * cos, off * sin, LENGTH * middle(i, steps)));
    }
    LENGTH * sum / f64::from(steps * rings * turns)
}

#[test]
fn the_bias_grows_with_the_square_of_the_radius() {
    let truth = smeared(0.0);
    let bias = |radius: f64| smeared(radius) / truth - 1.0;
    // As measured by an independent implementation: 2.4 ± 0.7 % and 8.7 ± 0.4 %.
    assert!(
        (bias(0.2) - 0.024).abs() < 0.015 && (bias(0.4) - 0.087).abs() < 0.01,
        "{} {}",
        bias(0.2),
        bias(0.4)
    );
    assert!((bias(0.2) / bias(0.1) - 4.0).abs() < 0.2, "{} {}", bias(0.2), bias(0.1));
}

/// Rays around the light, all of which are as bright.
fn around() -> Vec<Line> {
    let at = |k: u32| DVec2::from_angle(TAU * f64::from(k) / 16.0) * LIGHT.x;
    let origin = |k| dvec3(LIGHT.x - at(k).x, at(k).y, 0.0);
    (0..16).map(|k| Line { origin: origin(k), direction: DVec3::Z }).collect()
}

#[test]
fn replicas_tell_bias_and_variance_apart() {
    let scene = beside();
    let truth = smeared(0.0);
    const RADII: [f64; 3] = [0.1, 0.2, 0.4];
    for seed in SEEDS {
        let mut single = [Moments::new(); 3];
        let found = replicas(&scene, (1000, 1), seed, &around(), |map, line, source| {
            let found =
                RADII.map(|radius| beam(&scene, map, radius, SurfaceLight::Path).radiance(line, source));
            if line.origin.y == 0.0 {
                single.iter_mut().zip(found).for_each(|(moments, found)| moments.push(found));
            }
            found
        });
        for (radius, found) in RADII.into_iter().zip(&found) {
            assert_eq!(holds(&format!("{radius}"), found, smeared(radius)), Some(true));
        }
        // Against the truth itself it shows.
        assert_eq!(holds("truth", &found[2], truth), Some(false));
        // The variance of one ray falls as 1/r².
        let variances = single.map(|moments| moments.sample_variance().unwrap());
        let quotients = [variances[0] / variances[1], variances[1] / variances[2]];
        assert!(quotients.iter().all(|quotient| (3.0..5.0).contains(quotient)), "{variances:?}");
    }
}

#[derive(Debug)]
struct NothingBetween;

impl<M: Medium> RayTransmittance<M> for NothingBetween {
    fn estimate(&mut self, _ray: &Ray<&M>, _source: &mut impl UniformSource) -> f64 {
        1.0
    }
}

#[test]
fn twins_are_rejected() {
    let scene = beside();
    let radius = 0.2;
    let expected = smeared(radius);
    type Clear = MadeOf<f64, Homogeneous, HenyeyGreenstein, Surfaces<f64>, Uniform, NothingBetween>;
    let clear: World<'_, Clear> = World::new(&scene.volume, &scene.surfaces, &scene.lights);
    for seed in SEEDS {
        let twins = replicas(&scene, (1000, 1), seed, &around(), |map, line, source| {
            // bre_with_next_event: the first order is among the photons.
            let once = PathTracer::new(scene.world(), scene.walk, Regular, Heuristic::Balance);
            let more = once.with_max_vertices(1).radiance(line, source);
            let right = beam(&scene, map, radius, SurfaceLight::Path).radiance(line, source);
            let without =
                BeamRadiance::new(clear, (map, radius), scene.walk, NothingBetween, Heuristic::Balance);
            [right + more, without.unwrap().radiance(line, source), 2.0 * right]
        });
        for (name, twin) in ["next event", "transmittance", "half a disc"].iter().zip(&twins) {
            assert_eq!(holds(name, twin, expected), Some(false));
        }
    }
}

#[test]
fn a_radius_is_positive() {
    let (scene, map) = (beside(), PhotonMap::new([]));
    for found in [0.0, -1.0, f64::INFINITY] {
        let beam = BeamRadiance::new(scene.world(), (&map, found), scene.walk, Regular, Heuristic::Balance);
        assert_eq!(beam.err(), Some(NotARadius { found }));
    }
}

#[test]
fn an_estimate_allocates_nothing() {
    let scene = furnace();
    let mut source = Seeded::new(1);
    let map = map(&scene, (200, u32::MAX), &mut source);
    for surfaces in [SurfaceLight::Path, SurfaceLight::Map] {
        let mut beam = beam(&scene, &map, 0.3, surfaces);
        let allocated = allocation_counter::measure(|| {
            let sum: f64 = (0..100).map(|_| beam.radiance(&scene.eye, &mut source)).sum();
            assert!(sum > 0.0);
        });
        assert_eq!(allocated.count_total, 0);
    }
}

#[test]
fn golden_values() {
    let (scene, mut source) = (furnace(), Seeded::new(1));
    let map = map(&scene, (200, u32::MAX), &mut source);
    let found = [SurfaceLight::Path, SurfaceLight::Map].map(|surfaces| {
        let mut beam = beam(&scene, &map, 0.3, surfaces);
        (0..10).map(|_| beam.radiance(&scene.eye, &mut source)).sum::<f64>()
    });
    for (index, expected) in [3.3467810225866508, 2.048509072508004].into_iter().enumerate() {
        assert!((found[index] / expected - 1.0f64).abs() < 1e-12, "{found:?}");
    }
}
