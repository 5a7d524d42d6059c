//! Samples in fixed batches, so that a number does not depend on who draws them.

use fairflight_sources::Seeded;
use fairflight_stats::Moments;

/// Samples per batch. Fixed: it is part of what a seed means.
pub const BATCH: u64 = 4096;

/// An estimate that is not a finite number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the estimate of seed {seed}, batch {batch}, sample {sample} is {value}")]
pub struct NotFinite {
    /// The seed of the run.
    pub seed: u64,
    /// The batch.
    pub batch: u64,
    /// The sample within its batch.
    pub sample: u64,
    /// The estimate.
    pub value: f64,
}

/// Number of samples of the batch `index` of a run of `samples`: [`BATCH`], except for the last.
#[must_use]
pub fn batch_size(samples: u64, index: u64) -> u64 {
    samples.saturating_sub(index * BATCH).min(BATCH)
}

/// Number of batches of a run of `samples`.
#[must_use]
pub fn batch_count(samples: u64) -> u64 {
    samples.div_ceil(BATCH)
}

/// Draws the batch `index` of a run into `values`, from a stream of its own.
pub fn draw_batch(
    seed: u64,
    index: u64,
    samples: u64,
    values: &mut Vec<f64>,
    mut trial: impl FnMut(&mut Seeded) -> f64,
) {
    let mut source = Seeded::for_batch(seed, index);
    values.clear();
    values.extend((0..batch_size(samples, index)).map(|_| trial(&mut source)));
}

/// The moments of a batch.
///
/// # Errors
/// If an estimate is not finite: never replaced, never clamped.
pub fn batch_moments(seed: u64, batch: u64, values: &[f64]) -> Result<Moments, NotFinite> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(sample) => Err(NotFinite { seed, batch, sample: sample as u64, value: values[sample] }),
        None => Ok(Moments::from_slice(values)),
    }
}

/// The moments of a whole run, batch after batch: bit for bit what the harness merges from its threads.
///
/// # Errors
/// If an estimate is not finite.
pub fn measure(
    seed: u64,
    samples: u64,
    mut trial: impl FnMut(&mut Seeded) -> f64,
) -> Result<Moments, NotFinite> {
    let mut values = Vec::with_capacity(BATCH as usize);
    let mut moments = Moments::new();
    for batch in 0..batch_count(samples) {
        draw_batch(seed, batch, samples, &mut values, &mut trial);
        moments.merge(&batch_moments(seed, batch, &values)?);
    }
    Ok(moments)
}
