//! The outcome of one named check, for a table.

use crate::{Evidence, Refusal};
use fairflight_stats::Verdict;

/// What a check found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CheckResult {
    /// Whether the law holds; `None`: not testable at this N.
    pub holds: Option<bool>,
    /// Samples drawn; 0 for exact algebra.
    pub samples: u64,
    /// The z-score of the mean, where there is one; evidence only if the reason says so.
    pub mean_z: Option<f64>,
    /// That of the variance.
    pub variance_z: Option<f64>,
    /// Whether the variance was tested against its closed form, and not only compared with it.
    pub variance_is_tested: bool,
    /// That of the number of look-ups.
    pub lookups_z: Option<f64>,
    /// The smallest relative bias of the mean that the run would have detected with probability 0.99.
    pub detectable_relative_bias: Option<f64>,
    /// The N that would make the mean testable, where it is not.
    pub samples_needed: Option<f64>,
    /// Why, in words.
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
        Self {
            holds: evidence.holds(),
            lookups_z: lookups.and_then(|verdict| verdict.mean_z),
            reason: format!("{}; look-ups {reason}", estimates.reason),
            ..estimates
        }
    }

    /// The outcome of several verdicts that share one check: it holds if all do. Its numbers are those of the largest |z|, its
    /// power that of the weakest.
    #[must_use]
    pub(crate) fn of_all(parts: impl IntoIterator<Item = (&'static str, Self)>) -> Self {
        let mut whole = Self::exact(true, "");
        let mut weakest = Some(0.0_f64);
        for (name, part) in parts {
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
            weakest = weakest.zip(part.detectable_relative_bias).map(|(a, b)| a.max(b));
            let separator = if whole.reason.is_empty() { "" } else { "; " };
            whole.reason = format!("{}{separator}{name}: {}", whole.reason, part.reason);
        }
        Self { detectable_relative_bias: weakest, ..whole }
    }
}
