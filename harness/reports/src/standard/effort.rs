//! Points and seconds of measurements.

/// Numbers of points and CPU seconds. All of them are inputs: no sample size depends on a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// Points of a sweep's curve; odd, so that the majorant itself is one.
    pub(super) sweep_points: usize,
    /// The stride of those that are measured, and the number at either end that are not: the far ends cost most and tell least.
    pub(super) measured_every: usize,
    pub(super) unmeasured_ends: usize,
    /// CPU seconds of one measured point, about.
    pub(super) point_seconds: f64,
    /// CPU seconds of one whose variance can be tested for that.
    pub(super) testable_seconds: f64,
    /// CPU seconds of one point of a convergence curve, about.
    pub(super) convergence_seconds: f64,
    /// CPU seconds of one point of those that are not of the papers.
    pub(super) short_convergence_seconds: f64,
    /// The greatest number of steps of ray marching.
    pub(super) most_steps: u32,
    /// Pixels along an edge of an image.
    pub(super) resolution: usize,
    /// CPU seconds of one measurement that a claim asks for.
    pub(super) claim_seconds: f64,
}

impl Effort {
    pub(super) fn of(quick: bool) -> Self {
        if quick {
            Self {
                sweep_points: 17,
                measured_every: 4,
                unmeasured_ends: 4,
                point_seconds: 0.004,
                testable_seconds: 0.02,
                convergence_seconds: 0.015,
                short_convergence_seconds: 0.003,
                most_steps: 256,
                resolution: 32,
                claim_seconds: 0.02,
            }
        } else {
            Self {
                sweep_points: 49,
                measured_every: 6,
                unmeasured_ends: 0,
                point_seconds: 0.025,
                testable_seconds: 0.6,
                convergence_seconds: 0.1,
                short_convergence_seconds: 0.004,
                most_steps: 4096,
                resolution: 96,
                claim_seconds: 0.15,
            }
        }
    }
}

/// The fewest and the most samples of a point that need not be more, as powers of two: a whole batch, and some seconds of the cheapest field.
const SAMPLES: (u32, u32) = (12, 22);

/// Of how many samples of a point the look-ups are counted: known to two percent, for what is about as much as drawing a cheap point.
pub(super) const COUNTED: u64 = 1 << 11;

impl Effort {
    /// True if the i-th point of a sweep is measured: every other one where the estimator is not of the papers.
    pub(super) fn measures(&self, i: usize, is_of_the_papers: bool) -> bool {
        let stride = if is_of_the_papers { self.measured_every } else { 2 * self.measured_every };
        let inside = self.unmeasured_ends..self.sweep_points - self.unmeasured_ends;
        inside.contains(&i) && i.is_multiple_of(stride)
    }
}

/// The samples that fit into `seconds`, or the `needed` ones, in whole batches, if these fit into `at_most` seconds.
pub(super) fn samples_to_test(seconds: f64, at_most: f64, nanoseconds: f64, needed: f64) -> u64 {
    let usual = samples_within(seconds, nanoseconds);
    if needed <= samples_within(at_most, nanoseconds) as f64 {
        usual.max((needed.ceil() as u64).next_multiple_of(1 << SAMPLES.0))
    } else {
        usual
    }
}

/// The power of two of samples that fits into `seconds` if one costs `nanoseconds`.
pub(super) fn samples_within(seconds: f64, nanoseconds: f64) -> u64 {
    // Drawing variates and logarithms costs about as much as a cheap look-up, whatever the field.
    let each = nanoseconds + 20.0;
    let exponent = (seconds * 1e9 / each).log2().floor();
    1 << (exponent.max(0.0) as u32).clamp(SAMPLES.0, SAMPLES.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_powers_of_two_within_the_budget() {
        for nanoseconds in [1.0, 600.0, 8e3, 3e5] {
            let n = samples_within(0.1, nanoseconds);
            assert!(n.is_power_of_two() && (4096..=1 << 22).contains(&n));
            assert!(n == 4096 || n as f64 * nanoseconds <= 1e8);
        }
    }

    #[test]
    fn a_test_is_paid_for_where_it_is_affordable() {
        let samples = |needed| samples_to_test(0.01, 0.1, 1980.0, needed);
        assert_eq!([f64::INFINITY, 26_000.0, 60_000.0].map(samples), [4096, 28_672, 4096]);
    }
}
