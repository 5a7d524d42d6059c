//! Independent samples and chains at equal time.

use crate::compared::{Compared, Entry, Exact, Method, POINTS, REPLICAS};
use crate::run::Run;
use crate::scenes::{BULB, DOOR, MIRROR_ROOM, Scene, VOLUME_CAUSTIC};
use fairflight_document::{Block, Cell, Gallery, Section, Table};
use fairflight_harness::Failure;
use serde_json::json;

/// Scenes, with the place of the method that the reference is made by, in streams of its own, and its samples per pixel.
const SCENES: [(Scene, usize, u32); 4] = [
    (MIRROR_ROOM, PATH_SPACE, 1024),
    (DOOR, BIDIRECTIONAL, 256),
    (VOLUME_CAUSTIC, PATH_SPACE, 1024),
    (BULB, BIDIRECTIONAL, 256),
];
/// A scene that is shown and not judged: nearly all of its variance is in paths that few images meet, and what misses them looks good.
const NOT_JUDGED: &str = "volume-caustic";
/// Images of a reference.
const REFERENCES: u32 = 4;
pub(super) const STEPS: u64 = (SCENES.len() * (1 + METHODS * POINTS as usize)) as u64;

/// Number of methods, and places of some among [`methods`].
const METHODS: usize = 6;
pub(super) const PATH_TRACING: usize = 0;
pub(super) const BIDIRECTIONAL: usize = 1;
pub(super) const PRIMARY: usize = 2;
pub(super) const PATH_SPACE: usize = 4;

/// Methods of which an image takes about one time: independent samples, and chains.
pub(super) fn methods() -> [Method; METHODS] {
    // Images are replicas of each other: none within one.
    let chains =
        |over: &str| json!({ "kind": "metropolis", "space": "primary", "over": over, "replicas": 1 });
    let path = |kind: &str| json!({ "kind": kind, "space": "path", "replicas": 1 });
    let mut redistribution = path("energy_redistribution");
    redistribution["chain_length"] = json!(30);
    [
        ("path tracing", json!({ "kind": "path_tracer" }), 192),
        ("bidirectional", json!({ "kind": "bidirectional" }), 48),
        ("primary space", chains("bidirectional"), 32),
        ("multiplexed", chains("multiplexed"), 48),
        ("path space", path("metropolis"), 160),
        ("energy redistribution", redistribution, 4),
    ]
}

/// Columns and rows of the images.
pub(super) fn side(run: &Run<'_>) -> u32 {
    run.quick_or(24, 96)
}

pub(super) fn study(run: &Run<'_>) -> Result<Vec<Compared>, Failure> {
    let one = |(scene, reference, samples): &'static (Scene, usize, u32)| {
        let seed = run.seed(format_args!("{}/reference", scene.id));
        let mut long = methods()[*reference].1.clone();
        // Its own error is told by replicas within an image.
        long.as_object_mut().map(|keys| keys.remove("replicas"));
        let exact = Exact::of(run, scene.subject(side(run))?, (long, *samples), (seed, REFERENCES))?;
        Compared::study(run, scene, exact, methods())
    };
    SCENES.iter().map(one).collect()
}

/// Scenes that these images can judge.
pub(super) fn judged(compared: &[Compared]) -> impl Iterator<Item = &Compared> {
    compared.iter().filter(|scene| scene.scene.id != NOT_JUDGED)
}

/// Chains that are better than both parents at equal time, by 95 % intervals.
pub(super) fn better(scene: &Compared) -> Vec<&'static str> {
    let is_better = |&k: &usize| {
        [PATH_TRACING, BIDIRECTIONAL].iter().all(|&other| scene.gain(k, other).exceeds(1.0) == Some(true))
    };
    (PRIMARY..METHODS).filter(is_better).map(|k| scene.entries[k].name).collect()
}

/// Aims of chains, and whether they are met: factors by which the variance of a sample lies below that of bidirectional path tracing, and scenes on
/// which chains are better than both parents at equal time.
fn aims(compared: &[Compared]) -> Vec<(String, String)> {
    let verdict = |met: Option<bool>| match met {
        Some(true) => "met",
        Some(false) => "missed",
        None => "these images cannot tell",
    };
    let variance = |id: &str, aim: f64| {
        let scene = compared.iter().find(|scene| scene.scene.id == id)?;
        let [one, other] = [BIDIRECTIONAL, PRIMARY].map(|k| scene.entries[k].variance);
        let factor = one.over(&other);
        Some((
            format!("{id}: variance of a sample of primary space at least {aim} times below bidirectional"),
            format!("{}: {}", factor.words(1), verdict(factor.exceeds(aim))),
        ))
    };
    let ahead: Vec<String> = judged(compared)
        .filter(|scene| !better(scene).is_empty())
        .map(|scene| format!("{} ({})", scene.scene.id, better(scene).join(", ")))
        .collect();
    let on_scenes = (
        "better than path tracing and than bidirectional at equal CPU time on at least two scenes".to_owned(),
        format!("on {}: {}: {}", ahead.len(), ahead.join("; "), verdict(Some(ahead.len() >= 2))),
    );
    variance("mirror-room", 5.0).into_iter().chain(variance("door", 1.5)).chain([on_scenes]).collect()
}

pub(super) fn section(run: &Run<'_>, compared: &[Compared]) -> Section {
    let side = side(run);
    let text = format!(
        "Scenes of harness/scenes in gray, {side} x {side} pixels; chains in one replica for each image, energy redistribution in path space with \
         chains of 30 steps. Errors are against a reference, whose own error is taken off: sample variances mislead where bright paths are rare. It is made of \
         {REFERENCES} images by streams of their own: on mirror-room and volume-caustic by chains in path space, which alone get there in the time, on door and bulb by \
         bidirectional path tracing; z tells how far the mean of each method is from it. A sample of a chain is a step; the independent samples that choose \
         its start (a tenth more) are in the times. Intervals are 95 %, from {REPLICAS} independent images. Efficiency: 1/(MSE · CPU s). \
         Where a mode is rarer than a chain is long, most images miss it and look the same, and few are far off: then {REPLICAS} images tell neither error nor interval. So it \
         is on {NOT_JUDGED}, where the caustic is seen through the ball: errors there are shown, and no method is judged by them."
    );
    let all: Vec<(&Compared, &Entry)> =
        compared.iter().flat_map(|scene| scene.entries.iter().map(move |entry| (scene, entry))).collect();
    let over =
        |scene: &Compared, entry: &Entry, other: usize| scene.entries[other].cost.over(&entry.cost).cell();
    let table = Table::of(
        ["equal-time-table", "Methods at equal time", ""],
        &all,
        &[
            ("scene", "", &|(scene, _)| Cell::text(scene.scene.id)),
            ("method", "", &|(_, entry)| Cell::text(entry.name)),
            ("samples per pixel", "1", &|(_, entry)| Cell::Count(entry.images.rays_per_pixel().into())),
            ("CPU time of an image", "s", &|(_, entry)| Cell::Number(entry.images.seconds())),
            ("CPU time of a sample", "µs", &|(_, entry)| Cell::Number(1e6 * entry.seconds)),
            ("RMSE", "radiance", &|(_, entry)| entry.rmse.cell()),
            ("variance of bidirectional over its", "1", &|(scene, entry)| {
                scene.entries[BIDIRECTIONAL].variance.over(&entry.variance).cell()
            }),
            ("efficiency over path tracing", "1", &|(scene, entry)| over(scene, entry, PATH_TRACING)),
            ("efficiency over bidirectional", "1", &|(scene, entry)| over(scene, entry, BIDIRECTIONAL)),
            ("z of the mean", "1", &|(_, entry)| Cell::Number(entry.z)),
        ],
    );
    let references = SCENES.iter().zip(compared).map(|((_, reference, _), scene)| {
        scene.row(&format!("{}, RMSE {:.4}", methods()[*reference].0, scene.exact.rmse()), METHODS)
    });
    let gallery =
        Gallery::of_images("equal-time-images", "Images at roughly equal time", references.collect());
    Section::new("equal-time", "Chains and independent samples at equal time")
        .with(text)
        .with(Block::Facts(aims(compared)))
        .with_all(compared.iter().map(|scene| scene.chart.clone()))
        .with(table)
        .with(gallery)
}
