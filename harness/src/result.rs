//! Result of an experiment: the struct that every writer reads.

use fairflight_stats::Verdict;
use serde::{Serialize, Serializer};
use serde_json::Value;

/// The results of a sweep.
#[derive(Clone, Debug, Serialize)]
pub struct SweepResult<R> {
    /// The results, one for each value, in their order.
    pub points: Vec<SweepPoint<R>>,
}

/// The result at one value of the swept key.
#[derive(Clone, Debug, Serialize)]
pub struct SweepPoint<R> {
    /// The value.
    pub value: Value,
    /// The result, among whose keys the value stands.
    #[serde(flatten)]
    pub result: R,
}

/// The result of one experiment, in the form of the published spec.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExperimentResult {
    /// The measured moments.
    pub estimate: Estimate,
    /// The truth, and the closed form of the moments.
    pub reference: ReferenceResult,
    /// The cost of the measurement.
    pub cost: Cost,
    /// 1 / (mean squared error · cost).
    pub efficiency: Efficiency,
    /// The verdict: whether the measurement agrees with the reference.
    pub verdict: VerdictResult,
    /// The seed, the revision and the command that the numbers come from.
    pub provenance: Provenance,
}

/// The measured moments. Quantities that do not exist for so few samples are null.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Mean of the estimates.
    pub mean: f64,
    /// Standard error of the mean: from the closed form where one exists.
    #[serde(serialize_with = "number")]
    pub mean_standard_error: Option<f64>,
    /// Sample variance of the estimates.
    #[serde(serialize_with = "number")]
    pub variance: Option<f64>,
    /// Standard error of the variance: from the closed form where one exists.
    #[serde(serialize_with = "number")]
    pub variance_standard_error: Option<f64>,
    /// Least estimate.
    pub minimum: f64,
    /// Greatest estimate.
    pub maximum: f64,
}

/// The truth, and the closed form of the estimator's moments.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReferenceResult {
    /// exp(−optical thickness).
    pub transmittance: f64,
    /// ∫ σ_t ds.
    pub optical_thickness: f64,
    /// The variance of one estimate; "infinity" where it overflows or does not exist.
    #[serde(serialize_with = "number")]
    pub variance: Option<f64>,
    /// Natural logarithm of the variance; null for zero variance.
    #[serde(serialize_with = "number")]
    pub log_variance: Option<f64>,
    /// Bound of the absolute error of `transmittance`.
    pub error: f64,
    /// Expected look-ups of one estimate, preparation included.
    #[serde(serialize_with = "number")]
    pub lookups_per_sample: Option<f64>,
    /// Method by which all of these are known.
    pub method: String,
}

/// Cost of the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Number of estimates.
    pub samples: u64,
    /// Look-ups of one estimate if it stood alone.
    pub lookups_per_sample: f64,
    /// CPU seconds of the measuring loop over all threads.
    pub seconds: f64,
}

/// 1 / (MSE · cost), null at zero error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Efficiency {
    /// Cost in look-ups of one estimate.
    #[serde(serialize_with = "number")]
    pub per_lookup: Option<f64>,
    /// Cost in CPU seconds of one estimate.
    #[serde(serialize_with = "number")]
    pub per_second: Option<f64>,
}

/// The verdict, with the keys of the published spec.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VerdictResult {
    /// (mean − T) / standard error.
    #[serde(serialize_with = "number")]
    pub mean_z: Option<f64>,
    /// (variance − closed form) / standard error.
    #[serde(serialize_with = "number")]
    pub variance_z: Option<f64>,
    /// The smallest relative bias that would have been found with probability 0.99.
    #[serde(serialize_with = "number")]
    pub detectable_relative_bias: Option<f64>,
    /// true, false, or null: not testable at this N.
    pub sound: Option<bool>,
    /// Reason, in words.
    pub reason: String,
    /// The N that a test would take.
    #[serde(serialize_with = "number")]
    pub samples_needed: Option<f64>,
}

impl From<Verdict> for VerdictResult {
    fn from(verdict: Verdict) -> Self {
        Self {
            mean_z: verdict.mean_z,
            variance_z: verdict.variance_z,
            detectable_relative_bias: verdict.detectable_relative_bias,
            sound: verdict.sound,
            reason: verdict.reason,
            samples_needed: verdict.samples_needed,
        }
    }
}

/// Seed, revision and command that a number comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// The seed of the variates.
    pub seed: u64,
    /// The revision of the program.
    pub revision: String,
    /// The command that made it.
    pub command: String,
    /// The spec that the command read; without one there are no such keys.
    #[serde(flatten)]
    pub spec: Option<RecordedSpec>,
}

/// A spec as a command read it: with it the command can be run again, whatever has become of the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordedSpec {
    /// The spec, before options of the command stand for its keys.
    pub spec: Value,
    /// The SHA-256 of its bytes, in hexadecimal digits.
    pub spec_sha256: String,
}

/// JSON has no infinity: it is written as a word, and null means that a quantity does not exist.
pub fn number<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(x) if x.is_infinite() => {
            serializer.serialize_str(if *x > 0.0 { "infinity" } else { "-infinity" })
        }
        Some(x) if x.is_nan() => serializer.serialize_none(),
        Some(x) => serializer.serialize_f64(*x),
        None => serializer.serialize_none(),
    }
}
