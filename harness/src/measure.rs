//! Drawing estimates in parallel, the same ones whatever the number of threads.

use crate::estimator::Trial;
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_laws::{BATCH, batch_count, batch_moments, batch_size};
use fairflight_media::Violation;
use fairflight_sources::Seeded;
use fairflight_stats::Moments;
use rayon::prelude::*;

/// Measurement of one estimator on one profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Moments of the estimates.
    pub moments: Moments,
    /// Look-ups per estimate, without those of the preparation.
    pub lookups_per_sample: f64,
    /// CPU seconds over all threads of the loop that drew the estimates, without counting their look-ups.
    pub seconds: f64,
    /// The number of estimates below zero.
    pub negative: u64,
}

/// Look-ups are counted in a second run over the same variates, since the run that is timed does not count: of at most
/// this many samples, where nothing else is asked for. A mean of a million counts is known to a thousandth.
pub const MOST_COUNTED: u64 = 1 << 20;

/// Batches in flight before their moments are merged: memory does not grow with the number of samples.
const CHUNK: u64 = 1 << 9;

/// One batch, as a thread returns it.
struct Batch {
    moments: Moments,
    seconds: f64,
    lookups: u64,
    counted: u64,
    negative: u64,
}

/// Number of estimates to be drawn, and the seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    /// The number of estimates.
    pub samples: u64,
    /// The seed of their variates.
    pub seed: u64,
    /// Estimates, in whole batches, whose look-ups are counted.
    pub counted: u64,
    /// True if each estimate may depend on those before it: then there is one thread.
    pub sequential: bool,
}

/// Draws estimates. `advance` is told how many samples were added.
///
/// # Errors
/// If a look-up is not finite or not lawful for the estimator (the place is named by `place`), an estimate is
/// not finite, or an interrupt asked to stop.
pub fn measure(
    trial: &dyn Trial,
    draws: Draws,
    place: &(dyn Fn(Violation) -> Failure + Sync),
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Measurement, Failure> {
    let Draws { samples, sequential, .. } = draws;
    let batches = batch_count(samples);
    let mut moments = Moments::new();
    let (mut seconds, mut lookups, mut counted, mut negative) = (0.0, 0, 0, 0);
    for start in (0..batches).step_by(CHUNK as usize) {
        let indices = start..batches.min(start + CHUNK);
        let buffer = || Vec::with_capacity(BATCH as usize);
        let one = |values: &mut Vec<f64>, index| {
            interrupt::check()?;
            let batch = one_batch(trial, draws, index, values, place)?;
            advance(batch_size(samples, index));
            Ok(batch)
        };
        let chunk: Vec<Result<Batch, Failure>> = if sequential {
            let mut values = buffer();
            indices.map(|index| one(&mut values, index)).collect()
        } else {
            indices.into_par_iter().map_init(buffer, one).collect()
        };
        // In the order of the batches: the first failure and the last bit of each moment are the same on every run.
        for batch in chunk {
            let batch = batch?;
            moments.merge(&batch.moments);
            seconds += batch.seconds;
            lookups += batch.lookups;
            counted += batch.counted;
            negative += batch.negative;
        }
    }
    Ok(Measurement { moments, lookups_per_sample: lookups as f64 / counted as f64, seconds, negative })
}

fn one_batch(
    trial: &dyn Trial,
    Draws { samples, seed, counted: most_counted, .. }: Draws,
    index: u64,
    values: &mut Vec<f64>,
    place: &(dyn Fn(Violation) -> Failure + Sync),
) -> Result<Batch, Failure> {
    let size = batch_size(samples, index);
    values.resize(size as usize, 0.0);
    let clock = ThreadTime::now();
    let drawn = trial.draw(&mut Seeded::for_batch(seed, index), values);
    let seconds = clock.elapsed().as_secs_f64();
    drawn.map_err(place)?;
    let moments = batch_moments(seed, index, values).map_err(Failure::refused)?;
    let negative = values.iter().filter(|value| **value < 0.0).count() as u64;
    let counted = if index * BATCH < most_counted { size } else { 0 };
    let lookups = trial.count(&mut Seeded::for_batch(seed, index), counted);
    Ok(Batch { moments, seconds, lookups, counted, negative })
}
