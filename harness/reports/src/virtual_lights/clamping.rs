//! Fig. 2, 4 and 11: what bounding loses, and what steps of compensation bring back.

use super::reference::Reference;
use super::scenes::{self, Choice, lights};
use crate::measured::Measured;
use crate::replicas::Replicas;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Gallery, Mark, Picture, Pixels, Section, Table};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Independent images per measurement.
const REPLICAS: u32 = 8;
/// Light paths of a set.
const PATHS: u32 = 100;
/// Sets of an image.
const SETS: u32 = 32;

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

/// Fig. 2: a cloud by path tracing, by unbounded lights, by clamped ones.
fn splotches(run: &Run<'_>) -> Result<Section, Failure> {
    /// Paths per pixel of the reference, light paths of a set, points per eye ray.
    const CLOUD: (u32, u32, u32) = (512, 200, 48);
    const EXPOSURE: f64 = 3.0;
    let (reference_paths, paths, eye_samples) = CLOUD;
    let subject = scenes::cloud(scenes::side(run))?;
    let reference = Reference::of(run, &subject, reference_paths, run.seed("splotches/reference"))?;
    let unbiased = vec!["unbiased".to_owned()];
    let mut pictures =
        vec![reference.shown.picture("splotches-reference", "path tracing", unbiased, EXPOSURE)];
    for (id, name, clamp) in
        [("unbounded", "unbounded lights", Value::Null), ("clamped", "clamped", json!(LOW_BOUND))]
    {
        let one_set = subject.with("integrator", lights(paths, eye_samples, &clamp));
        let images = one_set.measure(1, (run.seed("splotches/lights"), 4), &run.media)?;
        let share = images.mean_of_images().0 / reference.mean.0;
        let lines = vec![format!("{:.0} % of the light", 100.0 * share)];
        pictures.push(images.picture(format!("splotches-{id}"), name, lines, EXPOSURE));
        run.advance();
    }
    let text = format!(
        "A cloud of Perlin noise lit by a small lamp, one and the same set of {paths} light paths, {eye_samples} points per eye ray, b = {LOW_BOUND}. Unbounded lights \
         have no second moment in a medium: their error is shown by eye only, an interval would mean nothing."
    );
    let gallery = Gallery::of_row("splotches-images", "The same cloud three times", pictures)
        .with_caption("Four sets each are averaged for the share of the light; one is shown.");
    Ok(Section::new("splotches", "Fig. 2: splotches, or too little light").with(text).with(gallery))
}

/// Fig. 11 and E1: the energy of the room, stage by stage.
fn energy(run: &Run<'_>, reference: &Reference) -> Result<(Vec<Stage>, Section), Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let low = stages(LOW_BOUND).into_iter().map(|stage| (LOW_BOUND, stage));
    let others =
        OTHER_BOUNDS.iter().flat_map(|&b| stages(b).into_iter().take(OF_OTHERS).map(move |stage| (b, stage)));
    let mut measured: Vec<Stage> = Vec::new();
    for (bound, (name, integrator)) in low.chain(others) {
        let seed = run.seed(format_args!("energy/{bound}/{name}"));
        let subject = subject.with("integrator", integrator);
        let images = subject.measure(run.samples(SETS), (seed, REPLICAS), &run.media)?;
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
    let text = format!(
        "{side} x {side} pixels in gray, {} sets of {PATHS} light paths per image, b = {LOW_BOUND}, four points per eye ray, {REPLICAS} independent images. \
         In the differences green is light that is missing, red light that is too much, as in the paper; noise is both.",
        run.samples(SETS),
        side = scenes::side(run)
    );
    let table = Table::of(
        [
            "energy-table",
            "Energy by steps of compensation",
            "Of the mean radiance of the path-traced image. z: in standard errors of both images; all but unlimited steps are biased by design.",
        ],
        &measured,
        &[
            ("b", "1/length²", &|stage| Cell::Number(stage.bound)),
            ("stage", "", &|stage| Cell::text(stage.name)),
            ("share of the light", "1", &|stage| stage.energy.cell()),
            ("of what clamping loses", "1", &|stage| Cell::Number(stage.recovered)),
            ("RMSE", "radiance", &|stage| stage.rmse.cell()),
            ("z", "1", &|stage| Cell::Number(stage.z)),
        ],
    );
    let at_low = measured.iter().filter(|stage| stage.bound == LOW_BOUND);
    let rows = at_low.enumerate().map(|(k, stage)| {
        let image = stage.images.picture(format!("energy-{k}"), "image", Vec::new(), super::EXPOSURE);
        (stage.name.to_owned(), vec![image, difference(k, stage, reference)])
    });
    let title = "Images, and their difference from the reference";
    let gallery = Gallery::of_images("energy-images", title, rows.collect())
        .with_caption("Differences are those of the mean of all images.");
    let section = Section::new("energy", "Fig. 11: lost energy and overcompensation in the room with smoke")
        .with(text)
        .with(table)
        .with(gallery);
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
    /// Pixels, sets of lights, and paths per pixel.
    const LINE: (u32, u32, u32) = (64, 512, 65536);
    let (columns, sets, paths) = (run.quick_or(LINE.0 / 2, LINE.0), LINE.1, LINE.2);
    let subject = scenes::scanline(columns)?;
    let reference = Reference::of(run, &subject, paths, run.seed("scanline/reference"))?;
    let x = |i: usize| i as f64 + 0.5;
    let exact = reference.pixels.iter().enumerate().map(|(i, &value)| (x(i), value));
    let mut curves = vec![Curve::reference("ground truth", exact)];
    let unbounded = ("unbounded, one set", lights(PATHS, 256, &Value::Null), 1);
    let staged = stages(LOW_BOUND).into_iter().map(|(name, lights)| (name, lights, run.samples(sets)));
    for (name, integrator, sets) in staged.chain([unbounded]) {
        let seed = run.seed(format_args!("scanline/{name}"));
        let images = subject.with("integrator", integrator).measure(sets, (seed, 2), &run.media)?;
        let (mean, _) = images.mean();
        let marks = mean.iter().enumerate().map(|(i, &value)| Mark::at(x(i), value));
        curves.push(Curve::method(name).with_marks(marks));
        run.advance();
    }
    let text = format!(
        "A row of {columns} pixels through the middle of the room in gray, b = {LOW_BOUND}; {} sets of {PATHS} light paths twice over, {paths} paths per pixel for the \
         ground truth.",
        run.samples(sets)
    );
    let chart = Chart::new(
            "scanline-radiance",
            "Fig. 4: a scanline",
            Axis::linear("column [pixel]"),
            Axis::linear("radiance [radiance]"),
        ).with_caption("The middle row of the room. Unbounded lights of one set jump where an eye ray passes near one of them.").with_curves(curves);
    Ok(Section::new("scanline", "Fig. 4: a scanline").with(text).with(chart))
}
