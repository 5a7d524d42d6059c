//! Light of a point is not seen behind smooth surfaces, by no integrator: a floor beside a mirror under a point light, whose light the
//! ceiling sees. Path tracing and unbounded virtual point lights must find the same.

use fairflight_collision::Version;
use fairflight_media::phase::Isotropic;
use fairflight_media::{Bounds, EmptySpace, Line};
use fairflight_paths::transport::World;
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_scene::surface::Rectangle;
use fairflight_scene::{Background, Lights, Material, Shape, Source, Surface, Surfaces, Volume};
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Pairing, Term, Uncorrected, VplIntegrator};
use glam::{DVec3, dvec3};

const REPLICAS: u64 = 200;

/// Mean, and the square of its standard error.
fn mean(of: impl Fn(u64) -> f64) -> (f64, f64) {
    let found: Vec<f64> = (0..REPLICAS).map(of).collect();
    let n = REPLICAS as f64;
    let mean = found.iter().sum::<f64>() / n;
    (mean, found.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n * (n - 1.0)))
}

fn square(z: f64, material: Material<f64>) -> Surface<f64> {
    let shape = Rectangle::new(dvec3(-1.0, -1.0, z), 2.0 * DVec3::X, 2.0 * DVec3::Y).unwrap();
    Surface::new(Shape::Rectangle(shape), material, 0.0).unwrap()
}

#[test]
fn both_integrators_see_the_same_of_a_point_light_and_a_mirror() {
    let diffuse = Material::Diffuse { reflectance: 0.8 };
    let wall = Rectangle::new(dvec3(-1.1, -1.0, 0.0), 2.0 * DVec3::Y, DVec3::Z).unwrap();
    let wall = Surface::new(Shape::Rectangle(wall), Material::Mirror, 0.0).unwrap();
    let surfaces = Surfaces::new(vec![square(0.0, diffuse), square(1.0, diffuse), wall]);
    let light = Source::point(dvec3(-0.6, 0.0, 0.5), 40.0).unwrap();
    let lights = Lights { background: Background::dark(), sources: vec![light] };
    let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
    let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
    let world = World::new(&volume, &surfaces, &lights);
    let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
    let eye = Line { origin: dvec3(0.2, 0.1, 0.5), direction: DVec3::Z };

    let by_paths = mean(|seed| {
        let mut tracer = PathTracer::new(world, walk, Regular, Heuristic::Balance);
        let mut source = Seeded::new(seed);
        (0..500).map(|_| tracer.radiance(&eye, &mut source)).sum::<f64>() / 500.0
    });
    let by_lights = mean(|seed| {
        let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), eye.origin);
        let paths = LightPaths::new(world, &emitters, walk);
        let (mut vpls, mut ledger, mut source) = (Vec::new(), Ledger::empty(), Seeded::new(seed));
        for _ in 0..300 {
            paths.trace(1.0 / 300.0, &mut ledger, &mut source, |vpl| vpls.push(vpl));
        }
        let (term, heuristic) = (Term::Bounded(f64::INFINITY), Heuristic::Balance);
        let gather = Gather { world, vpls: &vpls, term, heuristic, walk, shadow: Regular };
        let mut integrator = VplIntegrator::new(gather, (1, Pairing::Every), Uncorrected);
        (0..20).map(|_| integrator.radiance(&eye, &mut source)).sum::<f64>() / 20.0
    });
    // Five standard errors: false alarm 6e-7.
    let z = (by_lights.0 - by_paths.0) / (by_lights.1 + by_paths.1).sqrt();
    assert!(z.abs() < 5.0, "{} by lights, {} by paths: z = {z}", by_lights.0, by_paths.0);
}
