//! Paths that are guided by photons have the expectation of the path tracer, for any map.

#[path = "../../paths/tests/common/mod.rs"]
mod common;

use common::{
    Made, Scene, against, allocations, along, ball, courtyard, difference, diffuse, furnace, rectangle,
    volume,
};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, Line, LineThickness};
use fairflight_paths::extend::{Extended, Extension, Own, OwnShare, Resampled};
use fairflight_paths::transport::{Lobe, Types, Vertex, World};
use fairflight_paths::{Integrator, Uniform, Walk};
use fairflight_photons::{AnyExtension, GuideOptions, Guided, PhotonMap};
use fairflight_scene::{Background, Lights, Surfaces};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Moments, Verdict};
use fairflight_vpl::{Emitters, Ledger, LightPaths, Vpl};
use glam::{DVec3, dvec3};
use std::num::NonZeroU32;

const SEEDS: std::ops::Range<u64> = 1..2;
const SAMPLES: u32 = 200_000;

fn options(own_share: f64) -> GuideOptions {
    let many = |n| NonZeroU32::new(n).unwrap();
    GuideOptions { nearest: many(20), cells: many(64), own_share: OwnShare::new(own_share).unwrap() }
}

/// The map of so many light paths.
fn traced<M: LineThickness>(scene: &Scene<M>, paths: u32, seed: u64) -> PhotonMap<f64> {
    let world = scene.world();
    let emitters = Emitters::new(&scene.lights, &scene.surfaces, world.enclosing_ball(), scene.eye.origin);
    let light_paths = LightPaths::new(world, &emitters, scene.walk);
    let (mut vpls, mut source) = (Vec::new(), Seeded::new(derive_seed(seed, 7)));
    for _ in 0..paths {
        light_paths.trace(1.0 / f64::from(paths), &mut Ledger::empty(), &mut source, |vpl| vpls.push(vpl));
    }
    PhotonMap::new(vpls)
}

fn direction(source: &mut Seeded) -> DVec3 {
    loop {
        let at = DVec3::from(std::array::from_fn(|_| 2.0 * source.next_uniform() - 1.0));
        if (0.01..1.0).contains(&at.length_squared()) {
            return at.normalize();
        }
    }
}

/// A map that knows nothing: photons anywhere, from anywhere, of powers of either sign.
fn noise(photons: u32, seed: u64) -> PhotonMap<f64> {
    let mut source = Seeded::new(derive_seed(seed, 8));
    PhotonMap::new((0..photons).map(|index| {
        let position = DVec3::from(std::array::from_fn(|_| 2.0 * source.next_uniform() - 1.0));
        let incident = direction(&mut source);
        let lobe = if index % 2 == 0 {
            Lobe::Phase { incident }
        } else {
            Lobe::Diffuse { normal: -incident, surface: 0 }
        };
        let power = source.next_uniform().powi(8) * [1.0, -1.0][index as usize / 2 % 2];
        Vpl { vertex: Vertex { position, lobe }, incident, power, bounce: 1 }
    }))
}

fn agrees(name: &str, verdict: impl Fn(u64) -> Verdict) {
    for seed in SEEDS {
        let verdict = verdict(seed);
        assert_eq!(verdict.sound, Some(true), "{name}, seed {seed}: {}", verdict.reason);
    }
}

fn is_rejected(name: &str, verdict: impl Fn(u64) -> Verdict) {
    for seed in SEEDS {
        let verdict = verdict(seed);
        assert_eq!(verdict.sound, Some(false), "{name}, seed {seed}: {}", verdict.reason);
    }
}

/// Guided paths against the path tracer.
fn verdict<M: LineThickness>(
    scene: &Scene<M>,
    extension: impl Extension<Made<M>>,
    run: (u32, u64),
) -> Verdict {
    let mut found = scene.plain().with_extension(extension);
    difference(&mut along(&scene.eye, &mut found), &mut along(&scene.eye, &mut scene.plain()), run)
}

#[test]
fn directions_have_the_density_that_is_told() {
    // Means over directions drawn from q, and over all directions: ∫ g s by weights, and ∫ q = 1.
    let scene = courtyard();
    let vertices = [
        Lobe::Phase { incident: dvec3(0.6, 0.0, 0.8) },
        Lobe::Diffuse { normal: dvec3(0.0, -0.8, 0.6), surface: 0 },
    ];
    for map in [traced(&scene, 300, 1), noise(500, 1), noise(2, 1)] {
        for lobe in vertices {
            let vertex = Vertex { position: dvec3(0.1, -0.4, 0.2), lobe };
            let mut guided = Guided::new(&map, options(0.4));
            Extension::<Made<Homogeneous>>::prepare(&mut guided, &scene.world(), &vertex);
            let phase = &scene.volume.phase;
            let mut source = Seeded::new(2);
            let [mut whole, mut drawn, mut own] = [(); 3].map(|()| Moments::new());
            let g = |direction: DVec3| 1.0 + direction.x + 2.0 * (direction.y * direction.z).max(0.0);
            for _ in 0..200_000 {
                let towards = direction(&mut source);
                let scattered = vertex.pdf_solid_angle(phase, towards);
                let told = |direction, scattered| {
                    Extension::<Made<Homogeneous>>::pdf_solid_angle(&guided, &vertex, direction, scattered)
                };
                whole.push(4.0 * std::f64::consts::PI * told(towards, scattered));
                own.push(g(vertex.sample(phase, source.next_uniform(), source.next_uniform())));
            }
            for _ in 0..200_000 {
                let Extended { direction, weight, pdf_solid_angle } =
                    guided.sample(&scene.world(), &vertex, &mut source);
                assert!((direction.length() - 1.0).abs() < 1e-12);
                assert!((0.0..=2.5 + 1e-12).contains(&weight));
                let scattered = vertex.pdf_solid_angle(phase, direction);
                assert!((weight * pdf_solid_angle - scattered).abs() < 1e-12 * scattered);
                drawn.push(weight * g(direction));
            }
            // Five standard errors: false alarm 6e-7.
            let z = |difference: f64, error: f64| assert!(difference.abs() < 5.0 * error, "{difference}");
            z(whole.mean().unwrap() - 1.0, whole.standard_error().unwrap());
            let error = drawn.standard_error().unwrap().hypot(own.standard_error().unwrap());
            z(drawn.mean().unwrap() - own.mean().unwrap(), error);
        }
    }
}

#[test]
fn any_map_will_do() {
    let scene = courtyard();
    let maps = [
        ("photons", traced(&scene, 2000, 1)),
        ("noise", noise(3000, 1)),
        ("one photon", noise(1, 3)),
        ("none", PhotonMap::new([])),
    ];
    for (name, map) in &maps {
        agrees(name, |seed| verdict(&scene, Guided::new(map, options(0.7)), (SAMPLES, seed)));
    }
}

#[test]
fn any_number_of_cells_and_photons_will_do() {
    let scene = courtyard();
    let map = traced(&scene, 500, 2);
    for (nearest, cells) in [(1, 1), (3, 7), (200, 1000)] {
        let [nearest, cells] = [nearest, cells].map(|n| NonZeroU32::new(n).unwrap());
        let options = GuideOptions { nearest, cells, ..options(0.7) };
        let name = format!("{nearest} photons, {cells} cells");
        agrees(&name, |seed| verdict(&scene, Guided::new(&map, options), (SAMPLES, seed)));
    }
}

#[test]
fn a_furnace_is_equally_bright() {
    let scene = furnace();
    for map in [traced(&scene, 500, 1), noise(500, 1)] {
        agrees("furnace", |seed| {
            let mut tracer = scene.plain().with_extension(Guided::new(&map, options(0.9)));
            against(1.0, along(&scene.eye, &mut tracer), (3 * SAMPLES / 2, seed))
        });
    }
}

/// Haze and a floor lit by a lamp that shines on a wall alone: all that is seen comes from the bright spot there.
fn spot() -> Scene<Homogeneous> {
    let black = diffuse(0.0);
    let surfaces = vec![
        rectangle([-2.0, -1.0, -2.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0], diffuse(0.5), 0.0),
        rectangle([1.2, -1.0, -2.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], diffuse(0.8), 0.0),
        // The lamp, and the lid and sides that hide it.
        ball(dvec3(0.9, 0.6, 0.0), 0.1, black, 20.0),
        rectangle([0.7, 0.3, -0.3], [0.0, 0.6, 0.0], [0.0, 0.0, 0.6], black, 0.0),
        rectangle([0.7, 0.3, -0.3], [0.4, 0.0, 0.0], [0.0, 0.0, 0.6], black, 0.0),
    ];
    let lights = Lights { background: Background::dark(), sources: vec![] };
    let origin = dvec3(-0.3, 0.2, -1.0);
    let eye = Line { origin, direction: (dvec3(0.0, -1.0, 0.0) - origin).normalize() };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(0.2).unwrap());
    let bounds = Bounds::aligned_box(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
    let volume = fairflight_scene::Volume {
        phase: HenyeyGreenstein::new(0.3).unwrap(),
        ..volume(Homogeneous::new(0.1).unwrap(), 0.5, bounds)
    };
    Scene { volume, surfaces: Surfaces::new(surfaces), lights, walk, eye }
}

#[test]
fn a_map_that_knows_saves_variance_and_noise_costs() {
    let scene = spot();
    let variance = |map: &PhotonMap<f64>| {
        let mut tracer = scene.plain().with_extension(Guided::new(map, options(0.3)));
        let mut found = along(&scene.eye, &mut tracer);
        let mut source = Seeded::new(4);
        let moments: Moments = (0..SAMPLES).map(|_| found(&mut source)).collect();
        moments.sample_variance().unwrap()
    };
    let [plain, known, noise] =
        [PhotonMap::new([]), traced(&scene, 20_000, 1), noise(3000, 1)].map(|map| variance(&map));
    assert!(known < 0.4 * plain && noise > plain, "{plain}, known {known}, noise {noise}");
    let map = traced(&scene, 20_000, 1);
    agrees("spot", |seed| verdict(&scene, Guided::new(&map, options(0.3)), (4 * SAMPLES, seed)));
}

/// Twins of guided directions.
enum Wrong<'m> {
    /// guide_wrong_pdf: the density of the histogram alone.
    Histogram(Guided<'m, f64>),
    /// Weighted as if the vertex had drawn the direction itself.
    Own(Guided<'m, f64>),
    /// Light points compare with the density of the vertex, directions with their own.
    TwoDensities(Guided<'m, f64>),
}

const SHARE: f64 = 0.7;

impl<'m> Wrong<'m> {
    fn right(&mut self) -> &mut Guided<'m, f64> {
        let (Self::Histogram(right) | Self::Own(right) | Self::TwoDensities(right)) = self;
        right
    }
}

impl<W: Types<Spectrum = f64>> Extension<W> for Wrong<'_> {
    fn prepare(&mut self, world: &World<'_, W>, vertex: &Vertex) {
        Extension::<W>::prepare(self.right(), world, vertex);
    }
    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        let drawn = self.right().sample(world, vertex, source);
        match self {
            Self::Histogram(_) => {
                let scattered = vertex.pdf_solid_angle(&world.volume.phase, drawn.direction);
                let cell = (drawn.pdf_solid_angle - SHARE * scattered) / (1.0 - SHARE);
                let weight = if cell > 1e-9 * scattered { scattered / cell } else { 0.0 };
                Extended { weight, ..drawn }
            }
            Self::Own(_) => Extended { weight: 1.0, ..drawn },
            Self::TwoDensities(_) => drawn,
        }
    }
    fn pdf_solid_angle(&self, vertex: &Vertex, direction: DVec3, scattered: f64) -> f64 {
        let (Self::Histogram(right) | Self::Own(right)) = self else { return scattered };
        Extension::<W>::pdf_solid_angle(right, vertex, direction, scattered)
    }
}

#[test]
fn wrong_densities_are_rejected() {
    let scene = courtyard();
    let map = noise(3, 2);
    let guided = || Guided::new(&map, options(SHARE));
    is_rejected("histogram", |seed| verdict(&scene, Wrong::Histogram(guided()), (SAMPLES, seed)));
    is_rejected("own", |seed| verdict(&scene, Wrong::Own(guided()), (SAMPLES, seed)));
    is_rejected("two", |seed| verdict(&scene, Wrong::TwoDensities(guided()), (SAMPLES, seed)));
}

#[test]
fn a_sample_allocates_nothing() {
    let scene = courtyard();
    let map = traced(&scene, 2000, 1);
    let mut tracer = scene.plain().with_extension(Guided::new(&map, options(0.5)));
    assert_eq!(allocations(&scene.eye, &mut tracer), 0);
}

#[test]
fn any_of_them_is_the_one_that_it_holds() {
    let scene = courtyard();
    let map = traced(&scene, 500, 1);
    let resampled = Resampled::new(NonZeroU32::new(3).unwrap(), OwnShare::default());
    fn sum(scene: &Scene<Homogeneous>, extension: impl Extension<Made<Homogeneous>>) -> f64 {
        let mut tracer = scene.plain().with_extension(extension);
        let mut source = Seeded::new(3);
        (0..200).map(|_| tracer.radiance(&scene.eye, &mut source)).sum()
    }
    let guided = || Guided::new(&map, options(0.5));
    assert_eq!(sum(&scene, AnyExtension::Own), sum(&scene, Own));
    assert_eq!(sum(&scene, AnyExtension::Guided(guided())), sum(&scene, guided()));
    assert_eq!(sum(&scene, AnyExtension::Resampled(resampled)), sum(&scene, resampled));
}

#[test]
fn golden_values() {
    let scene = courtyard();
    let map = traced(&scene, 200, 1);
    let mut source = Seeded::new(1);
    let mut tracer = scene.plain().with_extension(Guided::new(&map, options(0.5)));
    let sum: f64 = (0..50).map(|_| tracer.radiance(&scene.eye, &mut source)).sum();
    assert_eq!([map.in_medium().len(), map.on_surfaces().len()], [18, 98]);
    assert!((sum / 13.608629144069635 - 1.0).abs() < 1e-12, "{sum}");
}
