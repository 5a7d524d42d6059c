//! The price that surfaces and medium pay for each other: `cargo bench --bench surfaces` prints ratios of two loops that ran in turn within this run.

use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Line, Medium};
use fairflight_paths::transport::World;
use fairflight_paths::{Heuristic, Integrator, ParticleTracer, PathTracer, Ratio, Uniform, Walk};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{
    Background, Geometry, Lights, Material, NoSurfaces, Shape, Surface, Surfaces, Volume,
};
use fairflight_sources::{Seeded, UniformSource};
use glam::{DVec3, dvec3};
use std::hint::black_box;
use std::time::Instant;

const SIGMA_T: f64 = 0.35;
/// Paths per timed loop.
const RAYS: u64 = 10_000;

type Haze<M> = Volume<M, HenyeyGreenstein, f64>;

fn haze<M>(medium: M) -> Haze<M> {
    let bounds = Bounds::aligned_box(dvec3(-2.5, -1.0, -2.5), dvec3(2.5, 2.0, 2.5)).expect("a box");
    Volume { medium, bounds, albedo: 0.98, phase: HenyeyGreenstein::new(0.3).expect("within ±1") }
}

fn homogeneous() -> Homogeneous {
    Homogeneous::new(SIGMA_T).expect("finite")
}

/// A floor, a wall, three spheres and a lamp.
fn spheres() -> Surfaces<f64> {
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

fn even() -> Lights<f64> {
    Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() }
}

fn walk() -> Walk<Uniform> {
    Walk::new(Version::NonTerminating, Uniform::new(SIGMA_T).expect("positive"))
}

fn time(work: &mut dyn FnMut() -> f64) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// The median ratio of two loops that run in turn.
fn ratio(mut ours: impl FnMut() -> f64, mut theirs: impl FnMut() -> f64) -> f64 {
    let mut ratios: Vec<f64> = (0..41).map(|_| time(&mut ours) / time(&mut theirs)).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

/// Paths from in front of the haze.
fn paths<G: Geometry<f64>, M: Medium>(volume: &Haze<M>, surfaces: &G) -> f64 {
    let lights = even();
    let world = World::new(volume, surfaces, &lights);
    let mut tracer = PathTracer::new(world, walk(), ratio_tracking(), Heuristic::Balance);
    trace(&mut tracer)
}

/// Ratio tracking, so that any medium will do.
fn ratio_tracking() -> Ratio<Uniform> {
    Ratio(Uniform::new(SIGMA_T).expect("positive"))
}

fn trace(tracer: &mut impl Integrator<f64>) -> f64 {
    let mut source = Seeded::new(1);
    let ray = |source: &mut Seeded| {
        let aim = dvec3(source.next_uniform() - 0.5, source.next_uniform() - 0.5, 4.5);
        Line { origin: dvec3(0.0, 0.6, -4.5), direction: aim.normalize() }
    };
    (0..RAYS)
        .map(|_| {
            let line = ray(&mut source);
            tracer.radiance(&line, &mut source)
        })
        .sum()
}

fn main() {
    let (volume, surfaces) = (haze(homogeneous()), spheres());
    let particles = || {
        let lights = even();
        trace(&mut ParticleTracer::new(&volume, &lights, walk()))
    };
    println!(
        "a medium without surfaces: path tracer / particle tracer, which knows none = {:.2}",
        ratio(|| paths(&volume, &NoSurfaces), particles)
    );
    println!(
        "the same / with an empty list of surfaces = {:.2}",
        ratio(|| paths(&volume, &NoSurfaces), || paths(&volume, &Surfaces::new(Vec::new())))
    );
    let (empty, thin) = (haze(EmptySpace), haze(Homogeneous::new(0.0).expect("finite")));
    println!(
        "surfaces without a medium / in a medium of extinction 0 = {:.2}",
        ratio(|| paths(&empty, &surfaces), || paths(&thin, &surfaces))
    );
}
