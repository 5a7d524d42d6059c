//! Answers of ports, judged.

use crate::Precision;
use serde_json::{Value, json};
use std::fmt;

/// A part of a port that is held to the vectors by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// The estimator: σ_t of each look-up is that of the trace, exponentials are given.
    Field,
    /// With it the port's own look-up of the profile; exponentials are given.
    Exponentials,
    /// With both the port's own logarithm: all from uniform variates.
    Uniforms,
}

impl Layer {
    /// All, from the innermost outwards.
    pub const ALL: [Self; 3] = [Self::Field, Self::Exponentials, Self::Uniforms];

    /// Name, as a case states it to a port.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Field => "field",
            Self::Exponentials => "exponentials",
            Self::Uniforms => "uniforms",
        }
    }

    /// Place of the mistake if this layer fails and none within it.
    #[must_use]
    pub fn blames(self) -> &'static str {
        match self {
            Self::Field => "the estimator itself: σ_t and exponentials were given",
            Self::Exponentials => {
                "the look-up of the profile: exponentials were given, and with σ_t given too the port is right"
            }
            Self::Uniforms => "the exponential, -ln(1 - u): with exponentials given the port is right",
        }
    }
}

/// The case as it is put to a port, or `None` where it has no such layer or does not bear the precision.
#[must_use]
pub fn asked(case: &Value, layer: Layer, precision: Precision) -> Option<Value> {
    let tolerance = &case["tolerance"];
    let bears = tolerance.get(precision.name()).is_some();
    let is_given = |draw: &Value| draw[1].is_null();
    let has = match layer {
        Layer::Field => case.get("profile").is_some(),
        Layer::Exponentials => true,
        Layer::Uniforms => !case["draws"].as_array().is_some_and(|draws| draws.iter().any(is_given)),
    };
    (bears && has).then(|| {
        let mut asked = case.clone();
        asked["layer"] = json!(layer.name());
        asked
    })
}

/// A difference between an answer and its case, the first in the order of the run.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The answer lacks this, or has it in another form.
    Unreadable(&'static str),
    /// A look-up at another distance: its number, where it ought to be, where it was, and what is granted \[length\].
    LookedUpElsewhere(usize, [f64; 3]),
    /// Another number of look-ups: expected, found.
    Lookups(u64, u64),
    /// Another number of variates: expected, found.
    Draws(u64, u64),
    /// Another end of a flight: expected, found.
    Event(String, String),
    /// A value out of tolerance: its number, what it ought to be, what it is, and what is granted.
    Value(usize, [f64; 3]),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(key) => write!(f, "the answer has no readable `{key}`"),
            Self::LookedUpElsewhere(number, [expected, found, granted]) => {
                write!(f, "look-up {number} at s = {found}, expected {expected} within {granted:e}")
            }
            Self::Lookups(expected, found) => write!(f, "{found} look-ups, expected {expected}"),
            Self::Draws(expected, found) => write!(f, "{found} variates drawn, expected {expected}"),
            Self::Event(expected, found) => write!(f, "{found}, expected {expected}"),
            Self::Value(number, [expected, found, granted]) => {
                write!(f, "value {number} is {found}, expected {expected} within {granted:e}")
            }
        }
    }
}

/// One number or several.
fn numbers(json: &Value) -> Option<Vec<f64>> {
    match json {
        Value::Array(all) => all.iter().map(Value::as_f64).collect(),
        one => one.as_f64().map(|one| vec![one]),
    }
}

/// Judges an answer: `Ok(true)` if every bit of its values is that of the case (in single precision: of its rounding), `Ok(false)` if it is within
/// tolerance.
///
/// # Errors
/// The first fault: distances before numbers of look-ups and variates, these before the end of a flight, and that before values.
pub fn judge(case: &Value, answer: &Value, precision: Precision) -> Result<bool, Fault> {
    let (expect, tolerance) = (&case["expect"], &case["tolerance"][precision.name()]);
    let count = |json: &Value, key: &'static str| json[key].as_u64().ok_or(Fault::Unreadable(key));
    if expect.get("lookups").is_some() {
        let found = numbers(&answer["s"]);
        let trace = case["trace"].as_array().into_iter().flatten();
        if let (Some(found), Some(granted)) = (found, tolerance["s"].as_f64()) {
            for (number, (step, found)) in trace.zip(found).enumerate() {
                let expected = step[0].as_f64().unwrap_or(f64::NAN);
                if !is_within(expected, found, granted) {
                    return Err(Fault::LookedUpElsewhere(number, [expected, found, granted]));
                }
            }
        }
        let (expected, found) = (count(expect, "lookups")?, count(answer, "lookups")?);
        if expected != found {
            return Err(Fault::Lookups(expected, found));
        }
    }
    let (expected, found) = (count(expect, "draws")?, count(answer, "draws")?);
    if expected != found {
        return Err(Fault::Draws(expected, found));
    }
    if let Some(expected) = expect["event"].as_str() {
        let found = answer["event"].as_str().ok_or(Fault::Unreadable("event"))?;
        if expected != found {
            return Err(Fault::Event(expected.to_owned(), found.to_owned()));
        }
    }
    let expected = numbers(&expect["value"]).unwrap_or_default();
    let granted = numbers(&tolerance["value"]).unwrap_or_default();
    let found = numbers(&answer["value"]).filter(|found| found.len() == expected.len());
    let found = found.ok_or(Fault::Unreadable("value"))?;
    for (number, ((&expected, &found), granted)) in expected.iter().zip(&found).zip(granted).enumerate() {
        if !is_within(expected, found, granted) {
            return Err(Fault::Value(number, [expected, found, granted]));
        }
    }
    let rounded = |x: f64| if precision == Precision::Binary32 { f64::from(x as f32) } else { x };
    Ok(expected.iter().zip(&found).all(|(&expected, &found)| rounded(expected) == found))
}

fn is_within(expected: f64, found: f64, granted: f64) -> bool {
    (found - expected).abs() <= granted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KINDS;
    use std::collections::BTreeMap;

    /// The number of cases that each known mistake fails, by kind and name.
    fn caught() -> BTreeMap<(&'static str, &'static str), [usize; 2]> {
        let mut caught = BTreeMap::new();
        for kind in KINDS {
            for case in kind.cases() {
                for mistaken in &case.mistaken {
                    let fails = judge(&case.json, &mistaken.answer, Precision::Binary64).is_err();
                    let [failed, all] = caught.entry((kind.name, mistaken.name)).or_default();
                    (*failed, *all) = (*failed + usize::from(fails), *all + 1);
                }
            }
        }
        caught
    }

    /// The vectors' own mutation score, and what docs/porting/mistakes.md says of it.
    #[test]
    fn every_known_mistake_fails_a_case() {
        let page = include_str!("../../../docs/porting/mistakes.md");
        let mut lacking = Vec::new();
        for ((kind, mistake), [failed, all]) in caught() {
            let row = format!("| {kind} | {mistake} | {failed} of {all} |");
            if failed == 0 || !page.contains(&row) {
                lacking.push(row);
            }
        }
        assert!(lacking.is_empty(), "docs/porting/mistakes.md lacks\n{}", lacking.join("\n"));
    }
}
