//! `report` and `verify`, as quick as they are.

use crate::common::{fixture, harness};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn the_quick_report_is_complete_and_says_where_it_comes_from() {
    let parent = tempfile::tempdir().expect("a temporary folder");
    let folder = parent.path().join("report");
    let path = folder.to_str().expect("UTF-8");
    let outcome = harness(&["report", "--quick", "--vdb", &fixture("tiles.vdb"), "--out", path], "");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (0, ""), "{}", outcome.stderr);
    // Nothing is left beside the report.
    assert_eq!(names(parent.path()), ["report"]);

    let results: Value =
        serde_json::from_str(&fs::read_to_string(folder.join("results.json")).expect("results"))
            .expect("JSON");
    let command = results["provenance"]["command"].as_str().expect("a command");
    assert!(command.starts_with("harness report --quick --vdb"), "{command}");
    assert_eq!(results["media"].as_array().map(Vec::len), Some(3));
    assert_eq!(results["claims"].as_array().map(Vec::len), Some(7));
    assert!(results["stability"].as_array().is_some_and(|rows| rows.iter().all(|row| row["passes"] == true)));

    let page = fs::read_to_string(folder.join("index.html")).expect("a page");
    // The script library speaks of addresses; the page asks for none.
    let body = page.split_once("</head>").expect("a head").1;
    assert!(!body.contains("src=\"http") && !body.contains("href=\"http"), "the page needs no network");
    let files = names(&folder);
    for plot in files.iter().filter(|name| name.ends_with(".svg")) {
        for format in ["png", "csv"] {
            let sibling = plot.replace(".svg", &format!(".{format}"));
            assert!(files.contains(&sibling), "{plot} has no {sibling}");
        }
    }
}

/// A quick report that is a document: its results, and the ledger without what depends on time.
fn document(name: &str, threads: &str) -> (Value, Vec<[String; 3]>) {
    let parent = tempfile::tempdir().expect("a temporary folder");
    let folder = parent.path().join(name);
    let path = folder.to_str().expect("UTF-8");
    let outcome = harness(&["report", name, "--quick", "--threads", threads, "--out", path], "");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (0, ""), "{}", outcome.stderr);
    assert_eq!(names(parent.path()), [name]);
    let text = fs::read_to_string(folder.join("results.json")).expect("results");
    let results: Value = serde_json::from_str(&text).expect("JSON");
    let files = names(&folder);
    for file in ["index.html", "tables.md"] {
        assert!(files.iter().any(|name| name == file), "{file} is missing");
    }
    let claims = results["claims"].as_array().expect("claims");
    let words = |claim: &Value, key: &str| claim[key].as_str().expect("words").to_owned();
    let ledger = claims.iter().map(|claim| ["id", "verdict", "measured"].map(|key| words(claim, key)));
    let ledger = ledger.collect();
    (results, ledger)
}

#[test]
fn the_report_on_single_scattering_says_the_same_on_any_number_of_threads() {
    let (results, ledger) = document("single-scattering", "1");
    assert_eq!(ledger[0][0], "S9");
    // No unbiased method has another mean than the closed form.
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
    assert_eq!(document("single-scattering", "3").1, ledger);
}

#[test]
fn the_report_on_free_flight_finds_no_broken_law() {
    let (results, ledger) = document("free-flight", "2");
    assert_eq!(ledger.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["R1", "R2", "R3"]);
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
    assert_ne!(ledger[0][1], "does_not_hold");
    assert_ne!(ledger[2][1], "does_not_hold");
}

#[test]
fn the_report_on_particle_tracing_has_its_sections() {
    let (results, ledger) = document("particle-tracing", "2");
    assert_eq!(ledger.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["S5", "S6"]);
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
    let sections: Vec<&str> =
        results["sections"].as_array().expect("sections").iter().filter_map(|s| s["id"].as_str()).collect();
    assert_eq!(sections, ["even-versions", "sun-versions", "noise", "speed", "growth"]);
}

#[test]
fn the_report_on_virtual_point_lights_keeps_the_expectation() {
    let (results, ledger) = document("vpl", "2");
    assert_eq!(
        ledger.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(),
        ["E1", "E2", "E3", "E4", "E5", "E6", "E7", "R4"]
    );
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
}

#[test]
fn the_report_on_bidirectional_path_tracing_finds_its_gain_and_no_broken_law() {
    let (results, ledger) = document("bidirectional", "2");
    let [a1, a2, l1, r5] = &ledger[..] else { panic!("{ledger:?}") };
    assert_eq!([a1, a2, l1, r5].map(|row| row[0].as_str()), ["A1", "A2", "L1", "R5"]);
    assert_eq!([&a1[1], &r5[1]], ["holds", "holds"], "{a1:?}");
    assert_ne!(l1[1], "holds_under", "{l1:?}");
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
}

#[test]
fn the_report_on_chains_has_its_sections_and_finds_no_bias() {
    let (results, ledger) = document("metropolis", "2");
    let [a3, r6] = &ledger[..] else { panic!("{ledger:?}") };
    assert_eq!([a3, r6].map(|row| row[0].as_str()), ["A3", "R6"]);
    assert_eq!(a3[1], "holds", "{a3:?}");
    assert_ne!(r6[1], "does_not_hold", "{r6:?}");
    assert_eq!(results["unsound"].as_array().map(Vec::len), Some(0), "{}", results["unsound"]);
    let sections: Vec<&str> =
        results["sections"].as_array().expect("sections").iter().filter_map(|s| s["id"].as_str()).collect();
    assert_eq!(sections, ["equal-time", "resolution", "mutations", "maps", "sizes", "rows", "start"]);
}

#[test]
fn what_cannot_be_written_is_said_before_anything_is_measured() {
    let parent = tempfile::tempdir().expect("a temporary folder");
    let file = parent.path().join("file");
    fs::write(&file, "not a folder").expect("writable");
    let foreign = parent.path().join("foreign");
    fs::create_dir(&foreign).expect("writable");
    fs::write(foreign.join("thesis.tex"), "precious").expect("writable");
    for out in [file.join("below"), file.clone(), foreign.clone()] {
        let outcome = harness(&["report", "--out", out.to_str().expect("UTF-8")], "");
        assert_eq!((outcome.code, outcome.stdout.as_str()), (3, ""), "{}: {}", out.display(), outcome.stderr);
        assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{}", outcome.stderr);
    }
    assert_eq!(fs::read_to_string(foreign.join("thesis.tex")).expect("still there"), "precious");
    assert_eq!(names(parent.path()).len(), 2);
}

#[test]
fn bad_reports_are_refused_and_leave_nothing() {
    let parent = tempfile::tempdir().expect("a temporary folder");
    let out = parent.path().join("report");
    let out = out.to_str().expect("UTF-8");
    let truncated = fixture("truncated.vdb");
    for arguments in [
        &["report", "unheard", "--out", out][..],
        &["report", "--quick", "--vdb", "no/such.vdb", "--out", out],
        &["report", "--quick", "--vdb", &truncated, "--out", out],
        &["report", "--quick", "--grid", "density", "--out", out],
    ] {
        let outcome = harness(arguments, "");
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}: {}", outcome.stderr);
    }
    assert!(names(parent.path()).is_empty());
}

#[test]
fn verify_of_one_estimator_holds_and_prints_its_power() {
    let outcome = harness(&["verify", "--quick", "--estimator", "line_integral"], "");
    assert_eq!(outcome.code, 0, "{}{}", outcome.stdout, outcome.stderr);
    assert!(outcome.stdout.contains("0 do not hold") && outcome.stdout.contains("with probability 0.99"));
    assert!(outcome.stdout.contains("line_integral_4") && !outcome.stdout.contains("/woodcock"));
}

#[test]
fn verify_takes_integrators_and_samplers_and_says_what_was_meant() {
    for (kind, other) in [("jittered_flight", "regular_flight"), ("transmittance", "vpl")] {
        let outcome = harness(&["verify", "--quick", "--json", "--kind", kind], "");
        assert_eq!(outcome.code, 0, "{}{}", outcome.stdout, outcome.stderr);
        let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
        let checks = json["checks"].as_array().unwrap();
        assert!(checks.iter().all(|check| check["kinds"].as_array().unwrap().contains(&kind.into())));
        let hard = checks.iter().filter(|check| check["law"] == "hard_case").count();
        assert!(hard > 3 && checks.len() > hard, "{kind}: {hard} of {}", checks.len());
        assert!(!checks.iter().any(|check| check["kinds"] == serde_json::json!([other])));
    }
    let outcome = harness(&["verify", "--estimator", "path_trace"], "");
    assert_eq!(outcome.code, 2);
    for word in ["woodcock, ", "vpl, ", "shared_distance", "(did you mean path_tracer?)"] {
        assert!(outcome.stderr.contains(word), "{word}: {}", outcome.stderr);
    }
}

#[test]
fn verify_as_json_tells_each_check_with_its_p_values() {
    let outcome = harness(&["verify", "--quick", "--json", "--estimator", "adaptive_ratio"], "");
    assert_eq!(outcome.code, 0, "{}{}", outcome.stdout, outcome.stderr);
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(json["provenance"]["seed"], 1);
    assert_eq!(json["family"]["level"], 1e-6);
    let checks = json["checks"].as_array().unwrap();
    assert!(checks.len() > 4);
    for check in checks {
        assert_eq!(check["holds"], true, "{check}");
        assert!(check["kinds"].as_array().unwrap().contains(&"adaptive_ratio".into()), "{check}");
        let p_values = check["p_values"].as_array().unwrap();
        assert!(p_values.iter().all(|p| (0.0..=1.0).contains(&p["p"].as_f64().unwrap())), "{check}");
        if check["law"] == "transmittance" {
            assert_eq!(p_values[0]["of"], "mean", "{check}");
            assert!(["exact", "studentised"].contains(&p_values[0]["level"].as_str().unwrap()), "{check}");
        }
    }
}
