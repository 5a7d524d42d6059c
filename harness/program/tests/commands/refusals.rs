//! Bad input: exit code 2, one line on standard error that names the key, nothing on standard output.

use crate::common::{fixture, harness};

const PROFILE: &str = r#"{ "kind": "constant", "sigma_t": 1.0, "length": 2.0 }"#;
const ESTIMATOR: &str = r#"{ "kind": "double_particle", "sigma_samp": 1.0 }"#;

fn spec(profile: &str, estimator: &str) -> String {
    format!(r#"{{ "profile": {profile}, "estimator": {estimator}, "samples": 100, "seed": 1 }}"#)
}

/// Runs a spec that must be refused; its message must hold all of `words`.
#[track_caller]
fn refused(spec: &str, words: &[&str]) {
    let outcome = harness(&["estimate", "-"], spec);
    assert_eq!(outcome.code, 2, "{spec}\n{}{}", outcome.stdout, outcome.stderr);
    assert_eq!(outcome.stdout, "", "{spec}");
    assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{}", outcome.stderr);
    for word in words {
        assert!(outcome.stderr.contains(word), "no {word:?} in: {}", outcome.stderr);
    }
}

#[track_caller]
fn profile_refused(profile: &str, words: &[&str]) {
    refused(&spec(profile, ESTIMATOR), words);
}

#[track_caller]
fn estimator_refused(estimator: &str, words: &[&str]) {
    refused(&spec(PROFILE, estimator), words);
}

#[test]
fn what_is_not_a_spec() {
    refused("", &["standard input", "not JSON"]);
    refused("{", &["not JSON", "line 1"]);
    refused("[]", &["must be an object"]);
    refused("{}", &["samples", "missing"]);
    refused(&spec(PROFILE, ESTIMATOR).replace("100", "0"), &["samples", "whole number from 1", "found 0"]);
    refused(&spec(PROFILE, ESTIMATOR).replace("100", "-5"), &["samples", "found -5"]);
    refused(&spec(PROFILE, ESTIMATOR).replace("100", "1.5"), &["samples", "found 1.5"]);
    refused(&spec(PROFILE, ESTIMATOR).replace(r#""seed": 1"#, r#""seed": -1"#), &["seed"]);
    refused(&spec(PROFILE, ESTIMATOR).replace(r#""seed": 1"#, r#""sede": 1"#), &["seed", "missing"]);
    refused(
        &spec(PROFILE, ESTIMATOR).replace(r#""seed": 1"#, r#""seed": 1, "extra": 2"#),
        &["extra", "unknown key"],
    );
    refused(r#"{ "samples": NaN }"#, &["not JSON"]);
    refused(&spec(PROFILE, ESTIMATOR).replace("1.0", "1e999"), &["number out of range"]);
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let outcome = harness(&["estimate", "no/such/spec.json"], "");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""));
    assert!(outcome.stderr.contains("no/such/spec.json"), "{}", outcome.stderr);
}

#[test]
fn profiles() {
    profile_refused(r#"{ "kind": "conical" }"#, &["profile.kind", "must be constant", "conical"]);
    profile_refused(r#"{ "kind": "constant", "sigma_t": 1.0 }"#, &["profile.length", "missing"]);
    profile_refused(
        r#"{ "kind": "constant", "sigma_t": "a", "length": 1 }"#,
        &["profile.sigma_t", "finite number"],
    );
    profile_refused(
        r#"{ "kind": "constant", "sigma_t": 1, "length": -1 }"#,
        &["profile.length", "at least 0"],
    );
    profile_refused(
        r#"{ "kind": "constant", "sigma_t": 1, "length": 1, "colour": 3 }"#,
        &["profile.colour", "unknown key", "sigma_t, length"],
    );
    let cells = |edges: &str, sigma_t: &str| {
        format!(r#"{{ "kind": "piecewise_constant", "edges": {edges}, "sigma_t": {sigma_t} }}"#)
    };
    profile_refused(&cells("[]", "[]"), &["profile.edges", "at least one number"]);
    profile_refused(&cells("[0, 1, 1]", "[1, 2]"), &["edges", "increase strictly"]);
    profile_refused(&cells("[0, 1, 2]", "[1]"), &["sigma_t", "2 entries", "found 1"]);
    profile_refused(&cells("[1, 2]", "[1]"), &["edges", "start at 0"]);
    profile_refused(&cells("[0, null]", "[1]"), &["profile.edges.1", "finite number", "null"]);
    let nodes = r#"{ "kind": "piecewise_linear", "positions": [0, 2, 1], "sigma_t": [1, 2, 3] }"#;
    profile_refused(nodes, &["positions", "increase strictly"]);
}

#[test]
fn expressions() {
    let formula = |sigma_t: &str, more: &str| {
        format!(r#"{{ "kind": "expression", "sigma_t": "{sigma_t}", "length": 2{more} }}"#)
    };
    profile_refused(&formula("1 + * 2", ""), &["profile.sigma_t", "column 5"]);
    profile_refused(&formula("1 + x", ""), &["profile.sigma_t", "x"]);
    profile_refused(&formula("sin(s", ""), &["profile.sigma_t", "column"]);
    profile_refused(&formula("", ""), &["profile.sigma_t"]);
    profile_refused(&formula("ln(s - 1)", ""), &["profile", "NaN", "s = 0"]);
    profile_refused(&formula("1/0", ""), &["profile", "inf"]);
    profile_refused(
        &formula("1 + s", r#", "majorant": 2"#),
        &["profile", "exceeds the declared majorant 2", "s = "],
    );
    profile_refused(&formula("1 + s", r#", "majorant": -2"#), &["profile.majorant", "at least 0"]);
}

#[test]
fn rays_and_media() {
    let ray = |medium: &str, more: &str| {
        format!(
            r#"{{ "kind": "ray", "medium": {medium}, "origin": [0, 0, 0], "direction": [0, 0, 1]{more} }}"#
        )
    };
    profile_refused(&ray(r#"{ "kind": "fog" }"#, ""), &["profile.medium.kind", "must be homogeneous"]);
    profile_refused(
        &ray(r#"{ "kind": "homogeneous", "sigma_t": 1 }"#, ""),
        &["profile.medium.bounds", "missing"],
    );
    let ball = |bounds: &str| format!(r#"{{ "kind": "homogeneous", "sigma_t": 1, "bounds": {bounds} }}"#);
    profile_refused(
        &ray(&ball(r#"{ "sphere": { "center": [0, 0], "radius": 1 } }"#), ""),
        &["profile.medium.bounds.sphere.center", "three numbers"],
    );
    profile_refused(
        &ray(&ball(r#"{ "sphere": { "center": [0, 0, 0], "radius": -1 } }"#), ""),
        &["profile.medium.bounds.sphere.radius", "at least 0"],
    );
    profile_refused(
        &ray(&ball(r#"{ "box": { "min": [0, 0, 0], "max": [1, -1, 1] } }"#), ""),
        &["profile.medium.bounds.box.max", "below min"],
    );
    profile_refused(&ray(&ball("{}"), ""), &["profile.medium.bounds", "either sphere or box"]);
    profile_refused(
        &ray(r#"{ "kind": "analytic_cosine" }"#, r#", "length": -1"#),
        &["profile.length", "at least 0"],
    );
    profile_refused(
        &ray(r#"{ "kind": "analytic_cosine" }"#, "").replace("[0, 0, 1]", "[0, 0, 0]"),
        &["profile.direction", "must not be zero"],
    );
    let noise =
        r#"{ "kind": "perlin", "octaves": 0, "bounds": { "sphere": { "center": [0,0,0], "radius": 1 } } }"#;
    profile_refused(&ray(noise, ""), &["profile.medium.octaves", "from 1 to 32"]);
}

#[test]
fn volumes() {
    let ray = |file: &str, more: &str| {
        format!(
            r#"{{ "kind": "ray", "medium": {{ "kind": "vdb", "file": "{file}"{more} }}, "origin": [0, 0, 0], "direction": [0, 0, 1] }}"#
        )
    };
    profile_refused(&ray("no/such.vdb", ""), &["profile.medium.file", "no/such.vdb"]);
    profile_refused(&ray(&fixture("README.md"), ""), &["profile.medium.file", "OpenVDB"]);
    profile_refused(&ray(&fixture("truncated.vdb"), ""), &["profile.medium.file", "cut off"]);
    profile_refused(
        &ray(&fixture("vec_only.vdb"), ""),
        &["profile.medium.file", "no float grid", "Tree_vec3s"],
    );
    profile_refused(
        &ray(&fixture("cloud.vdb"), r#", "grid": "smoke""#),
        &["profile.medium.file", "smoke", "density", "temperature"],
    );
    // Fourteen float grids, none of them called density.
    let codes = fixture("codes.vdb");
    profile_refused(&ray(&codes, ""), &["profile.medium.file", "several float grids", "twin[0], twin[1]"]);
}

#[test]
fn negative_voxels_are_refused_unless_they_are_meant() {
    let medium = |more: &str| {
        let codes = fixture("codes.vdb");
        format!(r#"{{ "kind": "vdb", "file": "{codes}", "grid": "code1_minus_background"{more} }}"#)
    };
    let ray = |more: &str| {
        let medium = medium(more);
        format!(r#"{{ "kind": "ray", "medium": {medium}, "origin": [-6.5, -3, 5], "direction": [1, 0, 0] }}"#)
    };
    for more in ["", r#", "allow_negative": false"#, r#", "scale": -1"#] {
        profile_refused(
            &ray(more),
            &["profile.medium.file", "code1_minus_background", "-0.25", "allow_negative"],
        );
    }
    profile_refused(&ray(r#", "allow_negative": 1"#), &["profile.medium.allow_negative", "true or false"]);
    let allowed = format!(
        r#"{{ "profile": {}, "estimator": {{ "kind": "double_particle", "sigma_samp": 9 }}, "samples": 100, "seed": 1 }}"#,
        ray(r#", "allow_negative": true"#)
    );
    let outcome = harness(&["estimate", "-"], &allowed);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let outcome = harness(&["advise", "-"], &medium(""));
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""));
    assert!(outcome.stderr.contains("allow_negative"), "{}", outcome.stderr);
}

/// The cloud with every `from` of its head and descriptors overwritten by `to`.
fn overwritten(from: &[u8], to: &[u8]) -> tempfile::NamedTempFile {
    assert_eq!(from.len(), to.len(), "positions stay");
    let mut bytes = std::fs::read(fixture("cloud.vdb")).unwrap();
    let mut found = 0;
    for at in 0..bytes.len() - from.len() {
        if bytes[at..].starts_with(from) {
            bytes[at..at + to.len()].copy_from_slice(to);
            found += 1;
        }
    }
    assert!(found > 0, "nothing to overwrite");
    let mut file = tempfile::Builder::new().suffix(".vdb").tempfile().unwrap();
    std::io::Write::write_all(&mut file, &bytes).unwrap();
    file
}

#[test]
fn what_a_volume_is_taken_for_is_not_left_to_chance() {
    let nameless = overwritten(b"density", b"densitx");
    let level_set = overwritten(b"fog volume", b" level set");
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().join("report");
    let picture = out.path().join("image.pfm");
    for (file, words) in [
        (&nameless, "several float grids, of which one must be named: the file has densitx, temperature"),
        (&level_set, "level set"),
    ] {
        let file = file.path().to_str().unwrap();
        let medium = format!(r#""kind": "vdb", "file": "{file}""#);
        let experiment = format!(
            r#"{{ "profile": {{ "kind": "ray", "medium": {{ {medium} }}, "origin": [0, 0, 0], "direction": [0, 0, 1] }},
                  "estimator": {{ "kind": "double_particle", "sigma_samp": 1 }}, "samples": 10, "seed": 1 }}"#
        );
        let scene = include_str!("../../../scenes/eq21-environment.json")
            .replace(r#""kind": "analytic_cosine""#, &medium);
        let (folder, picture) = (folder.to_str().unwrap(), picture.to_str().unwrap());
        for (arguments, input) in [
            (&["estimate", "-"][..], experiment.as_str()),
            (&["render", "-", "--out", picture], &scene),
            (&["advise", "--vdb", file], ""),
            (&["report", "--quick", "--vdb", file, "--out", folder], ""),
        ] {
            let outcome = harness(arguments, input);
            assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}: {}", outcome.stderr);
            assert!(outcome.stderr.contains(words), "{arguments:?}: {}", outcome.stderr);
        }
    }
    assert_eq!(std::fs::read_dir(out.path()).unwrap().count(), 0);
}

#[test]
fn estimators() {
    estimator_refused(r#"{ "kind": "magic" }"#, &["estimator.kind", "must be woodcock"]);
    estimator_refused(r#"{ "kind": "woodcock", "majorant": -1 }"#, &["estimator.majorant", "at least 0"]);
    estimator_refused(
        r#"{ "kind": "woodcock", "majorant": 0.5 }"#,
        &["estimator.majorant", "0.5 is none", "reaches 1"],
    );
    estimator_refused(
        r#"{ "kind": "line_integral", "majorant": 1, "splits": 0 }"#,
        &["estimator.splits", "from 1", "found 0"],
    );
    estimator_refused(r#"{ "kind": "ray_marching", "steps": 8 }"#, &["estimator.jitter", "missing"]);
    estimator_refused(
        r#"{ "kind": "ray_marching", "steps": 8, "jitter": 1 }"#,
        &["estimator.jitter", "true or false"],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": -1 }"#,
        &["estimator.sigma_samp", "at least 0"],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": 0 }"#,
        &["estimator.sigma_samp", "silent bias", "s = "],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 1], "values": [1] } }"#,
        &["estimator.sigma_samp.edges", "cover the whole profile"],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": { "edges": [0, 1, 2], "values": [1] } }"#,
        &["estimator.sigma_samp", "one entry more"],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": 1, "control": { "kind": "explorers", "count": 1 } }"#,
        &["estimator.control.count", "from 2"],
    );
    estimator_refused(
        r#"{ "kind": "double_particle", "sigma_samp": 1, "control": { "kind": "piecewise_linear", "positions": [0, 1], "sigma_main": [1, 1] } }"#,
        &["estimator.control.positions", "cover the whole profile"],
    );
    let single = |version: &str, albedo: &str, sigma_samp: &str| {
        format!(
            r#"{{ "kind": "single_particle", "version": "{version}", "albedo": {albedo}, "sigma_samp": {sigma_samp} }}"#
        )
    };
    estimator_refused(&single("mortal", "0.5", "1"), &["estimator.version", "terminating"]);
    estimator_refused(&single("adaptive", "1.5", "1"), &["estimator.albedo", "from 0 to 1"]);
    estimator_refused(&single("terminating", "0.5", "0.5"), &["estimator.version", "r = ", "= 2 at s = "]);
}

#[test]
fn a_field_below_zero_is_no_field_for_woodcock() {
    let negative = r#"{ "kind": "constant", "sigma_t": -0.5, "length": 2 }"#;
    refused(
        &spec(negative, r#"{ "kind": "woodcock", "majorant": 1 }"#),
        &["estimator.majorant", "at least 0"],
    );
    let terminating =
        r#"{ "kind": "single_particle", "version": "terminating", "albedo": 0.5, "sigma_samp": 1 }"#;
    refused(&spec(negative, terminating), &["estimator.version", "r = "]);
}

#[test]
fn a_majorant_that_a_narrow_peak_refutes() {
    let peak =
        r#"{ "kind": "expression", "sigma_t": "0.1 + 5*max(0, 1 - abs(s - 1.2345)*1e4)", "length": 2 }"#;
    let woodcock = r#"{ "kind": "woodcock", "majorant": 0.5 }"#;
    refused(
        &spec(peak, woodcock).replace("100", "200000"),
        &["estimator.majorant", "0.5 is none", "s = 1.23"],
    );
}

#[test]
fn sweeps() {
    let sweep = |path: &str, values: &str| {
        spec(PROFILE, ESTIMATOR).replace(
            r#""seed": 1"#,
            &format!(r#""seed": 1, "sweep": {{ "path": "{path}", "values": {values} }}"#),
        )
    };
    refused(&sweep("estimator.sigma_samp", "[]"), &["sweep.values", "at least one"]);
    refused(&sweep("estimator.sigma_samp", "[1, -1]"), &["estimator.sigma_samp"]);
    refused(&sweep("samples", "[1]"), &["sweep.path"]);
    refused(&sweep("estimator.sigma_samp.deeper", "[1]"), &["sweep.path"]);
    refused(&sweep("estimator.unheard", "[1]"), &["estimator.unheard", "unknown key"]);
}

#[test]
fn command_lines() {
    for arguments in [
        &["estimate"][..],
        &["estimate", "-", "--samples", "0"],
        &["estimate", "-", "--seed", "-1"],
        &["estimate", "-", "--threads", "0"],
        &["unheard"],
        &["verify", "--estimator", "unheard"],
    ] {
        let outcome = harness(arguments, "");
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}: {}", outcome.stderr);
        assert!(!outcome.stderr.is_empty());
    }
    assert_eq!(harness(&["--help"], "").code, 0);
    assert_eq!(harness(&["list"], "").code, 0);
}

#[test]
fn a_slip_is_told_what_was_meant() {
    let on_linear = |estimator: &str| {
        format!(
            r#"{{ "profile": {{ "kind": "piecewise_linear", "positions": [0, 1], "sigma_t": [0, 1] }},
                  "estimator": {estimator}, "samples": 10, "seed": 1 }}"#
        )
    };
    for (estimator, meant) in [
        (r#"{ "kind": "double_particle", "sigma_samp": 1, "sigma_sampl": 1 }"#, "did you mean sigma_samp?"),
        (r#"{ "kind": "ratio_tracking", "sigma_samp": 1 }"#, "did you mean double_particle without control?"),
        (r#"{ "kind": "doubel_particle", "sigma_samp": 1 }"#, "did you mean double_particle?"),
        (r#"{ "kind": "delta_tracking", "majorant": 1 }"#, "did you mean woodcock?"),
    ] {
        let outcome = harness(&["estimate", "-"], &on_linear(estimator));
        assert_eq!(outcome.code, 2);
        assert!(outcome.stderr.contains(meant), "{}", outcome.stderr);
    }
}
