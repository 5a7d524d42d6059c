//! The price that surfaces and medium pay for each other.

use super::haze::{Haze, SIGMA_T, haze, homogeneous, spheres, walk};
use super::in_turn::compare;
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{Cell, Table};
use fairflight_harness::Failure;
use fairflight_media::{EmptySpace, Line, Medium};
use fairflight_paths::transport::World;
use fairflight_paths::{Heuristic, Integrator, ParticleTracer, PathTracer, Ratio, Uniform};
use fairflight_scene::{Background, Geometry, Lights, NoSurfaces, Surfaces};
use fairflight_sources::{Seeded, UniformSource};
use glam::dvec3;

/// Paths per timed loop.
const RAYS: u64 = 10_000;

pub(super) const STEPS: u64 = 3;

/// Radiance of 1 from everywhere.
fn sky() -> Lights<f64> {
    Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() }
}

/// The sum over paths from in front of the haze.
fn trace(tracer: &mut impl Integrator<f64>) -> f64 {
    let mut source = Seeded::new(1);
    let mut one = || {
        let aim = dvec3(source.next_uniform() - 0.5, source.next_uniform() - 0.5, 4.5);
        let line = Line { origin: dvec3(0.0, 0.6, -4.5), direction: aim.normalize() };
        tracer.radiance(&line, &mut source)
    };
    (0..RAYS).map(|_| one()).sum()
}

/// Path tracing, transmittance by ratio tracking, so that any medium will do.
fn paths<G: Geometry<f64>, M: Medium>(volume: &Haze<M>, surfaces: &G) -> f64 {
    let lights = sky();
    let world = World::new(volume, surfaces, &lights);
    let shadow = Ratio(Uniform::new(SIGMA_T).expect("positive"));
    trace(&mut PathTracer::new(world, walk(), shadow, Heuristic::Balance))
}

fn particles<M: Medium>(volume: &Haze<M>) -> f64 {
    let lights = sky();
    trace(&mut ParticleTracer::new(volume, &lights, walk()))
}

pub(super) fn study(run: &Run<'_>) -> Result<Table, Failure> {
    let (even, thin, empty) = (haze(homogeneous(SIGMA_T)), haze(homogeneous(0.0)), haze(EmptySpace));
    let (surfaces, none) = (spheres(), Surfaces::new(Vec::new()));
    let rows: [([&str; 2], Measured); 3] = [
        (
            ["path tracer without surfaces", "with an empty list of them"],
            compare(run, &mut || paths(&even, &NoSurfaces), &mut || paths(&even, &none))?,
        ),
        (
            ["path tracer without a medium", "in a medium of extinction 0"],
            compare(run, &mut || paths(&empty, &surfaces), &mut || paths(&thin, &surfaces))?,
        ),
        (
            [
                "path tracer without surfaces",
                "particle tracer, which has no densities and weights to compare",
            ],
            compare(run, &mut || paths(&even, &NoSurfaces), &mut || particles(&even))?,
        ),
    ];
    let caption = "Paths of the haze above in a radiance of 1, one after the other. A scene without surfaces, or without a medium, compiles to no code for them.";
    Ok(Table::of(
        ["surfaces-table", "What surfaces and medium cost each other", caption],
        &rows,
        &[
            ("time of", "", &|row| Cell::text(row.0[0])),
            ("over that of", "", &|row| Cell::text(row.0[1])),
            ("ratio", "1", &|row| row.1.cell()),
        ],
    ))
}
