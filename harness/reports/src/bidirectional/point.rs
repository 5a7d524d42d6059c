//! A point light in a medium: a second moment that only weighted connections have.

use crate::measured::Measured;
use crate::replicas::Subject;
use crate::run::Run;
use crate::scenes::POINT;
use fairflight_document::{Axis, Chart, Curve, Section};
use fairflight_harness::Failure;
use serde_json::json;

/// Independent images per measurement.
const REPLICAS: u32 = 6;
/// Columns and rows.
const SIDE: u32 = 8;
const POINTS: u32 = 3;
/// Measurements.
pub(super) const STEPS: u64 = 2 * POINTS as u64;

/// The variances of both methods by the number of samples.
pub(super) struct Point {
    /// Path tracing, and bidirectional path tracing, least N first.
    pub(super) variances: [Vec<Measured>; 2],
    pub(super) section: Section,
}

impl Point {
    /// The variance at ten times the samples over that at the others, at the greatest numbers, by method.
    pub(super) fn growth(&self) -> [Measured; 2] {
        let last = POINTS as usize - 1;
        self.variances.each_ref().map(|variances| variances[last].over(&variances[last - 1]))
    }
}

pub(super) fn study(run: &Run<'_>) -> Result<Point, Failure> {
    let subject = Subject::gray(POINT, [SIDE; 2])?;
    let methods = [
        ("path tracing", json!({ "kind": "path_tracer" })),
        ("bidirectional", json!({ "kind": "bidirectional" })),
    ];
    let (mut variances, mut curves) = ([Vec::new(), Vec::new()], Vec::new());
    for ((name, integrator), variances) in methods.into_iter().zip(&mut variances) {
        let subject = subject.with("integrator", integrator);
        let mut marks = Vec::new();
        for point in 0..POINTS {
            let samples = run.quick_or(10, 150) * 10_u32.pow(point);
            let seed = run.seed(format_args!("point/{name}/{point}"));
            let images = subject.measure(samples, (seed, REPLICAS), &run.media)?;
            let variance = images.squared_error().map(|error| error * f64::from(samples));
            marks.push(variance.mark(f64::from(samples * SIDE * SIDE)));
            variances.push(variance);
            run.advance();
        }
        curves.push(Curve::joined(name, marks));
    }
    let chart = Chart::new(
        "point-variance",
        "Sample variance over the number of samples",
        Axis::logarithmic("samples of an image [1]"),
        Axis::logarithmic("variance of a sample [radiance²]"),
    )
    .with_caption("A variance that grows with the number of samples does not exist.")
    .with_curves(curves);
    let text = format!(
        "harness/scenes/point-in-haze.json, {SIDE} x {SIDE} pixels. A connection of a vertex in the medium with a point light is Φ f/(4π r²), whose square \
         is not integrable. By the balance heuristic a contribution is f/Σ p, and each density has the factors 1/r² of all edges but its \
         own: bounded. Intervals are 95 %, from {REPLICAS} independent images."
    );
    let section =
        Section::new("point", "A point light in a medium has a second moment for weighted connections only")
            .with(text)
            .with(chart);
    Ok(Point { variances, section })
}
