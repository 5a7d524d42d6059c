//! Collisions of the particle tracer, over the parts of a collision alone.

use super::in_turn::{Loops, Row};
use super::media::cosine;
use crate::run::Run;
use fairflight_collision::Version;
use fairflight_document::Table;
use fairflight_elementary::{InstructionSet, ln};
use fairflight_harness::Failure;
use fairflight_media::phase::{HenyeyGreenstein, Rayleigh};
use fairflight_media::{
    AnalyticCosine, Homogeneous, Medium, Observed, Perlin, PerlinParameters, PhaseFunction,
};
use fairflight_paths::{Integrator, ParticleTracer, Uniform, Walk};
use fairflight_scene::{Background, Camera, Lights, Source, Volume};
use fairflight_sources::{Seeded, UniformSource};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// Columns and rows of the image, in tiles of 16 x 16, and estimates of each pixel.
const SIDE: u32 = 64;
const TILE: u32 = 16;
const SAMPLES: u32 = 4;
const ALBEDO: f64 = 0.7;

pub(super) const STEPS: u64 = 5;

/// Pixels of each tile.
fn tiles() -> Vec<Vec<[u32; 2]>> {
    let steps = || (0..SIDE).step_by(TILE as usize);
    let tile = |left, top| (0..TILE * TILE).map(move |i| [left + i % TILE, top + i / TILE]).collect();
    steps().flat_map(|top| steps().map(move |left| tile(left, top))).collect()
}

/// The sum of all estimates of an image, each pixel from a stream of its own: in lanes by this set, or one after the other.
fn image<M: Medium, P: PhaseFunction>(
    volume: &Volume<M, P, f64>,
    (lights, walk): (&Lights<f64>, Walk<Uniform>),
    set: Option<InstructionSet>,
) -> f64 {
    let (origin, towards) = (dvec3(0.0, 0.0, -20.0), dvec3(0.0, 0.0, 10.0));
    let camera = Camera::new(origin, towards, DVec3::Y, 60.0, [SIDE; 2]).expect("a camera");
    let mut tracer = ParticleTracer::new(volume, lights, walk);
    let mut sum = 0.0;
    for pixels in tiles() {
        let stream = |[column, row]: &[u32; 2]| Seeded::for_batch(1, u64::from(SIDE * row + column));
        let mut streams: Vec<Seeded> = pixels.iter().map(stream).collect();
        if let Some(set) = set {
            let take = |_, radiance: f64| sum += radiance;
            tracer.trace_by(set, &camera, (&pixels, SAMPLES), &mut streams, take);
            continue;
        }
        for (pixel, source) in pixels.iter().zip(&mut streams) {
            for _ in 0..SAMPLES {
                let line = camera.ray(*pixel, [source.next_uniform(), source.next_uniform()]);
                sum += tracer.radiance(&line, source);
            }
        }
    }
    sum
}

/// One look-up in the ball, three uniform variates, one logarithm, one direction by the phase function, so many times.
fn bare(medium: &impl Medium, phase: &impl PhaseFunction, collisions: u64) -> f64 {
    let mut source = Seeded::new(1);
    let mut sum = 0.0;
    for _ in 0..collisions {
        let [u, v, w] = [source.next_uniform(), source.next_uniform(), source.next_uniform()];
        sum += medium.sigma_t_local(dvec3(0.3, 0.2, 20.0 * u)) + ln(1.0 - u);
        sum += phase.sample(DVec3::Z, v, w).direction.x;
    }
    sum
}

fn row<M: Medium + Copy, P: PhaseFunction + Copy>(
    run: &Run<'_>,
    name: &str,
    (medium, phase): (M, P),
    (lights, sigma_samp): (&Lights<f64>, f64),
) -> Result<Row, Failure> {
    let bounds = AnalyticCosine::default_bounds();
    let volume = Volume { medium, bounds, albedo: ALBEDO, phase };
    let walk = Walk::new(Version::Adaptive, Uniform::new(sigma_samp).expect("positive"));
    let how = (lights, walk);
    let observed = volume.with_medium(Observed::new(medium));
    image(&observed, how, None);
    let collisions = observed.medium.lookups();
    let loops = Loops {
        bare: &mut || bare(&medium, &phase, collisions),
        one_by_one: &mut || image(&volume, how, None),
        in_lanes: &mut |set| image(&volume, how, Some(set)),
    };
    Row::of(run, name, (collisions as f64, f64::from(SIDE * SIDE * SAMPLES)), loops)
}

pub(super) fn study(run: &Run<'_>) -> Result<Vec<Row>, Failure> {
    let sky = Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() };
    let point = Source::point(dvec3(0.0, 0.0, 10.0), 200.0 * PI).expect("a light");
    let point = Lights { background: Background::dark(), sources: vec![point] };
    let noise = PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() };
    let noise = Perlin::new(noise).expect("lawful");
    let forward = HenyeyGreenstein::new(0.8).expect("within ±1");
    let even = Homogeneous::new(0.25).expect("finite");
    Ok(vec![
        row(run, "homogeneous, sky", (even, Rayleigh), (&sky, 0.25))?,
        row(run, "eq. 21, sky", (cosine(), Rayleigh), (&sky, 1.0))?,
        row(run, "eq. 21, sky, Henyey-Greenstein 0.8", (cosine(), forward), (&sky, 1.0))?,
        row(run, "eq. 21, point light", (cosine(), Rayleigh), (&point, 1.0))?,
        row(run, "Perlin noise of twelve octaves, sky", (&noise, Rayleigh), (&sky, 1.0))?,
    ])
}

pub(super) fn table(rows: &[Row]) -> Table {
    let caption = "Adaptive single particles in the ball of eq. 21, albedo 0.7, Rayleigh scattering where nothing else is said; an image of 64 x 64, four estimates a pixel, whose rays \
                   outside the ball make no collision. Bare parts: one look-up, three uniform variates, one logarithm, one direction by the phase function; not every collision scatters. \
                   Look-ups of connections with lights count as collisions.";
    Row::table(
        ["walks-table", "A collision of the particle tracer", caption],
        ["collision", "camera ray"],
        rows,
    )
}
