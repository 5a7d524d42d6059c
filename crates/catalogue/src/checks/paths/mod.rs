//! Walks in space: furnaces, slabs, single scattering, photons against importons, and what bounds a walk.
//!
//! **N.** A walk has no closed moments, and the shape of the sample decides whether its mean may be taken as normal
//! (`fairflight_stats::approximation`). The N that this asks for differs between seeds by a factor whose logarithm has a standard
//! deviation of 0.06, measured over 154 checks (0.1 to 0.3 where N is below 10⁴ or the need a tenth of N). Every quick N of walks and
//! of virtual point lights is at least 1.6 times the need that was measured, eight standard deviations.

mod adjoint;
mod furnace;
mod single;
mod slab;
mod walks;

use super::{Check, Law};
use crate::function::joined;
use fairflight_laws::{CheckResult, NotFinite, Run};
use fairflight_stats::Verdict;

/// A scene that this folder gets wrong would be a bug here, not a finding.
pub(crate) const LAWFUL: &str = "the catalogue's scenes are lawful";

/// All checks of walks in space.
pub(super) fn checks() -> Vec<Check> {
    joined!(checks of furnace, slab, single, adjoint, walks)
}

/// A check of radiance that a verdict decides.
fn radiance(
    name: impl Into<String>,
    estimator: impl Into<String>,
    medium: impl Into<String>,
    samples: u64,
    verdict: impl Fn(Run) -> Result<Verdict, NotFinite> + Send + Sync + 'static,
) -> Check {
    let id = format!("paths/{}", name.into());
    Check::new(id, Law::Radiance, estimator, medium, samples, move |run| result(&verdict(run), run))
}

/// Result of a verdict; a refusal counts as a law that does not hold.
pub(super) fn result(verdict: &Result<Verdict, NotFinite>, run: Run) -> CheckResult {
    match verdict {
        Ok(verdict) => CheckResult::of_verdict(verdict, run.samples),
        Err(error) => CheckResult::exact(false, format!("refused: {error}")),
    }
}
