//! Gain of an estimator over ratio tracking, over many rays.

use super::Bout;
use fairflight_sources::{Seeded, UniformSource};

/// Unit of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Look-ups of σ_t.
    Lookups,
    /// CPU seconds.
    Seconds,
}

/// The efficiency 1/(variance · cost) of an estimator over that of another, ray by ray.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// The geometric mean over rays.
    pub mean: f64,
    /// 95 % interval of the mean, over the choice of rays (bootstrap).
    pub interval: [f64; 2],
    /// The gain on the worst ray.
    pub worst: f64,
    /// A tenth of the rays gain less.
    pub tenth: f64,
}

/// Resamples of the interval.
const RESAMPLES: usize = 2000;
/// Variance below which all is rounding: gains beyond are not told apart.
const ROUNDING: f64 = 1e-26;

/// The gain of `ours` over `theirs`, which are of the same rays in the same order; `None` without rays.
#[must_use]
pub fn gain(ours: &[Bout], theirs: &[Bout], unit: Unit, seed: u64) -> Option<Gain> {
    let price = |bout: &Bout| {
        let cost = match unit {
            Unit::Lookups => bout.lookups.max(1.0),
            Unit::Seconds => bout.seconds,
        };
        bout.relative_variance.max(ROUNDING) * cost
    };
    let logs: Vec<f64> =
        ours.iter().zip(theirs).map(|(ours, theirs)| (price(theirs) / price(ours)).ln()).collect();
    if logs.is_empty() {
        return None;
    }
    let mut sorted = logs.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    Some(Gain {
        mean: mean(&logs).exp(),
        interval: bootstrap_mean(&logs, RESAMPLES, seed).map(f64::exp),
        worst: sorted[0].exp(),
        tenth: sorted[sorted.len() / 10].exp(),
    })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The 2.5 and 97.5 % quantiles of means of as many values drawn with replacement, `resamples` times (Efron 1979); 0 without values.
pub fn bootstrap_mean(values: &[f64], resamples: usize, seed: u64) -> [f64; 2] {
    if values.is_empty() {
        return [0.0; 2];
    }
    let mut source = Seeded::new(seed);
    let mut resample = || {
        let drawn = (0..values.len()).map(|_| values[(source.next_uniform() * values.len() as f64) as usize]);
        drawn.sum::<f64>() / values.len() as f64
    };
    let mut means: Vec<f64> = (0..resamples).map(|_| resample()).collect();
    means.sort_unstable_by(f64::total_cmp);
    [means[resamples / 40], means[resamples - 1 - resamples / 40]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bout(relative_variance: f64, lookups: f64) -> Bout {
        Bout {
            relative_variance,
            measured_variance: relative_variance,
            variance_error: 0.0,
            is_closed: true,
            lookups,
            seconds: 1e-6 * lookups,
            relative_mean: 1.0,
            mean_error: 0.0,
            negative: 0.0,
            maximum: 1.0,
            kurtosis: None,
            samples: 1,
            is_certified: true,
        }
    }

    #[test]
    fn a_gain_is_a_geometric_mean_of_ratios() {
        let theirs = [bout(1.0, 10.0), bout(4.0, 10.0)];
        let ours = [bout(0.5, 10.0), bout(0.5, 10.0)];
        let gain = gain(&ours, &theirs, Unit::Lookups, 1).unwrap();
        assert!((gain.mean - 4.0).abs() < 1e-12);
        assert!((gain.worst - 2.0).abs() < 1e-12);
        assert!(gain.interval[0] >= 2.0 - 1e-12 && gain.interval[1] <= 8.0 + 1e-12);
        assert!(super::gain(&[], &[], Unit::Seconds, 1).is_none());
    }
}
