//! Lengths of paths, chosen before the paths.

use fairflight_sources::UniformSource;

/// A law of the number of edges of a path: in proportion to the light that a pilot found, mixed with a geometric tail.
///
/// **Law.** Every length from the first on has a positive probability: a medium makes paths of any length, and what a pilot did not see must be found as
/// well. A cut-off would be a bias.
///
/// **Variance.** The light of length k is divided by its probability. Where each length holds more than the share `ratio` of the light of the one before,
/// contributions of long paths grow without bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Lengths {
    first: u32,
    /// Sums of the light of the first 1, 2, … lengths.
    cumulative: Vec<f64>,
    tail: f64,
    ratio: f64,
}

/// Error of a law that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LengthsError {
    /// Paths have one edge at least.
    #[error("the first length must be at least 1")]
    NoEdge,
    /// The tail needs a positive probability, and lengths that go on.
    #[error("the share of the tail must lie in (0, 1] and its ratio in (0, 1), found {tail} and {ratio}")]
    NotATail {
        /// The probability of the tail given.
        tail: f64,
        /// The ratio given.
        ratio: f64,
    },
    /// Light that is negative or no number.
    #[error("the light of a length must be a finite number of at least 0, found {0}")]
    NotLight(f64),
}

impl Lengths {
    /// Lengths from `first` on: with the probability `tail` geometric, each following one `ratio` times as probable, else in proportion to `light` of
    /// the lengths `first`, `first` + 1, …, in whatever unit; without light the tail has all.
    ///
    /// # Errors
    /// If `first` is 0, the tail has no probability or no end, or the light is negative or not finite.
    pub fn new(first: u32, light: &[f64], (tail, ratio): (f64, f64)) -> Result<Self, LengthsError> {
        if first == 0 {
            return Err(LengthsError::NoEdge);
        }
        if !(0.0 < tail && tail <= 1.0 && 0.0 < ratio && ratio < 1.0) {
            return Err(LengthsError::NotATail { tail, ratio });
        }
        if let Some(&bad) = light.iter().find(|light| !(light.is_finite() && **light >= 0.0)) {
            return Err(LengthsError::NotLight(bad));
        }
        let mut sum = 0.0;
        let cumulative: Vec<f64> = light
            .iter()
            .map(|light| {
                sum += light;
                sum
            })
            .collect();
        let tail = if sum > 0.0 { tail } else { 1.0 };
        Ok(Self { first, cumulative, tail, ratio })
    }

    /// The probability of a length \[1\].
    #[must_use]
    pub fn pmf(&self, length: u32) -> f64 {
        let Some(index) = length.checked_sub(self.first) else { return 0.0 };
        let geometric = (1.0 - self.ratio) * self.ratio.powi(index.min(i32::MAX as u32) as i32);
        let index = index as usize;
        let before = index.checked_sub(1).map_or(Some(0.0), |before| self.cumulative.get(before).copied());
        let seen = match (before, self.cumulative.get(index), self.cumulative.last()) {
            (Some(before), Some(sum), Some(&total)) if total > 0.0 => (sum - before) / total,
            _ => 0.0,
        };
        self.tail * geometric + (1.0 - self.tail) * seen
    }

    /// Draws a length: by any number of variates, so that none is too long to be drawn.
    pub fn sample(&self, source: &mut dyn UniformSource) -> u32 {
        if source.next_uniform() < self.tail {
            let mut length = self.first;
            while source.next_uniform() < self.ratio {
                length = length.saturating_add(1);
            }
            return length;
        }
        let total = self.cumulative.last().copied().unwrap_or(0.0);
        let target = source.next_uniform() * total;
        let index = self.cumulative.partition_point(|&sum| sum <= target);
        // Rounding may reach the end: the last length with any light.
        self.first + index.min(self.cumulative.partition_point(|&sum| sum < total)) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_sources::Seeded;

    #[test]
    fn lengths_are_drawn_by_their_probabilities() {
        for (first, light) in [(1, vec![3.0, 0.0, 1.0]), (2, vec![1.0, 2.0]), (2, vec![]), (3, vec![0.0])] {
            let lengths = Lengths::new(first, &light, (0.25, 0.5)).unwrap();
            let sum: f64 = (0..200).map(|length| lengths.pmf(length)).sum();
            assert!((sum - 1.0).abs() < 1e-14, "{sum}");
            let mut source = Seeded::new(1);
            let mut counts = [0_u32; 8];
            for _ in 0..40_000 {
                let length = lengths.sample(&mut source) as usize;
                counts[length.min(7)] += 1;
            }
            for (length, &count) in counts[..7].iter().enumerate() {
                let p = lengths.pmf(length as u32);
                let error = (p * (1.0 - p) / 40_000.0).sqrt();
                // Five standard errors: a false alarm of 6e-7 each.
                assert!((f64::from(count) / 40_000.0 - p).abs() <= 5.0 * error, "{length}: {count} {p}");
            }
        }
    }

    #[test]
    fn every_length_has_a_chance() {
        let lengths = Lengths::new(2, &[1.0], (0.1, 0.9)).unwrap();
        assert_eq!((lengths.pmf(0), lengths.pmf(1)), (0.0, 0.0));
        assert!((2..1000).all(|length| lengths.pmf(length) > 0.0));
        assert!((lengths.pmf(4) - 0.1 * 0.1 * 0.81).abs() < 1e-17);
    }

    #[test]
    fn laws_that_are_none_are_refused() {
        assert_eq!(Lengths::new(0, &[], (0.5, 0.5)), Err(LengthsError::NoEdge));
        for (tail, ratio) in [(0.0, 0.5), (0.5, 1.0), (f64::NAN, 0.5), (1.5, 0.5)] {
            assert!(matches!(Lengths::new(1, &[], (tail, ratio)), Err(LengthsError::NotATail { .. })));
        }
        assert_eq!(Lengths::new(1, &[1.0, -1.0], (0.5, 0.5)), Err(LengthsError::NotLight(-1.0)));
    }
}
