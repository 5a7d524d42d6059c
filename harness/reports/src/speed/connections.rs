//! Connections with virtual point lights in even haze, over the parts of a connection alone.

use super::haze::{SIGMA_T, haze, homogeneous, spheres, walk};
use super::in_turn::{Loops, Row};
use crate::run::Run;
use fairflight_document::Table;
use fairflight_elementary::{InstructionSet, exp};
use fairflight_harness::Failure;
use fairflight_media::PhaseFunction;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_paths::transport::{Lobe, Types, Vertex, World};
use fairflight_paths::{Heuristic, Uniform};
use fairflight_scene::{Background, Lights, NoSurfaces};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Term, Vpl};
use glam::{DVec3, dvec3};

/// Greatest geometric term \[1/length²\].
const BOUND: f64 = 20.0;
/// Light paths.
const PATHS: u32 = 200;
/// Points that are connected with all lights.
const POINTS: usize = 100;

pub(super) const STEPS: u64 = 2;

/// Points in the haze.
fn points(source: &mut Seeded) -> Vec<Vertex> {
    let mut between = |low: f64, high: f64| low + (high - low) * source.next_uniform();
    let mut point = || dvec3(between(-2.4, 2.4), between(0.3, 1.2), between(-2.4, 2.4));
    let lobe = Lobe::Phase { incident: DVec3::Z };
    (0..POINTS).map(|_| Vertex { position: point(), lobe }).collect()
}

/// Connects every point with every light, in lanes by this instruction set or one after the other.
fn connect<W: Types<Spectrum = f64, Sampling = Uniform, Shadow = Regular>>(
    world: World<'_, W>,
    (vpls, points): (&[Vpl<f64>], &[Vertex]),
    set: Option<InstructionSet>,
) -> f64 {
    let term = Term::Bounded(BOUND);
    let mut gather =
        Gather { world, vpls, term, heuristic: Heuristic::Balance, walk: walk(), shadow: Regular };
    let source = &mut Seeded::new(1);
    let at = |point| match set {
        Some(set) => gather.all_by(set, point, source),
        None => (0..vpls.len()).map(|index| gather.one(point, index, source)).sum(),
    };
    points.iter().map(at).sum()
}

/// One distance, one transmittance and two values of the phase function for each pair.
fn bare(phase: &HenyeyGreenstein, (vpls, points): (&[Vpl<f64>], &[Vertex])) -> f64 {
    let mut sum = 0.0;
    for point in points {
        for vpl in vpls {
            let offset = vpl.vertex.position - point.position;
            let distance = offset.length();
            let scattering = phase.eval(offset.z / distance) * phase.eval(-offset.x / distance);
            sum += vpl.power * scattering * exp(-SIGMA_T * distance);
        }
    }
    sum
}

pub(super) fn study(run: &Run<'_>) -> Result<Vec<Row>, Failure> {
    let volume = haze(homogeneous(SIGMA_T));
    let surfaces = spheres();
    let lights = Lights { background: Background::dark(), sources: Vec::new() };
    let world = World::new(&volume, &surfaces, &lights);
    let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), dvec3(0.0, 0.6, -4.5));
    let paths = LightPaths::new(world, &emitters, walk());
    let mut source = Seeded::new(1);
    let (mut vpls, mut ledger) = (Vec::new(), Ledger::empty());
    for _ in 0..PATHS {
        paths.trace(1.0 / f64::from(PATHS), &mut ledger, &mut source, |vpl| vpls.push(vpl));
    }
    let points = points(&mut source);
    let empty = World::new(&volume, &NoSurfaces, &lights);
    let pairs = (&vpls[..], &points[..]);
    let size = ((vpls.len() * points.len()) as f64, points.len() as f64);
    let row = |name: &str, connect: &dyn Fn(Option<InstructionSet>) -> f64| {
        let loops = Loops {
            bare: &mut || bare(&volume.phase, pairs),
            one_by_one: &mut || connect(None),
            in_lanes: &mut |set| connect(Some(set)),
        };
        Row::of(run, name, size, loops)
    };
    Ok(vec![
        row("no surfaces", &|set| connect(empty, pairs, set))?,
        row("six surfaces", &|set| connect(world, pairs, set))?,
    ])
}

pub(super) fn table(rows: &[Row]) -> Table {
    let caption = "Virtual point lights in homogeneous haze, transmittance in closed form. Bare parts: one distance, one exponential, two values of the phase function; with surfaces a \
                   connection also asks which of them is in the way, and not all are unoccluded.";
    Row::table(
        ["connections-table", "A connection with a virtual point light", caption],
        ["connection", "point"],
        rows,
    )
}
