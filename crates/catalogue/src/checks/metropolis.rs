//! Metropolis sampling: replicas have the expectation of the paths that they are made of.

use super::paths::result;
use super::{Check, Law};
use crate::bidirectional::View;
use crate::bidirectional::scenes::haze_under_a_sky;
use crate::metropolis::{Over, Taught, of_paths, redistributed, replicas};
use fairflight_laws::{CheckResult, Run};
use fairflight_media::Homogeneous;

fn unbiased(
    name: &str,
    samples: u64,
    kinds: &[&'static str],
    law: impl Fn(Run) -> CheckResult + Send + Sync + 'static,
) -> Check {
    let id = format!("metropolis/{name}");
    Check::new(id, Law::Radiance, "Metropolis sampling", "haze under a sky", samples, law)
        .about(kinds.iter().copied())
}

fn four_pixels() -> View<Homogeneous> {
    haze_under_a_sky().in_pixels([2, 2])
}

/// Checks of replicas over path tracing from one end and from both, of chains that were taught, of chains of paths, and of energy redistribution. One strategy
/// per sample has tails that no affordable N tests: its means are the crate's own tests.
pub(super) fn checks() -> Vec<Check> {
    let chains = |name, samples, kinds: &[&'static str], how| {
        unbiased(name, samples, kinds, move |run| result(&replicas(how, &four_pixels(), run), run))
    };
    let (paths, both) = (["metropolis", "path_tracer"], ["metropolis", "bidirectional"]);
    vec![
        chains("over path tracing", 300_000, &paths, (Over::PathTracer, Taught::Nothing)),
        chains("over bidirectional path tracing", 300_000, &both, (Over::Bidirectional, Taught::Nothing)),
        chains("importance of pixels", 150_000, &paths, (Over::PathTracer, Taught::Importance)),
        chains("sizes of steps by pixel", 300_000, &paths, (Over::PathTracer, Taught::Sizes)),
        unbiased("in path space", 150_000, &both, |run| result(&of_paths(&four_pixels(), run), run)),
        unbiased("energy redistribution", 300_000, &["energy_redistribution"], |run| {
            result(&redistributed(&four_pixels(), run), run)
        }),
    ]
}
