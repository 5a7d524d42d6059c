//! A person gives up in the middle of a report or an image. Signals are sent as on Unix.

use crate::common::{ENDLESS, Running, endless, entries, names, scene, started, wait_for};
use fairflight_harness::image::Image;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Starts a report of a minute, and interrupts it as soon as its temporary folder is there.
fn interrupted(signal: &'static str, out: &Path) -> Running {
    let child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["report", "--threads", "1", "--out"])
            .arg(out)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped()),
    );
    let parent = out.parent().expect("a parent").to_owned();
    wait_for("the temporary folder", || entries(&parent) > 0);
    send(signal, &child);
    child
}

/// A signal that the program serves: the one given, or another where whoever started the tests ignores it (a shell in the
/// background, say), since what is ignored at the start stays ignored.
fn served(signal: &'static str) -> &'static str {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).map(str::trim);
    let ignored = mask.map_or(0, |mask| u64::from_str_radix(mask, 16).expect("a mask"));
    let all = [("-HUP", 1), ("-TERM", 15), ("-INT", 2), ("-QUIT", 3)];
    let is_served = |(_, number): &(&str, u32)| ignored >> (number - 1) & 1 == 0;
    let asked = all.into_iter().filter(|(name, _)| *name == signal);
    asked.chain(all).find(is_served).expect("one that is not ignored").0
}

/// Sends a signal that is served.
fn send(signal: &'static str, child: &Child) {
    let signal = served(signal);
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
}

fn statistics(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("statistics.json")).expect("a file")).expect("JSON")
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
    let output = child.output();
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
fn an_interrupt_ends_whatever_light_paths_share_after_a_whole_pass() {
    let mixed = include_str!("../../../scenes/mixed.json");
    for integrator in [
        json!({ "kind": "bidirectional" }),
        json!({ "kind": "path_tracer", "extension": { "kind": "guided", "photons": 500, "nearest": 8 } }),
        json!({ "kind": "path_tracer", "reuse": { "tile": 3 } }),
        json!({ "kind": "beam_radiance", "photons": 500, "radius": 0.1 }),
    ] {
        let root = tempfile::tempdir().expect("a temporary folder");
        let mut scene: Value = serde_json::from_str(mixed).expect("a scene of ours");
        scene["camera"]["resolution"] = json!([20, 18]);
        scene["integrator"] = integrator;
        scene["samples_per_pixel"] = json!(ENDLESS);
        let (drawn, _) = interrupted_image(&scene, root.path());
        // The image is that of so many passes.
        scene["samples_per_pixel"] = json!(drawn);
        is_image_of(&scene, root.path());
    }
}

#[test]
fn an_interrupt_ends_chains_after_whole_replicas() {
    let mut scene: Value =
        serde_json::from_str(include_str!("../../../scenes/mixed.json")).expect("a scene of ours");
    scene["camera"]["resolution"] = json!([20, 18]);
    scene["integrator"] =
        json!({ "kind": "metropolis", "space": "primary", "over": "path_tracer", "replicas": 1000 });
    scene["samples_per_pixel"] = json!(200_000);
    let root = tempfile::tempdir().expect("a temporary folder");
    let (drawn, told) = interrupted_image(&scene, root.path());
    assert_eq!(told["chains"]["replicas"], drawn / 200);
    scene["samples_per_pixel"] = json!(drawn);
    scene["integrator"]["replicas"] = json!(drawn / 200);
    is_image_of(&scene, root.path());
}

/// Draws a scene, interrupts that after a while; the samples per pixel that were drawn, and the statistics.
fn interrupted_image(scene: &Value, folder: &Path) -> (u64, Value) {
    let mut child = started(scene, folder);
    wait_for("temporary files", || entries(folder) >= 2);
    std::thread::sleep(Duration::from_millis(200));
    send("-INT", &child);
    wait_for("the end", || child.try_wait().expect("a state").is_some());
    let output = child.output();
    let integrator = &scene["integrator"];
    assert_eq!(output.status.code(), Some(130), "{integrator}: {output:?}");
    assert_eq!(names(folder), ["image.pfm", "statistics.json"], "{integrator}");
    let told = statistics(folder);
    let drawn = told["image"]["samples_per_pixel"].as_u64().expect("a number");
    let asked = &scene["samples_per_pixel"];
    let warning = format!("an interrupt ended the image after {drawn} of {asked} samples per pixel");
    assert!(told["warnings"].to_string().contains(&warning), "{integrator}");
    (drawn, told)
}

/// Asserts that the image in a folder is that of a scene.
fn is_image_of(scene: &Value, folder: &Path) {
    let again = folder.join("again.pfm");
    let mut same = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["render", "-", "--out"])
            .arg(&again)
            .stdin(Stdio::piped()),
    );
    same.stdin.take().expect("a pipe").write_all(scene.to_string().as_bytes()).expect("it reads");
    assert!(same.wait().expect("an end").success());
    let [image, again] = [folder.join("image.pfm"), again].map(|path| fs::read(path).expect("a file"));
    assert!(image == again, "{}: another image", scene["integrator"]);
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
        let output = child.output();
        assert_eq!(output.status.code(), Some(130), "{signal}: {output:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "interrupted\n", "{signal}");
        assert!(output.stdout.is_empty());
        assert_eq!(entries(root.path()), 0, "{signal}");
    }
}

/// Waits until the program serves signals: what comes before is the system's.
#[cfg(target_os = "linux")]
fn wait_until_served(process: u32) {
    wait_for("a handler of SIGTERM", || {
        let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        caught.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).expect("a mask") >> 14 & 1 == 1)
    });
}

#[cfg(target_os = "linux")]
#[test]
fn whatever_runs_ends_without_a_result_and_says_so() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let picture = root.path().join("image.pfm").display().to_string();
    let mut endless = scene();
    endless["camera"]["resolution"] = json!([512, 512]);
    endless["samples_per_pixel"] = json!(4_000);
    let mut photons = endless.clone();
    photons["integrator"]["particles"] = json!("photons");
    let experiment = r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1 },
        "estimator": { "kind": "double_particle", "sigma_samp": 1 }, "samples": 40000000000, "seed": 1 }"#;
    let noise = r#"{ "kind": "perlin", "bounds": { "sphere": { "center": [0, 0, 0], "radius": 90 } } }"#;
    for (arguments, input, signal) in [
        (&["estimate", "-"][..], experiment.to_owned(), "-HUP"),
        (&["advise", "-", "--rays", "2000"], noise.to_owned(), "-TERM"),
        (&["verify"], String::new(), "-INT"),
        (&["render", "-", "--out", &picture], endless.to_string(), "-TERM"),
        (&["render", "-", "--out", &picture], photons.to_string(), "-QUIT"),
    ] {
        let mut child = Running::start(
            Command::new(env!("CARGO_BIN_EXE_harness"))
                .args(arguments)
                .stdin(Stdio::piped())
                .stdout(Stdio::piped())
                .stderr(Stdio::piped()),
        );
        child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("it reads");
        wait_until_served(child.id());
        std::thread::sleep(Duration::from_millis(200));
        send(signal, &child);
        wait_for("the end", || child.try_wait().expect("a state").is_some());
        let output = child.output();
        assert_eq!(output.status.code(), Some(130), "{arguments:?}: {output:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "interrupted\n", "{arguments:?}");
        assert!(output.stdout.is_empty() && entries(root.path()) == 0, "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn more_than_an_hour_is_said_before_it_begins() {
    let experiment = r#"{ "profile": { "kind": "constant", "sigma_t": 1, "length": 1 },
        "estimator": { "kind": "ray_marching", "steps": 100000, "jitter": true }, "samples": 10000000000, "seed": 1 }"#;
    let mut child = Running::start(
        Command::new(env!("CARGO_BIN_EXE_harness"))
            .args(["estimate", "-", "--budget", "1e16", "--threads", "1"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped()),
    );
    child.stdin.take().expect("a pipe").write_all(experiment.as_bytes()).expect("it reads");
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut line = String::new();
    stderr.read_line(&mut line).expect("it says so");
    assert!(line.starts_with("warning: this will take about ") && line.contains("1.0e15 look-ups"), "{line}");
    send("-INT", &child);
    wait_for("the end", || child.try_wait().expect("a state").is_some());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
}

/// Signals that are ignored when the program starts: hang-ups under `nohup`, the interrupts of the keyboard in the
/// background of a shell.
#[cfg(target_os = "linux")]
#[test]
fn what_was_ignored_stays_ignored_and_the_rest_is_served() {
    for (shell, ignored, last) in [
        (r#"nohup "$0" "$@" <"$SCENE" & echo $!; wait $!"#, &["-HUP", "-INT", "-QUIT"][..], "-TERM"),
        (r#""$0" "$@" <"$SCENE" & echo $!; wait $!"#, &["-INT", "-QUIT"], "-HUP"),
        (r#"trap '' TERM; exec "$0" "$@" <"$SCENE""#, &["-TERM"], "-INT"),
    ] {
        let last = served(last);
        if ignored.contains(&last) {
            // Whoever started the tests ignores all others: nothing could end the program but a kill.
            continue;
        }
        let root = tempfile::tempdir().expect("a temporary folder");
        let specs = tempfile::tempdir().expect("a temporary folder");
        let spec = specs.path().join("scene.json");
        let mut endless = scene();
        endless["camera"]["resolution"] = json!([512, 512]);
        endless["samples_per_pixel"] = json!(4_000);
        fs::write(&spec, endless.to_string()).expect("a file");
        let mut child = Running::start(
            Command::new("sh")
                .args(["-c", shell, env!("CARGO_BIN_EXE_harness"), "render", "-", "--threads", "1", "--out"])
                .arg(root.path().join("image.png"))
                .arg("--out")
                .arg(root.path().join("image.json"))
                .env("SCENE", &spec)
                .stdout(Stdio::piped())
                .stderr(Stdio::piped()),
        );
        let mut stdout = BufReader::new(child.stdout.take().expect("a pipe"));
        let process = if shell.starts_with("trap") {
            child.id()
        } else {
            let mut line = String::new();
            stdout.read_line(&mut line).expect("the shell tells the process");
            line.trim().parse().expect("a number")
        };
        wait_for("temporary files", || entries(root.path()) == 2);
        let signal = |name: &str| {
            let status = Command::new("kill").args([name, &process.to_string()]).status().expect("kill runs");
            assert!(status.success(), "{shell}: {name} finds nobody");
        };
        ignored.iter().for_each(|name| signal(name));
        // Longer than a request would be waited for.
        std::thread::sleep(fairflight_harness::interrupt::GRACE + Duration::from_millis(500));
        assert_eq!(entries(root.path()), 2, "{shell}: still at work");
        signal(last);
        wait_for("the end", || child.try_wait().expect("a state").is_some());
        assert_eq!(child.wait().expect("an end").code(), Some(130), "{shell}");
        assert_eq!(entries(root.path()), 0, "{shell}");
    }
}
