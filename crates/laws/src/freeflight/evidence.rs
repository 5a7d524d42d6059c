//! Result of a run of flights, and its one line in a table.

use super::FlightRefusal;
use crate::result::{greater, normal_share};
use crate::{CheckResult, PValue};
use fairflight_stats::{GoodnessOfFit, Verdict};

/// The verdict on one score of the flights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) name: &'static str,
    pub(super) verdict: Verdict,
}

/// The outcome of a run of flights.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightEvidence {
    pub(super) flights: Vec<Part>,
    pub(super) lookups: Option<Verdict>,
    pub(super) distances: Option<GoodnessOfFit>,
    /// Look-ups were made by a sampler that promises none.
    pub(super) unexpected_lookups: bool,
    pub(super) samples: u64,
}

impl FlightEvidence {
    /// True if all laws hold; `None` if none is broken and one is not testable.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        let verdicts = self.findings().map(|(_, sound, _)| sound);
        let outcomes: Vec<Option<bool>> = verdicts.chain([Some(!self.unexpected_lookups)]).collect();
        if outcomes.contains(&Some(false)) {
            Some(false)
        } else {
            (!outcomes.contains(&None)).then_some(true)
        }
    }

    /// The verdict on one of [`super::TEST_FUNCTIONS`], or on `"escaped"`.
    #[must_use]
    pub fn verdict(&self, name: &str) -> Option<&Verdict> {
        self.flights.iter().find(|part| part.name == name).map(|part| &part.verdict)
    }

    /// The test of the distances of an unweighted sampler.
    #[must_use]
    pub fn distances(&self) -> Option<&GoodnessOfFit> {
        self.distances.as_ref()
    }

    fn findings(&self) -> impl Iterator<Item = (&'static str, Option<bool>, &str)> {
        let parts = self.flights.iter().map(|part| (part.name, part.verdict.sound, &*part.verdict.reason));
        let lookups = self.lookups.iter().map(|verdict| ("look-ups", verdict.sound, &*verdict.reason));
        let distances = self.distances.iter().map(|fit| ("distances", fit.sound, &*fit.reason));
        parts.chain(lookups).chain(distances)
    }

    fn p_values(&self) -> Vec<PValue> {
        let scores = self.flights.iter().flat_map(|part| PValue::of_verdict(&part.verdict, part.name));
        let lookups = self.lookups.iter().flat_map(|verdict| PValue::of_verdict(verdict, "look-ups"));
        let distances = self.distances.iter().filter_map(|fit| PValue::of_fit(fit, "distances"));
        scores.chain(lookups).chain(distances).collect()
    }

    fn extreme(&self, z: impl Fn(&Verdict) -> Option<f64>) -> Option<f64> {
        let all = self.flights.iter().filter_map(|part| z(&part.verdict));
        all.reduce(|worst, z| if z.abs() > worst.abs() { z } else { worst })
    }
}

impl CheckResult {
    /// The outcome of a run of flights; of the several z-scores the largest, of the several powers the least. What was
    /// refused does not hold.
    #[must_use]
    pub fn of_flights(evidence: &Result<FlightEvidence, FlightRefusal>) -> Self {
        let evidence = match evidence {
            Ok(evidence) => evidence,
            Err(refusal) => return Self::exact(false, format!("refused: {refusal}")),
        };
        let holds = evidence.holds();
        let verdicts = || evidence.flights.iter().map(|part| &part.verdict);
        let mut reasons: Vec<String> = evidence
            .findings()
            .filter(|(_, sound, _)| holds == Some(true) || *sound != Some(true))
            .map(|(name, _, reason)| format!("{name}: {reason}"))
            .collect();
        if evidence.unexpected_lookups {
            reasons.push("look-ups where none was expected".to_owned());
        }
        Self {
            holds,
            samples: evidence.samples,
            mean_z: evidence.extreme(|verdict| verdict.mean_z),
            variance_z: evidence.extreme(|verdict| verdict.variance_z),
            variance_is_tested: verdicts().any(|verdict| verdict.variance_p.is_some()),
            lookups_z: evidence.lookups.as_ref().and_then(|verdict| verdict.mean_z),
            detectable_relative_bias: verdicts()
                .map(|verdict| verdict.detectable_relative_bias)
                .reduce(|least, bias| Some(least?.max(bias?)))
                .flatten(),
            p_values: evidence.p_values(),
            normal_share: verdicts()
                .chain(&evidence.lookups)
                .map(|verdict| normal_share(verdict, evidence.samples))
                .fold(None, greater),
            samples_needed: verdicts().filter_map(|verdict| verdict.samples_needed).reduce(f64::max),
            reason: reasons.join("; "),
        }
    }
}
