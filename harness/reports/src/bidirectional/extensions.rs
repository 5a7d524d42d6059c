//! A2: extensions of the path tracer at equal cost, where light is hard to find and where it comes from everywhere.

use super::{SCENES, equal_time};
use crate::compared::Compared;
use crate::measured::Measured;
use crate::run::Run;
use crate::scenes::UNIFORM_SKY;
use fairflight_document::{Cell, Claim, ClaimVerdict, Section, Table};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Samples per pixel of path tracing where nothing has measured it yet.
const SAMPLES: u32 = 512;

/// Extensions with their samples per pixel: of about the time of path tracing.
fn methods() -> [(&'static str, Value, u32); 4] {
    let path_tracer = |key: &str, value: Value| json!({ "kind": "path_tracer", key: value });
    let guided = json!({ "kind": "guided", "photons": 5000, "nearest": 16, "cells": 32, "own_share": 0.5 });
    let resampled = json!({ "kind": "resampled", "candidates": 4 });
    [
        ("guided directions", path_tracer("extension", guided), 48),
        ("resampled directions", path_tracer("extension", resampled), 128),
        ("resampled light points", path_tracer("light_candidates", json!(4)), 256),
        ("path re-use", path_tracer("reuse", json!({ "tile": 4, "spacing": 1 })), 160),
    ]
}

/// A scene that is left out: nearly all of its variance is in paths that few images meet, and what misses them looks good.
const LEFT_OUT: &str = "volume-caustic";

/// Measurements of these scenes and of the uniform sky, with the reference and the path tracing of that.
pub(super) fn steps() -> u64 {
    let lit = SCENES.iter().filter(|scene| scene.id != LEFT_OUT).count();
    (methods().len() * (lit + 1) + 2) as u64
}

/// One extension in one scene.
pub(super) struct Extended {
    scene: &'static str,
    name: &'static str,
    /// 1/(MSE · CPU s) over that of path tracing.
    gain: Measured,
    /// Variance of a sample over that of path tracing.
    variance: Measured,
    /// CPU time of a sample over that of a path.
    price: f64,
    /// Samples per pixel.
    samples: u32,
    z: f64,
}

pub(super) fn study(run: &Run<'_>, compared: &[Compared]) -> Result<Vec<Extended>, Failure> {
    let seed = |scene: &str, name: &str| run.seed(format_args!("extensions/{scene}/{name}"));
    let exact = equal_time::exact(run, &UNIFORM_SKY)?;
    let plain = (run.samples(SAMPLES), seed(UNIFORM_SKY.id, "path tracing"));
    let plain = exact.entry(run, ("path tracing", json!({ "kind": "path_tracer" })), plain)?;
    let lit = compared.iter().filter(|scene| scene.scene.id != LEFT_OUT);
    let lit = lit.map(|scene| (scene.scene.id, &scene.exact, &scene.entries[0]));
    let mut rows = Vec::new();
    for (scene, exact, plain) in lit.chain([(UNIFORM_SKY.id, &exact, &plain)]) {
        for (name, integrator, samples) in methods() {
            let entry = exact.entry(run, (name, integrator), (run.samples(samples), seed(scene, name)))?;
            let gain = plain.cost.over(&entry.cost);
            let price = entry.seconds / plain.seconds;
            let variance = gain.map(|gain| 1.0 / (gain * price));
            rows.push(Extended {
                scene,
                name,
                gain,
                variance,
                price,
                samples: entry.images.rays_per_pixel(),
                z: entry.z,
            });
        }
    }
    Ok(rows)
}

pub(super) fn section(rows: &[Extended]) -> Section {
    let text = format!(
        "Scenes, errors, intervals and references as above, without {LEFT_OUT}, nearly all of whose variance is in paths that few images meet; the last is {}: directions differ in nothing there but by surfaces and the ends of the medium. \
         CPU times hold the tracing of photons. Variance: mean squared error of one sample.",
        UNIFORM_SKY.words
    );
    let table = Table::of(
        ["extensions-table", "Extensions of the path tracer, over the path tracer", ""],
        rows,
        &[
            ("scene", "", &|row| Cell::text(row.scene)),
            ("extension", "", &|row| Cell::text(row.name)),
            ("samples per pixel", "1", &|row| Cell::Count(row.samples.into())),
            ("variance of a sample", "1", &|row| row.variance.cell()),
            ("CPU time of a sample", "1", &|row| Cell::Number(row.price)),
            ("gain", "1", &|row| row.gain.cell()),
            ("z of the mean", "1", &|row| Cell::Number(row.z)),
        ],
    );
    Section::new("extensions", "A2: extensions of the path tracer at equal cost").with(text).with(table)
}

/// A2: the extensions pay where the survey says so.
///
/// Criterion: each has a gain above 1 in a scene lit by a lamp, by 95 % intervals.
pub(super) fn a2(rows: &[Extended]) -> Claim {
    let (mut verdicts, mut words) = (Vec::new(), Vec::new());
    for (name, ..) in methods() {
        let (even, lit): (Vec<&Extended>, Vec<&Extended>) =
            rows.iter().filter(|row| row.name == name).partition(|row| row.scene == UNIFORM_SKY.id);
        let exceeds = |row: &&Extended| row.gain.exceeds(1.0) == Some(true);
        verdicts.push(lit.iter().any(exceeds));
        let best = lit.iter().max_by(|a, b| a.gain.interval[0].total_cmp(&b.gain.interval[0]));
        let told = best.into_iter().chain(&even).map(|row| {
            format!("{} in {} (variance {})", row.gain.words(2), row.scene, row.variance.words(2))
        });
        words.push(format!("{name}: {}", told.collect::<Vec<_>>().join(", ")));
    }
    Claim::new(
        ("A2", "antwerpen-2011 4.5-4.7"),
        "Guided directions, resampled directions and light points, and path re-use lower the variance at equal cost",
        words.join("; "),
        (
            ClaimVerdict::of_cases(verdicts),
            "Gains of the best scene, and under the uniform sky. The survey counts paths: variances of one sample fall more often than those of one second.",
        ),
    )
}
