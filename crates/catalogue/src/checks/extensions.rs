//! Extensions of the path tracer, each of which leaves its expectation as it is; and the expectation of the beam radiance estimate.

use super::paths::{LAWFUL, result};
use super::{Check, Law};
use crate::bidirectional::scenes::haze_under_a_sky;
use crate::extensions::{against_paths, furnace, noise, plain, ray, traced};
use fairflight_laws::{CheckResult, Run};
use fairflight_paths::extend::{OwnShare, PathReuse, Resampled};
use fairflight_paths::{Heuristic, Integrator};
use fairflight_photons::{GuideOptions, Guided};
use fairflight_transmittance::Regular;
use std::num::NonZeroU32;

fn some(count: u32) -> NonZeroU32 {
    NonZeroU32::new(count).expect(LAWFUL)
}

/// A direction that is drawn too seldom costs up to the reciprocal of this, from vertex to vertex: with less, paths have tails that samples of a
/// reasonable number do not show.
fn share() -> OwnShare {
    OwnShare::new(0.8).expect(LAWFUL)
}

fn unbiased(name: &str, samples: u64, law: impl Fn(Run) -> CheckResult + Send + Sync + 'static) -> Check {
    let id = format!("extensions/{name}");
    Check::new(id, Law::Radiance, "extended path tracing", "haze under a sky", samples, law)
        .about(["path_tracer"])
}

fn guided(name: &str, samples: u64, is_noise: bool) -> Check {
    unbiased(name, samples, move |run| {
        let view = haze_under_a_sky();
        let map = if is_noise { noise(&view, 500, run.seed) } else { traced(&view, 500, run.seed) };
        let options = GuideOptions { nearest: some(20), cells: some(16), own_share: share() };
        let mut tracer = plain(&view).with_extension(Guided::new(&map, options));
        result(&against_paths(&view, |source| tracer.radiance(&ray(&view, source), source), run), run)
    })
}

/// Checks of each extension, of a map of noise too; and of the beam radiance estimate by replicas.
pub(super) fn checks() -> Vec<Check> {
    let law = |run| result(&furnace(100, run), run);
    let (estimator, medium) = ("beam radiance estimate", "a furnace with a mirror");
    let beam = Check::new("extensions/beam radiance", Law::OwnExpectation, estimator, medium, 220_000, law);
    vec![
        guided("guided by photons", 200_000, false),
        guided("guided by noise", 200_000, true),
        unbiased("resampled directions", 200_000, |run| {
            let view = haze_under_a_sky();
            let mut tracer = plain(&view).with_extension(Resampled::new(some(4), share()));
            result(&against_paths(&view, |source| tracer.radiance(&ray(&view, source), source), run), run)
        }),
        unbiased("resampled lights", 200_000, |run| {
            let view = haze_under_a_sky();
            let mut tracer = plain(&view).with_light_candidates(some(6));
            result(&against_paths(&view, |source| tracer.radiance(&ray(&view, source), source), run), run)
        }),
        unbiased("paths of four pixels", 200_000, |run| {
            let view = haze_under_a_sky();
            let mut reuse = PathReuse::new(view.world::<Regular>(), view.walk, Regular, Heuristic::Balance);
            let mut radiances = [0.0; 4];
            let group = |source: &mut _| {
                let lines = [(); 4].map(|()| ray(&view, source));
                reuse.radiances(&lines, &mut radiances, source);
                0.25 * radiances.iter().sum::<f64>()
            };
            result(&against_paths(&view, group, run), run)
        }),
        beam.about(["beam_radiance"]),
    ]
}
