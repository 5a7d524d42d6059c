//! Samples, seed and false alarm of a statistical check.

use fairflight_stats::{Reference, samples_needed};

/// Input of a statistical check: everything that its numbers depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Number of samples to draw.
    pub samples: u64,
    /// The seed of the check: two checks of one run must not share it ([`fairflight_sources::derive_seed`]).
    pub seed: u64,
    /// The false alarm that the whole check may have. For a family of checks: [`fairflight_stats::sidak_level`].
    pub alpha: f64,
}

/// The relative bias that a check finds, with the probability [`fairflight_stats::POWER`], where moments in closed form tell how many
/// samples that takes: the twentieth that is promised, less a margin for the discreteness of counts.
const DETECTABLE: f64 = 0.045;

/// N of a check whose moments are known may grow up to here; what asks for more is not testable, and says so.
const MOST_SAMPLES: f64 = 2e7;

impl Run {
    /// The same run with at least as many samples as the closed moments of `references` ask for at this `level` each: enough for
    /// their tests to hold it, and to find a relative bias of 4.5 %. No seed enters.
    #[must_use]
    pub fn sufficient_for(self, references: impl IntoIterator<Item = Reference>, level: f64) -> Self {
        let needed = references
            .into_iter()
            .filter_map(|reference| samples_needed(&reference, level, DETECTABLE))
            .filter(|&needed| needed <= MOST_SAMPLES)
            .fold(0.0, f64::max);
        Self { samples: self.samples.max(needed.ceil() as u64), ..self }
    }
}
