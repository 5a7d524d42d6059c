//! The laws of walks in space: an integrator's expectation is the radiance that the equation of transfer gives.
//!
//! * [`judge_estimates`]: any random radiance against a reference.
//! * [`single_scattering`]: eq. 22 of szirmay-kalos-2017 by quadrature.
//! * [`doubling`]: plane-parallel slabs, all orders of scattering, without a random number; [`slab`]: the same slab as a scene.
//! * [`adjoint`]: importons and photons have one expectation.
//! * [`growth`]: the growth of the squared energy in an endless medium, in closed form.

pub mod adjoint;
pub mod doubling;
pub mod growth;
pub mod single_scattering;
pub mod slab;

use fairflight_laws::{NotFinite, Run, measure};
use fairflight_media::Line;
use fairflight_paths::Integrator;
use fairflight_sources::Seeded;
use fairflight_stats::{Reference, Verdict, judge};

/// Draws `run.samples` independent estimates and judges their mean. Walks have no closed variance: the
/// sample's own is used, and believed, since the scenes of the catalogue are chosen to have mild tails.
///
/// # Errors
/// If an estimate is no number.
pub fn judge_estimates(
    estimate: impl FnMut(&mut Seeded) -> f64,
    reference: &Reference,
    run: Run,
) -> Result<Verdict, NotFinite> {
    Ok(judge(&measure(run.seed, run.samples, estimate)?, &reference.with_mild_tails(), run.alpha))
}

/// **Law.** E\[radiance\] averaged over `lines`, one estimate along each per sample, is the reference. What an integrator shares between
/// rays in a row must not change it.
///
/// # Errors
/// If an estimate is no number.
pub fn check(
    integrator: &mut impl Integrator<f64>,
    lines: &[Line],
    reference: &Reference,
    run: Run,
) -> Result<Verdict, NotFinite> {
    let share = 1.0 / lines.len() as f64;
    let estimate =
        |source: &mut Seeded| share * lines.iter().map(|line| integrator.radiance(line, source)).sum::<f64>();
    judge_estimates(estimate, reference, run)
}
