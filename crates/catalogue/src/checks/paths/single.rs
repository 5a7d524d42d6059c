//! Single scattering: every way to choose distances, with every walk.

use super::{Check, LAWFUL, radiance};
use crate::paths::{check, single_scattering};
use fairflight_collision::{Albedo, DoubleParticle, SingleParticle, Version};
use fairflight_media::phase::{HenyeyGreenstein, Rayleigh};
use fairflight_media::{AnalyticCosine, Bounds, Homogeneous, Line, LineThickness, PhaseFunction};
use fairflight_paths::single_scattering::{
    Heuristic, LineSampled, Primary, Sampling, SharedExplorers, SingleScattering, Technique, Tracked,
};
use fairflight_paths::{Ratio, RayTransmittance, Uniform};
use fairflight_scene::{Background, Lights, Source, Volume};
use fairflight_transmittance::{LineIntegral, Regular, Starts};
use glam::{DVec3, dvec3};
use std::sync::Arc;

/// A medium in light, and two rays through it: their explorers are shared.
struct Scene<M, P> {
    name: &'static str,
    volume: Volume<M, P, f64>,
    lights: Lights<f64>,
    lines: [Line; 2],
    /// N of a quick run ([`super`]); the techniques that are most uneven ask for multiples.
    samples: u64,
}

/// All checks of single scattering.
pub(super) fn checks() -> Vec<Check> {
    use Technique::{Attenuation, Scattering, Source};
    let ratio = |sigma_samp| Ratio(Uniform::new(sigma_samp).expect(LAWFUL));
    let mut checks = Vec::new();

    let inside = Arc::new(point_inside());
    for sampling in all() {
        let more = if sampling == Sampling::One(Source) { 2 } else { 1 };
        checks.push(of(&inside, "ratio", (sampling, more), (tracked(double(), 1.0, None), ratio(1.0))));
    }
    for sampling in all().into_iter().filter(|sampling| !sampling.uses(Attenuation)) {
        let more = if sampling == Sampling::One(Source) { 2 } else { 1 };
        checks.push(of(&inside, "regular", (sampling, more), (Regular, Regular)));
    }

    let outside = Arc::new(camera_inside());
    let is_power = |sampling| matches!(sampling, Sampling::Two(.., Heuristic::Power));
    for sampling in all().into_iter().filter(|&sampling| !is_power(sampling)) {
        // Below the extinction, with a control that two rays of three borrow.
        checks.push(of(
            &outside,
            "below, borrowed control",
            (sampling, 1),
            (tracked(double(), 0.7, Some((10, 3))), Regular),
        ));
    }
    for (name, version) in [("non terminating", Version::NonTerminating), ("adaptive", Version::Adaptive)] {
        let model = SingleParticle { version, albedo: Albedo::new(0.5).expect(LAWFUL) };
        for sampling in [Sampling::One(Attenuation), Sampling::Two(Source, Scattering, Heuristic::Balance)] {
            let name = format!("single particle {name}, own control");
            let more = if sampling == Sampling::One(Attenuation) { 2 } else { 1 };
            checks.push(of(
                &outside,
                &name,
                (sampling, more),
                (tracked(model, 0.9, Some((5, 1))), ratio(0.8)),
            ));
        }
    }

    let parallel = Arc::new(parallel_and_point());
    for sampling in all().into_iter().filter(|sampling| !sampling.uses(Source)) {
        let model = SingleParticle { version: Version::Terminating, albedo: Albedo::new(0.5).expect(LAWFUL) };
        checks.push(of(
            &parallel,
            "single particle terminating",
            (sampling, if sampling == Sampling::One(Scattering) { 2 } else { 1 }),
            (tracked(model, 0.9, None), ratio(0.6)),
        ));
    }
    checks.push(by_line(&inside, Starts::Equidistant));
    checks.push(by_line(&outside, Starts::Independent));
    checks
}

/// Every sampling.
fn all() -> Vec<Sampling> {
    use Technique::{Attenuation, Scattering, Source};
    let mut all = vec![Sampling::AttenuationResampled];
    all.extend([Attenuation, Source, Scattering].map(Sampling::One));
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        for (first, second) in [(Attenuation, Source), (Attenuation, Scattering), (Source, Scattering)] {
            all.push(Sampling::Two(first, second, heuristic));
        }
    }
    all
}

fn words(sampling: Sampling) -> String {
    let name = |technique| match technique {
        Technique::Attenuation => "attenuation",
        Technique::Source => "source",
        Technique::Scattering => "scattering",
    };
    match sampling {
        Sampling::One(technique) => name(technique).to_owned(),
        Sampling::AttenuationResampled => "attenuation resampled".to_owned(),
        Sampling::Two(first, second, heuristic) => {
            let by = match heuristic {
                Heuristic::Balance => "balance",
                Heuristic::Power => "power",
                Heuristic::Maximum => "maximum",
            };
            format!("{} and {}, {by}", name(first), name(second))
        }
    }
}

fn double() -> DoubleParticle {
    DoubleParticle { albedo: Albedo::default() }
}

/// Explorers, and how many rays share them.
fn tracked<L: fairflight_collision::CollisionModel + Copy>(
    model: L,
    sigma_samp: f64,
    explorers: Option<(usize, u32)>,
) -> Tracked<L> {
    let control = explorers.map(|(count, rays)| SharedExplorers::new(count, rays).expect(LAWFUL));
    Tracked::new(model, sigma_samp, control).expect(LAWFUL)
}

fn of<M: LineThickness + Send + Sync + 'static, P: PhaseFunction + Send + Sync + 'static, W, T>(
    scene: &Arc<Scene<M, P>>,
    walk: &str,
    (sampling, more): (Sampling, u64),
    (primary, shadow): (W, T),
) -> Check
where
    W: Primary<M> + Walks + Clone + Send + Sync + 'static,
    T: RayTransmittance<M> + Clone + Send + Sync + 'static,
{
    let (id, scene) = (format!("single/{}/{walk}, {}", scene.name, words(sampling)), Arc::clone(scene));
    // Alone, that technique is uneven where the medium is: more samples, which are stratified.
    let per_ray = if sampling == Sampling::One(Technique::Source) { 8 } else { 2 };
    let (words, name) = (format!("single scattering, {walk}"), scene.name);
    let samples = more * scene.samples;
    radiance(id, words, name, samples, move |run| {
        let Scene { volume, lights, lines, .. } = &*scene;
        // Explorers that fit the scattering-driven technique where the walk has no control.
        let explorers = SharedExplorers::new(7, 3).expect(LAWFUL);
        let (primary, shadow) = (primary.clone(), shadow.clone());
        let mut integrator =
            SingleScattering::new(volume, lights, (sampling, per_ray), primary, shadow, explorers)
                .expect(LAWFUL);
        check(&mut integrator, lines, &single_scattering::reference(volume, lights, lines), run)
    })
    .about(["single_scattering", W::KIND])
}

/// The estimator whose walk runs along a camera ray.
trait Walks {
    const KIND: &'static str;
}
impl Walks for Regular {
    const KIND: &'static str = "regular";
}
impl Walks for Tracked<DoubleParticle> {
    const KIND: &'static str = "double_particle";
}
impl Walks for Tracked<SingleParticle> {
    const KIND: &'static str = "single_particle";
}

fn by_line<M: LineThickness + Send + Sync + 'static, P: PhaseFunction + Send + Sync + 'static>(
    scene: &Arc<Scene<M, P>>,
    starts: Starts,
) -> Check {
    let (id, scene) = (format!("single/{}/algorithm 2, {starts:?}", scene.name), Arc::clone(scene));
    let (name, samples) = (scene.name, scene.samples);
    radiance(id, "single scattering by algorithm 2", name, samples, move |run| {
        let Scene { volume, lights, lines, .. } = &*scene;
        let line = LineIntegral::new(4).expect(LAWFUL);
        let mut integrator = LineSampled::new(volume, lights, (line, starts, 1.0), Regular);
        check(&mut integrator, lines, &single_scattering::reference(volume, lights, lines), run)
    })
    .about(["single_scattering", "line_integral"])
}

/// Eq. 21 in a ball.
fn eq21<P>(albedo: f64, phase: P) -> Volume<AnalyticCosine, P, f64> {
    let bounds = Bounds::sphere(dvec3(0.0, 0.0, 10.0), 3.0).expect(LAWFUL);
    Volume { medium: AnalyticCosine::new(1.0).expect(LAWFUL), bounds, albedo, phase }
}

/// A point light in eq. 21, where that is dense, one unit beside one of the rays, before a background.
fn point_inside() -> Scene<AnalyticCosine, HenyeyGreenstein> {
    Scene {
        name: "eq21 point inside",
        samples: 50_000,
        volume: eq21(0.8, HenyeyGreenstein::new(0.5).expect(LAWFUL)),
        lights: Lights {
            background: Background { constant: 0.05, maps: Vec::new() },
            sources: vec![Source::point(dvec3(0.9, 0.5, 11.1), 10.0).expect(LAWFUL)],
        },
        lines: [
            line(dvec3(0.0, 0.0, -20.0), dvec3(0.005, 0.01, 1.0)),
            line(dvec3(1.5, -0.4, 4.0), dvec3(-0.2, 0.1, 1.0)),
        ],
    }
}

/// The camera stands in eq. 21, the point light outside, and there is no background.
fn camera_inside() -> Scene<AnalyticCosine, Rayleigh> {
    let camera = dvec3(0.3, -0.5, 8.5);
    Scene {
        name: "eq21 camera inside",
        samples: 62_000,
        volume: eq21(0.9, Rayleigh),
        lights: Lights {
            background: Background::dark(),
            sources: vec![Source::point(dvec3(3.0, 2.5, 9.0), 50.0).expect(LAWFUL)],
        },
        lines: [line(camera, dvec3(0.1, 0.2, 1.0)), line(camera, dvec3(0.13, 0.17, 1.0))],
    }
}

/// Two lights, one of them infinitely far, in a homogeneous box before a background.
fn parallel_and_point() -> Scene<Homogeneous, HenyeyGreenstein> {
    Scene {
        name: "homogeneous directional and point",
        samples: 130_000,
        volume: Volume {
            medium: Homogeneous::new(0.7).expect(LAWFUL),
            bounds: Bounds::aligned_box(DVec3::splat(-1.0), dvec3(1.0, 1.5, 2.0)).expect(LAWFUL),
            albedo: 0.6,
            phase: HenyeyGreenstein::new(-0.4).expect(LAWFUL),
        },
        lights: Lights {
            background: Background { constant: 0.1, maps: Vec::new() },
            sources: vec![
                Source::directional(dvec3(0.3, -0.8, 0.5), 2.0).expect(LAWFUL),
                Source::point(dvec3(-1.5, 1.0, 2.5), 40.0).expect(LAWFUL),
            ],
        },
        lines: [line(dvec3(0.2, 0.1, -5.0), DVec3::Z), line(dvec3(3.0, 0.3, 0.2), dvec3(-1.0, 0.05, 0.1))],
    }
}

fn line(origin: DVec3, direction: DVec3) -> Line {
    Line { origin, direction: direction.normalize() }
}
