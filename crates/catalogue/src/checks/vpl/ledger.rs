//! The power of light paths.

use super::{Check, LAWFUL, Law, result};
use crate::vpl::ledger::{check, check_scattered};
use crate::vpl::rooms::Room;
use crate::vpl::scenes::{
    ball, clear, diffuse, environment, haze, homogeneous, open, point_light, rectangle, smoky,
};
use fairflight_collision::Version;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, EmptySpace, Homogeneous, Medium, PhaseFunction};
use fairflight_paths::transport::{MadeOf, World};
use fairflight_paths::{Uniform, Walk};
use fairflight_scene::{Geometry, NoSurfaces, Surfaces, Volume};
use fairflight_vpl::{KeepNear, Vpl};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// N of a quick run; more where the sample is skewed.
const SAMPLES: u64 = 400_000;
const MORE: u64 = 900_000;
const TERMINATING: Version = Version::Terminating;
const OTHER: Version = Version::NonTerminating;

/// Checks of the ledger.
pub(super) fn checks() -> Vec<Check> {
    // Both sides of a lamp of 0.49 and radiance 5.
    let lamp = 2.0 * PI * 0.49 * 5.0;
    let mut checks = vec![
        energy("surfaces", SAMPLES, || (gray(), 2.0 * PI * 0.16 * 3.0), (OTHER, 1.0)),
        energy("medium", SAMPLES, || (mist(1.0), POWER), (OTHER, 3.0)),
        energy("medium, terminating", SAMPLES, || (mist(1.0), POWER), (TERMINATING, 3.0)),
        // Weights of either sign: 1 − r = −0.25; a small medium keeps their second moment.
        energy("medium, below", MORE, || (mist(0.15), POWER), (OTHER, 1.6)),
        energy("both", SAMPLES, move || (smoky(), lamp), (OTHER, 4.0)),
        energy("both, terminating", SAMPLES, move || (smoky(), lamp), (TERMINATING, 4.0)),
    ];
    for (name, keep_near) in [
        ("all", None),
        ("near", Some(KeepNear { point: dvec3(0.5, 0.0, 0.0), radius: 0.8 })),
        ("nearer", Some(KeepNear { point: DVec3::ZERO, radius: 0.6 })),
    ] {
        checks.push(first_bounce(name, keep_near));
    }
    checks
}

const POWER: f64 = 3.0;

/// A ball of mist with a point light in its middle.
fn mist(radius: f64) -> Room<NoSurfaces, Homogeneous, HenyeyGreenstein> {
    let bounds = Bounds::sphere(DVec3::ZERO, radius).expect(LAWFUL);
    Room {
        volume: Volume { albedo: 0.7, ..haze(homogeneous(2.0), bounds) },
        surfaces: NoSurfaces,
        lights: point_light(DVec3::ZERO, POWER),
        eye: open(EmptySpace).eye,
    }
}

/// A lamp that glows on both sides, over a gray floor and a gray ball.
fn gray() -> Room<Surfaces<f64>, EmptySpace, HenyeyGreenstein> {
    let floor = rectangle(dvec3(-1.0, -0.5, -1.0), 2.0 * DVec3::Z, 2.0 * DVec3::X);
    let lamp = rectangle(dvec3(-0.2, 0.5, -0.2), 0.4 * DVec3::X, 0.4 * DVec3::Z);
    Room {
        surfaces: Surfaces::new(vec![
            diffuse(floor, 0.8, 0.0),
            diffuse(ball(dvec3(-0.3, -0.15, 0.3), 0.3), 0.6, 0.0),
            diffuse(lamp, 0.3, 3.0),
        ]),
        lights: environment(0.0),
        ..clear()
    }
}

/// A room and the power that shines in it, by a formula of its own.
fn energy<G: Geometry<f64> + 'static, M: Medium + 'static, P: PhaseFunction + 'static>(
    name: &str,
    samples: u64,
    room: impl Fn() -> (Room<G, M, P>, f64) + Send + Sync + 'static,
    (version, rate): (Version, f64),
) -> Check {
    let id = format!("vpl/energy/{name}");
    Check::new(id, Law::Energy, "light paths", name, samples, move |run| {
        let (Room { volume, surfaces, lights, .. }, power) = room();
        let world = World::<MadeOf<_, _, _, _, _>>::new(&volume, &surfaces, &lights);
        let walk = Walk::new(version, Uniform::new(rate).expect(LAWFUL));
        result(&check(world, walk, power, run), run)
    })
}

/// Σ power · |x| over first bounces: Φ a ∫ σ e^{−σ r} r dr = Φ a (1/σ − e^{−σ R} (R + 1/σ)) in a ball of radius R.
fn first_bounce(name: &str, keep_near: Option<KeepNear>) -> Check {
    let id = format!("vpl/energy/first bounces, {name} kept");
    Check::new(id, Law::Energy, "light paths", "a ball around a point light", MORE, move |run| {
        let Room { volume, surfaces, lights, .. } = mist(1.0);
        let world = World::<MadeOf<_, _, _, _, _>>::new(&volume, &surfaces, &lights);
        let walk = Walk::new(OTHER, Uniform::new(3.0).expect(LAWFUL));
        let sigma: f64 = 2.0;
        let expected = POWER * volume.albedo * (1.0 / sigma - (-sigma).exp() * (1.0 + 1.0 / sigma));
        let g = |vpl: &Vpl<f64>| match vpl.bounce {
            1 => vpl.vertex.position.length(),
            _ => 0.0,
        };
        result(&check_scattered(world, (walk, keep_near), (g, expected), run), run)
    })
}
