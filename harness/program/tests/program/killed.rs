//! Nobody can end well after `kill -9`: what is left then, and what the next run makes of it.

use crate::common::{Running, endless, entries, names, scene, wait_for};
use fairflight_harness::image::Image;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

fn kill(mut child: Running) {
    // SIGKILL.
    child.kill().expect("it runs");
    child.wait().expect("an end");
}

/// Renders a small scene into the files of [`endless`].
fn render(folder: &Path) {
    let mut child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["render", "-", "--out"])
            .arg(folder.join("image.pfm"))
            .arg("--out")
            .arg(folder.join("statistics.json"))
            .stdin(Stdio::piped())
            .stderr(Stdio::piped()),
    );
    child.stdin.take().expect("a pipe").write_all(scene().to_string().as_bytes()).expect("it reads");
    let output = child.output();
    assert!(output.status.success(), "{output:?}");
}

fn are_whole(folder: &Path) {
    assert_eq!(Image::read(&folder.join("image.pfm")).expect("it is whole").pixels().len(), 360);
    let statistics = fs::read(folder.join("statistics.json")).expect("a file");
    serde_json::from_slice::<Value>(&statistics).expect("it is whole");
}

#[test]
fn a_killed_image_leaves_a_hidden_file_at_most_which_the_next_run_removes() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path();
    let mut left = Vec::new();
    // A pass of several seconds: nothing is in place.
    for _ in 0..2 {
        let child = endless([1500, 1500], folder);
        // The files of the run before this one make way.
        wait_for("files of its own", || {
            entries(folder) == 2 && names(folder).iter().all(|name| !left.contains(name))
        });
        kill(child);
        left = names(folder);
        assert_eq!(left.len(), 2, "{left:?}");
        for (name, output) in left.iter().zip([".image.pfm.partial-", ".statistics.json.partial-"]) {
            assert!(name.starts_with(output), "{left:?}");
        }
    }
    render(folder);
    assert_eq!(names(folder), ["image.pfm", "statistics.json"]);
    are_whole(folder);

    // In the middle of small passes, with files that are put in place again and again.
    let child = endless([20, 18], folder);
    let image = folder.join("image.pfm");
    let first = fs::metadata(&image).expect("a file").modified().expect("a time");
    let is_newer = || fs::metadata(&image).is_ok_and(|it| it.modified().is_ok_and(|time| time > first));
    wait_for("an unfinished image", is_newer);
    kill(child);
    are_whole(folder);
    let hidden = names(folder).iter().filter(|name| name.starts_with('.')).count();
    assert!(hidden <= 2 && entries(folder) == hidden + 2, "{:?}", names(folder));
    render(folder);
    assert_eq!(names(folder), ["image.pfm", "statistics.json"]);
}

#[test]
fn a_run_leaves_the_hidden_file_of_another_one_that_lives() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path();
    let child = endless([1500, 1500], folder);
    wait_for("temporary files", || entries(folder) == 2);
    std::thread::sleep(std::time::Duration::from_millis(100));
    render(folder);
    assert_eq!(names(folder).iter().filter(|name| name.starts_with('.')).count(), 2, "{:?}", names(folder));
    kill(child);
    render(folder);
    assert_eq!(names(folder), ["image.pfm", "statistics.json"]);
}

#[test]
fn a_killed_report_leaves_a_hidden_folder_which_the_next_run_removes() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let start = || {
        Running::start(
            Command::new(env!("CARGO_BIN_EXE_harness"))
                .args(["report", "--threads", "1", "--out"])
                .arg(root.path().join("report"))
                .stderr(Stdio::piped()),
        )
    };
    let mut left = Vec::new();
    for _ in 0..2 {
        let child = start();
        wait_for("another temporary folder", || {
            let now = names(root.path());
            now.len() == 1 && now != left
        });
        std::thread::sleep(std::time::Duration::from_millis(100));
        kill(child);
        left = names(root.path());
        assert!(left.len() == 1 && left[0].starts_with(".report.partial-"), "{left:?}");
    }
}
