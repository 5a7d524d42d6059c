//! Drives the program as a user would: arguments and standard input in, exit code and both streams out.

use fairflight_harness::Host;
use fairflight_program::run;
use serde_json::{Value, json};

/// Exit code and output of a run of the program.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs `harness ARGUMENTS` with this standard input.
pub(crate) fn harness(arguments: &[&str], stdin: &str) -> Outcome {
    harness_on(Host::default(), arguments, stdin)
}

/// The same on a terminal, but without progress.
pub(crate) fn on_a_terminal(arguments: &[&str], stdin: &str) -> Outcome {
    harness_on(Host { tables: true, ..Host::default() }, arguments, stdin)
}

fn harness_on(host: Host, arguments: &[&str], stdin: &str) -> Outcome {
    let (mut stdout, mut stderr) = (Vec::new(), Vec::new());
    let words = std::iter::once(&"harness").chain(arguments).copied();
    let code = run(words, &mut stdin.as_bytes(), &mut stdout, &mut stderr, host);
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    Outcome { code, stdout: text(stdout), stderr: text(stderr) }
}

/// Runs `harness estimate -` on a spec, and reads the result.
pub(crate) fn estimate(spec: &str) -> Value {
    let outcome = harness(&["estimate", "-"], spec);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).expect("the result is JSON")
}

/// The path of a fixture.
pub(crate) fn fixture(name: &str) -> String {
    format!("{}/../../tests/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Statistics without what the clock and the command line say.
pub(crate) fn timeless(mut statistics: Value) -> Value {
    for (part, key) in [
        ("cost", "seconds"),
        ("cost", "cpu_seconds"),
        ("efficiency", "per_second"),
        ("provenance", "command"),
    ] {
        statistics[part][key] = Value::Null;
    }
    if let Some(maps) = statistics.get_mut("photon_maps") {
        maps["light_path_seconds"] = Value::Null;
    }
    statistics
}

/// A scene with Perlin noise in place of its homogeneous medium: without a closed form.
pub(crate) fn in_noise(mut scene: Value) -> Value {
    let medium = scene["medium"].as_object_mut().unwrap();
    medium.remove("sigma_t");
    let noise =
        json!({ "kind": "perlin", "octaves": 2, "frequency": 1, "seed": 3, "scale": 0.1, "offset": 0.2 });
    medium.extend(noise.as_object().unwrap().clone());
    scene
}
