//! Drawing estimates in parallel, the same ones whatever the number of threads.

use crate::estimator::Trial;
use crate::{Failure, interrupt};
use cpu_time::ThreadTime;
use fairflight_elementary::lanes::LANES;
use fairflight_laws::{BATCH, batch_count, batch_moments, batch_size};
use fairflight_media::Violation;
use fairflight_sources::{Seeded, derive_seed};
use fairflight_stats::Moments;
use rayon::prelude::*;
use std::ops::Range;

/// Measurement of one estimator on one profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Moments of the estimates.
    pub moments: Moments,
    /// Look-ups per estimate, without those of the preparation.
    pub lookups_per_sample: f64,
    /// CPU seconds over all threads of the loop that drew the estimates, without counting their look-ups (in lanes they are counted on the way).
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
    /// True if batches may be drawn side by side, by an estimator that runs in lanes: the same estimates.
    pub in_lanes: bool,
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
        let width = width(trial, draws, indices.end - indices.start);
        let groups = indices.clone().step_by(width).map(|from| from..indices.end.min(from + width as u64));
        let groups: Vec<Range<u64>> = groups.collect();
        let buffer = || Vec::with_capacity(width * BATCH as usize);
        let one = |values: &mut Vec<f64>, group: Range<u64>| {
            interrupt::check()?;
            let batches = batches_of(trial, draws, group.clone(), values, place)?;
            advance(group.map(|index| batch_size(samples, index)).sum());
            Ok(batches)
        };
        let chunk: Vec<Result<Vec<Batch>, Failure>> = if sequential {
            let mut values = buffer();
            groups.into_iter().map(|group| one(&mut values, group)).collect()
        } else {
            groups.into_par_iter().map_init(buffer, one).collect()
        };
        // In the order of the batches: the first failure and the last bit of each moment are the same on every run.
        for batch in chunk.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten() {
            moments.merge(&batch.moments);
            seconds += batch.seconds;
            lookups += batch.lookups;
            counted += batch.counted;
            negative += batch.negative;
        }
    }
    Ok(Measurement { moments, lookups_per_sample: lookups as f64 / counted as f64, seconds, negative })
}

/// Batches that are drawn side by side, of so many: as many as there are lanes, unless cores would then have nothing to do. The estimates are the same.
fn width(trial: &dyn Trial, draws: Draws, batches: u64) -> usize {
    /// Fewer are drawn one after the other: lanes cost what all of them cost.
    const FEWEST: usize = 4;
    let each = batches.div_ceil(rayon::current_num_threads() as u64) as usize;
    if draws.in_lanes && !draws.sequential && trial.runs_in_lanes() && each >= FEWEST {
        each.min(LANES)
    } else {
        1
    }
}

/// Draws a group of batches.
fn batches_of(
    trial: &dyn Trial,
    draws: Draws,
    group: Range<u64>,
    values: &mut Vec<f64>,
    place: &(dyn Fn(Violation) -> Failure + Sync),
) -> Result<Vec<Batch>, Failure> {
    if group.end - group.start > 1
        && let Some(batches) = in_lanes(trial, draws, group.clone(), values)
    {
        return batches;
    }
    group.map(|index| one_batch(trial, draws, index, values, place)).collect()
}

/// Draws a group of batches, one in each lane; `None` where a look-up may not have been lawful.
fn in_lanes(
    trial: &dyn Trial,
    draws: Draws,
    group: Range<u64>,
    values: &mut Vec<f64>,
) -> Option<Result<Vec<Batch>, Failure>> {
    let sizes = group.clone().map(|index| batch_size(draws.samples, index) as usize);
    values.resize(sizes.clone().sum(), 0.0);
    let (mut slices, mut rest): ([&mut [f64]; LANES], _) =
        (std::array::from_fn(|_| &mut [][..]), &mut values[..]);
    for (slice, size) in slices.iter_mut().zip(sizes) {
        (*slice, rest) = rest.split_at_mut(size);
    }
    let seeds = std::array::from_fn(|lane| derive_seed(draws.seed, group.start + lane as u64));
    let clock = ThreadTime::now();
    let lookups = trial.draw_lanes(seeds, &mut slices)?;
    let seconds = clock.elapsed().as_secs_f64() / (group.end - group.start) as f64;
    let batch = |((index, estimates), lookups): ((u64, &mut [f64]), u64)| {
        let (moments, negative) = told(draws.seed, index, estimates)?;
        let is_counted = index * BATCH < draws.counted;
        let (lookups, counted) = if is_counted { (lookups, estimates.len() as u64) } else { (0, 0) };
        Ok(Batch { moments, seconds, lookups, counted, negative })
    };
    Some(group.zip(slices).zip(lookups).map(batch).collect())
}

/// The moments of a batch, and its estimates below zero.
fn told(seed: u64, index: u64, estimates: &[f64]) -> Result<(Moments, u64), Failure> {
    let moments = batch_moments(seed, index, estimates).map_err(Failure::refused)?;
    Ok((moments, estimates.iter().filter(|estimate| **estimate < 0.0).count() as u64))
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
    let (moments, negative) = told(seed, index, values)?;
    let counted = if index * BATCH < most_counted { size } else { 0 };
    let lookups = trial.count(&mut Seeded::for_batch(seed, index), counted);
    Ok(Batch { moments, seconds, lookups, counted, negative })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{AnyProfile, ExpressionSpec, MediumLibrary, ProfileKind};
    use fairflight_collision::{Albedo, DoubleParticle};
    use fairflight_media::{Constant, PiecewiseLinear, Vacuum};
    use fairflight_transmittance::Tracking;

    /// Ratio tracking, one stream after the other and in lanes.
    fn trials(profile: &AnyProfile, sigma_samp: f64) -> [std::sync::Arc<dyn Trial>; 2] {
        let length = profile.length();
        let estimator = || {
            let sampling = Constant::new(sigma_samp, length).unwrap();
            Tracking::new(DoubleParticle { albedo: Albedo::default() }, Vacuum::new(length), sampling)
        };
        [profile.trial(estimator()), profile.trial_in_lanes(estimator())]
    }

    fn measured(trial: &dyn Trial, samples: u64, counted: u64) -> Result<Measurement, Failure> {
        let draws = Draws { samples, seed: 5, counted, sequential: false, in_lanes: true };
        let place = |at: Violation| Failure::refused(format!("at {}: {}", at.s, at.sigma_t));
        measure(trial, draws, &place, &|_| ())
    }

    #[test]
    fn lanes_change_nothing_but_the_time() {
        let nodes = PiecewiseLinear::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.5]).unwrap();
        let linear = AnyProfile::PiecewiseLinear(nodes);
        let constant = AnyProfile::Constant(Constant::new(1.0, 4.0).unwrap());
        for (profile, sigma_samp) in [(&linear, 0.7), (&linear, 2.0), (&constant, 1.0), (&constant, 3.0)] {
            // A last batch of one estimate, and one batch alone.
            for samples in [17 * BATCH + 1, 100] {
                let [one, lanes] = trials(profile, sigma_samp);
                let found = [one, lanes].map(|trial| measured(&*trial, samples, 5 * BATCH).unwrap());
                let [one, lanes] = found.map(|found| Measurement { seconds: 0.0, ..found });
                assert_eq!(one, lanes, "{sigma_samp}, {samples}");
            }
        }
    }

    #[test]
    fn what_is_not_lawful_is_named_as_by_one_stream() {
        let spec = ExpressionSpec { sigma_t: "1 + 2*(s - 2)".to_owned(), length: 4.0, majorant: Some(2.5) };
        let profile = spec.build(&MediumLibrary::default()).unwrap();
        let found =
            trials(&profile, 2.5).map(|trial| measured(&*trial, 20 * BATCH, 0).unwrap_err().to_string());
        assert_eq!(found[0], found[1]);
    }
}
