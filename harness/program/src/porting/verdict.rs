//! The verdict on a port: its answers to the cases of one kind at one layer.

use fairflight_vectors::{Case, Fault, Layer, Precision, judge};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Answers to the cases of one kind at one layer.
pub(crate) struct Verdict {
    layer: Layer,
    precision: Precision,
    cases: usize,
    equal: usize,
    faults: Vec<(String, Fault)>,
    /// Numbers of wrong answers that are those of a known mistake, by its name.
    looks_like: BTreeMap<&'static str, usize>,
}

/// Faults that are told one by one.
const TOLD: usize = 3;

impl Verdict {
    pub(crate) fn new(layer: Layer, precision: Precision) -> Self {
        Self { layer, precision, cases: 0, equal: 0, faults: Vec::new(), looks_like: BTreeMap::new() }
    }

    /// Adds an answer and what was judged of it.
    pub(crate) fn add(&mut self, case: &Case, answer: &Value, said: Result<bool, Fault>) {
        self.cases += 1;
        match said {
            Ok(is_equal) => self.equal += usize::from(is_equal),
            Err(fault) => {
                for mistaken in &case.mistaken {
                    if self.is_like(&case.json, &mistaken.answer, answer) {
                        *self.looks_like.entry(mistaken.name).or_default() += 1;
                    }
                }
                self.faults.push((case.id.clone(), fault));
            }
        }
    }

    /// True if an answer is that of a mistake. Where σ_t is given, a run that looks up elsewhere, or longer, sees no profile: its value says nothing then, and its
    /// look-ups and variates all.
    fn is_like(&self, case: &Value, mistaken: &Value, answer: &Value) -> bool {
        let trace = case["trace"].as_array().into_iter().flatten().map(|step| &step[0]);
        let strays = !mistaken["s"].as_array().into_iter().flatten().eq(trace);
        match judge(&expecting(case, mistaken), answer, self.precision) {
            Ok(_) => true,
            Err(Fault::Value(..)) => strays && self.layer == Layer::Field,
            Err(_) => false,
        }
    }

    /// True where no case has this layer.
    pub(crate) fn is_empty(&self) -> bool {
        self.cases == 0
    }

    /// True if every answer is within tolerance.
    pub(crate) fn holds(&self) -> bool {
        self.faults.is_empty()
    }

    /// A line, and a few more where something is wrong.
    pub(crate) fn text(&self, kind: &str) -> String {
        let Self { cases, equal, faults, .. } = self;
        let mut text = format!("{kind}, {}: {cases} cases, {equal} bit by bit", self.layer.name());
        if faults.is_empty() {
            text += ", the others within tolerance\n";
            return text;
        }
        let _ = writeln!(text, ", {} WRONG", faults.len());
        for (id, fault) in faults.iter().take(TOLD) {
            let _ = writeln!(text, "  {id}: {fault}");
        }
        let _ = writeln!(text, "  in: {}", self.layer.blames());
        if let Some((name, count)) = self.looks_like.iter().max_by_key(|(_, count)| **count) {
            let _ = writeln!(text, "  looks like: {name} ({count} of {} wrong answers)", faults.len());
        }
        text
    }
}

/// The case as if a mistake were right.
fn expecting(case: &Value, mistaken: &Value) -> Value {
    let mut expecting = case.clone();
    for key in ["value", "draws", "lookups", "event"] {
        if let Some(value) = mistaken.get(key) {
            expecting["expect"][key] = value.clone();
        }
    }
    if let Some(distances) = mistaken["s"].as_array() {
        expecting["trace"] = distances.iter().map(|s| json!([s])).collect();
    }
    expecting
}
