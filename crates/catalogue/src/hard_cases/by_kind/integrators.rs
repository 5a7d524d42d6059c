//! Every integrator by its kind, in a ball of haze before a background of 1.

use super::ends::End;
use crate::hard_cases::{HardCase, LAWFUL, Outcome, vacuum};
use fairflight_bidirectional::{Bidirectional, Neglected, Subpath, Walking, Weigh};
use fairflight_collision::Version;
use fairflight_compensation::{Compensation, CompensationOptions, LocalMean};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, Line};
use fairflight_metropolis::{Acceptance, Plan, Primary, Redistribution, Splats, Target};
use fairflight_paths::single_scattering::{Sampling, SharedExplorers, SingleScattering, Technique};
use fairflight_paths::transport::{Types, World};
use fairflight_paths::{
    Attenuation, Heuristic, Integrator, LineSplitting, ParticleTracer, PathTracer, Ratio, Uniform, Walk,
};
use fairflight_photons::{BeamRadiance, PhotonMap};
use fairflight_scene::{Background, Camera, Lights, NoSurfaces, Volume};
use fairflight_sources::{LARGEST_VARIATE, Seeded, UniformSource};
use fairflight_transmittance::{LineIntegral, Regular, Starts};
use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Term, Vpl, VplIntegrator};
use glam::{DVec3, dvec3};

/// A homogeneous ball around (0, 0, 10).
#[derive(Clone, Copy)]
struct Ball {
    sigma_t: f64,
    radius: f64,
    albedo: f64,
    anisotropy: f64,
    /// σ_samp of walks, a majorant.
    rate: f64,
}

/// A ball, a line, and the length of the line inside it.
type Setting = (Ball, Line, f64);

/// Radiance of one estimate along a line.
type Radiance = fn(&Ball, &Line, &mut dyn UniformSource) -> f64;

/// Condition under which one estimate is exact.
#[derive(Clone, Copy, PartialEq)]
enum Exact {
    /// Exact without absorption: every path sees the background.
    Furnace,
    /// Exact without scattering: the optical thickness in closed form attenuates the background.
    Absorbing,
    /// Exact on rays that meet no matter.
    Vacuum,
}

const INTEGRATORS: [(&str, Exact, Radiance); 10] = [
    ("transmittance", Exact::Absorbing, transmittance),
    ("particle_tracer", Exact::Furnace, particle_tracer),
    ("line_splitting", Exact::Furnace, line_splitting),
    ("single_scattering", Exact::Absorbing, single_scattering),
    ("path_tracer", Exact::Furnace, path_tracer),
    ("vpl", Exact::Vacuum, vpl),
    ("bidirectional", Exact::Vacuum, bidirectional),
    ("beam_radiance", Exact::Vacuum, beam_radiance),
    ("metropolis", Exact::Furnace, metropolis),
    ("energy_redistribution", Exact::Furnace, energy_redistribution),
];

/// Tells whether a kind is an integrator.
pub(super) fn is_integrator(kind: &str) -> bool {
    INTEGRATORS.iter().any(|(name, ..)| *name == kind)
}

impl Ball {
    fn volume(&self) -> Volume<Homogeneous, HenyeyGreenstein, f64> {
        Volume {
            medium: Homogeneous::new(self.sigma_t).expect(LAWFUL),
            bounds: Bounds::sphere(dvec3(0.0, 0.0, 10.0), self.radius).expect(LAWFUL),
            albedo: self.albedo,
            phase: HenyeyGreenstein::new(self.anisotropy).expect(LAWFUL),
        }
    }

    fn sampling(&self) -> Uniform {
        Uniform::new(self.rate).expect(LAWFUL)
    }

    fn walk(&self) -> Walk<Uniform> {
        Walk::new(Version::NonTerminating, self.sampling())
    }
}

fn lights() -> Lights<f64> {
    Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() }
}

fn transmittance(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    Attenuation::new(&ball.volume(), &lights(), Regular).radiance(line, &mut source)
}

fn particle_tracer(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    ParticleTracer::new(&ball.volume(), &lights(), ball.walk()).radiance(line, &mut source)
}

fn line_splitting(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let splits = LineIntegral::new(4).expect(LAWFUL);
    let (volume, lights) = (ball.volume(), lights());
    LineSplitting::new(&volume, &lights, ball.walk(), (splits, Starts::Equidistant, ball.rate))
        .radiance(line, &mut source)
}

fn single_scattering(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let (volume, lights) = (ball.volume(), lights());
    let sampling = (Sampling::One(Technique::Scattering), 2);
    let explorers = SharedExplorers::new(7, 1).expect(LAWFUL);
    SingleScattering::new(&volume, &lights, sampling, Regular, Regular, explorers)
        .expect(LAWFUL)
        .radiance(line, &mut source)
}

fn path_tracer(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let (volume, lights) = (ball.volume(), lights());
    let world = World::new(&volume, &NoSurfaces, &lights);
    PathTracer::new(world, ball.walk(), Ratio(ball.sampling()), Heuristic::Balance)
        .radiance(line, &mut source)
}

/// The vertices of one light path.
fn light_path<W: Types<Spectrum = f64, Sampling = Uniform>>(
    ball: &Ball,
    world: World<'_, W>,
    line: &Line,
    mut source: &mut dyn UniformSource,
) -> Vec<Vpl<f64>> {
    let emitters = Emitters::new(world.lights, &NoSurfaces, world.enclosing_ball(), line.origin);
    let mut vertices = Vec::new();
    LightPaths::new(world, &emitters, ball.walk())
        .trace(1.0, &mut Ledger::empty(), &mut source, |vertex| vertices.push(vertex));
    vertices
}

fn vpl(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let (volume, lights) = (ball.volume(), lights());
    let world = World::new(&volume, &NoSurfaces, &lights);
    let vpls = light_path(ball, world, line, source);
    let gather = Gather {
        world,
        vpls: &vpls,
        term: Term::Bounded(1.0),
        heuristic: Heuristic::Balance,
        walk: ball.walk(),
        shadow: Regular,
    };
    let mean = LocalMean::of(&volume.medium, &volume.bounds, [1; 3], 1);
    let correction = Compensation::new(CompensationOptions::EXACT, &mean);
    let pairing = correction.pairing();
    VplIntegrator::new(gather, (1, pairing), correction).radiance(line, &mut source)
}

/// A camera of one pixel around a line.
fn camera(line: &Line) -> Camera {
    let up = if line.direction.cross(DVec3::Y) == DVec3::ZERO { DVec3::X } else { DVec3::Y };
    Camera::new(line.origin, line.origin + line.direction, up, 1.0, [1, 1]).expect(LAWFUL)
}

/// The strategies of one camera ray.
fn bidirectional(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let (volume, lights, camera) = (ball.volume(), lights(), camera(line));
    let world = World::new(&volume, &NoSurfaces, &lights);
    let emitters = Emitters::new(&lights, &NoSurfaces, world.enclosing_ball(), line.origin);
    let (thickness, heuristic) = (Neglected, Heuristic::Balance);
    let weigh = Weigh { world, camera: &camera, emitters: &emitters, thickness, heuristic, light_paths: 1.0 };
    let mut integrator = Bidirectional::new(weigh, Walking::new(ball.walk()), Regular);
    let mut light = Subpath::empty();
    integrator.trace_light(&mut light, &mut source);
    integrator.radiance(line, &light, &mut source)
}

/// Chains of path tracing, by `draw`; the sum that they add to the only pixel.
fn chained(
    ball: &Ball,
    line: &Line,
    draw: impl FnOnce(&mut dyn Target<f64>, &mut dyn FnMut([u32; 2], f64)),
) -> f64 {
    let (volume, lights) = (ball.volume(), lights());
    let world = World::new(&volume, &NoSurfaces, &lights);
    let mut tracer = PathTracer::new(world, ball.walk(), Ratio(ball.sampling()), Heuristic::Balance);
    let mut integrand = |splats: &mut Splats<f64>, mut source: &mut dyn UniformSource| {
        splats.push([0, 0], tracer.radiance(line, &mut source));
    };
    let mut sum = 0.0;
    draw(&mut Primary::new(&mut integrand), &mut |_, value| sum += value);
    sum
}

/// A replica of a few steps.
fn metropolis(ball: &Ball, line: &Line, source: &mut dyn UniformSource) -> f64 {
    let plan = Plan::new(2, 1, 4).expect(LAWFUL);
    let seed = source.next_uniform().to_bits();
    chained(ball, line, |target, film| {
        plan.replica(target, (0, seed), film).expect("contributions are finite");
    })
}

/// The energy of one sample, in chains of a few steps.
fn energy_redistribution(ball: &Ball, line: &Line, source: &mut dyn UniformSource) -> f64 {
    let rule = Redistribution::new(4, 0.25).expect(LAWFUL);
    let (seed, mut counts) = (source.next_uniform().to_bits(), [Acceptance::default(); 2]);
    chained(ball, line, |target, film| {
        rule.sample(target, (0, seed), &mut counts, film).expect("contributions are finite");
    })
}

/// The photons of one light path.
fn beam_radiance(ball: &Ball, line: &Line, mut source: &mut dyn UniformSource) -> f64 {
    let (volume, lights) = (ball.volume(), lights());
    let world = World::new(&volume, &NoSurfaces, &lights);
    let map = PhotonMap::new(light_path(ball, world, line, source));
    BeamRadiance::new(world, (&map, 0.5), ball.walk(), Regular, Heuristic::Balance)
        .expect(LAWFUL)
        .radiance(line, &mut source)
}

/// Estimates of one case.
const ESTIMATES: u64 = 16;

/// Rounding of a walk of some thousand collisions.
const GRANTED: f64 = 1e-12;

/// Each estimate is the background through `inside` of the ball, where that is exact; else finite, and not negative.
fn seen(index: usize, settings: &[Setting]) -> Outcome {
    let (_, exact, radiance) = INTEGRATORS[index];
    let mut worst = 0.0_f64;
    for &(ball, line, inside) in settings {
        let albedo = if exact == Exact::Furnace { 1.0 } else { 0.0 };
        let right = match exact {
            Exact::Furnace => Some(1.0),
            Exact::Absorbing => Some((-ball.sigma_t * inside).exp()),
            Exact::Vacuum => (ball.sigma_t * inside == 0.0).then_some(1.0),
        };
        // Whatever is scattered where no estimate is exact.
        let ball = Ball { albedo: if right.is_some() { albedo } else { 0.8 }, ..ball };
        for seed in 0..ESTIMATES {
            let found = radiance(&ball, &line, &mut Seeded::new(seed));
            match right {
                Some(right) => {
                    let off = (found - right).abs();
                    worst = if off.is_nan() { off } else { worst.max(off) };
                }
                None if found >= 0.0 && found.is_finite() => {}
                None => return Outcome::said(false, format!("{found}")),
            }
        }
    }
    Outcome::said(worst <= GRANTED, format!("off by {worst:.1e} at most"))
}

/// The variates at one end, and then their middle.
fn at_the_ends(index: usize) -> Outcome {
    let (.., radiance) = INTEGRATORS[index];
    let ball = Ball { sigma_t: 1.0, radius: 1.0, albedo: 0.8, anisotropy: 0.5, rate: 1.5 };
    for variate in [0.0, LARGEST_VARIATE] {
        for left in 1..5 {
            let found = radiance(&ball, &THROUGH, &mut End::new(variate, left));
            if !found.is_finite() {
                return Outcome::said(false, format!("{found} for {left} variates of {variate}"));
            }
        }
    }
    Outcome::said(true, "finite")
}

/// A line through the middle of the ball.
const THROUGH: Line = Line { origin: DVec3::ZERO, direction: DVec3::Z };

/// Hard cases of every integrator.
pub(super) fn cases(own: &[HardCase]) -> Vec<HardCase> {
    let haze = Ball { sigma_t: 1.0, radius: 1.0, albedo: 1.0, anisotropy: 0.5, rate: 1.2 };
    let ball = |sigma_t: f64, radius: f64, rate: f64| Ball { sigma_t, radius, rate, ..haze };
    let nothing = vec![(ball(0.0, 1e100, 1e-100), THROUGH, 2e100)];
    let beside = [44.0, 372.5, 1000.0].map(|rate| (ball(0.0, 1.0, rate), THROUGH, 2.0)).to_vec();
    let thick =
        [1e-12, 1e-3, 1.0, 50.0].map(|tau: f64| (ball(0.5 * tau, 1.0, 0.6 * tau), THROUGH, 2.0)).to_vec();
    let clipped = vacuum::clips()
        .into_iter()
        .filter(|(.., length, _, _)| length.is_none())
        .map(|(_, origin, direction, _, inside, _)| {
            (ball(0.5, 10.0, 0.6), Line { origin, direction }, inside)
        })
        .collect();
    let lobes = [0.0, 1e-7, 1e-4, 0.999_999]
        .into_iter()
        .flat_map(|g: f64| [g, -g])
        .map(|anisotropy| (Ball { anisotropy, ..haze }, THROUGH, 2.0))
        .collect();
    let rows: [(u32, &str, Vec<Setting>); 5] = [
        (1, "nothing in a ball of radius 1e100", nothing),
        (2, "nothing in a ball, rates of optical thickness 88, 745 and 2000", beside),
        (8, "balls of optical thickness 1e-12 to 50", thick),
        (12, "rays that graze, miss, start on, in and beyond a ball", clipped),
        (16, "anisotropies 0, 1e-7, 1e-4 and 0.999999 of either sign", lobes),
    ];
    let mut cases = Vec::new();
    for (index, &(kind, ..)) in INTEGRATORS.iter().enumerate() {
        let is_met =
            |number| own.iter().any(|case: &HardCase| case.number == number && case.kinds.contains(&kind));
        for (number, what, settings) in rows.iter().filter(|(number, ..)| !is_met(*number)) {
            let (title, settings) = (format!("{what}: {kind}"), settings.clone());
            let exact = "the background: 1, or attenuated; finite where that is no single estimate's answer";
            let case =
                HardCase::deterministic(*number, title, kind, exact, "1e-12", move || seen(index, &settings));
            cases.push(case.about([kind]));
        }
        let title = format!("the uniform variates 0 and 1 - 2^-53: {kind}");
        let case = HardCase::deterministic(14, title, kind, "finite", "finite", move || at_the_ends(index));
        cases.push(case.about([kind]));
    }
    cases
}
