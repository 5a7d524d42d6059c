//! Bidirectional path tracing and path tracing at equal time, in each scene.

use super::{SCENES, side};
use crate::compared::{Compared, Entry, Exact, Method, POINTS, REPLICAS};
use crate::run::Run;
use crate::scenes::Scene;
use fairflight_document::{Cell, Gallery, Section, Table};
use fairflight_harness::Failure;
use serde_json::json;

/// Images of a reference, and its samples per pixel.
const REFERENCES: u32 = 4;
const REFERENCE: u32 = 800;
/// Measurements: of each scene its reference, and the points of all methods.
pub(super) const STEPS: u64 = SCENES.len() as u64 * (1 + 4 * POINTS as u64);

/// Methods of which an image takes about one time.
fn methods() -> [Method; 4] {
    [
        ("path tracing", json!({ "kind": "path_tracer" }), 512),
        ("bidirectional", json!({ "kind": "bidirectional" }), 96),
        ("τ neglected in weights", json!({ "kind": "bidirectional", "thickness": "neglected" }), 96),
        ("no light image", json!({ "kind": "bidirectional", "light_image": false }), 96),
    ]
}

/// The reference of a scene.
pub(super) fn exact(run: &Run<'_>, scene: &Scene) -> Result<Exact, Failure> {
    let seed = run.seed(format_args!("{}/reference", scene.id));
    let long = (json!({ "kind": "bidirectional" }), REFERENCE);
    Exact::of(run, scene.subject(side(run))?, long, (seed, REFERENCES))
}

pub(super) fn study(run: &Run<'_>, scene: &'static Scene) -> Result<Compared, Failure> {
    Compared::study(run, scene, exact(run, scene)?, methods())
}

/// Methods whose mean is too far from that of the reference. Those without a light image may lack what is bright and rare.
pub(super) fn unsound(compared: &Compared) -> Vec<String> {
    compared.unsound(1..3)
}

pub(super) fn section(run: &Run<'_>, compared: &[Compared]) -> Section {
    let text = format!(
        "Scenes of harness/scenes in gray, {side} x {side} pixels. Errors are against a bidirectional reference of {samples} samples per \
         pixel, whose own error is taken off: the sample variance of a path tracer tells too little where bright paths are rare. Intervals \
         are 95 %, from {REPLICAS} independent images. Gain: 1/(MSE · CPU s) over that of path tracing.",
        side = side(run),
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
    let rows = compared.iter().map(|scene| scene.row("bidirectional", 2)).collect();
    let section = Section::new("equal-time", "L1: indirect light at equal time").with(text);
    section.with_all(compared.iter().map(|scene| scene.chart.clone())).with(table).with(Gallery::of_images(
        "equal-time-images",
        "Images at roughly equal time",
        rows,
    ))
}
