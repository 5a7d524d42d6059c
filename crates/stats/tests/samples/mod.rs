//! Samples of known laws, and their references.

use fairflight_stats::{ClosedMoments, Moments, Reference, Scores};

pub(crate) const ALPHA: f64 = 1e-6;

/// n samples of which `successes` are `high` and the rest zero, without drawing them.
pub(crate) fn counts(n: u64, successes: u64, high: f64) -> Moments {
    let repeated = |value: f64, mut times: u64| {
        let (mut all, mut block) = (Moments::new(), Moments::from_slice(&[value]));
        while times > 0 {
            if times & 1 == 1 {
                all.merge(&block);
            }
            let half = block;
            block.merge(&half);
            times >>= 1;
        }
        all
    };
    let mut moments = repeated(high, successes);
    moments.merge(&repeated(0.0, n - successes));
    moments
}

/// A stratified sample of a law given by its quantile function: its mean and variance are nearly exact.
pub(crate) fn stratified(n: u32, quantile: impl Fn(f64) -> f64) -> Moments {
    (0..n).map(|i| quantile((f64::from(i) + 0.5) / f64::from(n))).collect()
}

pub(crate) fn exponential(n: u32, mean: f64) -> Moments {
    stratified(n, |u| -mean * (-u).ln_1p())
}

pub(crate) fn unit_exponential() -> Reference {
    let raw = [1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0];
    Reference { moments: Some(ClosedMoments::from_raw(&raw)), ..Reference::exact(1.0) }
}

pub(crate) fn two_valued(mean: f64) -> Reference {
    Reference { scores: Scores::TwoValued { high: 1.0 }, ..Reference::exact(mean) }
}
