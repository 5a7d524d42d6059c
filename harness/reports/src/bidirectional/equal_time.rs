//! Bidirectional path tracing and path tracing at equal time, in each scene.

use super::scenes::Scene;
use crate::measured::Measured;
use crate::replicas::{Replicas, Subject};
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Gallery, Picture, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::render::StrategyShare;
use serde_json::{Value, json};

/// Independent images per measurement.
const REPLICAS: u32 = 8;
/// Those of a reference, and its samples per pixel.
const REFERENCES: u32 = 4;
const REFERENCE: u32 = 800;
/// The points of a curve have so many times the samples of the one before.
const STEP: u32 = 4;
const POINTS: u32 = 3;
/// Measurements of a scene: its reference, and the points of all methods.
pub(super) const STEPS: u64 = 1 + 4 * POINTS as u64;

/// A method, and the samples per pixel of its longest image: of about one time.
fn methods() -> [(&'static str, Value, u32); 4] {
    [
        ("path tracing", json!({ "kind": "path_tracer" }), 512),
        ("bidirectional", json!({ "kind": "bidirectional" }), 96),
        ("τ neglected in weights", json!({ "kind": "bidirectional", "thickness": "neglected" }), 96),
        ("no light image", json!({ "kind": "bidirectional", "light_image": false }), 96),
    ]
}

/// The image of a scene that all others are judged by.
pub(super) struct Exact {
    subject: Subject,
    images: Replicas,
    pixels: Vec<f64>,
    /// Its own, of a pixel on average.
    squared_error: f64,
}

impl Exact {
    pub(super) fn of(run: &Run<'_>, scene: &Scene) -> Result<Self, Failure> {
        let subject = scene.subject(run)?;
        let seed = run.seed(format_args!("{}/reference", scene.id));
        let long = subject.with("integrator", json!({ "kind": "bidirectional" }));
        let images = long.measure(run.samples(REFERENCE), (seed, REFERENCES), &run.media)?;
        run.advance();
        let (pixels, squared_error) = images.mean();
        Ok(Self { subject, images, pixels, squared_error })
    }

    /// Images of a method, of so many samples per pixel.
    pub(super) fn entry(
        &self,
        run: &Run<'_>,
        (name, integrator): (&'static str, Value),
        (samples, seed): (u32, u64),
    ) -> Result<Entry, Failure> {
        let images =
            self.subject.with("integrator", integrator).measure(samples, (seed, REPLICAS), &run.media)?;
        run.advance();
        let squares = images.squared_difference(&self.pixels, self.squared_error);
        let (seconds, rays) = (images.seconds(), f64::from(samples) * self.pixels.len() as f64);
        let [(mean, error), (exact, its_error)] = [&images, &self.images].map(Replicas::mean_of_images);
        Ok(Entry {
            name,
            rmse: squares.map(|square| square.max(0.0).sqrt()),
            cost: squares.map(|square| square * seconds),
            seconds: seconds / rays,
            z: (mean - exact) / error.hypot(its_error),
            images,
        })
    }
}

/// One method in one scene.
pub(super) struct Entry {
    pub(super) name: &'static str,
    rmse: Measured,
    /// MSE · CPU seconds \[radiance² s\].
    pub(super) cost: Measured,
    /// CPU seconds of one sample of a pixel.
    pub(super) seconds: f64,
    pub(super) z: f64,
    pub(super) images: Replicas,
}

/// Measurements of one scene: error and CPU time of each method.
pub(super) struct Compared {
    pub(super) scene: &'static Scene,
    pub(super) entries: Vec<Entry>,
    pub(super) exact: Exact,
    chart: Chart,
}

pub(super) fn study(run: &Run<'_>, scene: &'static Scene) -> Result<Compared, Failure> {
    let exact = Exact::of(run, scene)?;
    let (mut entries, mut curves) = (Vec::new(), Vec::new());
    for (name, integrator, samples) in methods() {
        let mut points = Vec::new();
        for point in 0..POINTS {
            let part = STEP.pow(POINTS - 1 - point);
            let samples = (run.samples(samples) / part).max(2);
            let seed = run.seed(format_args!("{}/{name}/samples over {part}", scene.id));
            points.push(exact.entry(run, (name, integrator.clone()), (samples, seed))?);
        }
        curves.push(Curve::joined(name, points.iter().map(|entry| entry.rmse.mark(entry.images.seconds()))));
        entries.extend(points.pop());
    }
    let (x, y) = (Axis::logarithmic("CPU seconds of an image [s]"), Axis::logarithmic("RMSE [radiance]"));
    let title = format!("Error over time: {}", scene.words);
    let chart = Chart::new(&format!("{}-time", scene.id), &title, x, y).with_curves(curves);
    Ok(Compared { scene, entries, chart, exact })
}

impl Compared {
    /// The efficiency, 1/(MSE · CPU seconds), of the second method over that of path tracing.
    pub(super) fn gain(&self) -> Measured {
        self.entries[0].cost.over(&self.entries[1].cost)
    }

    /// CPU time of a bidirectional sample over that of a path.
    pub(super) fn price(&self) -> f64 {
        self.entries[1].seconds / self.entries[0].seconds
    }

    /// Light by strategy, as bidirectional path tracing found it.
    pub(super) fn strategies(&self) -> Vec<StrategyShare> {
        self.exact.images.first().strategies()
    }

    /// Methods whose mean is too far from that of the reference. Those without a light image may lack what is bright and rare.
    pub(super) fn unsound(&self) -> Vec<String> {
        // Of so few images the scatter has heavy tails: t of 7 degrees of freedom at 1e-6.
        let far = self.entries[1..3].iter().filter(|entry| entry.z.abs() > 14.0);
        far.map(|entry| format!("{} in {}: z = {:.1}", entry.name, self.scene.id, entry.z)).collect()
    }

    /// Its images.
    pub(super) fn row(&self) -> (String, Vec<Picture>) {
        let Scene { id, words, exposure, .. } = self.scene;
        let shown = |images: &Replicas, part: &str, label: &str, lines: Vec<String>| {
            images.picture(format!("{id}-{part}"), label, lines, *exposure)
        };
        let exact = shown(&self.exact.images, "reference", "reference", vec!["bidirectional".to_owned()]);
        let others = self.entries.iter().take(2).enumerate().map(|(k, entry)| {
            let lines = vec![
                format!("RMSE {:.4}", entry.rmse.value),
                format!("{} samples", entry.images.rays_per_pixel()),
                format!("{:.1} CPU s", entry.images.seconds()),
            ];
            shown(&entry.images, &k.to_string(), entry.name, lines)
        });
        ((*words).to_owned(), [exact].into_iter().chain(others).collect())
    }
}

pub(super) fn section(run: &Run<'_>, compared: &[Compared], rows: Vec<(String, Vec<Picture>)>) -> Section {
    let text = format!(
        "Scenes of harness/scenes in gray, {side} x {side} pixels. Errors are against a bidirectional reference of {samples} samples per \
         pixel, whose own error is taken off: the sample variance of a path tracer tells too little where bright paths are rare. Intervals \
         are 95 %, from {REPLICAS} independent images. Gain: 1/(MSE · CPU s) over that of path tracing.",
        side = run.quick_or(12, 32),
        samples = run.samples(REFERENCE) * REFERENCES,
    );
    let all: Vec<(&Compared, &Entry)> =
        compared.iter().flat_map(|scene| scene.entries.iter().map(move |entry| (scene, entry))).collect();
    let table = Table::of(
        ["equal-time-table", "Methods at equal time", ""],
        &all,
        &[
            ("scene", "", &|(scene, _)| Cell::text(scene.scene.id)),
            ("method", "", &|(_, entry)| Cell::text(entry.name)),
            ("samples per pixel", "1", &|(_, entry)| Cell::Count(entry.images.rays_per_pixel().into())),
            ("RMSE", "radiance", &|(_, entry)| entry.rmse.cell()),
            ("CPU time of a sample", "µs", &|(_, entry)| Cell::Number(1e6 * entry.seconds)),
            ("gain", "1", &|(scene, entry)| scene.entries[0].cost.over(&entry.cost).cell()),
            ("z of the mean", "1", &|(_, entry)| Cell::Number(entry.z)),
        ],
    );
    let section = Section::new("equal-time", "L1: indirect light at equal time").with(text);
    compared
        .iter()
        .fold(section, |section, scene| section.with(scene.chart.clone()))
        .with(table)
        .with(Gallery::of_images("equal-time-images", "Images at roughly equal time", rows))
}
