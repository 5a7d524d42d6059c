//! What the preparation of an estimator costs: the time of its explorers, which no measuring loop contains.

use super::Subject;
use crate::plan::{AnyControl, AnyEstimator, Field, FieldJob, KnownField};
use cpu_time::ThreadTime;
use fairflight_transmittance::Explorers;
use std::hint::black_box;

/// CPU seconds of one preparation.
pub(super) fn preparation_seconds(subject: &Subject, estimator: &AnyEstimator) -> f64 {
    let control = match estimator {
        AnyEstimator::DoubleParticle(tracking) => tracking.control(),
        AnyEstimator::SingleParticle(tracking) => tracking.control(),
        AnyEstimator::Woodcock { .. }
        | AnyEstimator::LineIntegral { .. }
        | AnyEstimator::RayMarching(_)
        | AnyEstimator::Beyond(_) => {
            return 0.0;
        }
    };
    match control {
        AnyControl::Explorers(explorers) => subject.profile.with(Refit(explorers.clone())),
        AnyControl::None(_) | AnyControl::Constant(_) | AnyControl::PiecewiseLinear(_) => 0.0,
    }
}

struct Refit(Explorers);

impl FieldJob for Refit {
    type Output = f64;
    fn run<F: KnownField>(mut self, field: &F) -> f64
    where
        for<'a> &'a F: Field,
    {
        const TIMES: u32 = 256;
        let clock = ThreadTime::now();
        for _ in 0..TIMES {
            self.0.refit(black_box(field));
        }
        black_box(&self.0);
        clock.elapsed().as_secs_f64() / f64::from(TIMES)
    }
}
