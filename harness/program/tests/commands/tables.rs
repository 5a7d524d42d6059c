//! Tables on a terminal, JSON on a pipe and where it is asked for.

use crate::common::{harness, on_a_terminal};
use serde_json::Value;

const EXPERIMENT: &str = r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1 },
    "estimator": { "kind": "double_particle", "sigma_samp": 2 }, "samples": 400000, "seed": 1,
    "sweep": { "path": "estimator.sigma_samp", "values": [1.5, 2.5] } }"#;
const MEDIUM: &str = r#"{ "kind": "homogeneous", "sigma_t": 2, "bounds": { "sphere": { "center": [0, 0, 0], "radius": 1 } } }"#;

fn is_json(text: &str) -> bool {
    serde_json::from_str::<Value>(text).is_ok()
}

#[test]
fn an_estimate_is_a_table_on_a_terminal() {
    let json = harness(&["estimate", "-"], EXPERIMENT).stdout;
    let result: Value = serde_json::from_str(&json).expect("JSON on a pipe");
    assert!(is_json(&on_a_terminal(&["estimate", "-", "--json"], EXPERIMENT).stdout));

    let table = on_a_terminal(&["estimate", "-"], EXPERIMENT);
    assert_eq!((table.code, table.stderr.as_str()), (0, ""));
    let lines: Vec<&str> = table.stdout.lines().collect();
    assert!(
        lines[0].starts_with("estimator.sigma_samp  ") && lines[0].ends_with("verdict"),
        "{}",
        table.stdout
    );
    for (line, point) in lines[1..3].iter().zip(result["points"].as_array().expect("points")) {
        assert!(line.starts_with(&point["value"].to_string()) && line.ends_with("sound"), "{line}");
        // The efficiency lies in its interval.
        let efficiency = point["efficiency"]["per_lookup"].as_f64().expect("a number");
        let (_, interval) = line.split_once('[').expect("an interval");
        let (low, high) =
            interval.split_once(']').expect("an interval").0.split_once(", ").expect("two ends");
        let [low, high] = [low, high].map(|end| end.parse::<f64>().expect("a number"));
        assert!(low < efficiency && efficiency < high && high < 1.5 * low, "{line}");
    }
    assert!(table.stdout.contains("95 % interval"), "{}", table.stdout);
    let quiet = on_a_terminal(&["--quiet", "estimate", "-"], EXPERIMENT).stdout;
    // But for seconds.
    let start = |line: &str| line.split(']').next().unwrap_or_default().to_owned();
    let starts: Vec<String> = quiet.lines().map(start).collect();
    assert_eq!(starts[1..], lines[1..3].iter().copied().map(start).collect::<Vec<_>>());
}

#[test]
fn advice_is_a_table_on_a_terminal() {
    let arguments = ["advise", "-", "--rays", "4"];
    let piped = harness(&arguments, MEDIUM);
    assert!(is_json(&piped.stdout) && piped.stderr.contains("gain per look-up"), "{}", piped.stderr);
    let table = on_a_terminal(&arguments, MEDIUM);
    assert!(table.stdout.contains("gain per look-up") && table.stderr.is_empty(), "{}", table.stderr);
    for more in ["--json", "--quiet"] {
        let arguments: Vec<&str> = arguments.into_iter().chain([more]).collect();
        let outcome = harness(&arguments, MEDIUM);
        assert!(is_json(&outcome.stdout) && outcome.stderr.is_empty(), "{}", outcome.stderr);
    }
    let with_json: Vec<&str> = arguments.into_iter().chain(["--json"]).collect();
    assert!(is_json(&on_a_terminal(&with_json, MEDIUM).stdout));
}

/// A table on a pipe too: so it has always been.
#[test]
fn verdicts_are_a_table_unless_json_is_asked_for() {
    let arguments = ["verify", "--quick", "--estimator", "regular"];
    let more = |word: &'static str| arguments.into_iter().chain([word]).collect::<Vec<_>>();
    let table = harness(&arguments, "").stdout;
    assert!(table.starts_with("check ") && table.contains("false alarm of the whole catalogue"), "{table}");
    assert_eq!(on_a_terminal(&arguments, "").stdout, table);
    for run in [harness, on_a_terminal] {
        assert!(is_json(&run(&more("--json"), "").stdout));
    }
    let quiet = harness(&more("--quiet"), "").stdout;
    assert!(table.starts_with(&quiet) && quiet.ends_with("not testable at this N\n"), "{quiet}");
}

#[test]
fn progress_takes_one_of_two_forms() {
    let outcome = harness(&["estimate", "-", "--progress", "xml"], EXPERIMENT);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("[possible values: bar, json]"),
        "{}",
        outcome.stderr
    );
    assert_eq!(harness(&["estimate", "-", "--progress", "json", "--quiet"], EXPERIMENT).code, 2);
}
