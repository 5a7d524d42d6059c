//! Time of the preparation of an estimator: that of its explorers, which no measuring loop contains.

use super::Subject;
use cpu_time::ThreadTime;
use fairflight_harness::estimator::Prepared;
use std::hint::black_box;

/// CPU seconds of one preparation.
pub(super) fn preparation_seconds(subject: &Subject, estimator: &Prepared) -> f64 {
    const TIMES: u32 = 256;
    let Some(mut explorers) = estimator.explorers.clone() else { return 0.0 };
    let clock = ThreadTime::now();
    for _ in 0..TIMES {
        explorers.refit(black_box(&subject.profile.field()));
    }
    black_box(&explorers);
    clock.elapsed().as_secs_f64() / f64::from(TIMES)
}
