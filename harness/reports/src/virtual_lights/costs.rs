//! Fig. 10: where the time goes.

use super::scenes::{self, BOUND, Choice, lights};
use crate::measured::Measured;
use crate::run::Run;
use cpu_time::ThreadTime;
use fairflight_collision::Version;
use fairflight_document::{Cell, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::field::AnyMedium;
use fairflight_harness::plan::Spectra;
use fairflight_media::phase::Isotropic;
use fairflight_media::{Medium, Ray};
use fairflight_paths::transport::{Event, Types, Vertex, World};
use fairflight_paths::{Heuristic, Ratio, RayTransmittance, Uniform, Walk};
use fairflight_scene::{Geometry, NoSurfaces, Segment, Volume};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_vpl::{Connected, Emitters, Gather, Ledger, LightPaths, Term, Vpl};
use serde_json::json;
use std::hint::black_box;

/// Light paths of a set.
const PATHS: u32 = 100;
/// Independent images per measurement, and sets of an image.
const REPLICAS: u32 = 6;
const SETS: u32 = 4;
/// Rounds of the loops over connections, of which the median counts.
const ROUNDS: usize = 5;
/// Points of eye rays that are connected in a round.
const POINTS: u32 = 400;

pub(super) fn steps() -> u64 {
    4
}

/// Where the time goes.
pub(super) struct Costs {
    /// The share of compensation in the time of an image, two approximate steps with and without seeing surfaces.
    pub(super) share_ignored: Measured,
    pub(super) share_full: Measured,
    pub(super) section: Section,
}

/// What a connection is made of \[ns\].
struct Connection {
    geometry: f64,
    visibility: f64,
    transmittance: f64,
    whole: f64,
    light: f64,
}

pub(super) fn study(run: &Run<'_>) -> Result<Costs, Failure> {
    let subject = scenes::smoke_room(run.quick_or(16, 32))?;
    let seconds = |name: &str, integrator| -> Result<(Measured, f64), Failure> {
        let seed = run.seed(format_args!("costs/{name}"));
        let lit = subject.with("integrator", integrator);
        let images = lit.measure(run.samples(SETS).max(2), (seed, REPLICAS), &run.media)?;
        run.advance();
        Ok((images.measured_seconds(), images.virtual_lights().light_path_seconds))
    };
    let (clamped, paths) = seconds("clamped", lights(PATHS, 1, &json!(BOUND)))?;
    let paper = Choice { strategy: "many_to_one", ..Choice::PAPER };
    let ignored = Choice { visibility: "ignored", ..paper };
    let (ignored, _) = seconds("visibility ignored", ignored.lights(PATHS, 1, BOUND))?;
    let (full, _) = seconds("visibility seen", paper.lights(PATHS, 1, BOUND))?;
    let share = |with: &Measured| clamped.over(with).map(|rest| 1.0 - rest);
    let (share_ignored, share_full) = (share(&ignored), share(&full));
    let connection = connections(run)?;
    run.advance();

    let cell = |measured: Option<&Measured>| measured.map_or(Cell::Empty, Measured::cell);
    let images = Table::of(
        [
            "costs-images",
            "An image",
            "One compensation vertex per point and light, two steps, approximate transmittance: as the paper's renderer has it.",
        ],
        [
            ("light paths alone", Cell::Number(paths), None),
            ("clamped", clamped.cell(), None),
            ("compensated, visibility ignored", ignored.cell(), Some(&share_ignored)),
            ("compensated, visibility seen", full.cell(), Some(&share_full)),
        ],
        &[
            ("image", "", &|(name, ..)| Cell::text(*name)),
            ("CPU seconds", "s", &|(_, seconds, _)| seconds.clone()),
            ("share of compensation", "1", &|(.., share)| cell(*share)),
        ],
    );
    let parts = Table::of(
        [
            "costs-connection",
            "A connection",
            "Between points of eye rays and lights of one set, in the room; medians of loops that ran in turn. Visibility and transmittance by \
             leaving them out; a connection that is not seen needs no transmittance.",
        ],
        [
            ("directions, cosines and phase functions", connection.geometry),
            ("visibility", connection.visibility),
            ("transmittance by ratio tracking", connection.transmittance),
            ("whole connection", connection.whole),
            ("a virtual point light, once per set", connection.light),
        ],
        &[("part", "", &|(name, _)| Cell::text(*name)), ("time", "ns", &|(_, time)| Cell::Number(*time))],
    );
    let text = format!(
        "The room with smoke in gray, sets of {PATHS} light paths, b = {BOUND}. The paper's renderer spends most of its time on shadow maps; \
         here visibility is {} rectangles tried one by one, and transmittance three octaves of noise at each look-up.",
        6
    );
    let section = Section::new("costs", "Fig. 10: where the time goes").with(text).with(images).with(parts);
    Ok(Costs { share_ignored, share_full, section })
}

/// Transmittance left out.
struct Clear;

impl<M: Medium> RayTransmittance<M> for Clear {
    fn estimate(&mut self, _ray: &Ray<&M>, _source: &mut impl UniformSource) -> f64 {
        1.0
    }
}

/// The parts of a connection in the room with smoke.
fn connections(run: &Run<'_>) -> Result<Connection, Failure> {
    let plan = scenes::smoke_room(32)?.with("integrator", lights(PATHS, 1, &json!(BOUND))).plan(
        1,
        run.seed("costs/connection/plan"),
        &run.media,
    )?;
    let (AnyMedium::Perlin(medium), Spectra::Gray(radiant)) = (&plan.medium, &plan.spectra) else {
        return Err(Failure::refused("the room of the report is gray and full of noise"));
    };
    let volume = Volume { medium: &**medium, bounds: plan.bounds, albedo: radiant.albedo, phase: Isotropic };
    let (surfaces, lights) = (&radiant.surfaces, &radiant.lights);
    let world = World::new(&volume, surfaces, lights);
    let sampling = Uniform::new(medium.upper_bound().unwrap_or(1.0)).map_err(Failure::refused)?;
    let walk = Walk::new(Version::NonTerminating, sampling);
    let emitters = Emitters::new(lights, surfaces, world.enclosing_ball(), plan.camera.origin());
    let tracer = LightPaths::new(world, &emitters, walk);
    let mut source = Seeded::new(run.seed("costs/connection/points"));
    let (mut vpls, mut ledger) = (Vec::new(), Ledger::empty());
    let clock = ThreadTime::now();
    for _ in 0..PATHS {
        tracer.trace(1.0 / f64::from(PATHS), &mut ledger, &mut source, |vpl| vpls.push(vpl));
    }
    let light = clock.elapsed().as_secs_f64() * 1e9 / vpls.len().max(1) as f64;

    let [columns, rows] = plan.camera.resolution();
    let collisions = world.collisions(&walk);
    let mut points: Vec<Vertex> = Vec::new();
    for i in 0..POINTS {
        let pixel = [i % columns, i / columns % rows];
        let line = plan.camera.ray(pixel, [0.5, 0.5]);
        let mut segment = Segment { line, length: f64::INFINITY, from: None, to: None };
        let hit = world.surfaces.intersect(&segment);
        segment.length = hit.map_or(f64::INFINITY, |hit| hit.distance);
        match world.follow(&walk, &collisions, &segment, &mut source) {
            Event::Scattered { vertex, .. } => points.push(vertex),
            _ => points
                .extend(hit.as_ref().and_then(|hit| world.diffuse_vertex(hit)).map(|(vertex, _)| vertex)),
        }
    }
    let ratio = || Ratio(sampling);
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        times[0].push(time(
            gather(World::new(&volume, &NoSurfaces, lights), &vpls, walk, Clear),
            &points,
            &mut source,
        ));
        times[1].push(time(
            gather(World::new(&volume, surfaces, lights), &vpls, walk, Clear),
            &points,
            &mut source,
        ));
        times[2].push(time(
            gather(World::new(&volume, &NoSurfaces, lights), &vpls, walk, ratio()),
            &points,
            &mut source,
        ));
        times[3].push(time(gather(world, &vpls, walk, ratio()), &points, &mut source));
    }
    let [geometry, seen, attenuated, whole] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    Ok(Connection {
        geometry,
        visibility: seen - geometry,
        transmittance: attenuated - geometry,
        whole,
        light,
    })
}

fn gather<'s, W: Types<Spectrum = f64>>(
    world: World<'s, W>,
    vpls: &'s [Vpl<f64>],
    walk: Walk<W::Sampling>,
    shadow: W::Shadow,
) -> Gather<'s, W> {
    Gather { world, vpls, term: Term::Bounded(BOUND), heuristic: Heuristic::Balance, walk, shadow }
}

/// Nanoseconds of CPU time per connection.
fn time<W: Types<Spectrum = f64>>(mut gather: Gather<'_, W>, points: &[Vertex], source: &mut Seeded) -> f64 {
    let clock = ThreadTime::now();
    for point in points {
        black_box(gather.connected(point, Connected::All, source));
    }
    clock.elapsed().as_secs_f64() * 1e9 / (points.len() * gather.vpls.len()).max(1) as f64
}
