//! A scene with paths of all kinds, independent paths of it with their weights, and functions of paths.

#![allow(dead_code, unreachable_pub)] // Each test file uses its part.

#[path = "../../../paths/tests/common/shapes.rs"]
mod shapes;

use fairflight_bidirectional::{Bidirectional, Exact, Subpath, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Line, LineThickness, PhaseFunction};
use fairflight_metropolis::Mutation;
use fairflight_metropolis::laws::Probe;
use fairflight_metropolis::path::{
    Met, PathEdge, PathSite, PathState, PathVertex, PathWorld, StepSizes, View,
};
use fairflight_paths::transport::{Emitters, MadeOf, World};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::{
    Background, Camera, EnvironmentMap, Lights, Material, Segment, Source, Surface, Surfaces, Volume,
    cosine_hemisphere,
};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
use shapes::{ball, diffuse, rectangle};
use std::f64::consts::PI;

pub type Made<M> = MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>;

pub struct Scene<M = Homogeneous> {
    pub camera: Camera,
    pub volume: Volume<M, HenyeyGreenstein, f64>,
    pub surfaces: Surfaces<f64>,
    pub lights: Lights<f64>,
}

/// [`Scene`]'s extinction.
pub const SIGMA_T: f64 = 1.0;

fn phase() -> HenyeyGreenstein {
    HenyeyGreenstein::new(0.4).unwrap()
}

fn scene(surfaces: Vec<Surface<f64>>) -> Scene {
    with(Homogeneous::new(SIGMA_T).unwrap(), surfaces)
}

fn with<M>(medium: M, surfaces: Vec<Surface<f64>>) -> Scene<M> {
    let bounds = Bounds::aligned_box(dvec3(-2.0, -1.0, -0.5), dvec3(2.0, 0.5, 3.0)).unwrap();
    Scene {
        camera: Camera::new(DVec3::ZERO, DVec3::Z, DVec3::Y, 100.0, [1, 1]).unwrap(),
        volume: Volume { medium, bounds, albedo: 0.8, phase: phase() },
        surfaces: Surfaces::new(surfaces),
        lights: Lights { background: Background::dark(), sources: vec![] },
    }
}

fn floor() -> Surface<f64> {
    rectangle([-2.0, -1.0, -0.5], [4.0, 0.0, 0.0], [0.0, 0.0, 3.5], diffuse(0.6), 0.0)
}

fn lamp() -> Surface<f64> {
    rectangle([-1.0, 1.6, 0.5], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.0), 1.0)
}

/// Haze over a floor, seen from inside with a wide view, under a lamp.
pub fn hall() -> Scene {
    scene(vec![floor(), lamp()])
}

/// The same hall with uneven smoke.
pub fn smoke() -> Scene<AnalyticCosine> {
    with(AnalyticCosine::new(SIGMA_T).unwrap(), vec![floor(), lamp()])
}

/// A wall of mirror beside haze under a lamp that shines to it.
pub fn mirrored() -> Scene {
    let mirror = rectangle([2.0, -1.0, -0.5], [0.0, 0.0, 3.5], [0.0, 3.0, 0.0], Material::Mirror, 0.0);
    scene(vec![mirror, lamp()])
}

/// A ball of glass and one that shines, over a floor and beside a mirror.
pub fn glass() -> Scene {
    let mirror = rectangle([2.0, -1.0, -0.5], [0.0, 0.0, 3.5], [0.0, 3.0, 0.0], Material::Mirror, 0.0);
    let pane = ball(dvec3(-0.4, -0.1, 1.2), 0.5, Material::Dielectric { ior: 1.4 }, 0.0);
    scene(vec![floor(), lamp(), mirror, pane, ball(dvec3(0.6, 0.3, 2.0), 0.3, diffuse(0.5), 2.0)])
}

/// A sky of a constant and a map over a ball of mirror and a floor in haze, with light from a point and from a direction.
pub fn sky() -> Scene {
    let map = EnvironmentMap::new(4, 2, vec![0.5, 2.0, 1.0, 0.2, 0.1, 0.0, 0.3, 0.4]).unwrap();
    let background = Background { constant: 0.3, maps: vec![map] };
    let parallel = Source::directional(dvec3(0.3, -1.0, 0.4), 0.8).unwrap();
    let point = Source::point(dvec3(0.2, 0.9, 1.0), 4.0).unwrap();
    let lights = Lights { background, sources: vec![parallel, point] };
    Scene { lights, ..scene(vec![floor(), ball(dvec3(-0.4, -0.3, 1.4), 0.5, Material::Mirror, 0.0)]) }
}

impl<M: LineThickness> Scene<M> {
    pub fn world(&self) -> World<'_, Made<M>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }

    pub fn view(&self) -> View<'_, Made<M>, Exact> {
        self.view_by(Exact)
    }

    pub fn view_by<E>(&self, edges: E) -> View<'_, Made<M>, E> {
        View { world: self.world(), camera: &self.camera, edges }
    }

    pub fn emitters(&self) -> Emitters<f64> {
        Emitters::new(&self.lights, &self.surfaces, self.world().enclosing_ball(), self.camera.origin())
    }
}

/// Independent paths by all strategies of the bidirectional integrator, of up to `longest` edges.
pub struct Paths<'s> {
    integrator: Bidirectional<'s, Made<Homogeneous>, Exact>,
    light: Subpath<f64>,
    view: View<'s, Made<Homogeneous>, Exact>,
    longest: u32,
}

impl<'s> Paths<'s> {
    pub fn new(scene: &'s Scene, emitters: &'s Emitters<f64>, longest: u32) -> Self {
        let (world, camera) = (scene.world(), &scene.camera);
        let heuristic = Heuristic::Balance;
        let weigh = Weigh { world, camera, emitters, thickness: Exact, heuristic, light_paths: 1.0 };
        let walk = Walk::new(Version::NonTerminating, Uniform::new(SIGMA_T).unwrap());
        let walking = Walking { max_vertices: longest, ..Walking::new(walk) };
        let integrator = Bidirectional::new(weigh, walking, Regular);
        Self { integrator, light: Subpath::empty(), view: scene.view(), longest }
    }

    /// One sample: `each` sees every path that it found, and its weight.
    pub fn sample(&mut self, source: &mut Seeded, each: &mut dyn FnMut(&PathState, f64, &mut Seeded)) {
        let Self { integrator, light, view, longest } = self;
        let mut path = PathState::default();
        integrator.trace_light(light, source);
        let within = [source.next_uniform(), source.next_uniform()];
        let line = integrator.weigh().camera.ray([0, 0], within);
        let mut all = Vec::new();
        integrator.strategies(&line, light, source, |eye, found| {
            if found.strategy.light + found.strategy.eye <= *longest + 1
                && path.set_found(view, (&found, eye, light), &mut Seeded::new(0))
            {
                all.push((path.clone(), found.value));
            }
        });
        let none = Subpath::empty();
        for index in 0..light.steps.len().min(*longest as usize - 1) {
            if let Some((_, found)) = integrator.splat(light, index, source)
                && path.set_found(view, (&found, &none, light), source)
            {
                all.push((path.clone(), found.value));
            }
        }
        for (path, weight) in &all {
            each(path, *weight, source);
        }
    }
}

pub type Boxed<'w> = Box<dyn Mutation<PathState> + 'w>;

/// ln of the wrong f J over the right one.
pub type Mistake = fn(&dyn PathWorld, &PathState) -> f64;

/// A mutation with a mistake.
pub struct Twin<'w> {
    pub right: Boxed<'w>,
    pub world: &'w dyn PathWorld,
    pub mistake: Mistake,
}

impl Mutation<PathState> for Twin<'_> {
    fn propose(&mut self, x: &PathState, y: &mut PathState, source: &mut dyn UniformSource) -> Option<f64> {
        let ratio = self.right.propose(x, y, source)?;
        Some(ratio + (self.mistake)(self.world, y) - (self.mistake)(self.world, x))
    }
}

/// Samples, each with its states and their weights.
pub type Bank = Vec<Vec<(PathState, f64)>>;

/// Samples of the bidirectional integrator of which some path is wanted, with their states and weights. Roulette leaves out the faint ones: of less than
/// `threshold` mean weights.
pub fn bank(
    scene: &Scene,
    (longest, threshold): (u32, f64),
    wanted: fn(&PathState) -> bool,
    (count, seed): (usize, u64),
) -> Bank {
    let emitters = scene.emitters();
    let mut paths = Paths::new(scene, &emitters, longest);
    let mut source = Seeded::new(seed);
    let mut sum = 0.0;
    for _ in 0..2000 {
        paths.sample(&mut source, &mut |path, weight, _| sum += if wanted(path) { weight } else { 0.0 });
    }
    let threshold = threshold * sum / 2000.0;
    let mut all = Bank::with_capacity(count);
    while all.len() < count {
        let mut kept = Vec::new();
        paths.sample(&mut source, &mut |path, weight, source| {
            if wanted(path) && source.next_uniform() * threshold < weight {
                kept.push((path.clone(), weight.max(threshold) / threshold));
            }
        });
        if !kept.is_empty() {
            all.push(kept);
        }
    }
    all
}

/// Paths of one kind, as a path tracer would find them: by directions and flights from the camera, and a point of the lamp at the end.
pub struct Traced<'w> {
    pub world: &'w dyn PathWorld,
    /// The kinds of the vertices between the ends, S at the last place at most.
    pub kinds: &'static str,
}

impl Traced<'_> {
    /// A path of weight `threshold`, or more where the weight was greater: the others play roulette, and those that lose are drawn again, by which all weights
    /// change by one factor.
    pub fn even_sample(&self, threshold: f64, source: &mut Seeded) -> (PathState, f64) {
        loop {
            if let Some((path, weight)) = self.sample(source)
                && source.next_uniform() * threshold < weight
            {
                return (path, weight.max(threshold));
            }
        }
    }

    /// The mean weight of a few samples.
    pub fn mean_weight(&self, source: &mut Seeded) -> f64 {
        (0..4000).filter_map(|_| self.sample(source)).map(|(_, weight)| weight).sum::<f64>() / 4000.0
    }

    /// A path and its weight: what scattering, transmittance and the light give, over the densities of what was drawn.
    pub fn sample(&self, source: &mut Seeded) -> Option<(PathState, f64)> {
        let Self { world, kinds } = *self;
        let mut film = [source.next_uniform(), source.next_uniform()];
        if kinds.starts_with('D') {
            film[1] = 0.5 + 0.5 * film[1];
        }
        // Half of the film for what is below; the lamp has the area 4.
        let mut weight = if kinds.starts_with('D') { 2.0 } else { 4.0 };
        let camera = world.camera();
        let lamp = dvec3(2.0 * source.next_uniform() - 1.0, 1.6, 0.5 + 2.0 * source.next_uniform());
        let pinhole = PathVertex { position: camera.origin(), site: PathSite::Pinhole, colour: DVec3::ONE };
        let (mut vertices, edges) =
            (Vec::with_capacity(kinds.len() + 2), Vec::with_capacity(kinds.len() + 1));
        vertices.push(pinhole);
        let mut path = PathState { vertices, edges, film };
        let mut direction = camera.ray([0, 0], film).direction;
        for (i, letter) in kinds.bytes().enumerate() {
            let last = *path.vertices.last().unwrap();
            let line = Line { origin: last.position, direction };
            let mut segment = Segment { line, length: f64::INFINITY, from: last.surface(), to: None };
            let (site, colour) = match letter {
                b'V' => {
                    segment.length = source.next_exponential() / SIGMA_T;
                    weight /= SIGMA_T * (-SIGMA_T * segment.length).exp();
                    let sigma_t = world.sigma_t(line.at(segment.length));
                    if world.is_occluded(&segment) || sigma_t == 0.0 {
                        return None;
                    }
                    (PathSite::Medium { sigma_t }, world.albedo())
                }
                letter => {
                    let met = world.intersect(&segment)?;
                    segment.length = met.distance;
                    let Met { normal, surface, .. } = met;
                    match (letter, world.surface(surface).0) {
                        (b'D', Material::Diffuse { reflectance }) => {
                            (PathSite::Diffuse { normal, surface }, reflectance)
                        }
                        (b'S', Material::Mirror) => {
                            let site =
                                PathSite::Smooth { normal, surface, ratio: 1.0, reflects: true, share: 1.0 };
                            (site, DVec3::ONE)
                        }
                        _ => return None,
                    }
                }
            };
            weight *= self.push(
                &mut path,
                &segment,
                PathVertex { position: segment.line.at(segment.length), site, colour },
            );
            let vertex = path.vertices[i + 1];
            let next = kinds.as_bytes().get(i + 1);
            let before = direction;
            direction = match (site, next) {
                (PathSite::Smooth { normal, .. }, _) => before - 2.0 * normal.dot(before) * normal,
                (_, None) => (lamp - vertex.position).normalize(),
                // Towards the image of the lamp behind the mirror, by area.
                (_, Some(b'S')) => {
                    let offset = dvec3(4.0 - lamp.x, lamp.y, lamp.z) - vertex.position;
                    weight *= offset.y.abs() / offset.length().powi(3);
                    offset.normalize()
                }
                (PathSite::Diffuse { normal, .. }, _) => {
                    weight *= PI;
                    cosine_hemisphere(normal, source.next_uniform(), source.next_uniform())
                }
                _ => {
                    let drawn = phase().sample(before, source.next_uniform(), source.next_uniform());
                    weight /= drawn.pdf_solid_angle;
                    drawn.direction
                }
            };
            let is_drawn_by_cosine = matches!((site, next), (PathSite::Diffuse { .. }, Some(b'V' | b'D')));
            let cosine = if is_drawn_by_cosine { 1.0 } else { vertex.facing(direction) };
            weight *= colour.x
                * match site {
                    PathSite::Smooth { .. } => 1.0,
                    _ => vertex.scatter(world, before, direction) * cosine,
                };
        }
        let last = *path.vertices.last().unwrap();
        let line = Line { origin: last.position, direction };
        let mut segment = Segment { line, length: f64::INFINITY, from: last.surface(), to: None };
        let met = world.intersect(&segment)?;
        let (_, emission) = world.surface(met.surface);
        if emission.x == 0.0 || weight == 0.0 {
            return None;
        }
        segment.length = met.distance;
        if !last.is_smooth() {
            weight *= direction.y.abs() / (met.distance * met.distance);
        }
        let site = PathSite::Lamp { normal: met.normal, surface: met.surface };
        weight *=
            self.push(&mut path, &segment, PathVertex { position: met.position, site, colour: emission });
        Some((path, weight * emission.x))
    }

    fn push(&self, path: &mut PathState, segment: &Segment, vertex: PathVertex) -> f64 {
        let ln_transmittance = self.world.ln_transmittance(segment, &mut Seeded::new(0));
        let (direction, length) = (segment.line.direction, segment.length);
        path.edges.push(PathEdge { direction, length, ln_transmittance });
        path.vertices.push(vertex);
        ln_transmittance.exp()
    }
}

/// The kinds of a path's vertices between its ends: D, V in the medium, S smooth.
pub fn signature(path: &PathState) -> String {
    let letter = |site: &PathSite| match site {
        PathSite::Medium { .. } => 'V',
        PathSite::Diffuse { .. } => 'D',
        PathSite::Smooth { .. } => 'S',
        _ => '?',
    };
    path.vertices[1..path.len()].iter().map(|vertex| letter(&vertex.site)).collect()
}

/// Bounded functions of a path: of its image, its distances and its vertices.
pub const PROBES: [fn(&PathState) -> f64; 8] = [
    |x| x.film[0],
    |x| x.film[1],
    |x| (x.film[0] - 0.5).powi(2) + (x.film[1] - 0.5).powi(2),
    |x| (-x.edges[0].length).exp(),
    |x| (-x.edges[1].length).exp(),
    |x| x.vertices[1].position.y.tanh(),
    |x| x.vertices[x.len() - 1].position.y.tanh(),
    |x| x.vertices[x.len()].position.x.tanh(),
];

/// Steps large enough that a mistake shows, in units of an image of one pixel.
pub fn sizes() -> StepSizes {
    StepSizes { film: [0.1, 0.2], turn: [0.15, 0.4], stretch: 0.6 }
}

/// Smaller ones, for the lever of a mirror.
pub fn fine_sizes() -> StepSizes {
    StepSizes { film: [0.05, 0.15], turn: [0.05, 0.15], stretch: 0.6 }
}

pub fn probes(indices: &[usize]) -> Vec<Probe<'static, PathState>> {
    indices.iter().map(|&i| &PROBES[i] as Probe<'static, PathState>).collect()
}
