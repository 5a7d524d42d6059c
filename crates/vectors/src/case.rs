//! Cases as lines of JSON.

use crate::kinds::Model;
use crate::moments::Moments;
use crate::number::Precise;
use crate::run::{Run, Use};
use crate::tolerance::{Finished, Tolerance};
use crate::{Binary64, Exact, Precision, Profile, Script};
use serde_json::{Map, Value, json};

/// Name of the format, in the header line.
pub const FORMAT: &str = "fairflight-vectors";
/// Version of the format; it changes when a reader of the one before would misread a line.
pub const VERSION: u32 = 1;

/// Digits of exact values.
const DIGITS: usize = 30;

/// The first line of a file of vectors.
#[must_use]
pub fn header(kind: &str, outputs: &[&str], notes: &[(&str, &str)]) -> Value {
    let notes: Map<String, Value> =
        notes.iter().map(|&(name, text)| (name.to_owned(), json!(text))).collect();
    json!({
        "format": FORMAT,
        "version": VERSION,
        "license": "MIT OR Apache-2.0",
        "kind": kind,
        "outputs": outputs,
        "lattice": 53,
        "exponential": "-ln(1-u), correctly rounded",
        "notes": notes,
    })
}

/// A case: its name, and the line that states it.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// KIND/PARAMETERS/NUMBER.
    pub id: String,
    /// The case as a line of its file.
    pub json: Value,
    /// Answers of ports with a known mistake.
    pub mistaken: Vec<Mistaken>,
    /// Exact moments of its parameters, with the first case of them.
    pub moments: Option<Value>,
}

/// A known mistake, and what a port with it answers to a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistaken {
    /// Name of the mistake.
    pub name: &'static str,
    /// The answer, as a port prints it.
    pub answer: Value,
}

/// Origin of a case, which decides the precisions that it is put to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    /// Drawn at random; kept if robust at binary64.
    Drawn,
    /// On a border, with numbers that every precision holds: a decision between < and ≤.
    Tie,
    /// At an end of the variates, in double precision.
    Extreme,
}

impl Sort {
    fn flag(self) -> Option<&'static str> {
        match self {
            Self::Drawn => None,
            Self::Tie => Some("tie"),
            Self::Extreme => Some("extreme"),
        }
    }
}

impl Case {
    /// The case of a model, or `None` of drawn ones that a right port may decide otherwise.
    pub(crate) fn of(
        id: String,
        sort: Sort,
        model: &impl Model,
        script: &Script,
        profile: Profile,
    ) -> Option<Self> {
        let mut run = Run::new(Exact, script, profile);
        let outcome = model.run(&mut run);
        let exact = Finished::of(model, Exact, script, profile);
        let double = Finished::of(model, Binary64, script, profile);
        assert!(exact.uses.len() <= script.len(), "{id}: draws more than it is given");
        let on_lattice =
            |(number, used): (usize, &Use)| *used == Use::Exponential || script.get(number).k().is_some();
        assert!(exact.uses.iter().enumerate().all(on_lattice), "{id}: a uniform variate off the lattice");
        assert!(sort == Sort::Drawn || double.decides_as(&exact), "{id}: decided otherwise in doubles");
        let (mut tolerance, mut flags) = (Map::new(), Vec::new());
        // Without functions, ties are exact in every precision, and all else is in doubles once the exponentials are given.
        let is_exact = |precision| sort == Sort::Tie || precision == Precision::Binary64;
        let mut given = Map::new();
        for precision in Precision::ALL {
            let name = precision.name().to_owned();
            if is_exact(precision) && !model.takes_functions() {
                given.insert(name.clone(), json!(0));
            }
            let found = match sort {
                Sort::Drawn => Tolerance::at(precision, model, script, profile, &exact),
                _ if is_exact(precision) => Tolerance::at(precision, model, script, profile, &exact)
                    .or_else(|| Some(Tolerance::of_a_border(precision, &exact))),
                _ => None,
            };
            match found {
                Some(found) => {
                    tolerance.insert(name, written(&found));
                    if precision == Precision::Binary32 {
                        flags.push("f32");
                    }
                }
                None if precision == Precision::Binary64 => return None,
                None => {}
            }
        }
        flags.extend(sort.flag());
        if !given.is_empty() {
            tolerance.insert("exponentials_given".to_owned(), Value::Object(given));
        }
        let draws: Vec<Value> =
            exact.uses.iter().enumerate().map(|(i, used)| drawn(script, i, *used)).collect();
        let bits: Vec<Value> =
            double.values.iter().map(|value| json!(format!("{:016x}", value.to_bits()))).collect();
        let digits: Vec<Value> =
            outcome.values.iter().map(|value: &Precise| json!(value.digits(DIGITS))).collect();
        let mut expect = json!({
            "value": one_or_all(double.values.iter().map(|&value| json!(value)).collect()),
            "bits": one_or_all(bits),
            "exact": one_or_all(digits),
            "draws": draws.len(),
        });
        if let Some(event) = exact.event {
            expect["event"] = json!(event.name());
        }
        let mut json = json!({ "id": id, "flags": flags });
        parameters(&mut json, model, profile);
        if model.looks_up() {
            expect["lookups"] = json!(exact.trace.len());
        }
        json["draws"] = json!(draws);
        json["expect"] = expect;
        if model.looks_up() {
            json["trace"] =
                double.trace.iter().map(|&(s, sigma_t, weight)| step(s, sigma_t, weight)).collect();
        }
        json["tolerance"] = Value::Object(tolerance);
        let wrong = |(name, answer): (&'static str, Finished)| Mistaken {
            name,
            answer: answered(&id, &answer, model),
        };
        let mistaken = model.mistakes(script, profile).into_iter().map(wrong).collect();
        Some(Self { id, json, mistaken, moments: None })
    }
}

/// Parameters with their exact moments, as a header states them.
pub(crate) fn stated(name: &str, model: &impl Model, profile: Profile, moments: &Moments) -> Value {
    let mut json = json!({ "id": format!("{name}/statistics") });
    parameters(&mut json, model, profile);
    json["expect"] = moments.json();
    json
}

/// Puts the parameters of a case into it.
fn parameters(json: &mut Value, model: &impl Model, profile: Profile) {
    for (key, value) in model.stated().as_object().into_iter().flatten() {
        json[key] = value.clone();
    }
    if model.looks_up() {
        json["profile"] = profile.json();
        json["knowledge"] = json!({ "majorant": profile.majorant() });
    }
}

/// An answer in the form of a port's.
fn answered(id: &str, run: &Finished, model: &impl Model) -> Value {
    let mut answer = json!({ "id": id, "value": run.values, "draws": run.uses.len() });
    if let Some(event) = run.event {
        answer["event"] = json!(event.name());
    }
    if model.looks_up() {
        answer["lookups"] = json!(run.trace.len());
        answer["s"] = run.trace.iter().map(|&(s, ..)| json!(s)).collect();
    }
    answer
}

/// A number where there is one, else all of them.
fn one_or_all(mut values: Vec<Value>) -> Value {
    if values.len() == 1 { values.remove(0) } else { Value::Array(values) }
}

fn drawn(script: &Script, number: usize, used: Use) -> Value {
    let draw = script.get(number);
    match used {
        Use::Uniform => json!(["u", draw.k()]),
        Use::Exponential => {
            let exponential = crate::Number::to_f64(&draw.exponential());
            json!(["e", draw.k(), exponential])
        }
    }
}

fn step(s: f64, sigma_t: f64, weight: Option<f64>) -> Value {
    weight.map_or_else(|| json!([s, sigma_t]), |weight| json!([s, sigma_t, weight]))
}

fn written(tolerance: &Tolerance) -> Value {
    let mut json =
        json!({ "value": one_or_all(tolerance.values.iter().map(|&value| json!(value)).collect()) });
    if let Some(s) = tolerance.s {
        json["s"] = json!(s);
    }
    json
}
