//! The strategies: the share of light that each finds, its variance, and what it sees.

use super::equal_time::Compared;
use super::scenes::SCENES;
use crate::run::Run;
use fairflight_document::{Cell, Gallery, Picture, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::render::StrategyShare;
use serde_json::json;

/// Edges of the longest paths whose strategies are shown.
const LONGEST: u32 = 4;
/// Strategies of paths of 2 to [`LONGEST`] edges.
pub(super) const STEPS: u64 = 3 + 4 + 5;
const SAMPLES: u32 = 64;

/// The triangle of strategies of the first scene, a row for each length of paths.
pub(super) fn study(run: &Run<'_>) -> Result<Vec<(String, Vec<Picture>)>, Failure> {
    let scene = &SCENES[0];
    let subject = scene.subject(run)?;
    let mut rows = Vec::new();
    for edges in 2..=LONGEST {
        let mut pictures = Vec::new();
        for t in 1..=edges + 1 {
            let s = edges + 1 - t;
            let subject =
                subject.with("integrator", json!({ "kind": "bidirectional", "strategies": [[s, t]] }));
            let seed = run.seed(format_args!("strategies/{s}/{t}"));
            let images = subject.measure(run.samples(SAMPLES), (seed, 2), &run.media)?;
            let (mean, _) = images.mean_of_images();
            let lines = vec![format!("mean {mean:.2e}")];
            pictures.push(images.picture(
                format!("strategy-{s}-{t}"),
                format!("s = {s}, t = {t}"),
                lines,
                4.0 * scene.exposure,
            ));
            run.advance();
        }
        rows.push((format!("{edges} edges"), pictures));
    }
    Ok(rows)
}

pub(super) fn section(compared: &[Compared], triangle: Vec<(String, Vec<Picture>)>) -> Section {
    let title = format!("Light by strategy in {}, weighted, two stops brighter", SCENES[0].id);
    let section = Section::new("strategies", "Strategies and what they find")
        .with(
            "Weighted contributions of s vertices from a light and t from the camera. The sum over a row of pictures is all light of paths of that \
             length. Variances are those of one sample of a pixel, averaged over pixels; only strategies with a share of at least 0.1 % are listed."
                .to_owned(),
        )
        .with(Gallery::of_images("strategies-images", &title, triangle));
    let rows: Vec<(&str, StrategyShare)> = compared
        .iter()
        .flat_map(|scene| scene.strategies().into_iter().map(move |told| (scene.scene.id, told)))
        .filter(|(_, told)| told.share.abs() >= 1e-3)
        .collect();
    let count =
        |vertices: Option<u32>| vertices.map_or_else(|| Cell::text("more"), |n| Cell::Count(n.into()));
    section.with(Table::of(
        ["strategies-table", "Shares and variances", ""],
        &rows,
        &[
            ("scene", "", &|(id, _)| Cell::text(*id)),
            ("s", "1", &|(_, told)| count(told.s)),
            ("t", "1", &|(_, told)| count(told.t)),
            ("share of the light", "1", &|(_, told)| Cell::Number(told.share)),
            ("variance of a sample", "radiance²", &|(_, told)| Cell::maybe(told.variance)),
        ],
    ))
}
