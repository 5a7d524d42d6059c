//! Outputs of the program over many experiments and scenes, kept as files: what a change of its code leaves as it was.
//!
//! ```sh
//! cargo build --release && cp target/release/harness before
//! cargo run -p fairflight-tests --example recordings -- before FOLDER_BEFORE
//! cargo build --release
//! cargo run -p fairflight-tests --example recordings -- target/release/harness FOLDER_AFTER
//! diff -r FOLDER_BEFORE FOLDER_AFTER
//! ```
//!
//! `tests/recordings` holds profiles, estimators, whole experiments (refusals, sweeps) and parts of scenes by name. Each estimator meets
//! six profiles, each profile six estimators; each integrator a scene without surfaces and one with, each medium, light and
//! estimator a few integrators. A file per run holds the input, the exit code, standard output and standard error, without seconds,
//! revision and command; of images a hash of the bytes.

use fairflight_tests::repository;
use serde_json::{Map, Value, json};
use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// One run of the program.
struct Run {
    name: String,
    input: String,
    kind: Kind,
}

enum Kind {
    Estimate,
    Render,
    Plain(Vec<&'static str>),
}

fn data(file: &str) -> Map<String, Value> {
    let path = repository().join("tests/recordings").join(file);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Experiments: the product of what is listed here, and the whole ones.
fn experiments() -> Vec<Run> {
    const PROFILES: [&str; 6] = ["constant", "linear", "expression", "cosine, clipped", "noise", "voxels"];
    const ESTIMATORS: [&str; 6] =
        ["ratio", "explorers", "regular", "jittered ratio, cells", "unbiased marching", "hybrid"];
    let (profiles, estimators) = (data("profiles.json"), data("estimators.json"));
    let mut runs = Vec::new();
    for (profile, shape) in &profiles {
        for (estimator, parameters) in &estimators {
            if PROFILES.contains(&profile.as_str()) || ESTIMATORS.contains(&estimator.as_str()) {
                let spec = json!({ "profile": shape, "estimator": parameters, "samples": 1000, "seed": 11 });
                runs.push(estimate(&format!("{estimator} on {profile}"), &spec));
            }
        }
    }
    for (name, mut spec) in data("experiments.json") {
        // A name stands for what is listed under it.
        for (key, list) in [("profile", &profiles), ("estimator", &estimators)] {
            if let Some(found) = spec.get(key).and_then(Value::as_str).and_then(|name| list.get(name)) {
                spec[key] = found.clone();
            }
        }
        runs.push(match spec {
            Value::String(text) => Run { name, input: text, kind: Kind::Estimate },
            spec => estimate(&name, &spec),
        });
    }
    runs
}

fn estimate(name: &str, spec: &Value) -> Run {
    Run { name: format!("estimate {name}"), input: format!("{spec:#}"), kind: Kind::Estimate }
}

/// Scenes: each part of the list among the usual other ones.
fn scenes() -> Vec<Run> {
    let parts = Value::Object(data("scenes.json"));
    let estimators = data("estimators.json");
    let named = |of: &str| parts[of].as_object().expect(of).clone();
    let mut runs = Vec::new();
    let mut add = |name: String, medium: &str, lights: &str, surfaces: &str, integrator: &Value| {
        let mut scene = json!({
            "camera": parts["camera"], "lights": parts["lights"][lights], "surfaces": parts["surfaces"][surfaces],
            "integrator": integrator, "samples_per_pixel": 2, "seed": 5,
        });
        if let Some(medium) = parts["media"].get(medium) {
            scene["medium"] = medium.clone();
        }
        runs.push(Run { name: format!("render {name}"), input: format!("{scene:#}"), kind: Kind::Render });
    };
    for (name, integrator) in &named("integrators") {
        add(format!("{name} in a ball"), "ball", "all", "none", integrator);
        add(format!("{name} in noise"), "noise", "point", "none", integrator);
        add(format!("{name} among surfaces"), "ball", "none", "floor and lamp", integrator);
    }
    for (name, integrator) in ["particles", "paths", "vpl, one to one", "single, attenuation"]
        .map(|name| (name, &parts["integrators"][name]))
    {
        for medium in named("media").keys().map(String::as_str).chain(["vacuum"]) {
            add(format!("{name}, medium {medium}"), medium, "all", "none", integrator);
        }
        for lights in named("lights").keys() {
            add(format!("{name}, lights {lights}"), "formula", lights, "none", integrator);
        }
        add(format!("{name} with glass"), "coloured", "none", "glass and mirror", integrator);
    }
    for (name, estimator) in &estimators {
        let transmittance = json!({ "kind": "transmittance", "estimator": estimator });
        add(format!("transmittance, {name}"), "formula", "environment", "none", &transmittance);
        let paths = json!({ "kind": "path_tracer", "estimator": estimator });
        add(format!("paths, {name}"), "ball", "point", "floor and lamp", &paths);
    }
    runs
}

fn plain(name: &str, arguments: &[&'static str]) -> Run {
    Run { name: name.to_owned(), input: String::new(), kind: Kind::Plain(arguments.to_vec()) }
}

/// Leaves out what differs from run to run.
fn normalised(value: &mut Value) {
    match value {
        Value::Object(map) => {
            for (key, found) in map.iter_mut() {
                if key.ends_with("second")
                    || key.ends_with("seconds")
                    || ["command", "revision"].contains(&key.as_str())
                {
                    *found = json!("…");
                }
            }
            map.values_mut().for_each(normalised);
        }
        Value::Array(items) => items.iter_mut().for_each(normalised),
        _ => {}
    }
}

fn as_kept(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    match serde_json::from_str::<Value>(&text) {
        Ok(mut json) => {
            normalised(&mut json);
            format!("{json:#}")
        }
        Err(_) => text.into_owned(),
    }
}

fn kept(run: &Run, program: &Path, scratch: &Path) -> String {
    let images = ["image.pfm", "image.png", "statistics.json"].map(|name| scratch.join(name));
    for image in &images {
        // There is none before the first.
        let _ = fs::remove_file(image);
    }
    let mut command = Command::new(program);
    match &run.kind {
        Kind::Estimate => command.args(["estimate", "-"]),
        Kind::Render => images
            .iter()
            .fold(command.args(["render", "-"]), |command, image| command.arg("--out").arg(image)),
        Kind::Plain(arguments) => command.args(arguments),
    };
    command.current_dir(repository()).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    child.stdin.take().expect("a pipe").write_all(run.input.as_bytes()).unwrap_or_default();
    let output = child.wait_with_output().expect("the program");
    let mut text = format!("{}\n\nexit code {:?}\n", run.input, output.status.code());
    for (title, bytes) in [("output", &output.stdout), ("errors", &output.stderr)] {
        let place = scratch.display().to_string();
        text += &format!("\n{title}\n{}\n", as_kept(bytes).replace(&place, "…"));
    }
    for image in &images {
        let Ok(bytes) = fs::read(image) else { continue };
        let name = image.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        text += &if name.ends_with(".json") {
            format!("\n{name}\n{}\n", as_kept(&bytes))
        } else {
            let mut hasher = DefaultHasher::new();
            bytes.hash(&mut hasher);
            format!("\n{name}: {} bytes, {:016x}\n", bytes.len(), hasher.finish())
        };
    }
    text
}

fn main() {
    let arguments: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let [program, folder] = &arguments[..] else { panic!("give the program and a folder") };
    let program = fs::canonicalize(program).unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    fs::create_dir_all(folder).expect("a folder");
    let folder = fs::canonicalize(folder).expect("a folder");
    let scratch = folder.with_extension("scratch");
    fs::create_dir_all(&scratch).expect("a folder");
    let mut runs = experiments();
    runs.extend(scenes());
    runs.push(plain("list", &["list"]));
    runs.push(plain("verify regular", &["verify", "--quick", "--estimator", "regular"]));
    runs.push(plain("verify nothing", &["verify", "--quick", "--estimator", "nothing"]));
    for run in &runs {
        fs::write(folder.join(run.name.replace('/', " ") + ".txt"), kept(run, &program, &scratch))
            .expect("a file");
    }
    fs::remove_dir_all(&scratch).expect("a folder");
    println!("{} runs", runs.len());
}
