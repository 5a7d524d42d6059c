//! The outcome of testing drawn samples against a whole distribution.

/// What a test of goodness of fit says, with the numbers that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct GoodnessOfFit {
    /// Whether the samples follow the distribution; `None` = not testable at this N.
    pub sound: Option<bool>,
    /// The statistic: Pearson's sum, or Kolmogorov's distance; 0 without a test.
    pub statistic: f64,
    /// A bound of the p-value, safety factors included; `None` without a test that holds its level.
    pub p_value_bound: Option<f64>,
    /// The smallest deviation that would have been rejected with probability 0.99, in the unit that the test states;
    /// `None` without a test.
    pub detectable: Option<f64>,
    /// Why, in words.
    pub reason: String,
}

impl GoodnessOfFit {
    pub(crate) fn not_testable(reason: impl Into<String>) -> Self {
        let reason = format!("not testable: {}", reason.into());
        Self { sound: None, statistic: 0.0, p_value_bound: None, detectable: None, reason }
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
