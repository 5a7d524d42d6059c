//! The variance of combs, as earlier rays showed it.

/// The running mean of k2, the variance of one draw of a comb, over rays that came before.
///
/// A roulette tuned by it ([`Roulette::tuned`](super::Roulette::tuned)) leaves an estimate unbiased if every
/// observation is independent of the variates of that estimate: observe *after* a ray is estimated, use it for the
/// *next*. Merged in a fixed order the result does not depend on threads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningCumulant {
    count: u64,
    mean: f64,
}

impl RunningCumulant {
    /// Nothing observed.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an unbiased estimate of k2, such as the sample variance of independent draws.
    pub fn observe(&mut self, k2: f64) {
        self.count += 1;
        self.mean += (k2 - self.mean) / self.count as f64;
    }

    /// Adds what another one has observed.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        if self.count > 0 {
            self.mean += (other.mean - self.mean) * (other.count as f64 / self.count as f64);
        }
    }

    /// The number of observations.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean; `None` before the first observation.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }
}

#[cfg(test)]
mod tests {
    use super::RunningCumulant;

    #[test]
    fn it_is_the_mean_in_any_parts() {
        let all = [0.5, 0.25, 0.125, 1.0];
        let of = |values: &[f64]| {
            let mut running = RunningCumulant::new();
            values.iter().for_each(|&k2| running.observe(k2));
            running
        };
        assert_eq!(of(&[]).value(), None);
        let mut parts = of(&all[..1]);
        parts.merge(&of(&[]));
        parts.merge(&of(&all[1..]));
        assert!((parts.value().unwrap() - of(&all).value().unwrap()).abs() < 1e-15);
        assert_eq!(parts.count(), 4);
    }
}
