//! One walk of the double particle model with explorers, as a transmittance function.

use super::Subject;
use fairflight_collision::DoubleParticle;
use fairflight_harness::Failure;
use fairflight_harness::field::KnownField;
use fairflight_media::Constant;
use fairflight_sources::Seeded;
use fairflight_transmittance::{Explorers, Interaction, Tracking, TransmittanceFunction};

/// Explorer points of the walks that are shown one by one (fig. 5 and 8).
pub(super) const WALK_EXPLORERS: usize = 20;

/// The estimator of szirmay-kalos-2017 section 4.2 with a control through explorers.
pub(super) type Walker = Tracking<DoubleParticle, Explorers, Constant>;

/// The estimator on the ray of a subject.
///
/// # Errors
/// If σ_samp is not lawful.
pub(super) fn walker(subject: &Subject, explorers: usize, sigma_samp: f64) -> Result<Walker, Failure> {
    let field = subject.profile.field();
    let control = Explorers::through(&field, explorers).map_err(Failure::refused)?;
    let sampling = Constant::new(sigma_samp, field.length()).map_err(Failure::refused)?;
    let model = DoubleParticle { albedo: fairflight_collision::Albedo::default() };
    Ok(Tracking::new(model, control, sampling))
}

/// σ_t of a subject's ray at many distances.
pub(super) fn looked_up(subject: &Subject, distances: &[f64]) -> Vec<f64> {
    distances.iter().map(|&s| subject.profile.field().sigma_t(s)).collect()
}

/// The interaction points of `walks` walks from one source.
pub(super) fn trace(
    subject: &Subject,
    walker: &Walker,
    walks: usize,
    mut source: Seeded,
) -> Vec<Vec<Interaction>> {
    let field = subject.profile.field();
    let one = |_| {
        let mut walk = Vec::new();
        TransmittanceFunction::<&dyn KnownField>::trace(walker, &field, &mut source, &mut walk);
        walk
    };
    (0..walks).map(one).collect()
}

/// `count` equidistant distances from 0 to `length`, both included.
pub(super) fn distances(length: f64, count: usize) -> Vec<f64> {
    let last = count - 1;
    (0..count).map(|i| if i == last { length } else { length * i as f64 / last as f64 }).collect()
}
