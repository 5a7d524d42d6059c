//! The law of transmittance, drawn in lanes.

use super::{Admitted, Evidence, Expectation, Observed, Refusal, Tally, check};
use crate::{Run, batch_count, batch_size};
use fairflight_media::Extinction;
use fairflight_sources::derive_seed;
use fairflight_transmittance::TransmittanceEstimator;
use fairflight_transmittance::lockstep::{self, LANES, Lockstep, Watched};

/// Fewer batches than these are drawn one after the other: lanes cost what all of them cost.
const FEWEST: u64 = 4;

/// Judges as [`check`] does, to the last bit, an estimator that runs in lanes: a batch in each.
///
/// # Errors
/// As there.
pub fn check_in_lanes<'f, 'e, G: Extinction, E: Lockstep<G> + for<'a> Lockstep<Watched<'a, G, E>>>(
    field: &'f G,
    estimator: &'e E,
    expected: &Expectation,
    run: Run,
) -> Result<Evidence, Refusal>
where
    &'e E: TransmittanceEstimator<&'f G> + TransmittanceEstimator<Observed<&'f G, &'e E>>,
{
    let batches = batch_count(run.samples);
    let mut tally = Tally::new(expected, run);
    let mut alone = Observed::new(fairflight_media::Watched::new(field, Admitted { field, estimator }));
    let watched = Watched::new(field, estimator, f64::INFINITY);
    let (mut values, mut counts) = (Vec::new(), Vec::new());
    for from in (0..batches).step_by(LANES) {
        let to = batches.min(from + LANES as u64);
        if to - from < FEWEST {
            for batch in from..to {
                tally.draw(&estimator, &mut alone, batch)?;
            }
            continue;
        }
        let sizes: [usize; LANES] =
            std::array::from_fn(|lane| batch_size(run.samples, from + lane as u64) as usize);
        for numbers in [&mut values, &mut counts] {
            numbers.resize(sizes.iter().sum(), 0.0);
        }
        let (mut estimates, mut lookups) = (slices(&mut values, sizes), slices(&mut counts, sizes));
        let seeds = std::array::from_fn(|lane| derive_seed(run.seed, from + lane as u64));
        lockstep::fill_and_count(estimator, &watched, seeds, &mut estimates, &mut lookups);
        if !watched.all_lawful() {
            // Which look-up it was, if it was one of a walk at all.
            return check(field, estimator, expected, run);
        }
        for ((batch, estimates), lookups) in (from..to).zip(estimates).zip(lookups) {
            tally.add(batch, estimates, lookups)?;
        }
    }
    Ok(tally.judged())
}

/// The parts of these sizes.
fn slices(mut rest: &mut [f64], sizes: [usize; LANES]) -> [&mut [f64]; LANES] {
    sizes.map(|size| {
        let (slice, behind) = std::mem::take(&mut rest).split_at_mut(size);
        rest = behind;
        slice
    })
}
