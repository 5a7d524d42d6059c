//! The outcome of one named check, for a table.

use crate::{Evidence, PValue, Refusal};
use fairflight_stats::{MeanTest, Verdict};

/// Result of a check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CheckResult {
    /// True if the law holds; `None`: not testable at this N.
    pub holds: Option<bool>,
    /// Samples drawn; 0 for exact algebra.
    pub samples: u64,
    /// The z-score of the mean, where there is one; evidence only if the reason says so.
    pub mean_z: Option<f64>,
    /// The z-score of the variance.
    pub variance_z: Option<f64>,
    /// True if the variance was tested against its closed form, and not only compared with it.
    pub variance_is_tested: bool,
    /// The z-score of the number of look-ups.
    pub lookups_z: Option<f64>,
    /// The smallest relative bias of the mean that the run would have detected with probability 0.99.
    pub detectable_relative_bias: Option<f64>,
    /// The p-value of each test.
    pub p_values: Vec<PValue>,
    /// The share of N that normal approximations ask for, at worst over the tests that use one
    /// ([`Verdict::normal_samples`]): from 1 on the check is not testable.
    pub normal_share: Option<f64>,
    /// The N that would make the mean testable, where it is not.
    pub samples_needed: Option<f64>,
    /// Reason, in words.
    pub reason: String,
}

impl CheckResult {
    /// An exact outcome.
    #[must_use]
    pub fn exact(holds: bool, reason: impl Into<String>) -> Self {
        Self { holds: Some(holds), reason: reason.into(), ..Self::default() }
    }

    /// The outcome of a verdict on estimates.
    #[must_use]
    pub fn of_verdict(verdict: &Verdict, samples: u64) -> Self {
        Self {
            holds: verdict.sound,
            samples,
            mean_z: verdict.mean_z,
            variance_z: verdict.variance_z,
            variance_is_tested: verdict.variance_p.is_some(),
            lookups_z: None,
            detectable_relative_bias: verdict.detectable_relative_bias,
            p_values: PValue::of_verdict(verdict, "mean"),
            normal_share: normal_share(verdict, samples),
            samples_needed: verdict.samples_needed,
            reason: verdict.reason.clone(),
        }
    }

    /// The outcome of a whole law check. What was refused does not hold.
    #[must_use]
    pub fn of_evidence(evidence: &Result<Evidence, Refusal>) -> Self {
        let evidence = match evidence {
            Ok(evidence) => evidence,
            Err(refusal) => return Self::exact(false, format!("refused: {refusal}")),
        };
        let estimates = Self::of_verdict(&evidence.verdict, evidence.estimates.count());
        let lookups = evidence.lookups_verdict.as_ref();
        let reason =
            lookups.map_or("not tested (their number has no closed form)", |verdict| &verdict.reason);
        let mut p_values = estimates.p_values;
        p_values.extend(lookups.into_iter().flat_map(|verdict| PValue::of_verdict(verdict, "look-ups")));
        let of_lookups = lookups.and_then(|verdict| normal_share(verdict, estimates.samples));
        Self {
            holds: evidence.holds(),
            normal_share: greater(estimates.normal_share, of_lookups),
            p_values,
            lookups_z: lookups.and_then(|verdict| verdict.mean_z),
            reason: format!("{}; look-ups {reason}", estimates.reason),
            ..estimates
        }
    }

    /// The outcome of several verdicts that share one check: it holds if all do. Its numbers are those of the largest |z|, its
    /// power that of the weakest.
    #[must_use]
    pub fn of_all<N: AsRef<str>>(parts: impl IntoIterator<Item = (N, Self)>) -> Self {
        let mut whole = Self::exact(true, "");
        let mut weakest = Some(0.0_f64);
        for (name, part) in parts {
            let name = name.as_ref();
            whole.holds = match (whole.holds, part.holds) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) => Some(true),
                _ => None,
            };
            let size = |z: Option<f64>| z.map_or(0.0, f64::abs);
            if whole.mean_z.is_none() || size(part.mean_z) > size(whole.mean_z) {
                whole.mean_z = part.mean_z;
            }
            whole.samples = whole.samples.max(part.samples);
            whole.normal_share = greater(whole.normal_share, part.normal_share);
            whole.p_values.extend(part.p_values.into_iter().map(|p_value| p_value.within(name)));
            weakest = weakest.zip(part.detectable_relative_bias).map(|(a, b)| a.max(b));
            let separator = if whole.reason.is_empty() { "" } else { "; " };
            whole.reason = format!("{}{separator}{name}: {}", whole.reason, part.reason);
        }
        Self { detectable_relative_bias: weakest, ..whole }
    }
}

/// Samples that a normal approximation asks for, as a share of `samples`; `None` for a test that needs none.
pub(crate) fn normal_share(verdict: &Verdict, samples: u64) -> Option<f64> {
    let asks = matches!(verdict.mean_test, MeanTest::Normal | MeanTest::NotTestable);
    asks.then(|| verdict.normal_samples / samples as f64)
}

/// The greater one of those that are there.
pub(crate) fn greater(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).reduce(f64::max)
}
