//! Scenes with every kind of light and material, small enough to be seen in one pixel or four.

#![allow(dead_code, unreachable_pub)] // Each test file uses its part.

#[path = "../../../paths/tests/common/shapes.rs"]
mod shapes;

use fairflight_bidirectional::laws::{Path, Side, Weights};
use fairflight_bidirectional::{
    Bidirectional, Found, Node, Strategy, Subpath, Walking, Weigh, WeightThickness,
};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, LineThickness, Medium};
use fairflight_paths::transport::{Emitters, MadeOf, World};
use fairflight_paths::{Heuristic, RayTransmittance, Uniform, Walk};
use fairflight_scene::{
    Background, Camera, EnvironmentMap, Lights, Material, Source, Surface, Surfaces, Volume,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
pub use shapes::{ball, diffuse, rectangle};

pub const ALL: [Heuristic; 3] = [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum];

pub struct Scene<M> {
    pub camera: Camera,
    /// For a sample of a pixel: 1, or 0 without a light image.
    pub light_paths_per_pixel: f64,
    pub volume: Volume<M, HenyeyGreenstein, f64>,
    pub surfaces: Surfaces<f64>,
    pub lights: Lights<f64>,
    pub walk: Walk<Uniform>,
}

pub type Made<M, T> = MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, T>;

impl<M: Medium> Scene<M> {
    pub fn world<T: RayTransmittance<M>>(&self) -> World<'_, Made<M, T>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }

    pub fn emitters<T: RayTransmittance<M>>(&self) -> Emitters<f64> {
        let ball = self.world::<T>().enclosing_ball();
        Emitters::new(&self.lights, &self.surfaces, ball, self.camera.origin())
    }

    /// The same view in so many columns and rows.
    pub fn in_pixels(self, resolution: [u32; 2]) -> Self {
        Self { camera: self.camera.with_resolution(resolution).unwrap(), ..self }
    }

    pub fn pixels(&self) -> f64 {
        self.camera.resolution().map(f64::from).iter().product()
    }

    /// As many light paths as pixels.
    pub fn weigh<'s, T: RayTransmittance<M>, K>(
        &'s self,
        emitters: &'s Emitters<f64>,
        heuristic: Heuristic,
        thickness: K,
    ) -> Weigh<'s, Made<M, T>, K> {
        let light_paths = self.light_paths_per_pixel * self.pixels();
        Weigh { world: self.world(), camera: &self.camera, emitters, thickness, heuristic, light_paths }
    }
}

/// One sample of a pixel and the light path that goes with it: `each` sees what was found, with its path.
pub fn sample<M: Medium, T: RayTransmittance<M>, K: WeightThickness<M>>(
    integrator: &mut Bidirectional<'_, Made<M, T>, K>,
    light: &mut Subpath<f64>,
    pixel: [u32; 2],
    source: &mut Seeded,
    mut each: impl FnMut(Found<f64>, &Subpath<f64>, &Subpath<f64>),
) {
    integrator.trace_light(light, source);
    let within = [source.next_uniform(), source.next_uniform()];
    let line = integrator.weigh().camera.ray(pixel, within);
    integrator.strategies(&line, light, source, |eye, found| each(found, eye, light));
    let none = Subpath::empty();
    if integrator.weigh().light_paths == 0.0 {
        return;
    }
    for index in 0..light.steps.len() {
        if let Some((_, found)) = integrator.splat(light, index, source) {
            each(found, &none, light);
        }
    }
}

/// Floor, ceiling and three walls about the origin, 2 · 2 in size, open towards the camera.
fn room(reflectance: f64) -> Vec<Surface<f64>> {
    let gray = diffuse(reflectance);
    vec![
        rectangle([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], gray, 0.0),
        rectangle([-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], gray, 0.0),
        rectangle([-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], gray, 0.0),
        rectangle([1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], gray, 0.0),
        rectangle([-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], gray, 0.0),
    ]
}

/// In the front of the room: a wide view, whose pixels are far from equal.
fn camera() -> Camera {
    let origin = dvec3(0.1, -0.1, -1.3);
    Camera::new(origin, dvec3(0.0, -0.2, 0.0), DVec3::Y, 75.0, [1, 1]).unwrap()
}

fn scene<M>(
    medium: M,
    (g, albedo): (f64, f64),
    surfaces: Vec<Surface<f64>>,
    lights: Lights<f64>,
) -> Scene<M> {
    // Up to below the point lights: a path tracer has no second moment of one in a medium.
    let bounds = Bounds::aligned_box(DVec3::splat(-1.2), dvec3(1.2, 0.3, 1.2)).unwrap();
    let phase = HenyeyGreenstein::new(g).unwrap();
    Scene {
        camera: camera(),
        light_paths_per_pixel: 1.0,
        volume: Volume { medium, bounds, albedo, phase },
        surfaces: Surfaces::new(surfaces),
        lights,
        walk: Walk::new(Version::NonTerminating, Uniform::new(0.5).unwrap()),
    }
}

fn sources(sources: Vec<Source<f64>>) -> Lights<f64> {
    Lights { background: Background::dark(), sources }
}

fn point(x: f64, y: f64, z: f64, power: f64) -> Source<f64> {
    Source::point(dvec3(x, y, z), power).unwrap()
}

/// Haze, a mirror, a lamp that reflects and one that is round.
pub fn mixed() -> Scene<Homogeneous> {
    let mut surfaces = room(0.6);
    surfaces.push(rectangle([-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], diffuse(0.3), 3.0));
    surfaces.push(ball(dvec3(0.5, -0.6, 0.3), 0.3, Material::Mirror, 0.0));
    surfaces.push(ball(dvec3(-0.5, -0.7, 0.2), 0.2, diffuse(0.5), 2.0));
    scene(Homogeneous::new(0.4).unwrap(), (0.3, 0.9), surfaces, sources(vec![]))
}

/// Uneven smoke that collides more often than it is looked up for, a ball of glass, a point light and a lamp.
pub fn glass() -> Scene<AnalyticCosine> {
    let mut surfaces = room(0.5);
    surfaces.push(ball(dvec3(0.3, -0.5, 0.0), 0.4, Material::Dielectric { ior: 1.5 }, 0.0));
    surfaces.push(rectangle([-0.9, 0.8, -0.8], [1.4, 0.0, 0.0], [0.0, 0.1, 1.4], diffuse(0.0), 1.0));
    let lights = sources(vec![point(-0.5, 0.6, -0.3, 4.0)]);
    scene(AnalyticCosine::new(0.8).unwrap(), (-0.2, 0.8), surfaces, lights)
}

/// Under a sky of a constant and a map, with parallel light, a point light, and haze of a few mean free paths that ends.
pub fn sky() -> Scene<Homogeneous> {
    let surfaces = vec![
        rectangle([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.7), 0.0),
        ball(dvec3(0.3, -0.4, 0.2), 0.5, diffuse(0.4), 0.0),
        ball(dvec3(-0.6, -0.5, 0.0), 0.3, Material::Mirror, 0.0),
    ];
    let map = EnvironmentMap::new(4, 2, vec![0.5, 2.0, 1.0, 0.2, 0.1, 0.0, 0.3, 0.4]).unwrap();
    let background = Background { constant: 0.3, maps: vec![map] };
    let parallel = Source::directional(dvec3(0.3, -1.0, 0.4), 0.8).unwrap();
    let lights = Lights { background, sources: vec![parallel, point(0.2, 0.8, -0.5, 4.0)] };
    scene(Homogeneous::new(0.5).unwrap(), (0.4, 0.9), surfaces, lights)
}

/// A lamp and a faint point light over a strongly forward scattering medium.
pub fn forward() -> Scene<Homogeneous> {
    let mut surfaces = room(0.5);
    surfaces.push(rectangle([-0.9, 0.9, -0.9], [1.8, 0.0, 0.0], [0.0, 0.0, 1.8], diffuse(0.0), 1.0));
    let lights = sources(vec![point(-0.3, 0.7, -0.3, 1.0)]);
    let scene = scene(Homogeneous::new(2.0).unwrap(), (0.95, 0.95), surfaces, lights);
    Scene { walk: Walk::new(Version::Terminating, Uniform::new(2.5).unwrap()), ..scene }
}

/// A lamp in a globe of glass, and one of glass that glows itself.
pub fn bulb() -> Scene<Homogeneous> {
    let mut surfaces = room(0.7);
    surfaces.push(ball(dvec3(0.0, 0.4, 0.0), 0.35, Material::Dielectric { ior: 1.5 }, 0.0));
    surfaces.push(ball(dvec3(0.0, 0.4, 0.0), 0.2, diffuse(0.0), 4.0));
    surfaces.push(ball(dvec3(-0.5, -0.6, 0.1), 0.3, Material::Dielectric { ior: 1.3 }, 0.15));
    scene(Homogeneous::new(0.3).unwrap(), (0.3, 0.9), surfaces, sources(vec![]))
}

/// Distances of the weights of the paths that were found from what they should be.
#[derive(Debug, Default)]
pub struct Defects {
    pub paths: u64,
    /// Of the integrator's weight from the recursive one of its whole path.
    pub walked: f64,
    /// Of the recursive weights from those by all densities.
    pub direct: f64,
    /// Of the sum of the recursive ones from one: the greatest, and the sum over paths.
    pub sum: f64,
    pub sums: f64,
    pub longest: usize,
}

impl Defects {
    pub fn mean(&self) -> f64 {
        self.sums / self.paths as f64
    }

    pub fn observe(&mut self, walked: f64, recursive: &Weights, direct: &Weights, strategy: Strategy) {
        let relative = |a: f64, b: f64| (a - b).abs() / b.max(1e-100);
        self.paths += 1;
        self.walked = self.walked.max(relative(walked, recursive[strategy.eye as usize - 1]));
        let worst = recursive.iter().zip(direct).map(|(&a, &b)| relative(a, b)).fold(0.0, f64::max);
        self.direct = self.direct.max(worst);
        let sum = (recursive.iter().sum::<f64>() - 1.0).abs();
        self.sum = self.sum.max(sum);
        self.sums += sum;
        self.longest = self.longest.max(recursive.len() - 1);
    }
}

/// Weights of the paths that so many samples find, those through smooth surfaces to a point light included.
pub fn defects<M: LineThickness, K: WeightThickness<M> + Clone>(
    scene: &Scene<M>,
    (heuristic, thickness): (Heuristic, K),
    samples: u32,
    mut twist: impl FnMut(Side, usize, &mut Node),
) -> Defects {
    let emitters = scene.emitters::<Regular>();
    let world = scene.world::<Regular>();
    let laws = scene.weigh::<Regular, K>(&emitters, heuristic, thickness.clone());
    let weigh = scene.weigh(&emitters, heuristic, thickness);
    let walking = Walking { point_caustics: true, ..Walking::new(scene.walk) };
    let mut integrator = Bidirectional::new(weigh, walking, Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(14));
    let mut defects = Defects::default();
    for index in 0..samples {
        let [columns, rows] = scene.camera.resolution();
        let pixel = [index % columns, index / columns % rows];
        sample(&mut integrator, &mut light, pixel, &mut source, |found, eye, light| {
            let path = Path::of((&world, &emitters), &found, eye, light);
            let recursive = laws.recursive(&path, &mut twist);
            defects.observe(found.weight, &recursive, &laws.direct(&path), found.strategy);
        });
    }
    defects
}
