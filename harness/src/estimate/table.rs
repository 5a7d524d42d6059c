//! Results of experiments as a table for a person.

use super::Outcome;
use crate::Environment;
use crate::result::{ExperimentResult, Provenance};
use crate::table::{aligned, digits};

/// The two-sided 95 % quantile of the normal law.
const Z: f64 = 1.96;

/// A line for each result; the first column is the swept key, if there is one.
pub(super) fn table(path: Option<&str>, outcomes: &[Outcome]) -> String {
    let names = [
        "mean",
        "std. error",
        "transmittance",
        "variance",
        "look-ups",
        "efficiency per look-up",
        "per second",
        "verdict",
    ];
    let names = [path.unwrap_or_default()].into_iter().chain(names).map(str::to_owned).collect();
    let rows = outcomes.iter().map(|Outcome { value, result, .. }| {
        let or_none = |value: Option<f64>, count| value.map_or_else(|| "-".to_owned(), |v| digits(v, count));
        let verdict = match result.verdict.sound {
            Some(true) => "sound",
            Some(false) => "NOT SOUND",
            None => "not testable",
        };
        vec![
            value.as_ref().map(ToString::to_string).unwrap_or_default(),
            digits(result.estimate.mean, 6),
            or_none(result.estimate.mean_standard_error, 2),
            digits(result.reference.transmittance, 6),
            or_none(result.estimate.variance, 3),
            digits(result.cost.lookups_per_sample, 4),
            efficiency(result),
            or_none(result.efficiency.per_second, 3),
            verdict.to_owned(),
        ]
    });
    let mut rows: Vec<Vec<String>> = std::iter::once(names).chain(rows).collect();
    if path.is_none() {
        rows.iter_mut().for_each(|row| drop(row.remove(0)));
    }
    aligned(&rows)
}

/// The efficiency per look-up with its interval.
fn efficiency(result: &ExperimentResult) -> String {
    let Some(value) = result.efficiency.per_lookup else { return "-".to_owned() };
    let interval = interval(result).map(|ends| ends.map(|end| digits(end, 3)).join(", "));
    format!("{} [{}]", digits(value, 3), interval.unwrap_or_else(|| "-".to_owned()))
}

/// The 95 % interval of 1/(mean squared error · look-ups) that the standard errors of variance and mean allow; `None` where they are
/// not known.
fn interval(result: &ExperimentResult) -> Option<[f64; 2]> {
    let (estimate, cost) = (&result.estimate, result.cost.lookups_per_sample);
    let squared_error = 1.0 / (result.efficiency.per_lookup? * cost);
    let bias = estimate.mean - result.reference.transmittance;
    let of_bias = 2.0 * bias.abs() * estimate.mean_standard_error?;
    let error = Z * (estimate.variance_standard_error? + of_bias);
    let least = squared_error - error;
    let greatest = if least > 0.0 { 1.0 / (least * cost) } else { f64::INFINITY };
    Some([1.0 / ((squared_error + error) * cost), greatest])
}

/// Reasons of verdicts that are not sound, and without `--quiet` the meaning of the columns.
pub(super) fn notes(outcomes: &[Outcome], environment: &Environment) -> String {
    let mut notes: Vec<String> = Vec::new();
    for Outcome { value, result, .. } in outcomes {
        if result.verdict.sound != Some(true) {
            let place = value.as_ref().map(|value| format!("{value}: ")).unwrap_or_default();
            notes.push(format!("{place}{}", result.verdict.reason));
        }
    }
    if !environment.is_quiet() {
        notes.push("efficiency: 1/(mean squared error * cost), with the 95 % interval that the standard errors of variance and mean \
                    allow; --json gives all numbers".to_owned());
        let mut methods: Vec<&str> = outcomes.iter().map(|it| it.result.reference.method.as_str()).collect();
        methods.dedup();
        notes.extend(methods.into_iter().map(str::to_owned));
        if let Some(Outcome { result, .. }) = outcomes.first() {
            let Provenance { seed, revision, .. } = &result.provenance;
            notes.push(format!("seed {seed}, revision {revision}"));
        }
    }
    notes.iter().map(|note| format!("\n{note}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{Cost, Efficiency, Estimate, ReferenceResult, VerdictResult};

    fn result(variance_standard_error: Option<f64>) -> ExperimentResult {
        let (variance, cost, bias): (f64, f64, f64) = (0.25, 2.0, 0.1);
        ExperimentResult {
            estimate: Estimate {
                mean: 0.5 + bias,
                mean_standard_error: Some(0.05),
                variance: Some(variance),
                variance_standard_error,
                minimum: 0.0,
                maximum: 1.0,
            },
            reference: ReferenceResult {
                transmittance: 0.5,
                optical_thickness: 2_f64.ln(),
                variance: None,
                log_variance: None,
                error: 0.0,
                lookups_per_sample: None,
                method: String::new(),
            },
            cost: Cost { samples: 100, lookups_per_sample: cost, seconds: 1.0 },
            efficiency: Efficiency {
                per_lookup: Some(1.0 / ((variance + bias * bias) * cost)),
                per_second: None,
            },
            verdict: VerdictResult {
                mean_z: None,
                variance_z: None,
                detectable_relative_bias: None,
                sound: None,
                reason: String::new(),
                samples_needed: None,
            },
            provenance: Provenance::default(),
        }
    }

    #[test]
    fn the_interval_is_that_of_the_mean_squared_error() {
        // MSE 0.26, its standard error 0.02 + 2 * 0.1 * 0.05.
        let [low, high] = interval(&result(Some(0.02))).unwrap();
        assert!(
            (low - 0.5 / (0.26 + 1.96 * 0.03)).abs() < 1e-12
                && (high - 0.5 / (0.26 - 1.96 * 0.03)).abs() < 1e-12
        );
        assert_eq!(interval(&result(Some(1.0))).unwrap()[1], f64::INFINITY);
        assert_eq!(interval(&result(None)), None);
    }
}
