//! The laws of a path tracer's extensions, and of the beam radiance estimate.

use crate::bidirectional::View;
use crate::bidirectional::scenes::Viewed;
use crate::checks::paths::LAWFUL;
use crate::vpl::scenes::{diffuse, rectangle, smooth};
use fairflight_collision::Version;
use fairflight_laws::{NotFinite, Run, measure};
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{Bounds, Homogeneous, Line};
use fairflight_paths::transport::{Emitters, Lobe, MadeOf, Vertex, World};
use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
use fairflight_photons::{BeamRadiance, PhotonMap, SurfaceLight};
use fairflight_scene::{Background, Lights, Material, Surfaces, Volume};
use fairflight_sources::{Seeded, UniformSource, derive_seed};
use fairflight_stats::{Reference, Verdict, judge};
use fairflight_transmittance::Regular;
use fairflight_vpl::{Ledger, LightPaths, Vpl};
use glam::{DVec3, dvec3};

/// The path tracer of a view, without any extension.
pub(crate) type Plain<'s> = PathTracer<'s, Viewed<Homogeneous, Regular>>;

/// One path tracer of a view.
pub(crate) fn plain(view: &View<Homogeneous>) -> Plain<'_> {
    PathTracer::new(view.world(), view.walk, Regular, Heuristic::Balance)
}

/// A camera ray through the only pixel.
pub(crate) fn ray(view: &View<Homogeneous>, source: &mut Seeded) -> Line {
    view.camera.ray([0, 0], [source.next_uniform(), source.next_uniform()])
}

/// **Law.** What an extension finds less what the path tracer finds is 0 on average.
///
/// One sample holds one of either, independent of each other; a constant is added so that power can be told as a relative bias.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn against_paths(
    view: &View<Homogeneous>,
    mut extended: impl FnMut(&mut Seeded) -> f64,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let mut tracer = plain(view);
    let mut traced = |source: &mut Seeded| {
        let line = ray(view, source);
        tracer.radiance(&line, source)
    };
    let scale = measure(derive_seed(run.seed, 1), run.samples, &mut traced)?.mean().unwrap_or(0.0);
    let measured = measure(run.seed, run.samples, |source| scale + extended(source) - traced(source))?;
    Ok(judge(&measured, &Reference::exact(scale).with_mild_tails(), run.alpha))
}

/// The photons of so many light paths, from a stream of their own.
pub(crate) fn traced(view: &View<Homogeneous>, paths: u32, seed: u64) -> PhotonMap<f64> {
    let emitters = view.emitters::<Regular>();
    let mut source = Seeded::new(derive_seed(seed, 2));
    let light_paths = LightPaths::new(view.world::<Regular>(), &emitters, view.walk);
    let mut vertices = Vec::new();
    for _ in 0..paths {
        let share = 1.0 / f64::from(paths);
        light_paths.trace(share, &mut Ledger::empty(), &mut source, |vpl| vertices.push(vpl));
    }
    PhotonMap::new(vertices)
}

/// Photons where there are some, that arrive from anywhere with any power.
pub(crate) fn noise(view: &View<Homogeneous>, paths: u32, seed: u64) -> PhotonMap<f64> {
    let mut source = Seeded::new(derive_seed(seed, 3));
    let right = traced(view, paths, seed);
    let all = right.in_medium().iter().chain(right.on_surfaces());
    PhotonMap::new(all.map(|photon| {
        let [x, y, z] = std::array::from_fn(|_| source.next_uniform() - 0.5);
        let incident = dvec3(x, y, z).normalize_or(DVec3::Z);
        let lobe = match photon.surface {
            Some(surface) => Lobe::Diffuse { normal: -incident, surface: surface as usize },
            None => Lobe::Phase { incident },
        };
        let vertex = Vertex { position: photon.position, lobe };
        Vpl { vertex, incident, power: source.next_uniform(), bounce: 1 }
    }))
}

const SIGMA: f64 = 0.5;
/// Radius of the estimate, within which nothing is smeared out beyond the medium.
const RADIUS: f64 = 0.4;

type Furnace = MadeOf<f64, Homogeneous, HenyeyGreenstein, Surfaces<f64>, Uniform, Regular>;

/// **Law.** The expectation of the beam radiance estimate over maps is the radiance smeared out across the ray: 1 in a furnace, where it is the same
/// everywhere. A medium that absorbs nothing under a sky of 1, a mirror that sends the ray aside, and a panel that glows as much as it absorbs.
///
/// One sample is a replica: a map of `paths` light paths of its own, and a ray.
///
/// # Errors
/// If an estimate is no number.
pub(crate) fn furnace(paths: u32, run: Run) -> Result<Verdict, NotFinite> {
    let mirror = rectangle(dvec3(-1.0, -1.0, 0.0), dvec3(2.0, 0.0, 2.0), 2.0 * DVec3::Y);
    let panel = rectangle(dvec3(1.5, -1.0, 0.0), 2.0 * DVec3::Y, 2.0 * DVec3::Z);
    let all = Surfaces::new(vec![smooth(mirror, Material::Mirror), diffuse(panel, 0.6, 0.4)]);
    let lights = Lights { background: Background { constant: 1.0, maps: Vec::new() }, sources: Vec::new() };
    let volume = Volume {
        medium: Homogeneous::new(SIGMA).expect(LAWFUL),
        // As small as beam and radius allow: photons start anywhere on a ball about it.
        bounds: Bounds::aligned_box(dvec3(-0.5, -0.5, -1.0), dvec3(2.0, 0.5, 1.5)).expect(LAWFUL),
        albedo: 1.0,
        phase: HenyeyGreenstein::new(0.4).expect(LAWFUL),
    };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(SIGMA).expect(LAWFUL));
    let world = World::<Furnace>::new(&volume, &all, &lights);
    let line = Line { origin: dvec3(0.0, 0.0, -0.5), direction: DVec3::Z };
    let emitters = Emitters::new(&lights, &all, world.enclosing_ball(), line.origin);
    let light_paths = LightPaths::new(world, &emitters, walk);
    let measured = measure(run.seed, run.samples, |source| {
        let mut vertices = Vec::new();
        for _ in 0..paths {
            let share = 1.0 / f64::from(paths);
            light_paths.trace(share, &mut Ledger::empty(), source, |vpl| vertices.push(vpl));
        }
        let map = PhotonMap::new(vertices);
        BeamRadiance::new(world, (&map, RADIUS), walk, Regular, Heuristic::Balance)
            .expect(LAWFUL)
            .with_surfaces(SurfaceLight::Map)
            .radiance(&line, source)
    })?;
    Ok(judge(&measured, &Reference::exact(1.0).with_mild_tails(), run.alpha))
}
