//! Statistics of ports, judged: mean, variance and look-ups of many estimates from a generator of their own.

use crate::Kind;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// |z| that a right port exceeds with a probability of 1e-9, two-sided, for a normal mean.
const MOST_Z: f64 = 6.1;
/// Kurtosis over the number of estimates up to which the mean of squares is taken for normal.
const MOST_KURTOSIS: f64 = 1e-3;
/// Relative error of a mean that is judged as a sum of numbers in single precision, where nothing varies.
const ROUNDING: f64 = 1e-5;

/// The statistics that are asked of a port: the parameters of each entry of a header's moments, a number of estimates and a seed.
#[must_use]
pub fn asked_statistics(kind: &Kind, samples: u64) -> Vec<Value> {
    let mut entries = kind.moments();
    for (seed, entry) in entries.iter_mut().enumerate() {
        entry["layer"] = json!("statistics");
        entry["samples"] = json!(samples);
        entry["seed"] = json!(seed + 1);
    }
    entries
}

/// Asks a port, by `answer` to an id and a line, for all statistics of a kind: what is to be said of them, and if they are those of its moments. Nothing
/// is said of a kind without moments.
///
/// # Errors
/// Those of `answer`.
pub fn ask_statistics<E>(
    kind: &Kind,
    samples: u64,
    mut answer: impl FnMut(&str, &str) -> Result<Value, E>,
) -> Result<(String, bool), E> {
    let (mut faults, mut wrong, asked) = (String::new(), 0, asked_statistics(kind, samples));
    for entry in &asked {
        let id = entry["id"].as_str().unwrap_or_default();
        if let Err(fault) = judge_statistics(entry, &answer(id, &entry.to_string())?) {
            wrong += 1;
            let _ = writeln!(faults, "  {id}: {fault}");
        }
    }
    if asked.is_empty() {
        return Ok((faults, true));
    }
    let said = if wrong == 0 { "the moments are right".to_owned() } else { format!("{wrong} WRONG") };
    let (name, sets) = (kind.name, asked.len());
    let text = format!("{name}, statistics: {sets} sets of {samples} estimates, {said}\n{faults}");
    Ok((text, wrong == 0))
}

/// Scores of a port.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scores {
    /// (mean − exact)/standard error.
    pub mean: f64,
    /// (variance − exact)/standard error, where the fourth moment is known and the number of estimates tells.
    pub variance: Option<f64>,
}

/// Judges the statistics of `asked["samples"]` estimates. The standard error of the mean is the exact one where the variance is known, else the port's own; the
/// level of each score is 1e-9, so that a right port fails one of a hundred with less than 1e-6. Look-ups may be off by so many of sqrt((L + L²)/N).
///
/// # Errors
/// A sentence on the first that is wrong.
pub fn judge_statistics(asked: &Value, answer: &Value) -> Result<Scores, String> {
    let found = |key: &str| {
        answer[key].as_f64().filter(|found| found.is_finite()).ok_or_else(|| format!("no readable `{key}`"))
    };
    let expected = |key: &str| asked["expect"][key].as_f64();
    let samples = asked["samples"].as_f64().unwrap_or(f64::NAN);
    let (mean, variance) = (found("mean")?, found("variance")?);
    let exact = expected("mean").unwrap_or(f64::NAN);
    let spread = expected("variance").unwrap_or(variance);
    let rounding = ROUNDING * exact.abs().max(spread.sqrt());
    let z = (mean - exact) / (spread / samples).sqrt().hypot(rounding / MOST_Z);
    if z.is_nan() || z.abs() > MOST_Z {
        return Err(format!("the mean is {mean}, expected {exact}: z = {z:.1}"));
    }
    let mut scores = Scores { mean: z, variance: None };
    if let (Some(exact), Some(fourth)) = (expected("variance"), expected("fourth_central"))
        && exact > 0.0
        && fourth < MOST_KURTOSIS * samples * exact * exact
    {
        let z =
            (variance - exact) / ((fourth - exact * exact) / samples).sqrt().hypot(ROUNDING * exact / MOST_Z);
        if z.is_nan() || z.abs() > MOST_Z {
            return Err(format!("the variance is {variance:e}, expected {exact:e}: z = {z:.1}"));
        }
        scores.variance = Some(z);
    }
    if let Some(exact) = expected("lookups") {
        let found = found("lookups")?;
        let granted = MOST_Z * ((exact + exact * exact) / samples).sqrt();
        if (found - exact).abs() > granted {
            return Err(format!("{found} look-ups on average, expected {exact} within {granted:.1e}"));
        }
    }
    Ok(scores)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_mean_a_wrong_variance_and_wrong_lookups_are_told() {
        let expect = json!({ "mean": 1.0, "variance": 0.25, "fourth_central": 0.1875, "lookups": 2.0 });
        let asked = json!({ "samples": 10_000, "expect": expect });
        let judged = |mean: f64, variance: f64, lookups: f64| {
            judge_statistics(&asked, &json!({ "mean": mean, "variance": variance, "lookups": lookups }))
        };
        let scores = judged(1.005, 0.25, 2.0).unwrap();
        assert!((scores.mean - 1.0).abs() < 1e-2 && scores.variance == Some(0.0), "{scores:?}");
        for (mean, variance, lookups, word) in
            [(1.05, 0.25, 2.0, "mean"), (1.0, 0.3, 2.0, "variance"), (1.0, 0.25, 3.0, "look-ups")]
        {
            assert!(judged(mean, variance, lookups).unwrap_err().contains(word));
        }
        assert!(judged(f64::NAN, 0.25, 2.0).is_err());
    }
}
