//! The outcome of judging one measured mean and variance, with every number that led to it.

use serde::{Serialize, Serializer};

/// Where the standard error of the mean comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StandardErrorSource {
    /// From the moments of the law.
    ClosedForm,
    /// From the measured variance.
    Sample,
}

/// How the mean was tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MeanTest {
    /// Exact binomial test of the number of successes.
    Binomial,
    /// A z-score, normal to a stated accuracy.
    Normal,
    /// Bernstein's inequality.
    Bernstein,
    /// Agreement to rounding, for a law without variance.
    Rounding,
    /// Broken facts: a value that the law excludes.
    Contradiction,
    /// No test holds its level at this N.
    NotTestable,
}

/// The verdict on one call. Infinite numbers are serialised as the string "infinity", missing ones as null.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// (measured mean - reference)/standard error, nothing subtracted; `None` where the standard error is zero,
    /// infinite or unknown. Evidence only if `mean_test` is `normal`.
    #[serde(serialize_with = "number")]
    pub mean_z: Option<f64>,
    /// (sample variance - closed-form variance)/its standard error, nothing subtracted; `None` likewise.
    #[serde(serialize_with = "number")]
    pub variance_z: Option<f64>,
    /// p-value of the test of the mean, safety factors included and the reference's error granted; `None` if no test
    /// holds its level, and where agreement is judged to rounding.
    #[serde(serialize_with = "number")]
    pub mean_p: Option<f64>,
    /// p-value of the test of the variance; `None` if there is none that holds its level.
    #[serde(serialize_with = "number")]
    pub variance_p: Option<f64>,
    /// Smallest |bias|/|reference| of the mean that this call would have rejected with probability 0.99; `None` for a
    /// reference of zero or without a test.
    #[serde(serialize_with = "number")]
    pub detectable_relative_bias: Option<f64>,
    /// Whether mean and variance agree with the reference; `None` = not testable at this N.
    pub sound: Option<bool>,
    /// Why, in words.
    pub reason: String,
    /// Where `sound` is `None`: the N that would make the mean testable, possibly infinite; `None` if that is unknown.
    #[serde(serialize_with = "number")]
    pub samples_needed: Option<f64>,
    /// Where the standard error of the mean comes from.
    pub standard_error_source: StandardErrorSource,
    /// How the mean was tested.
    pub mean_test: MeanTest,
}

/// JSON has no infinity, and null means that a quantity does not exist.
#[expect(clippy::ref_option, reason = "the signature that serde calls")]
fn number<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(x) if x.is_infinite() => {
            serializer.serialize_str(if *x > 0.0 { "infinity" } else { "-infinity" })
        }
        Some(x) => serializer.serialize_f64(*x),
        None => serializer.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::{MeanTest, StandardErrorSource, Verdict};

    #[test]
    fn serialises_infinity_as_a_word() {
        let verdict = Verdict {
            mean_z: Some(0.5),
            variance_z: None,
            mean_p: None,
            variance_p: None,
            detectable_relative_bias: None,
            sound: None,
            reason: "because".to_owned(),
            samples_needed: Some(f64::INFINITY),
            standard_error_source: StandardErrorSource::ClosedForm,
            mean_test: MeanTest::NotTestable,
        };
        assert_eq!(
            serde_json::to_string(&verdict).unwrap(),
            r#"{"mean_z":0.5,"variance_z":null,"mean_p":null,"variance_p":null,"detectable_relative_bias":null,"#
                .to_owned()
                + r#""sound":null,"reason":"because","samples_needed":"infinity","#
                + r#""standard_error_source":"closed_form","mean_test":"not_testable"}"#
        );
    }
}
