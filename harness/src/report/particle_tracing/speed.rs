//! Speed against error: all integrators of multiple scattering on one scene.

use super::{REPLICAS, Run, scenes};
use crate::Failure;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::replicas::Measured;
use serde_json::{Value, json};

/// Rays per pixel of the points of a curve.
const RAYS: [u32; 4] = [2, 8, 32, 128];

/// An integrator with its name.
fn integrators() -> Vec<(&'static str, Value)> {
    let tracer = |version: &str, sigma_samp: Value| json!({ "kind": "particle_tracer", "version": version, "sigma_samp": sigma_samp });
    let splitting = |starts: &str| {
        json!({ "kind": "line_splitting", "splits": 4, "majorant": 1.0, "starts": starts,
                                           "version": "adaptive", "sigma_samp": 1.0 })
    };
    vec![
        ("adaptive, σ_samp 0.8", tracer("adaptive", json!(0.8))),
        ("adaptive, σ_samp 1", tracer("adaptive", json!(1.0))),
        ("non-terminating, σ_samp 2", tracer("non_terminating", json!(2.0))),
        ("terminating, σ_samp 1", tracer("terminating", json!(1.0))),
        (
            "adaptive, grid",
            tracer("adaptive", json!({ "cells": [40, 40, 40], "factor": 1.0, "floor": 0.05 })),
        ),
        ("splitting 4, equidistant", splitting("equidistant")),
        ("splitting 4, independent", splitting("independent")),
    ]
}

pub(super) fn steps() -> u64 {
    (integrators().len() * RAYS.len()) as u64
}

/// One integrator at its largest number of rays.
pub(super) struct Fastest {
    pub(super) name: &'static str,
    /// 1/(MSE · CPU seconds).
    pub(super) per_second: Measured,
    pub(super) per_lookup: Measured,
}

pub(super) struct Speed {
    pub(super) section: Section,
    pub(super) integrators: Vec<Fastest>,
}

pub(super) fn study(run: &Run<'_>) -> Result<Speed, Failure> {
    let subject = scenes::evenly_lit(run.resolution());
    let (mut by_lookups, mut by_seconds, mut fastest) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (name, integrator)) in integrators().into_iter().enumerate() {
        let subject = subject.with("integrator", integrator);
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        let mut last = None;
        for (k, &rays) in RAYS.iter().enumerate() {
            let seed = run.seed(30 + i as u64, k as u64);
            let image = subject.measure(run.samples(rays), (seed, REPLICAS), &run.library)?;
            let error = image.squared_error();
            let rmse = error.map(f64::sqrt);
            lookups.push(Mark::measured(image.lookups_per_pixel(), rmse.value, rmse.interval));
            seconds.push(Mark::measured(image.seconds(), rmse.value, rmse.interval));
            let (cost, per_pixel) = (image.seconds(), image.lookups_per_pixel());
            last = Some(Fastest {
                name,
                per_second: error.map(|error| 1.0 / (error * cost)),
                per_lookup: error.map(|error| 1.0 / (error * per_pixel)),
            });
            run.progress.advance();
        }
        fastest.extend(last);
        let curve = |marks: Vec<Mark>| {
            let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
            Curve::method(name).with_line(line).with_marks(marks)
        };
        by_lookups.push(curve(lookups));
        by_seconds.push(curve(seconds));
    }
    let mut section = Section::new("speed", "Speed against error");
    section.text = vec![
        "The scene of fig. 6 in an even environment, by every integrator of multiple scattering. Seconds are CPU seconds over all threads, \
         look-ups counted; the figures of the table are those of the largest number of rays."
            .to_owned(),
    ];
    let chart = |id: &str, title: &str, x: &str, curves: Vec<Curve>| {
        let mut chart = Chart::new(id, title, Axis::logarithmic(x), Axis::logarithmic("RMSE [radiance]"));
        chart.curves = curves;
        chart
    };
    section.charts = vec![
        chart("speed-lookups", "Error against look-ups", "look-ups per pixel [1]", by_lookups),
        chart("speed-seconds", "Error against time", "CPU seconds of an image [s]", by_seconds),
    ];
    let mut table = Table::new(
        "speed-table",
        "Efficiency",
        "Per CPU second: on two cores an image takes half of that time.",
        &[
            ("integrator", ""),
            ("1/(MSE · CPU s)", "1/(radiance² s)"),
            ("1/(MSE · look-ups per pixel)", "1/radiance²"),
        ],
    );
    for row in &fastest {
        table.rows.push(vec![
            Cell::text(row.name),
            Cell::measured(row.per_second.value, row.per_second.interval),
            Cell::measured(row.per_lookup.value, row.per_lookup.interval),
        ]);
    }
    section.tables = vec![table];
    Ok(Speed { section, integrators: fastest })
}
