//! Scenes that ask something of directions and light points, and the comparison of two integrators.

#![allow(dead_code, unreachable_pub)] // Each test file uses its part.

mod shapes;

use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Line, LineThickness};
use fairflight_paths::transport::{MadeOf, World};
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_scene::{Background, EnvironmentMap, Lights, Material, Source, Surfaces, Volume};
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::{Moments, Reference, Verdict, judge};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
pub use shapes::{ball, diffuse, rectangle};

/// False alarm of one check; there are about forty.
pub const ALPHA: f64 = 1e-4;

pub struct Scene<M> {
    pub volume: Volume<M, HenyeyGreenstein, f64>,
    pub surfaces: Surfaces<f64>,
    pub lights: Lights<f64>,
    pub walk: Walk<Uniform>,
    /// The ray that sees it.
    pub eye: Line,
}

pub type Made<M> = MadeOf<f64, M, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>;

impl<M: LineThickness> Scene<M> {
    pub fn world(&self) -> World<'_, Made<M>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }

    /// The path tracer without any extension.
    pub fn plain(&self) -> PathTracer<'_, Made<M>> {
        self.by(Heuristic::Balance)
    }

    pub fn by(&self, heuristic: Heuristic) -> PathTracer<'_, Made<M>> {
        PathTracer::new(self.world(), self.walk, Regular, heuristic)
    }
}

pub fn volume<M>(medium: M, albedo: f64, bounds: Bounds) -> Volume<M, HenyeyGreenstein, f64> {
    Volume { medium, bounds, albedo, phase: HenyeyGreenstein::new(0.5).unwrap() }
}

fn box_of(half: f64) -> Bounds {
    Bounds::aligned_box(DVec3::splat(-half), DVec3::splat(half)).unwrap()
}

/// A courtyard in haze: floor and two walls, under a sky of a constant and a map that a roof hides the most of, with a lamp that reflects, a
/// mirror, and a point light above the haze.
pub fn courtyard() -> Scene<Homogeneous> {
    let surfaces = vec![
        rectangle([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.6), 0.0),
        rectangle([-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], diffuse(0.4), 0.0),
        rectangle([1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.3), 0.0),
        rectangle([-1.0, 1.0, -1.0], [1.6, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.4), 0.0),
        rectangle([-0.8, 0.5, -0.2], [0.5, 0.0, 0.0], [0.0, 0.1, 0.5], diffuse(0.3), 3.0),
        ball(dvec3(0.4, -0.7, 0.4), 0.3, Material::Mirror, 0.0),
    ];
    let map = EnvironmentMap::new(4, 2, vec![0.5, 2.0, 1.0, 0.2, 0.1, 0.0, 0.3, 0.4]).unwrap();
    let background = Background { constant: 0.6, maps: vec![map] };
    let lights = Lights { background, sources: vec![Source::point(dvec3(0.8, 1.6, 0.0), 4.0).unwrap()] };
    let origin = dvec3(0.1, 0.3, -1.8);
    let eye = Line { origin, direction: (dvec3(-0.1, -0.9, 0.0) - origin).normalize() };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(0.4).unwrap());
    let volume = volume(Homogeneous::new(0.3).unwrap(), 0.7, box_of(1.1));
    Scene { volume, surfaces: Surfaces::new(surfaces), lights, walk, eye }
}

/// A cellar of dark walls, into which a bright sky shines through a hole in its roof.
pub fn cellar() -> Scene<EmptySpace> {
    let dark = diffuse(0.1);
    let surfaces = vec![
        rectangle([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.6), 0.0),
        rectangle([-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], dark, 0.0),
        rectangle([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], dark, 0.0),
        rectangle([1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], dark, 0.0),
        rectangle([-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], dark, 0.0),
        rectangle([-1.0, 1.0, -1.0], [1.6, 0.0, 0.0], [0.0, 0.0, 2.0], dark, 0.0),
    ];
    let lights = Lights { background: Background { constant: 5.0, maps: vec![] }, sources: vec![] };
    let eye = Line { origin: dvec3(0.1, 0.5, 0.0), direction: dvec3(-0.2, -1.0, 0.1).normalize() };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
    let volume = volume(EmptySpace, 0.0, box_of(1.0));
    Scene { volume, surfaces: Surfaces::new(surfaces), lights, walk, eye }
}

/// A closed room that glows as much as it absorbs, with haze that absorbs nothing, a mirror and a lamp in it: 1 everywhere.
pub fn furnace() -> Scene<Homogeneous> {
    let glowing = |emission| diffuse(1.0 - emission);
    let surfaces = vec![
        ball(DVec3::ZERO, 1.0, glowing(0.4), 0.4),
        ball(dvec3(0.4, 0.2, 0.3), 0.2, Material::Mirror, 0.0),
        ball(dvec3(-0.2, 0.4, 0.4), 0.25, glowing(0.8), 0.8),
    ];
    let lights = Lights { background: Background::dark(), sources: vec![] };
    let eye = Line { origin: dvec3(0.1, 0.0, -0.6), direction: dvec3(-0.1, 0.1, 1.0).normalize() };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(0.8).unwrap());
    let volume = volume(Homogeneous::new(0.8).unwrap(), 1.0, Bounds::sphere(DVec3::ZERO, 1.0).unwrap());
    Scene { volume, surfaces: Surfaces::new(surfaces), lights, walk, eye }
}

/// Integrator of one ray less another, of which the means agree, with the mean of the latter added: a sample holds one of either, independent
/// of each other.
pub fn difference(
    found: &mut impl FnMut(&mut Seeded) -> f64,
    plain: &mut impl FnMut(&mut Seeded) -> f64,
    (samples, seed): (u32, u64),
) -> Verdict {
    let [mut source, mut other, mut pilot] = [1, 2, 3].map(|stream| Seeded::new(derive_seed(seed, stream)));
    // A constant by which the power is told as a relative bias.
    let scale = (0..samples).map(|_| plain(&mut pilot)).sum::<f64>() / f64::from(samples);
    let moments: Moments = (0..samples).map(|_| scale + found(&mut source) - plain(&mut other)).collect();
    judge(&moments, &Reference::exact(scale).with_mild_tails(), ALPHA)
}

/// The radiance along the ray of a scene, by an integrator.
pub fn along<'a>(line: &'a Line, integrator: &'a mut impl Integrator<f64>) -> impl FnMut(&mut Seeded) -> f64 {
    move |source| integrator.radiance(line, source)
}

/// Allocations of 500 samples, which are not all dark.
pub fn allocations(line: &Line, integrator: &mut impl Integrator<f64>) -> u64 {
    let mut source = Seeded::new(3);
    let allocated = allocation_counter::measure(|| {
        let sum: f64 = (0..500).map(|_| integrator.radiance(line, &mut source)).sum();
        assert!(sum > 0.0);
    });
    allocated.count_total
}

/// The mean of an integrator along a ray against a closed form.
pub fn against(
    expected: f64,
    mut found: impl FnMut(&mut Seeded) -> f64,
    (samples, seed): (u32, u64),
) -> Verdict {
    let mut source = Seeded::new(derive_seed(seed, 4));
    let moments: Moments = (0..samples).map(|_| found(&mut source)).collect();
    judge(&moments, &Reference::exact(expected).with_mild_tails(), ALPHA)
}
