//! The outcome of testing drawn samples against a whole distribution.

use crate::policy::MAX_DETECTABLE_RELATIVE_BIAS;

/// Result of a test of goodness of fit, with the numbers that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct GoodnessOfFit {
    /// True if the samples follow the distribution; `None` = not testable at this N.
    pub sound: Option<bool>,
    /// The statistic: Pearson's sum, or Kolmogorov's distance; 0 without a test.
    pub statistic: f64,
    /// A bound of the p-value, safety factors included; `None` without a test that holds its level.
    pub p_value_bound: Option<f64>,
    /// The smallest deviation that would have been rejected with probability 0.99, in the unit that the test states;
    /// `None` without a test.
    pub detectable: Option<f64>,
    /// Reason, in words.
    pub reason: String,
}

impl GoodnessOfFit {
    pub(crate) fn not_testable(reason: impl Into<String>) -> Self {
        let reason = format!("not testable: {}", reason.into());
        Self { sound: None, statistic: 0.0, p_value_bound: None, detectable: None, reason }
    }

    /// The outcome of a test whose p-value is held against the false alarm `alpha`. Agreement
    /// says nothing where `detectable`, the deviation rejected with probability 0.99, is too great.
    pub(crate) fn decided(
        statistic: f64,
        (p_value, alpha): (f64, f64),
        detectable: f64,
        reason: &str,
    ) -> Self {
        let sound = match (p_value > alpha, detectable < MAX_DETECTABLE_RELATIVE_BIAS) {
            (false, _) => Some(false),
            (true, true) => Some(true),
            (true, false) => None,
        };
        let without_power = if sound.is_none() { "not testable, without power: " } else { "" };
        Self {
            sound,
            statistic,
            p_value_bound: Some(p_value),
            detectable: Some(detectable),
            reason: format!("{without_power}{reason}"),
        }
    }

    /// Samples that the distribution excludes.
    pub(crate) fn contradiction(reason: impl Into<String>) -> Self {
        Self {
            sound: Some(false),
            statistic: f64::INFINITY,
            p_value_bound: Some(0.0),
            detectable: None,
            reason: reason.into(),
        }
    }
}
