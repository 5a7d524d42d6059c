//! The strategies: the share of light that each finds, its variance, and what it sees.

use super::side;
use crate::compared::Compared;
use crate::run::Run;
use crate::scenes::{FIXTURE, Scene};
use fairflight_document::{Cell, Gallery, Picture, Section, Table};
use fairflight_harness::Failure;
use fairflight_harness::render::StrategyShare;
use serde_json::json;

/// The scene of the triangle: no smooth surface is in it, so that every strategy finds light of every length.
const SHOWN: Scene = FIXTURE;
/// Edges of the longest paths whose strategies are shown.
const LONGEST: u32 = 4;
/// Strategies of paths of 2 to [`LONGEST`] edges, weighted and alone.
pub(super) const STEPS: u64 = 2 * (3 + 4 + 5);
const SAMPLES: u32 = 64;

/// Rows of pictures with their labels.
type Rows = Vec<(String, Vec<Picture>)>;

/// The triangle of strategies of one scene: two rows for each length of paths, with the same variates.
pub(super) fn study(run: &Run<'_>) -> Result<Rows, Failure> {
    let subject = SHOWN.subject(side(run))?;
    let mut rows = Vec::new();
    for edges in 2..=LONGEST {
        for (id, words, weighted) in [("strategy", "weighted", true), ("alone", "each alone", false)] {
            let mut pictures = Vec::new();
            for t in 1..=edges + 1 {
                let s = edges + 1 - t;
                let one = json!({ "kind": "bidirectional", "strategies": [[s, t]], "weighted": weighted });
                let (samples, seed) = (run.samples(SAMPLES), run.seed(format_args!("strategies/{s}/{t}")));
                let images = subject.with("integrator", one).measure(samples, (seed, 2), &run.media)?;
                let variance = images.squared_error().value * f64::from(samples);
                let mean = images.mean_of_images().0;
                let lines = vec![format!("mean {mean:.2e}"), format!("variance {variance:.1e}")];
                let label = format!("s = {s}, t = {t}");
                pictures.push(images.picture(format!("{id}-{s}-{t}"), label, lines, 4.0 * SHOWN.exposure));
                run.advance();
            }
            rows.push((format!("{edges} edges, {words}"), pictures));
        }
    }
    Ok(rows)
}

/// Light by strategy, as bidirectional path tracing found it.
fn strategies(scene: &Compared) -> Vec<StrategyShare> {
    scene.exact.images.first().strategies()
}

pub(super) fn section(compared: &[Compared], triangle: Rows) -> Section {
    let title = format!("Light by strategy in {}, two stops brighter", SHOWN.id);
    let section = Section::new("strategies", "Strategies and what they find")
        .with(
            "Contributions of s vertices from a light and t from the camera: weighted, and divided by their weights, as each strategy finds light alone. \
             The sum over a weighted row is all light of paths of that length; a strategy alone has the mean of that sum, where it can make all such \
             paths, and its own noise. What is bright and rare alone weighs little. Variances are those of one sample of a pixel, averaged over \
             pixels: of these samples, since one connection in the medium alone has none (1/r²). The table lists strategies with a share of at least 0.1 %."
                .to_owned(),
        )
        .with(Gallery::of_images("strategies-images", &title, triangle));
    let rows: Vec<(&str, StrategyShare)> = compared
        .iter()
        .flat_map(|scene| strategies(scene).into_iter().map(move |told| (scene.scene.id, told)))
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
