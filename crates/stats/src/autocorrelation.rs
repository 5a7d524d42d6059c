//! Time over which a series stays like itself: a diagnosis of chains.

/// Integrated autocorrelation time τ = 1 + 2 Σ ρ_k (k ≥ 1) of a stationary series, by means of blocks of 1, 2, 4, … values.
///
/// The variance of the mean of b values tends to τ σ²/b, so that
///
/// ```text
/// τ_b = b · Var(means of b values)/Var(values)
/// ```
///
/// reaches τ once b is long beside it (Flyvbjerg and Petersen, "Error estimates on averages of correlated data", 1989). What is told is τ_b of the
/// first b of at least [`WINDOW`](Self::WINDOW) τ_b, as Sokal's window has it for sums of ρ_k ("Monte Carlo methods in statistical mechanics", 1997).
///
/// **A diagnosis, and no error.** It sees one function of the states, and of that function what the series saw: of a mode that was never visited it knows
/// nothing, and blocks of finite length make it too small. Errors of chains come from independent replicas.
///
/// **Cost.** Two additions to sums per value on average, no allocation.
///
/// ```
/// use fairflight_stats::Autocorrelation;
///
/// // Each value four times.
/// let (mut series, mut state) = (Autocorrelation::new(), 1_u64);
/// for _ in 0..10_000 {
///     state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
///     (0..4).for_each(|_| series.push((state >> 33) as f64));
/// }
/// assert!((series.time().unwrap() - 4.0).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Autocorrelation {
    /// The first value, which all sums are relative to.
    first: Option<f64>,
    levels: [Level; Self::LEVELS],
}

/// Means of blocks of one length, less the first value of the series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Level {
    blocks: f64,
    sum: f64,
    squares: f64,
    /// The first of two blocks that make one of the next level.
    half: Option<f64>,
}

impl Level {
    /// Sample variance; `None` for fewer than two blocks.
    fn variance(&self) -> Option<f64> {
        (self.blocks > 1.0)
            .then(|| (self.squares - self.sum * self.sum / self.blocks).max(0.0) / (self.blocks - 1.0))
    }
}

impl Default for Autocorrelation {
    fn default() -> Self {
        Self::new()
    }
}

impl Autocorrelation {
    /// The shortest block that is believed, in times that it tells.
    pub const WINDOW: f64 = 10.0;

    /// The fewest blocks: the variance of their means is known to a quarter then.
    const LEAST: f64 = 32.0;

    const LEVELS: usize = 40;

    /// No values.
    #[must_use]
    pub const fn new() -> Self {
        let none = Level { blocks: 0.0, sum: 0.0, squares: 0.0, half: None };
        Self { first: None, levels: [none; Self::LEVELS] }
    }

    /// Adds the next value of the series.
    #[inline]
    pub fn push(&mut self, value: f64) {
        debug_assert!(value.is_finite(), "a value must be finite, found {value}");
        let mut mean = value - *self.first.get_or_insert(value);
        for level in &mut self.levels {
            level.blocks += 1.0;
            level.sum += mean;
            level.squares += mean * mean;
            match level.half.take() {
                None => {
                    level.half = Some(mean);
                    return;
                }
                Some(half) => mean = 0.5 * (half + mean),
            }
        }
    }

    /// Ends the series: what is pushed next is the start of another one of the same law.
    pub fn end(&mut self) {
        self.levels.iter_mut().for_each(|level| level.half = None);
    }

    /// Adds the blocks of other series of the same law. Their variance is that about the mean of all: series that stay apart have long times.
    pub fn merge(&mut self, other: &Self) {
        let Some(theirs) = other.first else { return };
        let by = theirs - *self.first.get_or_insert(theirs);
        self.end();
        for (level, other) in self.levels.iter_mut().zip(&other.levels) {
            level.blocks += other.blocks;
            level.squares += other.squares + by * (2.0 * other.sum + by * other.blocks);
            level.sum += other.sum + by * other.blocks;
        }
    }

    /// τ \[values\]; `None` where the series is too short to tell it, or constant.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        let all = self.levels[0].variance().filter(|&variance| variance > 0.0)?;
        let mut length = 1.0;
        for level in &self.levels {
            if level.blocks < Self::LEAST {
                return None;
            }
            let time = length * level.variance()? / all;
            if length >= Self::WINDOW * time {
                return Some(time);
            }
            length *= 2.0;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::uniforms;

    /// x' = ρ x + noise: ρ_k = ρ^k.
    fn autoregressive(rho: f64, length: usize, seed: u64) -> Autocorrelation {
        let (mut series, mut x) = (Autocorrelation::new(), 0.0);
        for u in uniforms(seed).take(length) {
            x = rho * x + u - 0.5;
            series.push(1e3 + x);
        }
        series
    }

    #[test]
    fn the_time_of_a_series_of_known_correlation() {
        for (rho, expected) in [(0.0, 1.0), (0.5, 3.0), (0.9, 19.0)] {
            let found = autoregressive(rho, 1 << 18, 3).time().unwrap();
            // Blocks of ten times leave out a twentieth, and some thousand of them know a variance to a twentieth.
            assert!((found / expected - 1.0).abs() < 0.2, "{rho}: {found}");
        }
    }

    #[test]
    fn several_series_are_one_sample() {
        let mut all = Autocorrelation::new();
        for seed in 0..64 {
            all.merge(&autoregressive(0.5, 1 << 10, seed));
        }
        let found = all.time().unwrap();
        assert!((found / 3.0 - 1.0).abs() < 0.2, "{found}");
        // Ended and begun again, no block lies across.
        let mut series = Autocorrelation::new();
        for value in [1.0, 5.0, 2.0] {
            series.push(value);
            series.end();
        }
        assert_eq!((series.levels[0].blocks, series.levels[1].blocks), (3.0, 0.0));
        assert_eq!(series.levels[0].variance(), Some(13.0 / 3.0));
    }

    #[test]
    fn what_cannot_be_told_is_not() {
        assert_eq!(Autocorrelation::new().time(), None);
        assert_eq!(autoregressive(0.99, 500, 1).time(), None);
        let mut constant = Autocorrelation::new();
        (0..10_000).for_each(|_| constant.push(0.1));
        assert_eq!(constant.time(), None);
    }
}
