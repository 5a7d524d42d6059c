//! Fig. 2, 4 and 11: what bounding loses, and what steps of compensation bring back.

use super::reference::Reference;
use super::scenes::{self, Choice, lights};
use crate::Failure;
use crate::report::document::{
    Axis, Cell, Chart, Curve, Gallery, GalleryRow, Mark, Picture, Pixels, Section, Table,
};
use crate::report::replicas::{Measured, Replicas, Subject};
use crate::report::run::Run;
use serde_json::{Value, json};

/// Independent images per measurement.
const REPLICAS: u32 = 8;
/// Light paths of a set.
const PATHS: u32 = 100;
/// Light paths of the set whose splotches are shown, and points per eye ray.
const SPLOTCH_PATHS: u32 = 200;
const EYE_SAMPLES: u32 = 48;
/// Sets of an image.
const SETS: u32 = 32;
/// Paths per pixel of the cloud.
const REFERENCE: u32 = 512;
/// Pixels of the scanline.
const COLUMNS: u32 = 64;
/// Sets and paths per pixel of the scanline.
const LINE: (u32, u32) = (512, 65536);

/// A bound that takes away what can be seen \[1/length²\].
pub(super) const LOW_BOUND: f64 = 2.0;
/// Other bounds at which the energy is measured.
const OTHER_BOUNDS: [f64; 2] = [0.5, 8.0];

/// What is rendered, from nothing recovered to everything.
fn stages(bound: f64) -> Vec<(&'static str, Value)> {
    let exact = Choice { strategy: "one_to_one", placement: "locally_homogeneous", ..Choice::EXACT };
    let steps = |steps| Choice { steps: Some(steps), ..exact }.lights(PATHS, 4, bound);
    vec![
        ("clamped", steps(0)),
        ("1 step", steps(1)),
        ("2 steps", steps(2)),
        ("2 steps, approximate transmittance", Choice::PAPER.lights(PATHS, 4, bound)),
        ("unlimited", exact.lights(PATHS, 4, bound)),
    ]
}

pub(super) fn steps() -> u64 {
    // References of cloud and line; unbounded and clamped clouds; all stages twice; the unbounded line.
    let others = OTHER_BOUNDS.len() * OF_OTHERS;
    // The reference of the room is made elsewhere.
    (2 + 2 + 2 * stages(LOW_BOUND).len() + others + 1) as u64
}

/// Stages at other bounds: clamped, and steps of a number.
const OF_OTHERS: usize = 3;

/// One stage in the room.
pub(super) struct Stage {
    pub(super) name: &'static str,
    /// b.
    pub(super) bound: f64,
    /// Of the light of the reference.
    pub(super) energy: Measured,
    /// Of what clamping loses.
    pub(super) recovered: f64,
    pub(super) z: f64,
    pub(super) rmse: Measured,
    images: Replicas,
}

pub(super) struct Clamping {
    pub(super) stages: Vec<Stage>,
    pub(super) sections: Vec<Section>,
}

impl Clamping {
    pub(super) fn of(&self, name: &str) -> Option<&Stage> {
        self.stages.iter().find(|stage| stage.name == name && stage.bound == LOW_BOUND)
    }
}

pub(super) fn study(run: &Run<'_>, reference: &Reference) -> Result<Clamping, Failure> {
    let splotches = splotches(run)?;
    let (stages, energy) = energy(run, reference)?;
    let scanline = scanline(run)?;
    Ok(Clamping { stages, sections: vec![splotches, scanline, energy] })
}

fn picture(id: &str, label: &str, lines: Vec<String>, images: &Replicas, exposure: f64) -> Picture {
    Picture {
        id: id.to_owned(),
        label: label.to_owned(),
        lines,
        resolution: images.first().resolution(),
        pixels: Pixels::Radiance { values: images.first().means().to_vec(), exposure },
    }
}

/// Fig. 2: a cloud by path tracing, by unbounded lights, by clamped ones.
fn splotches(run: &Run<'_>) -> Result<Section, Failure> {
    let subject = scenes::cloud(run.quick_or(24, 48))?;
    let reference = Reference::of(run, &subject, REFERENCE, run.seed(20, 0))?;
    let exposure = 3.0;
    let paths = SPLOTCH_PATHS;
    let energy = |images: &Replicas| images.mean_of_images().0 / reference.mean.0;
    let mut pictures = vec![picture(
        "splotches-reference",
        "path tracing",
        vec!["unbiased".to_owned()],
        &reference.shown,
        exposure,
    )];
    for (id, name, clamp) in
        [("unbounded", "unbounded lights", Value::Null), ("clamped", "clamped", json!(LOW_BOUND))]
    {
        let one_set = subject.with("integrator", lights(paths, EYE_SAMPLES, &clamp));
        let images = one_set.measure(1, (run.seed(21, 0), 4), &run.media)?;
        let lines = vec![format!("{:.0} % of the light", 100.0 * energy(&images))];
        pictures.push(picture(&format!("splotches-{id}"), name, lines, &images, exposure));
        run.advance();
    }
    let mut section = Section::new("splotches", "Fig. 2: splotches, or too little light");
    section.text = vec![format!(
        "A cloud of Perlin noise lit by a small lamp, one and the same set of {paths} light paths, {EYE_SAMPLES} points per eye ray, b = {LOW_BOUND}. Unbounded lights \
         have no second moment in a medium: their error is shown by eye only, an interval would mean nothing."
    )];
    section.galleries.push(Gallery {
        id: "splotches-images".to_owned(),
        title: "The same cloud three times".to_owned(),
        caption: "Four sets each are averaged for the share of the light; one is shown.".to_owned(),
        rows: vec![GalleryRow { label: String::new(), pictures }],
    });
    Ok(section)
}

/// Fig. 11 and E1: the energy of the room, stage by stage.
fn energy(run: &Run<'_>, reference: &Reference) -> Result<(Vec<Stage>, Section), Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let low = stages(LOW_BOUND).into_iter().map(|stage| (LOW_BOUND, stage));
    let others =
        OTHER_BOUNDS.iter().flat_map(|&b| stages(b).into_iter().take(OF_OTHERS).map(move |stage| (b, stage)));
    let mut measured: Vec<Stage> = Vec::new();
    for (k, (bound, (name, integrator))) in (0..).zip(low.chain(others)) {
        let subject = subject.with("integrator", integrator);
        let images = subject.measure(run.samples(SETS), (run.seed(23, k), REPLICAS), &run.media)?;
        let energy = images.measured_mean().map(|mean| mean / reference.mean.0);
        let clamped = measured.iter().find(|stage| stage.bound == bound);
        let clamped = clamped.map_or(energy.value, |stage| stage.energy.value);
        measured.push(Stage {
            name,
            bound,
            energy,
            recovered: (energy.value - clamped) / (1.0 - clamped),
            z: reference.z_of(&images),
            rmse: reference.rmse(&images),
            images,
        });
        run.advance();
    }
    let mut table = Table::new(
        "energy-table",
        "Energy by steps of compensation",
        "Of the mean radiance of the path-traced image. z: in standard errors of both images; all but unlimited steps are biased by design.",
        &[
            ("b", "1/length²"),
            ("stage", ""),
            ("share of the light", "1"),
            ("of what clamping loses", "1"),
            ("RMSE", "radiance"),
            ("z", "1"),
        ],
    );
    for stage in &measured {
        table.rows.push(vec![
            Cell::Number(stage.bound),
            Cell::text(stage.name),
            Cell::measured(stage.energy.value, stage.energy.interval),
            Cell::Number(stage.recovered),
            Cell::measured(stage.rmse.value, stage.rmse.interval),
            Cell::Number(stage.z),
        ]);
    }
    let mut section =
        Section::new("energy", "Fig. 11: lost energy and overcompensation in the room with smoke");
    section.text = vec![format!(
        "{side} x {side} pixels in gray, {} sets of {PATHS} light paths per image, b = {LOW_BOUND}, four points per eye ray, {REPLICAS} independent images. \
         In the differences green is light that is missing, red light that is too much, as in the paper; noise is both.",
        run.samples(SETS),
        side = scenes::side(run)
    )];
    section.tables.push(table);
    let at_low = measured.iter().filter(|stage| stage.bound == LOW_BOUND);
    let rows = at_low.enumerate().map(|(k, stage)| GalleryRow {
        label: stage.name.to_owned(),
        pictures: vec![
            picture(&format!("energy-{k}"), "image", Vec::new(), &stage.images, super::EXPOSURE),
            difference(k, stage, reference),
        ],
    });
    section.galleries.push(Gallery {
        id: "energy-images".to_owned(),
        title: "Images, and their difference from the reference".to_owned(),
        caption: "Differences are those of the mean of all images.".to_owned(),
        rows: rows.collect(),
    });
    Ok((measured, section))
}

/// Green for what is missing, red for what is too much.
fn difference(k: usize, stage: &Stage, reference: &Reference) -> Picture {
    let (mean, _) = stage.images.mean();
    let colour = |(found, exact): (&f64, &f64)| [(found - exact).max(0.0), (exact - found).max(0.0), 0.0];
    Picture {
        id: format!("energy-{k}-difference"),
        label: "difference".to_owned(),
        lines: vec![format!("{:.1} % of the light", 100.0 * stage.energy.value)],
        resolution: stage.images.first().resolution(),
        pixels: Pixels::Radiance {
            values: mean.iter().zip(&reference.pixels).map(colour).collect(),
            exposure: 4.0 * super::EXPOSURE,
        },
    }
}

/// Fig. 4: a line through the room.
fn scanline(run: &Run<'_>) -> Result<Section, Failure> {
    let subject = scenes::scanline(COLUMNS)?;
    let (sets, paths) = LINE;
    let reference = Reference::of(run, &subject, paths, run.seed(24, 0))?;
    let x = |i: usize| i as f64 + 0.5;
    let exact = reference.pixels.iter().enumerate().map(|(i, &value)| (x(i), value));
    let mut curves = vec![Curve::reference("ground truth", exact)];
    let mut add = |name: &str, integrator: Value, sets: u32, seed: u64, subject: &Subject| {
        let images = subject.with("integrator", integrator).measure(sets, (seed, 2), &run.media)?;
        let (mean, _) = images.mean();
        let marks = mean.iter().enumerate().map(|(i, &value)| Mark::at(x(i), value));
        curves.push(Curve::method(name).with_marks(marks));
        run.advance();
        Ok::<(), Failure>(())
    };
    for (k, (name, integrator)) in (0..).zip(stages(LOW_BOUND)) {
        add(name, integrator, run.samples(sets), run.seed(25, k), &subject)?;
    }
    add("unbounded, one set", lights(PATHS, 256, &Value::Null), 1, run.seed(26, 0), &subject)?;
    let mut chart = Chart::new(
        "scanline-radiance",
        "Fig. 4: a scanline",
        Axis::linear("column [pixel]"),
        Axis::linear("radiance [radiance]"),
    );
    chart.caption = "The middle row of the room. Unbounded lights of one set jump where an eye ray passes near one of them.".to_owned();
    chart.curves = curves;
    let mut section = Section::new("scanline", "Fig. 4: a scanline");
    section.text = vec![format!(
        "A row of {COLUMNS} pixels through the middle of the room in gray, b = {LOW_BOUND}; {} sets of {PATHS} light paths twice over, {paths} paths per pixel for the \
         ground truth.",
        run.samples(sets)
    )];
    section.charts.push(chart);
    Ok(section)
}
