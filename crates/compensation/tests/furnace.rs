//! A closed room whose walls glow is equally bright everywhere: emission/(1 − reflectance), whatever scatters inside without
//! absorbing. Path tracing, unbounded virtual point lights, and bounded ones with every unbiased correction must say so.

use fairflight_collision::Version;
use fairflight_compensation::{
    Compensation, CompensationOptions, LocalMean, Placement, Strategy, Visibility,
};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, Line};
use fairflight_paths::transport::World;
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_scene::surface::{Rectangle, Sphere};
use fairflight_scene::{Background, Lights, Material, Shape, Surface, Surfaces, Volume};
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Term, VplIntegrator};
use glam::{DVec3, dvec3};

type Room = (Volume<Homogeneous, HenyeyGreenstein, f64>, Surfaces<f64>, Lights<f64>);

const REFLECTANCE: f64 = 0.5;
const EMISSION: f64 = 1.0;
const RADIANCE: f64 = EMISSION / (1.0 - REFLECTANCE);

fn volume(sigma_t: f64, bounds: Bounds) -> Volume<Homogeneous, HenyeyGreenstein, f64> {
    Volume {
        medium: Homogeneous::new(sigma_t).unwrap(),
        bounds,
        albedo: 1.0,
        phase: HenyeyGreenstein::new(0.3).unwrap(),
    }
}

fn dark() -> Lights<f64> {
    Lights { background: Background::dark(), sources: Vec::new() }
}

fn glowing(shape: Shape) -> Surface<f64> {
    Surface::new(shape, Material::Diffuse { reflectance: REFLECTANCE }, EMISSION).unwrap()
}

/// A sphere of radius 1.
fn round(sigma_t: f64) -> Room {
    let walls = vec![glowing(Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap()))];
    (volume(sigma_t, Bounds::sphere(DVec3::ZERO, 1.0).unwrap()), Surfaces::new(walls), dark())
}

/// A box of rectangles, haze in its lower half.
fn square(sigma_t: f64) -> Room {
    let rectangle = |corner, u, v| glowing(Shape::Rectangle(Rectangle::new(corner, u, v).unwrap()));
    let (a, b) = (DVec3::splat(-1.0), DVec3::splat(1.0));
    let [x, y, z] = [2.0 * DVec3::X, 2.0 * DVec3::Y, 2.0 * DVec3::Z];
    let walls = vec![
        rectangle(a, x, y),
        rectangle(a, y, z),
        rectangle(a, z, x),
        rectangle(b, -x, -y),
        rectangle(b, -y, -z),
        rectangle(b, -z, -x),
    ];
    let bounds = Bounds::aligned_box(a, dvec3(1.0, 0.0, 1.0)).unwrap();
    (volume(sigma_t, bounds), Surfaces::new(walls), dark())
}

/// Mean over replicas of the set and z against the radiance.
fn z_of(replicas: &[f64]) -> (f64, f64) {
    let n = replicas.len() as f64;
    let mean = replicas.iter().sum::<f64>() / n;
    let variance = replicas.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (mean - RADIANCE) / (variance / n).sqrt().max(1e-12))
}

fn eye() -> Line {
    Line { origin: dvec3(0.1, 0.2, -0.3), direction: dvec3(0.3, -0.5, 0.6).normalize() }
}

const REPLICAS: u64 = 64;
const RAYS: u32 = 10;

fn by_paths(room: &Room, seed: u64) -> f64 {
    let world = World::new(&room.0, &room.1, &room.2);
    let walk = Walk::new(Version::NonTerminating, Uniform::new(3.0).unwrap());
    let mut tracer = PathTracer::new(world, walk, Regular, Heuristic::Balance);
    let mut source = Seeded::new(seed);
    (0..RAYS).map(|_| tracer.radiance(&eye(), &mut source)).sum::<f64>() / f64::from(RAYS)
}

fn by_lights(room: &Room, bound: f64, options: Option<CompensationOptions>, seed: u64) -> f64 {
    let world = World::new(&room.0, &room.1, &room.2);
    let walk = Walk::new(Version::NonTerminating, Uniform::new(3.0).unwrap());
    let emitters = Emitters::new(&room.2, &room.1, world.enclosing_ball(), eye().origin);
    let paths = LightPaths::new(world, &emitters, walk);
    let mut source = Seeded::new(seed);
    let (mut vpls, mut ledger) = (Vec::new(), Ledger::empty());
    for _ in 0..10 {
        paths.trace(0.1, &mut ledger, &mut source, |vpl| vpls.push(vpl));
    }
    let term = Term::Bounded(bound);
    let gather = Gather { world, vpls: &vpls, term, heuristic: Heuristic::Balance, walk, shadow: Regular };
    let mean = LocalMean::of(&room.0.medium, &room.0.bounds, [4; 3], 2);
    let options = options.unwrap_or(CompensationOptions { steps: Some(0), ..CompensationOptions::EXACT });
    let correction = Compensation::new(options, &mean);
    let pairing = correction.pairing();
    let mut integrator = VplIntegrator::new(gather, (4, pairing), correction);
    let mut sum = 0.0;
    let allocated = allocation_counter::measure(|| {
        sum = (0..RAYS).map(|_| integrator.radiance(&eye(), &mut source)).sum::<f64>();
    });
    assert_eq!(allocated.count_total, 0, "a ray, its connections and its compensation allocate nothing");
    sum / f64::from(RAYS)
}

#[test]
fn the_counter_of_allocations_counts() {
    let allocated = allocation_counter::measure(|| drop(std::hint::black_box(vec![1])));
    assert_eq!(allocated.count_total, 1);
}

#[test]
fn paths_find_the_radiance_of_the_furnace() {
    for room in [round(0.0), round(2.0), square(0.0), square(3.0)] {
        let (mean, z) = z_of(&(0..REPLICAS).map(|k| by_paths(&room, k)).collect::<Vec<_>>());
        assert!(z.abs() < 5.0, "{mean}, z = {z}");
    }
}

/// A bound that takes half of the light away.
const BOUND: f64 = 2.0;

#[test]
fn bounded_lights_and_their_compensation_add_up() {
    for room in [round(2.0), square(0.0), square(3.0)] {
        let unbiased = CompensationOptions::EXACT;
        for strategy in [Strategy::OneToMany, Strategy::ManyToOne, Strategy::OneToOne] {
            for placement in [Placement::FreeFlight, Placement::LocallyHomogeneous] {
                let options = CompensationOptions { strategy, placement, ..unbiased };
                let found: Vec<f64> =
                    (0..REPLICAS).map(|k| by_lights(&room, BOUND, Some(options), k)).collect();
                let (mean, z) = z_of(&found);
                assert!(z.abs() < 5.0, "{options:?}: {mean}, z = {z}");
                // What lies further away than the region cannot matter: the same variates, the same numbers.
                let local = CompensationOptions { visibility: Visibility::Local, ..options };
                assert_eq!(by_lights(&room, BOUND, Some(local), 1), found[1], "{options:?}");
            }
        }
    }
}

#[test]
fn without_compensation_half_is_missing() {
    let found: Vec<f64> = (0..REPLICAS).map(|k| by_lights(&round(2.0), BOUND, None, k)).collect();
    let (mean, z) = z_of(&found);
    assert!(z < -5.0 && mean < 0.8 * RADIANCE, "{mean}, z = {z}");
}
