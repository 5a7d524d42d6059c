//! A program that runs beside its test, and what it leaves in a folder.

use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::ops::{Deref, DerefMut};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Far longer than the first steps of a report and the removal of a folder take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// The reference scene, small.
pub(crate) fn scene() -> Value {
    let mut scene: Value =
        serde_json::from_str(include_str!("../../../scenes/eq21-environment.json")).expect("a scene of ours");
    scene["camera"]["resolution"] = json!([20, 18]);
    scene["samples_per_pixel"] = json!(4);
    scene
}

/// A program that does not outlive its test.
pub(crate) struct Running(Option<Child>);

impl Running {
    pub(crate) fn start(command: &mut Command) -> Self {
        Self(Some(command.spawn().expect("the program starts")))
    }

    pub(crate) fn output(mut self) -> Output {
        self.0.take().expect("it runs").wait_with_output().expect("an end")
    }
}

impl Deref for Running {
    type Target = Child;
    fn deref(&self) -> &Child {
        self.0.as_ref().expect("it runs")
    }
}

impl DerefMut for Running {
    fn deref_mut(&mut self) -> &mut Child {
        self.0.as_mut().expect("it runs")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

pub(crate) fn wait_for(what: &str, mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < PATIENCE, "{what}: not within {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

pub(crate) fn entries(folder: &Path) -> usize {
    fs::read_dir(folder).map_or(0, Iterator::count)
}

/// Starts the reference scene as an image that never ends, in passes.
pub(crate) fn endless(resolution: [u32; 2], folder: &Path) -> Running {
    let mut scene = scene();
    scene["camera"]["resolution"] = json!(resolution);
    scene["samples_per_pixel"] = json!(ENDLESS);
    started(&scene, folder)
}

/// Samples per pixel that nobody waits for.
pub(crate) const ENDLESS: u32 = 4_000_000_000;

/// Starts an image that may end early.
pub(crate) fn started(scene: &Value, folder: &Path) -> Running {
    let mut child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["render", "-", "--threads", "1", "--time-limit", "1000", "--out"])
            .arg(folder.join("image.pfm"))
            .arg("--out")
            .arg(folder.join("statistics.json"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped()),
    );
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin.write_all(scene.to_string().as_bytes()).expect("it reads");
    child
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().expect("Unicode")).collect();
    names.sort();
    names
}
