//! Laws of the path tracer's extensions: whatever chooses directions and light points, the expectation is that of the path tracer.

mod common;

use common::{
    Made, Scene, against, allocations, along, cellar, courtyard, difference, diffuse, furnace, rectangle,
    volume,
};
use fairflight_collision::Version;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Line};
use fairflight_paths::extend::{
    Extended, Extension, LightCandidates, One, Own, OwnShare, PathSampling, Resampled, Several,
};
use fairflight_paths::transport::{Types, Vertex, World};
use fairflight_paths::{Heuristic, Uniform, Walk};
use fairflight_scene::{Background, Lights, Surfaces};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_stats::{Moments, Verdict};
use fairflight_transmittance::Regular;
use glam::{DVec3, dvec3};
use std::f64::consts::PI;
use std::num::NonZeroU32;

const SEEDS: std::ops::Range<u64> = 1..2;
const SAMPLES: u32 = 150_000;

fn many(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).unwrap()
}

fn resampled(candidates: u32, share: f64) -> Resampled {
    Resampled::new(many(candidates), OwnShare::new(share).unwrap())
}

/// Holds `verdict` to be sound for every seed.
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

/// The courtyard by these samplers against the path tracer without any.
fn in_courtyard<E: Extension<Made<Homogeneous>> + Clone, L: LightCandidates>(
    sampling: &PathSampling<E, L>,
    seed: u64,
) -> Verdict {
    let scene = courtyard();
    let mut plain = scene.plain();
    let mut found = tracing(&scene, sampling.clone());
    difference(&mut found, &mut along(&scene.eye, &mut plain), (SAMPLES, seed))
}

/// A path tracer of any samplers, wrong ones included.
fn tracing<'s, E: Extension<Made<Homogeneous>> + 's, L: LightCandidates + 's>(
    scene: &'s Scene<Homogeneous>,
    mut sampling: PathSampling<E, L>,
) -> impl FnMut(&mut Seeded) -> f64 + 's {
    let segment = fairflight_scene::Segment { line: scene.eye, length: f64::INFINITY, from: None, to: None };
    move |source| {
        let how = (&mut sampling, u32::MAX);
        scene.world().trace(&scene.walk, how, (segment, None), &mut Regular, source).radiance
    }
}

const BY_BALANCE: Heuristic = Heuristic::Balance;

#[test]
fn any_number_of_candidates_for_directions() {
    for (candidates, share) in [(1, 0.3), (4, 0.5), (16, 0.6)] {
        let sampling =
            PathSampling { heuristic: BY_BALANCE, extension: resampled(candidates, share), candidates: One };
        agrees(&format!("{candidates} directions"), |seed| in_courtyard(&sampling, seed));
    }
}

#[test]
fn any_number_of_candidates_for_light_points() {
    for heuristic in [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum] {
        for candidates in [1, 3, 16] {
            let sampling = PathSampling { heuristic, extension: Own, candidates: Several(many(candidates)) };
            agrees(&format!("{candidates} light points, {heuristic:?}"), |seed| {
                in_courtyard(&sampling, seed)
            });
        }
    }
}

#[test]
fn both_at_once() {
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        let sampling = PathSampling { heuristic, extension: resampled(4, 0.5), candidates: Several(many(8)) };
        agrees("both", |seed| in_courtyard(&sampling, seed));
    }
}

#[test]
fn a_furnace_is_equally_bright() {
    let scene = furnace();
    let mut tracer = scene.plain().with_extension(resampled(4, 0.7)).with_light_candidates(many(3));
    for seed in SEEDS {
        let verdict = against(1.0, along(&scene.eye, &mut tracer), (SAMPLES, seed));
        assert_eq!(verdict.sound, Some(true), "{}", verdict.reason);
    }
    assert_eq!(tracer.truncated(), 0);
}

/// The part of the light of a square lamp of radiance 1 and half width 1 at the height 2, that a point of a parallel floor below its middle
/// receives (Lambert): irradiance/π = 4 · (a/√(a² + d²)) atan(a/√(a² + d²))/π for a = 1, d = 2, twice for either pair of edges.
fn received() -> f64 {
    let slant = 5f64.sqrt();
    4.0 * (1.0 / slant) * (1.0 / slant).atan() / PI
}

/// A floor of reflectance 1/2 below that lamp, seen from aside.
fn lamp() -> Scene<EmptySpace> {
    let floor = rectangle([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], diffuse(0.5), 0.0);
    let lamp = rectangle([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], diffuse(0.0), 1.0);
    let origin = dvec3(0.6, 0.8, 0.0);
    Scene {
        volume: volume(EmptySpace, 0.0, Bounds::sphere(DVec3::ZERO, 1.0).unwrap()),
        surfaces: Surfaces::new(vec![floor, lamp]),
        lights: Lights { background: Background::dark(), sources: vec![] },
        walk: Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap()),
        eye: Line { origin, direction: -origin.normalize() },
    }
}

#[test]
fn a_lamp_on_a_floor_is_its_form_factor() {
    let scene = lamp();
    let expected = 0.5 * received();
    for heuristic in [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum] {
        for candidates in [2, 10] {
            let points = || scene.by(heuristic).with_light_candidates(many(candidates));
            let name = format!("{candidates}, {heuristic:?}");
            agrees(&name, |seed| against(expected, along(&scene.eye, &mut points()), (SAMPLES, seed)));
            let both = || points().with_extension(resampled(candidates, 0.5));
            agrees(&name, |seed| against(expected, along(&scene.eye, &mut both()), (SAMPLES, seed)));
        }
    }
}

/// Twins of the right choice of directions.
#[derive(Clone, Copy)]
enum Wrong {
    /// The mean of the weights is left out.
    Weightless(Resampled),
    /// A direction counts as often as there were candidates, when it meets a light, and once when it is compared with light points.
    TwoDensities(Resampled),
}

impl Wrong {
    fn right(&self) -> &Resampled {
        let (Self::Weightless(right) | Self::TwoDensities(right)) = self;
        right
    }
}

impl<W: Types> Extension<W> for Wrong {
    fn prepare(&mut self, _world: &World<'_, W>, _vertex: &Vertex) {}
    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        let drawn = self.right().clone().sample(world, vertex, source);
        match self {
            Self::Weightless(_) => Extended { weight: 1.0, ..drawn },
            Self::TwoDensities(_) => Extended { pdf_solid_angle: 8.0 * drawn.pdf_solid_angle, ..drawn },
        }
    }
    fn pdf_solid_angle(&self, vertex: &Vertex, direction: DVec3, scattered: f64) -> f64 {
        Extension::<W>::pdf_solid_angle(self.right(), vertex, direction, scattered)
    }
}

#[test]
fn directions_without_the_mean_of_their_weights_are_rejected() {
    let scene = cellar();
    is_rejected("without the mean", |seed| {
        let mut twin = scene.plain().with_extension(Wrong::Weightless(resampled(8, 0.5)));
        let mut twin = along(&scene.eye, &mut twin);
        difference(&mut twin, &mut along(&scene.eye, &mut scene.plain()), (SAMPLES, seed))
    });
    // Below a lamp as wide as it is high directions and light points share its light: the sum of their weights is off by almost a half.
    let scene = lamp();
    is_rejected("two densities", |seed| {
        let mut twin = scene.plain().with_extension(Wrong::TwoDensities(resampled(8, 0.5)));
        against(0.5 * received(), along(&scene.eye, &mut twin), (SAMPLES, seed))
    });
}

/// Wrong scales of the candidate that is kept.
#[derive(Clone, Copy)]
enum Misscaled {
    /// ris_no_mean: it counts as if it had been drawn alone.
    WithoutMean(Several),
    /// The sum over candidates in place of their mean: weights against directions know nothing of their number on one side.
    Sum(Several),
}

impl Misscaled {
    fn several(self) -> Several {
        match self {
            Self::WithoutMean(several) | Self::Sum(several) => several,
        }
    }
}

impl LightCandidates for Misscaled {
    fn count(self) -> f64 {
        self.several().count()
    }
    fn keep<T, S: UniformSource>(
        self,
        source: &mut S,
        draw: impl FnMut(&mut S) -> Option<T>,
        weigh: impl FnMut(&T) -> f64,
    ) -> Option<(T, f64)> {
        let (kept, scale) = self.several().keep(source, draw, weigh)?;
        Some((kept, if let Self::Sum(several) = self { several.count() * scale } else { 1.0 }))
    }
}

#[test]
fn light_points_without_the_mean_of_their_weights_are_rejected() {
    let several = Several(many(4));
    let sampling =
        PathSampling { heuristic: BY_BALANCE, extension: Own, candidates: Misscaled::WithoutMean(several) };
    is_rejected("the one that is kept", |seed| in_courtyard(&sampling, seed));
    let sampling =
        PathSampling { heuristic: BY_BALANCE, extension: Own, candidates: Misscaled::Sum(several) };
    is_rejected("a sum", |seed| in_courtyard(&sampling, seed));
}

/// Sample variance of an integrator.
fn variance(mut found: impl FnMut(&mut Seeded) -> f64) -> f64 {
    let mut source = Seeded::new(5);
    let moments: Moments = (0..SAMPLES).map(|_| found(&mut source)).collect();
    moments.sample_variance().unwrap()
}

#[test]
fn candidates_save_variance_where_they_tell_something() {
    // Directions where the sky is seen through a hole, light points in the courtyard: each half of the variance or less.
    let scene = cellar();
    let plain = variance(along(&scene.eye, &mut scene.plain()));
    let kept = variance(along(&scene.eye, &mut scene.plain().with_extension(resampled(16, 0.2))));
    assert!(kept < 0.5 * plain, "{kept} of {plain}");
    let scene = courtyard();
    let plain = variance(along(&scene.eye, &mut scene.plain()));
    let kept = variance(along(&scene.eye, &mut scene.plain().with_light_candidates(many(8))));
    assert!(kept < 0.8 * plain, "{kept} of {plain}");
}

#[test]
fn a_hole_in_a_roof() {
    let scene = cellar();
    agrees("directions", |seed| {
        let mut found = scene.plain().with_extension(resampled(16, 0.2));
        difference(
            &mut along(&scene.eye, &mut found),
            &mut along(&scene.eye, &mut scene.plain()),
            (2 * SAMPLES, seed),
        )
    });
}

#[test]
fn a_sample_allocates_nothing() {
    let scene = courtyard();
    let mut tracer = scene.plain().with_extension(resampled(4, 0.5)).with_light_candidates(many(4));
    assert_eq!(allocations(&scene.eye, &mut tracer), 0);
}

#[test]
fn golden_values() {
    // The path tracer without extensions, and with them.
    let scene = courtyard();
    let sum = |mut found: Box<dyn FnMut(&mut Seeded) -> f64 + '_>| {
        let mut source = Seeded::new(1);
        (0..50).map(|_| found(&mut source)).sum::<f64>()
    };
    let candidates = Several(many(4));
    let found = [
        sum(Box::new(tracing(&scene, PathSampling::by(BY_BALANCE)))),
        sum(Box::new(tracing(&scene, PathSampling { heuristic: BY_BALANCE, extension: Own, candidates }))),
        sum(Box::new(tracing(
            &scene,
            PathSampling { heuristic: BY_BALANCE, extension: resampled(4, 0.5), candidates: One },
        ))),
    ];
    for (index, expected) in GOLDEN.into_iter().enumerate() {
        assert!((found[index] / expected - 1.0).abs() < 1e-12, "{found:?}");
    }
}

const GOLDEN: [f64; 3] = [24.16886464634634, 24.836508721552015, 20.868901847613085];
