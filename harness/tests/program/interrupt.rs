//! A person gives up in the middle of a report or an image. Signals are sent as on Unix.

use crate::render::scene;
use fairflight_harness::image::Image;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
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
    send(signal, &child);
    child
}

fn send(signal: &str, child: &Child) {
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
}

/// Starts an image that never ends, in passes.
fn endless(resolution: [u32; 2], folder: &Path) -> Child {
    let mut scene = scene();
    scene["camera"]["resolution"] = json!(resolution);
    scene["samples_per_pixel"] = json!(4_000_000_000_u32);
    let mut child = Command::new(env!("CARGO_BIN_EXE_harness"))
        .args(["render", "-", "--threads", "1", "--time-limit", "1000", "--out"])
        .arg(folder.join("image.pfm"))
        .arg("--out")
        .arg(folder.join("statistics.json"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin.write_all(scene.to_string().as_bytes()).expect("it reads");
    child
}

fn statistics(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("statistics.json")).expect("a file")).expect("JSON")
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().expect("Unicode")).collect();
    names.sort();
    names
}

const ASKED: &str = "interrupted: stops with what is done, again: stops at once\n";

#[test]
fn an_image_in_passes_can_be_watched_and_interrupted() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path();
    let mut child = endless([20, 18], folder);
    let image = folder.join("image.pfm");
    // Files are put in place together, this one last.
    wait_for("an unfinished image", || folder.join("statistics.json").exists());
    assert_eq!(Image::read(&image).expect("it is whole").pixels().len(), 360);
    let unfinished = statistics(folder);
    let so_far = unfinished["image"]["samples_per_pixel"].as_u64().expect("a number");
    let warning = unfinished["warnings"][0].as_str().expect("a text");
    assert!(warning.contains("not finished") && warning.contains(" of 4000000000"), "{warning}");

    send("-INT", &child);
    wait_for("the end", || child.try_wait().expect("a state").is_some());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let finished = statistics(folder);
    let drawn = finished["image"]["samples_per_pixel"].as_u64().expect("a number");
    assert!(drawn > so_far && so_far > 0, "{drawn} after {so_far}");
    let warning = format!("an interrupt ended the image after {drawn} of 4000000000 samples per pixel");
    assert_eq!(finished["warnings"], json!([warning]));
    assert_eq!(String::from_utf8_lossy(&output.stderr), format!("{ASKED}warning: {warning}\n"));
    assert_eq!(Image::read(&image).expect("it is whole").pixels().len(), 360);
    assert_eq!(names(folder), ["image.pfm", "statistics.json"]);
}

#[test]
fn a_second_interrupt_leaves_nothing() {
    let root = tempfile::tempdir().expect("a temporary folder");
    // A pass of several seconds.
    let mut child = endless([1500, 1500], root.path());
    wait_for("temporary files", || entries(root.path()) == 2);
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    send("-INT", &child);
    let mut line = String::new();
    stderr.read_line(&mut line).expect("it says so");
    assert_eq!(line, ASKED);
    send("-INT", &child);
    wait_for("the end", || child.try_wait().expect("a state").is_some());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).expect("UTF-8");
    assert_eq!(rest, "interrupted\n");
    assert_eq!(entries(root.path()), 0);
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
