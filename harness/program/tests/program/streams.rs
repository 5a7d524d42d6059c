//! Standard output and standard error of the program.

use crate::common::{Running, entries, wait_for};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

const EXPERIMENT: &str = r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1 },
    "estimator": { "kind": "double_particle", "sigma_samp": 2 }, "samples": 300000, "seed": 1 }"#;

#[test]
fn progress_is_told_in_lines_of_json() {
    let mut child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["estimate", "-", "--progress", "json"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped()),
    );
    child.stdin.take().expect("a pipe").write_all(EXPERIMENT.as_bytes()).expect("it reads");
    let output = child.output();
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice::<Value>(&output.stdout).expect("the result is JSON");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    let lines: Vec<Value> = stderr.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let number = |line: &Value, key: &str| line[key].as_f64().expect("a number");
    for line in &lines {
        let keys: Vec<&String> = line.as_object().expect("an object").keys().collect();
        assert_eq!(keys, ["done", "total", "what", "seconds"]);
        assert_eq!((line["total"].as_u64(), line["what"].as_str()), (Some(300_000), Some("estimating")));
    }
    assert!(
        lines
            .windows(2)
            .all(|pair| ["done", "seconds"].iter().all(|key| number(&pair[0], key) <= number(&pair[1], key)))
    );
    let ends = [lines.first(), lines.last()].map(|line| number(line.expect("two lines at least"), "done"));
    assert_eq!(ends, [0.0, 300_000.0]);
}

#[test]
fn a_bare_command_says_where_it_will_write() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let mut child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness")).current_dir(root.path()).stderr(Stdio::piped()),
    );
    let mut line = String::new();
    BufReader::new(child.stderr.take().expect("a pipe")).read_line(&mut line).expect("it says so");
    let folder = root.path().canonicalize().expect("a folder").join("reports/standard");
    assert!(line.contains(&folder.display().to_string()), "{line}");
    wait_for("its folder", || entries(root.path()) == 1);
}
