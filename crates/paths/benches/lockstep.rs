//! Importons of an image in lanes over importons one after the other: the image of szirmay-kalos-2017 eq. 21 at 128 x 128, 16 estimates a pixel.
//!
//! `cargo bench -p fairflight-paths --bench lockstep` prints, for several scenes, the time of each per look-up and the median of the ratios of loops that ran in turn.

use fairflight_collision::Version;
use fairflight_media::phase::{HenyeyGreenstein, Rayleigh};
use fairflight_media::{AnalyticCosine, Medium, Observed, Perlin, PerlinParameters, PhaseFunction};
use fairflight_paths::{Integrator, ParticleTracer, Uniform, Walk};
use fairflight_scene::{Background, Camera, Lights, Source, Volume};
use fairflight_sources::{Seeded, UniformSource};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;
use std::time::Instant;

const SIDE: u32 = 128;
/// Columns and rows of a tile.
const TILE: u32 = 16;
const SAMPLES: u32 = 16;
const ROUNDS: usize = 7;

/// Pixels of each tile.
fn tiles() -> Vec<Vec<[u32; 2]>> {
    let steps = || (0..SIDE).step_by(TILE as usize);
    let tile = |left, top| (0..TILE * TILE).map(move |i| [left + i % TILE, top + i / TILE]).collect();
    steps().flat_map(|top| steps().map(move |left| tile(left, top))).collect()
}

/// The sum of all estimates of an image.
fn image<M: Medium, P: PhaseFunction>(
    volume: &Volume<M, P, f64>,
    lights: &Lights<f64>,
    tiles: &[Vec<[u32; 2]>],
    in_lanes: bool,
) -> f64 {
    let camera = Camera::new(dvec3(0.0, 0.0, -20.0), dvec3(0.0, 0.0, 10.0), DVec3::Y, 60.0, [SIDE; 2])
        .expect("a camera");
    let walk = Walk::new(Version::Adaptive, Uniform::new(1.0).expect("positive"));
    let mut tracer = ParticleTracer::new(volume, lights, walk);
    let mut sum = 0.0;
    for pixels in tiles {
        let stream = |[column, row]: &[u32; 2]| Seeded::for_batch(1, u64::from(SIDE * row + column));
        let mut streams: Vec<Seeded> = pixels.iter().map(stream).collect();
        let mut sums = vec![0.0; pixels.len()];
        if in_lanes {
            tracer.trace(&camera, (pixels, SAMPLES), &mut streams, |pixel, radiance| sums[pixel] += radiance);
        } else {
            for ((sum, pixel), source) in sums.iter_mut().zip(pixels).zip(&mut streams) {
                for _ in 0..SAMPLES {
                    let line = camera.ray(*pixel, [source.next_uniform(), source.next_uniform()]);
                    *sum += tracer.radiance(&line, source);
                }
            }
        }
        sum += sums.iter().sum::<f64>();
    }
    sum
}

fn bench<M: Medium, P: PhaseFunction>(name: &str, (medium, phase): (M, P), lights: &Lights<f64>) {
    let (bounds, tiles) = (AnalyticCosine::default_bounds(), tiles());
    let volume = Volume { medium: Observed::new(medium), bounds, albedo: 0.7, phase };
    let time = |in_lanes: bool| {
        let start = Instant::now();
        let sum = image(&volume, lights, &tiles, in_lanes);
        (start.elapsed().as_secs_f64(), sum)
    };
    let expected = time(false).1;
    let lookups = volume.medium.lookups() as f64;
    let mut times: Vec<[f64; 2]> = (0..ROUNDS)
        .map(|_| {
            [false, true].map(|in_lanes| {
                let (seconds, sum) = time(in_lanes);
                assert_eq!(sum.to_bits(), expected.to_bits(), "lanes change a bit");
                seconds
            })
        })
        .collect();
    times.sort_unstable_by(|a, b| (a[0] / a[1]).total_cmp(&(b[0] / b[1])));
    let [one, lanes] = times[ROUNDS / 2];
    println!(
        "{name}: {:.1} ns a look-up one after the other, {:.1} in lanes: {:.2} times as fast",
        1e9 * one / lookups,
        1e9 * lanes / lookups,
        one / lanes
    );
}

fn main() {
    let environment =
        Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() };
    let point = Source::point(dvec3(0.0, 0.0, 10.0), 200.0 * PI).expect("a light");
    let point = Lights { background: Background::dark(), sources: vec![point] };
    let eq21 = AnalyticCosine::new(1.0).expect("finite");
    let noise = PerlinParameters { offset: 0.25, scale: 0.75, ..PerlinParameters::default() };
    let noise = Perlin::new(noise).expect("lawful");
    bench("eq. 21, environment, Rayleigh", (eq21, Rayleigh), &environment);
    let forward = HenyeyGreenstein::new(0.8).expect("lawful");
    bench("eq. 21, environment, Henyey-Greenstein", (eq21, forward), &environment);
    bench("eq. 21, point light, Rayleigh", (eq21, Rayleigh), &point);
    bench("Perlin noise, environment, Rayleigh", (&noise, Rayleigh), &environment);
}
