//! A case of the committed test vectors, read.

use fairflight_catalogue::vectors::{Seen, Variate, Variates, Vector};
use fairflight_media::{BoundCell, PiecewiseLinear};
use serde_json::Value;

/// One number or several.
pub(crate) fn numbers(json: &Value) -> Vec<f64> {
    match json {
        Value::Array(all) => all.iter().map(|number| number.as_f64().unwrap()).collect(),
        one => vec![one.as_f64().unwrap()],
    }
}

/// The variates of a case.
pub(crate) fn variates(case: &Value) -> Vec<Variate> {
    let variate = |draw: &Value| Variate {
        uniform: draw[1].as_u64().map_or(0.5, |k| k as f64 * 2.0_f64.powi(-53)),
        exponential: draw[2].as_f64(),
    };
    case["draws"].as_array().unwrap().iter().map(variate).collect()
}

/// The bounds in cells that the spec of a case claims.
fn cells(case: &Value) -> Vec<BoundCell> {
    let cells = &case["estimator"]["cells"];
    if cells.is_null() {
        return Vec::new();
    }
    let [edges, minorants, majorants] = ["edges", "minorants", "majorants"].map(|key| numbers(&cells[key]));
    (0..minorants.len())
        .map(|i| BoundCell { to: edges[i + 1], minorant: minorants[i], majorant: majorants[i] })
        .collect()
}

/// The profile of a case, where it has one.
fn field(case: &Value) -> Option<Seen> {
    let profile = case.get("profile")?;
    let profile = PiecewiseLinear::new(numbers(&profile["s"]), numbers(&profile["sigma_t"]));
    Some(Seen::new(profile.unwrap(), cells(case)))
}

/// Puts a case to `answer`, with the source of its variates; `look` sees what it did.
pub(crate) fn put<T>(
    case: &Value,
    answer: impl FnOnce(&Vector<'_>, &mut Variates<'_>) -> T,
    look: impl FnOnce(&T, &Variates<'_>, Option<&Seen>),
) -> T {
    let variates = variates(case);
    let mut source = Variates::new(&variates);
    as_vector(case, |vector| {
        let answered = answer(vector, &mut source);
        look(&answered, &source, vector.field);
        answered
    })
}

/// A case, or the parameters of one, as a vector.
pub(crate) fn as_vector<T>(case: &Value, then: impl FnOnce(&Vector<'_>) -> T) -> T {
    let field = field(case);
    let number = |path: &str| {
        let found = case.pointer(path)?;
        found.as_f64().or_else(|| found.as_bool().map(f64::from))
    };
    let word = |path: &str| case.pointer(path).and_then(Value::as_str);
    let kind =
        ["estimator", "sampler", "phase", "collision"].iter().find_map(|key| case[key]["kind"].as_str());
    let kind = kind.unwrap_or(if case["path"].is_array() {
        "path_weights"
    } else if case["heuristic"].is_string() {
        "mis_weight"
    } else {
        "connection"
    });
    then(&Vector { kind, number: &number, word: &word, field: field.as_ref() })
}
