//! The outcome of judging one measured mean and variance, with every number that led to it.

/// Source of the standard error of the mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandardErrorSource {
    /// The moments of the law.
    ClosedForm,
    /// The measured variance.
    Sample,
}

/// Test of the mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeanTest {
    /// Exact binomial test of the number of successes.
    Binomial,
    /// A z-score, normal to a stated accuracy.
    Normal,
    /// Bernstein's inequality, whose power is known.
    Bernstein,
    /// A rejection by an inequality that holds for every shape of the law.
    Inequality,
    /// Agreement to rounding, for a law without variance.
    Rounding,
    /// Broken facts: a value that the law excludes.
    Contradiction,
    /// No test holds its level at this N.
    NotTestable,
}

/// The verdict on one call.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// (measured mean - reference)/standard error, nothing subtracted; `None` where the standard error is zero,
    /// infinite or unknown. Evidence only if `mean_test` is `normal`.
    pub mean_z: Option<f64>,
    /// (sample variance - closed-form variance)/its standard error, nothing subtracted; `None` likewise.
    pub variance_z: Option<f64>,
    /// p-value of the test of the mean, safety factors included and the reference's error granted; `None` if no test
    /// holds its level, and where agreement is judged to rounding.
    pub mean_p: Option<f64>,
    /// p-value of the test of the variance; `None` if there is none that holds its level.
    pub variance_p: Option<f64>,
    /// Smallest |bias|/|reference| of the mean with which this call would have agreed with a probability below 0.01; `None`
    /// for a reference of zero or without a test.
    pub detectable_relative_bias: Option<f64>,
    /// True if mean and variance agree with the reference; `None` = not testable at this N.
    pub sound: Option<bool>,
    /// Reason, in words.
    pub reason: String,
    /// N that would make the mean testable where `sound` is `None`, possibly infinite; `None` if that is unknown.
    pub samples_needed: Option<f64>,
    /// The N from which on a normal approximation of the mean holds at this level, by the shape of the law where that is known,
    /// else of the sample; infinite for a shape that is neither. How near to it a run comes is how much another seed may change.
    pub normal_samples: f64,
    /// Source of the standard error of the mean.
    pub standard_error_source: StandardErrorSource,
    /// Test by which the mean was judged.
    pub mean_test: MeanTest,
}
