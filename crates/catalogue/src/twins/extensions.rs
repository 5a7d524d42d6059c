//! Mistakes in extensions of a path tracer, tried by the law that the right ones pass: the expectation of the path tracer without any.

use super::trial::LAWFUL;
use super::{Evident, Rejection, Twin};
use crate::bidirectional::scenes::haze_under_a_sky;
use crate::extensions::{against_paths, noise, plain, ray};
use fairflight_laws::Run;
use fairflight_media::Homogeneous;
use fairflight_paths::extend::{
    Extended, Extension, LightCandidates, Own, OwnShare, PathSampling, Resampled, Several,
};
use fairflight_paths::transport::{Types, Vertex, World};
use fairflight_paths::{Heuristic, Integrator};
use fairflight_photons::{GuideOptions, Guided};
use fairflight_scene::Segment;
use fairflight_sources::UniformSource;
use fairflight_transmittance::Regular;
use glam::DVec3;
use std::num::NonZeroU32;

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let twins = vec![
        Twin::new(
            "guided directions",
            "guide_weightless",
            "a direction that photons chose counts as one that the vertex chose",
            SCENE,
            (200_000, Evident::Mean { z: 30.5 }),
            |run| {
                let view = haze_under_a_sky();
                // One map for all seeds: how wrong it is depends on it.
                let map = noise(&view, 500, 1);
                let options = GuideOptions { nearest: some(20), cells: some(16), own_share: seldom() };
                directions(&Weightless(Guided::new(&map, options)), run)
            },
        ),
        Twin::new(
            "resampled directions",
            "ris_direction_no_mean",
            "the mean of the candidates' weights is left out",
            SCENE,
            (500_000, Evident::Mean { z: 26.5 }),
            |run| directions(&Weightless(Resampled::new(some(16), seldom())), run),
        ),
        Twin::new(
            "resampled light points",
            "ris_no_mean",
            "the point that is kept counts as if it had been drawn alone",
            SCENE,
            (200_000, Evident::Mean { z: 41.8 }),
            |run| light_points(6, |_, _| 1.0, run),
        ),
        Twin::new(
            "resampled light points",
            "ris_sum",
            "the sum of the candidates' weights stands for their mean",
            SCENE,
            (200_000, Evident::Mean { z: 89.4 }),
            |run| light_points(2, |scale, count| count * scale, run),
        ),
    ];
    twins.into_iter().map(|twin| twin.about(["path_tracer"])).collect()
}

const SCENE: &str = "haze under a sky";

fn some(count: u32) -> NonZeroU32 {
    NonZeroU32::new(count).expect(LAWFUL)
}

/// Own directions are few: a mistake in the others shows.
fn seldom() -> OwnShare {
    OwnShare::new(0.1).expect(LAWFUL)
}

/// Directions of an extension that all weigh 1.
#[derive(Clone, Debug)]
struct Weightless<E>(E);

impl<W: Types, E: Extension<W>> Extension<W> for Weightless<E> {
    fn prepare(&mut self, world: &World<'_, W>, vertex: &Vertex) {
        self.0.prepare(world, vertex);
    }

    fn sample(&mut self, world: &World<'_, W>, vertex: &Vertex, source: &mut impl UniformSource) -> Extended {
        // Right: the weight as it was drawn.
        Extended { weight: 1.0, ..self.0.sample(world, vertex, source) }
    }

    fn pdf_solid_angle(&self, vertex: &Vertex, direction: DVec3, scattered: f64) -> f64 {
        self.0.pdf_solid_angle(vertex, direction, scattered)
    }
}

/// Paths that go on by `extension`.
fn directions<E>(extension: &E, run: Run) -> Rejection
where
    E: Extension<crate::bidirectional::scenes::Viewed<Homogeneous, Regular>> + Clone,
{
    let view = haze_under_a_sky();
    let mut tracer = plain(&view).with_extension(extension.clone());
    let verdict = against_paths(&view, |source| tracer.radiance(&ray(&view, source), source), run);
    verdict.map_or_else(|error| Rejection::exact(true, error.to_string()), Rejection::of_mean)
}

/// Candidates of which the one that is kept has a scale made of the right one and of their number.
#[derive(Clone, Copy)]
struct Misscaled {
    several: Several,
    scale: fn(f64, f64) -> f64,
}

impl LightCandidates for Misscaled {
    fn count(self) -> f64 {
        self.several.count()
    }

    fn keep<T, S: UniformSource>(
        self,
        source: &mut S,
        draw: impl FnMut(&mut S) -> Option<T>,
        weigh: impl FnMut(&T) -> f64,
    ) -> Option<(T, f64)> {
        let (kept, right) = self.several.keep(source, draw, weigh)?;
        Some((kept, (self.scale)(right, self.count())))
    }
}

/// Paths with so many candidates for each light point.
fn light_points(candidates: u32, scale: fn(f64, f64) -> f64, run: Run) -> Rejection {
    let view = haze_under_a_sky();
    let candidates = Misscaled { several: Several(some(candidates)), scale };
    let mut sampling = PathSampling { heuristic: Heuristic::Balance, extension: Own, candidates };
    let world = view.world::<Regular>();
    let traced = |source: &mut fairflight_sources::Seeded| {
        let segment = Segment { line: ray(&view, source), length: f64::INFINITY, from: None, to: None };
        let by = (&mut sampling, u32::MAX);
        world.trace(&view.walk, by, (segment, None), &mut Regular, source).radiance
    };
    let verdict = against_paths(&view, traced, run);
    verdict.map_or_else(|error| Rejection::exact(true, error.to_string()), Rejection::of_mean)
}
