//! A person gives up in the middle of a report. Signals are sent as on Unix.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Far longer than the first steps of a report and the removal of a folder take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

fn wait_for(what: &str, mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < PATIENCE, "{what}: not within {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn entries(folder: &Path) -> usize {
    fs::read_dir(folder).map_or(0, Iterator::count)
}

/// Starts a report of a minute, and interrupts it as soon as its temporary folder is there.
fn interrupted(signal: &str, out: &Path) -> Child {
    let child = Command::new(env!("CARGO_BIN_EXE_harness"))
        .args(["report", "--threads", "1", "--out"])
        .arg(out)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let parent = out.parent().expect("a parent").to_owned();
    wait_for("the temporary folder", || entries(&parent) > 0);
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
    child
}

#[test]
fn an_interrupted_report_leaves_nothing_and_says_so() {
    let root = tempfile::tempdir().expect("a temporary folder");
    for signal in ["-INT", "-TERM"] {
        let mut child = interrupted(signal, &root.path().join("new/parents/report"));
        wait_for("the end", || child.try_wait().expect("a state").is_some());
        let output = child.wait_with_output().expect("an end");
        assert_eq!(output.status.code(), Some(130), "{signal}: {output:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "interrupted\n", "{signal}");
        assert!(output.stdout.is_empty());
        assert_eq!(entries(root.path()), 0, "{signal}");
    }
}
