//! Virtual point lights: where light starts, what a bound takes away, and the roulette of what makes up for it.

use super::{Check, LAWFUL, check};
use crate::vpl::local::Local;
use crate::vpl::scenes::{ball, diffuse, environment, phase, point_light, rectangle};
use crate::vpl::tiny;
use fairflight_collision::Version;
use fairflight_compensation::{Compensation, CompensationOptions, LocalMean};
use fairflight_laws::CheckResult;
use fairflight_laws::exact::decisions::expectation;
use fairflight_laws::exact::{agree, greatest};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Line};
use fairflight_paths::transport::{Lobe, MadeOf, Vertex, World};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::{Geometry, Lights, Material, Segment, Surfaces, Volume};
use fairflight_sources::{LARGEST_VARIATE, Scripted};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Connected, Connections, Correction, Emitters, Gather, Term, Vpl};
use glam::{DVec3, dvec3};

/// Rounding of a few products.
const GRANTED: f64 = 1e-13;

pub(super) fn checks() -> Vec<Check> {
    let lights = "virtual point lights";
    vec![
        check("connection/bounded and excess are the whole", lights, "tiny scenes", complement)
            .about(["vpl"]),
        check("connection/roulette of compensation", "compensation", "a floor and a ceiling", roulette)
            .about(["vpl"]),
        check("emission/sides and shares", lights, "lamps", emission).about(["vpl"]),
        check("emission/fresnel", "smooth surfaces", "glass", fresnel),
    ]
}

/// **Law.** What a bound leaves of a connection, and what it takes away, are the connection.
fn complement() -> CheckResult {
    let scenes = [tiny::medium(2), tiny::above_floor(), tiny::near_floor(tiny::SIGMA_T), tiny::corner(0.0)];
    let of = |scene: &Local, bound: f64| {
        let connected = |term: Term| {
            let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).expect(LAWFUL));
            let gather = scene.gather(walk, Regular);
            let mut gather = Gather { term, ..gather };
            let found: f64 = gather.connected(&scene.y, Connected::All, &mut Scripted::new([]));
            found
        };
        let whole = connected(Term::Bounded(f64::INFINITY));
        let parts = connected(Term::Bounded(bound)) + connected(Term::Excess(bound));
        // Each bound must take something and leave something in one scene at least, which the sum does not tell.
        (parts / whole - 1.0).abs()
    };
    let bounds = [0.0, 0.5, 2.0, 4.0, 8.0, 100.0];
    agree(greatest(scenes.iter().flat_map(|scene| bounds.map(|bound| of(scene, bound)))), GRANTED)
}

/// Two plates, [`HEIGHT`] apart, a point light between them, nothing else.
struct Plates {
    volume: Volume<EmptySpace, HenyeyGreenstein, f64>,
    surfaces: Surfaces<f64>,
    lights: Lights<f64>,
}

const HEIGHT: f64 = 0.5;
const REFLECTANCE: f64 = 0.5;

impl Plates {
    fn new() -> Self {
        let plate = |z: f64| {
            let shape = rectangle(dvec3(-9.0, -9.0, z), 18.0 * DVec3::X, 18.0 * DVec3::Y);
            diffuse(shape, REFLECTANCE, 0.0)
        };
        Self {
            volume: Volume {
                medium: EmptySpace,
                bounds: Bounds::sphere(DVec3::ZERO, 20.0).expect(LAWFUL),
                albedo: 0.0,
                phase: phase(),
            },
            surfaces: Surfaces::new(vec![plate(0.0), plate(HEIGHT)]),
            lights: point_light(0.5 * HEIGHT * DVec3::Z, 5.0),
        }
    }

    fn world(&self) -> World<'_, MadeOf<f64, EmptySpace, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>> {
        World::new(&self.volume, &self.surfaces, &self.lights)
    }

    /// The middle of the floor, or of the ceiling.
    fn plate(surface: usize) -> Vertex {
        let (z, normal) = [(0.0, DVec3::Z), (HEIGHT, DVec3::NEG_Z)][surface];
        Vertex { position: z * DVec3::Z, lobe: Lobe::Diffuse { normal, surface } }
    }

    /// Light that compensation recovers at the middle of a plate for these variates, at half of the bound that is reached straight across.
    fn recovered(&self, surface: usize, steps: Option<u32>, variates: &[f64]) -> f64 {
        let vertex = Vertex { position: dvec3(0.1, 0.05, 0.2), lobe: Lobe::Phase { incident: DVec3::X } };
        let vpls = [Vpl { vertex, incident: DVec3::X, power: 3.0, bounce: 1 }];
        let mean = LocalMean::of(&self.volume.medium, &self.volume.bounds, [1; 3], 1);
        let options = CompensationOptions { steps, ..CompensationOptions::EXACT };
        let mut gather = Gather {
            world: self.world(),
            vpls: &vpls,
            term: Term::Bounded(0.5 / (HEIGHT * HEIGHT)),
            heuristic: Heuristic::Balance,
            walk: Walk::new(Version::Terminating, Uniform::new(1.0).expect(LAWFUL)),
            shadow: Regular,
        };
        let mut source = Scripted::new(variates.iter().copied());
        let connections =
            Connections { gather: &mut gather, y: &Self::plate(surface), which: Connected::All };
        Compensation::new(options, &mean).recover(connections, &mut source)
    }
}

/// **Law.** Straight across G is twice the bound: a vertex there weighs half of the reflectance. Two steps of compensation are one step, and
/// so much of one step from there; and the roulette of unlimited compensation changes no expectation: averaged over its variate after one
/// vertex, and stopped after two, it is two steps.
fn roulette() -> CheckResult {
    let plates = Plates::new();
    let across = [0.0; 2];
    let one = |surface: usize| plates.recovered(surface, Some(1), &across);
    let expected = one(0) + 0.5 * REFLECTANCE * one(1);
    let limited = plates.recovered(0, Some(2), &[across, across].concat());
    let unlimited = expectation(|u| {
        plates.recovered(0, None, &[&across[..], &[u], &across[..], &[LARGEST_VARIATE]].concat())
    });
    agree(greatest([limited, unlimited].map(|found| (found / expected - 1.0).abs())), GRANTED)
}

/// **Law.** Light starts from each emitter as often as its share of the power says, and from both sides of a lamp that is seen from both
/// alike.
fn emission() -> CheckResult {
    let lamp =
        |z: f64, radiance: f64| diffuse(rectangle(dvec3(-0.5, -0.5, z), DVec3::X, DVec3::Y), 0.0, radiance);
    let globe = diffuse(ball(4.0 * DVec3::Z, 0.4), 0.0, 0.8);
    let surfaces = Surfaces::new(vec![lamp(1.0, 1.5), lamp(2.0, 0.4), globe]);
    let lights = point_light(5.0 * DVec3::X, 3.0);
    // The observer stands in the globe, so that both of its sides are seen.
    let emitters = Emitters::new(&lights, &surfaces, (DVec3::ZERO, 9.0), 4.0 * DVec3::Z);
    let none = environment(0.0);
    let power = |index: usize| {
        let alone = Surfaces::new(vec![Geometry::<f64>::surfaces(&surfaces)[index]]);
        Emitters::new(&none, &alone, (DVec3::ZERO, 9.0), 4.0 * DVec3::Z).power()
    };
    let start = |choice: f64, side: f64| {
        let mut source = Scripted::new([choice, 0.3, 0.6, side, 0.2, 0.7, 0.5]);
        emitters.sample(&lights, &surfaces, &mut source)
    };
    let share = |index: usize| {
        let is_this = |choice: f64| start(choice, 0.2).is_some_and(|start| start.segment.from == Some(index));
        let found = expectation(|choice| if is_this(choice) { 1.0 } else { 0.0 });
        let Some(choice) = (0..1000).map(|i| f64::from(i) / 1000.0).find(|&choice| is_this(choice)) else {
            return f64::NAN;
        };
        // On the outer side of the plane through where it starts, or of the globe.
        let outwards = |line: &Line| match index {
            2 => line.direction.dot(line.origin - 4.0 * DVec3::Z),
            _ => line.direction.z,
        };
        let sides = expectation(|side| {
            start(choice, side).map_or(f64::NAN, |start| outwards(&start.segment.line).signum())
        });
        let carried = start(choice, 0.2).map_or(f64::NAN, |start| start.power / emitters.power() - 1.0);
        (found * emitters.power() / power(index) - 1.0).abs().max(sides.abs()).max(carried.abs())
    };
    agree(greatest([0, 1, 2].map(share)), GRANTED)
}

/// **Law** (Fresnel). At right angles the share that glass reflects is ((n − 1)/(n + 1))², and at Brewster's angle half of
/// ((n² − 1)/(n² + 1))²: found from the decision itself.
fn fresnel() -> CheckResult {
    let of = |ior: f64, cosine: f64, expected: f64| {
        let mut plates = Plates::new();
        let shape = rectangle(dvec3(-9.0, -9.0, 0.0), 18.0 * DVec3::X, 18.0 * DVec3::Y);
        plates.surfaces =
            Surfaces::new(vec![crate::vpl::scenes::smooth(shape, Material::Dielectric { ior })]);
        let direction = dvec3((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, -cosine);
        let line = Line { origin: DVec3::Z, direction };
        let segment = Segment { line, length: f64::INFINITY, from: None, to: None };
        let Some(hit) = plates.surfaces.intersect(&segment) else { return f64::NAN };
        let found = expectation(|u| {
            let passage = plates.world().pass(&hit, direction, &mut Scripted::new([u]));
            passage.map_or(f64::NAN, |passage| if passage.direction.z > 0.0 { 1.0 } else { 0.0 })
        });
        (found / expected - 1.0).abs()
    };
    let deviations = [1.33, 1.5, 2.4].map(|n| {
        let right: f64 = (n - 1.0) / (n + 1.0);
        let polarised: f64 = (n * n - 1.0) / (n * n + 1.0);
        of(n, 1.0, right * right).max(of(n, 1.0 / f64::hypot(1.0, n), 0.5 * polarised * polarised))
    });
    agree(greatest(deviations), 1e-12)
}
