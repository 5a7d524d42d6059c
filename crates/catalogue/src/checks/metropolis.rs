//! Metropolis sampling: replicas have the expectation of the paths that they are made of.

use super::paths::result;
use super::{Check, Law};
use crate::bidirectional::scenes::haze_under_a_sky;
use crate::metropolis::{Over, redistributed, replicas};
use fairflight_laws::{CheckResult, Run};

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

/// Checks of replicas over each integrator, and of energy redistribution.
pub(super) fn checks() -> Vec<Check> {
    let chains = |name, samples, kinds, over| {
        unbiased(name, samples, kinds, move |run| result(&replicas(over, &haze_under_a_sky(), run), run))
    };
    vec![
        chains("over path tracing", 60_000, &["metropolis", "path_tracer"], Over::PathTracer),
        chains(
            "over bidirectional path tracing",
            60_000,
            &["metropolis", "bidirectional"],
            Over::Bidirectional,
        ),
        chains("one strategy", 60_000, &["metropolis"], Over::Multiplexed),
        unbiased("energy redistribution", 60_000, &["energy_redistribution"], |run| {
            result(&redistributed(&haze_under_a_sky(), run), run)
        }),
    ]
}
