//! Chains that learn from others: where an image is noisy, and how far to step.

use crate::compared::{Compared, Entry, REPLICAS};
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Panel, Section, Table};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Scenes.
const SHOWN: [&str; 2] = ["door", "bulb"];
/// Pixels of the images at equal time on a side of one of these.
const BLOCK: u32 = 3;
/// Steps of a pixel of an image.
const SAMPLES: u32 = 64;
/// Classes of pixels of like brightness.
const CLASSES: [&str; 4] = ["darkest quarter", "second", "third", "brightest quarter"];
/// Integrators whose variates are the states, of which sizes of steps are learnt.
const OVER: [&str; 2] = ["bidirectional", "multiplexed"];
pub(super) const STEPS: u64 = SHOWN.len() as u64 * (4 + 5 * OVER.len() as u64);

/// A method: its name, and the key in which it differs.
type Variant = (&'static str, (&'static str, Value));

/// Brightness alone, and importance of pixels by its aim.
fn maps() -> Vec<Variant> {
    let aim = |name, aim| (name, ("importance", json!({ "stages": 2, "aim": aim })));
    vec![
        ("brightness alone", ("importance", Value::Null)),
        aim("even visits", "even_visits"),
        aim("least squared error", "squared_error"),
        aim("least relative error", "relative_error"),
    ]
}

/// Small steps of one size and of its parts, and sizes that are learnt by pixel.
fn sizes() -> Vec<Variant> {
    let step = |name, ends: [f64; 2]| (name, ("step", json!(ends.map(f64::recip))));
    vec![
        step("1/1024 to 1/16", [1024.0, 16.0]),
        step("1/1024 to 1/256", [1024.0, 256.0]),
        step("1/256 to 1/64", [256.0, 64.0]),
        step("1/64 to 1/16", [64.0, 16.0]),
        ("learnt by pixel", ("adaptation", json!("crosswise"))),
    ]
}

/// Replicas of an image, of which the first half teaches the second.
fn replicas(run: &Run<'_>) -> u32 {
    run.quick_or(4, 16)
}

/// Chains of one scene over one integrator; the first learn nothing.
struct Group {
    scene: &'static str,
    over: &'static str,
    entries: Vec<Entry>,
    /// Mean radiance of each class of pixels, and the relative error of each entry there.
    classes: Vec<(f64, Vec<Measured>)>,
}

impl Group {
    fn study(
        run: &Run<'_>,
        compared: &Compared,
        (over, variants): (&'static str, Vec<Variant>),
    ) -> Result<Self, Failure> {
        let (scene, exact) = (compared.scene.id, compared.exact.coarser(BLOCK));
        let entry = |(name, (key, value)): Variant| {
            let mut chains =
                json!({ "kind": "metropolis", "space": "primary", "over": over, "replicas": replicas(run) });
            chains[key] = value;
            let seed = run.seed(format_args!("learning/{scene}/{over}/{name}"));
            exact.entry(run, (name, chains), (run.samples(SAMPLES), seed))
        };
        let entries = variants.into_iter().map(entry).collect::<Result<Vec<_>, _>>()?;
        let class = |pixels: &Vec<usize>| {
            let errors = entries.iter().map(|entry| exact.relative_error(entry, pixels));
            (exact.mean_of(pixels), errors.collect())
        };
        let classes = exact.classes(CLASSES.len()).iter().map(class).collect();
        Ok(Self { scene, over, entries, classes })
    }

    /// Efficiencies over that of the first, in words.
    fn gains(&self, from: usize) -> String {
        let gain = |entry: &Entry| {
            let gain = self.entries[0].cost.over(&entry.cost).words(2);
            format!("{} on {} ({}) {gain}", entry.name, self.scene, self.over)
        };
        self.entries[from..].iter().map(gain).collect::<Vec<_>>().join("; ")
    }

    /// A table of all entries, with some cells of each.
    fn table(&self, id: &str, of: (&[&str], &dyn Fn(usize) -> Vec<Cell>)) -> Table {
        let title =
            format!("{}, over {}: squared error of the first over that of others", self.scene, self.over);
        let own = of.0.iter().chain(&["all pixels", "efficiency over the first", "z of the mean"]);
        let columns: Vec<(&str, &str)> =
            [("method", "")].into_iter().chain(own.map(|name| (*name, "1"))).collect();
        let row = |(k, entry): (usize, &Entry)| {
            let first = &self.entries[0];
            let last =
                [first.variance.over(&entry.variance), first.cost.over(&entry.cost)].map(|it| it.cell());
            [Cell::text(entry.name)]
                .into_iter()
                .chain(of.1(k))
                .chain(last)
                .chain([Cell::Number(entry.z)])
                .collect()
        };
        let rows = self.entries.iter().enumerate().map(row).collect();
        Table { rows, ..Table::new(&format!("{id}-{}-{}", self.scene, self.over), &title, "", &columns) }
    }
}

/// Measurements of both.
pub(super) struct Study {
    maps: Vec<Group>,
    sizes: Vec<Group>,
}

pub(super) fn study(run: &Run<'_>, compared: &[Compared]) -> Result<Study, Failure> {
    let shown = || compared.iter().filter(|scene| SHOWN.contains(&scene.scene.id));
    let maps = shown().map(|scene| Group::study(run, scene, (OVER[0], maps())));
    let sizes = shown().flat_map(|scene| OVER.map(|over| Group::study(run, scene, (over, sizes()))));
    Ok(Study { maps: maps.collect::<Result<_, _>>()?, sizes: sizes.collect::<Result<_, _>>()? })
}

impl Study {
    /// Means that are too far above that of the reference.
    pub(super) fn unsound(&self) -> impl Iterator<Item = String> + '_ {
        let groups = self.maps.iter().chain(&self.sizes);
        groups.flat_map(|group| group.entries.iter().filter_map(|entry| entry.too_bright(group.scene)))
    }

    /// The findings, in words: efficiencies over those of chains that learn nothing.
    pub(super) fn summary(&self) -> Vec<String> {
        let told = |what: &str, groups: &[Group], from: usize| {
            let gains: Vec<String> = groups.iter().map(|group| group.gains(from)).collect();
            format!("{what}, efficiency over that of chains that learn nothing: {}.", gains.join("; "))
        };
        vec![told("Importance of pixels", &self.maps, 1), told("Sizes of steps", &self.sizes, 4)]
    }

    pub(super) fn sections(&self, run: &Run<'_>) -> [Section; 2] {
        let (steps, replicas) = (run.samples(SAMPLES), replicas(run));
        let maps = format!(
            "Chains over bidirectional path tracing at equal work, {steps} steps for each pixel, which follow brightness, or brightness times an importance of its pixel that the \
             first half of {replicas} replicas taught the second (antwerpen-2011 6.7). A chain visits pixels by their brightness; an importance spreads its visits as evenly as it can, \
             to the least sum of squared errors, or to that of relative ones. Blocks of {BLOCK} x {BLOCK} pixels of the reference above are put together, and their pixels into classes \
             of like brightness. Relative error: RMSE over the mean of the class. Intervals are 95 %, from {REPLICAS} independent images."
        );
        let sizes = format!(
            "Chains of the same work with small steps from 1/1024 to 1/16, of one part of these, or of parts whose shares each pixel learns (antwerpen-2011 6.9): two halves of {replicas} \
             replicas teach each other by how far accepted steps lead, and the later half of each uses it. Independent samples that chains start from are of bidirectional path tracing, \
             or of one strategy each (multiplexed). The same pixels and intervals as above."
        );
        let panel = |group: &Group| {
            let (x, y) =
                (Axis::linear("radiance of the class [radiance]"), Axis::logarithmic("relative error [1]"));
            let curve = |(k, entry): (usize, &Entry)| {
                Curve::joined(entry.name, group.classes.iter().map(|(mean, errors)| errors[k].mark(*mean)))
            };
            Panel {
                curves: group.entries.iter().enumerate().map(curve).collect(),
                ..Panel::new(group.scene, x, y)
            }
        };
        let panels = self.maps.iter().map(panel).collect();
        let squares = |group: &Group| {
            let ratio =
                |errors: &Vec<Measured>, k: usize| errors[0].over(&errors[k]).map(|ratio| ratio * ratio);
            group.table(
                "maps",
                (&CLASSES, &|k| group.classes.iter().map(|(_, it)| ratio(it, k).cell()).collect()),
            )
        };
        let accepted = |group: &Group| {
            let of = |k: usize| {
                let moves = group.entries[k].images.moves();
                let small: Vec<_> = moves.iter().filter(|it| it.kind.starts_with("small_step")).collect();
                // Learnt sizes have one each.
                vec![if let [moves] = small[..] { moves.acceptance.cell() } else { Cell::Empty }]
            };
            group.table("sizes", (&["acceptance"], &of))
        };
        let chart = Chart::of("maps-error", "Relative error by brightness", panels);
        [
            Section::new("maps", "Importance of pixels")
                .with(maps)
                .with(chart)
                .with_all(self.maps.iter().map(squares)),
            Section::new("sizes", "Populations of step sizes")
                .with(sizes)
                .with_all(self.sizes.iter().map(accepted)),
        ]
    }
}
