//! Fig. 5 and 8: what approximate transmittance and ignored visibility change. E3: how many vertices a free flight loses.

use super::reference::Reference;
use super::scenes::{self, BOUND, Choice};
use crate::measured::Measured;
use crate::replicas::{Replicas, Subject};
use crate::run::Run;
use fairflight_document::{Cell, Gallery, Picture, Pixels, Section, Table};
use fairflight_harness::Failure;
use serde_json::json;

/// Independent images per measurement.
const REPLICAS: u32 = 8;
/// Light paths of a set.
const PATHS: u32 = 100;
/// Sets of an image.
const SETS: u32 = 64;
/// Paths per pixel of the whole images.
const REFERENCE: u32 = 512;
/// Pixels along each side of the blocks over which differences are averaged.
const BLOCK: usize = 12;
/// Bounds at which vertices are counted \[1/length²\].
pub(super) const BOUNDS: [f64; 5] = [1.0, 5.0, 20.0, 100.0, 1000.0];

pub(super) fn steps() -> u64 {
    6 + BOUNDS.len() as u64
}

/// The difference that an approximation makes.
pub(super) struct Difference {
    /// Of mean radiance.
    pub(super) relative: Measured,
    /// The greatest difference of a block that is not noise, over the mean radiance; 0 if all may be noise.
    pub(super) greatest: f64,
    /// The root of the mean squared standard error of a block, over the mean radiance.
    pub(super) noise: f64,
    /// How much brighter the difference must be made to be as bright as the image; at least that where only noise is seen.
    pub(super) scale: f64,
    section: Section,
}

pub(super) struct Approximations {
    pub(super) transmittance: Difference,
    pub(super) visibility: Difference,
    /// The share of free flights that end where something is lost, by bound.
    pub(super) inside: Vec<(f64, f64)>,
    pub(super) sections: Vec<Section>,
}

pub(super) fn study(run: &Run<'_>) -> Result<Approximations, Failure> {
    let exact = Choice { strategy: "one_to_one", placement: "locally_homogeneous", ..Choice::EXACT };
    let transmittance = compare(
        run,
        &scenes::smoke_room(scenes::side(run))?,
        ("transmittance", "Fig. 5: exact and approximate transmittance to the compensation vertex"),
        [exact, Choice { transmittance: "approximate", ..exact }],
    )?;
    let mut visibility = compare(
        run,
        &scenes::screen(scenes::side(run))?,
        ("visibility", "Fig. 8: visibility of the compensation vertex, seen and ignored"),
        [exact, Choice { visibility: "ignored", ..exact }],
    )?;
    let room = "The room has even smoke (σ_t = 0.6) and a thin screen under the lamp, seen from below. Where visibility is ignored the vertices of points \
         of the medium lie in the medium only, also behind surfaces; what surfaces would reflect over short distances is missing.";
    visibility.section.blocks.insert(1, room.into());
    let (inside, counted) = vertices(run)?;
    let sections = vec![transmittance.section.clone(), visibility.section.clone(), counted];
    Ok(Approximations { transmittance, visibility, inside, sections })
}

/// Renders the compensation both ways, and their difference.
fn compare(
    run: &Run<'_>,
    subject: &Subject,
    (id, title): (&str, &str),
    [with, without]: [Choice; 2],
) -> Result<Difference, Failure> {
    // The same sets of lights both ways, and nothing but the compensation: the rest is the same.
    let render = |choice: Choice| {
        let mut integrator = choice.lights(PATHS, 4, BOUND);
        integrator["component"] = json!("correction");
        let seed = run.seed(format_args!("{id}/lights"));
        let lit = subject.with("integrator", integrator);
        let images = lit.measure(run.samples(SETS), (seed, REPLICAS), &run.media);
        run.advance();
        images
    };
    let (exact, approximate) = (render(with)?, render(without)?);
    let whole = Reference::of(run, subject, REFERENCE, run.seed(format_args!("{id}/whole")))?;
    let brightness = whole.mean.0;
    let change = approximate.measured_change(&exact).map(|change| change / brightness);
    let blocks = approximate.changes_of_blocks(&exact, BLOCK);
    // Two standard errors of the greatest of so many blocks are noise; four are not.
    let beyond = |&&(difference, error): &&(f64, f64)| difference.abs() > 4.0 * error;
    let greatest = blocks.iter().filter(beyond).map(|(d, _)| d.abs()).fold(0.0, f64::max) / brightness;
    let squares = blocks.iter().map(|(_, error)| error * error).sum::<f64>() / blocks.len() as f64;
    let noise = squares.sqrt() / brightness;
    let scale = 1.0 / if greatest > 0.0 { greatest } else { 4.0 * noise };
    let picture = |name: &str, label: &str, images: &Replicas| {
        images.picture(format!("{id}-{name}"), label, Vec::new(), super::EXPOSURE)
    };
    let side = scenes::side(run) as usize / BLOCK;
    let shown = Picture {
        id: format!("{id}-difference"),
        label: "difference".to_owned(),
        lines: vec![
            format!("blocks of {BLOCK} x {BLOCK} pixels"),
            format!("made {:.0} times brighter", scale),
        ],
        resolution: [side, side],
        pixels: Pixels::Signed {
            values: blocks.iter().map(|(difference, _)| *difference).collect(),
            scale: brightness / scale,
        },
    };
    let text = format!(
        "{0} x {0} pixels in gray, the compensation alone, 1-to-1 locally homogeneous, unlimited steps, b = {BOUND}, {1} sets of {PATHS} light paths, {REPLICAS} independent \
         images each way. The mean radiance changes by {2:.2} % [{3:.2}, {4:.2}]; the greatest change of a block that is beyond four standard \
         errors is {5:.2} % of the mean radiance (noise of a block: {6:.2} %).",
        scenes::side(run),
        run.samples(SETS),
        100.0 * change.value,
        100.0 * change.interval[0],
        100.0 * change.interval[1],
        100.0 * greatest,
        100.0 * noise
    );
    let pictures = vec![
        picture("whole", "path tracing", &whole.shown),
        picture("exact", "exact", &exact),
        picture("approximate", "approximated", &approximate),
        shown,
    ];
    let gallery = Gallery::of_row(&format!("{id}-images"), "Both, and their difference", pictures)
        .with_caption("Orange: the approximation is brighter.");
    let section = Section::new(id, title).with(text).with(gallery);
    Ok(Difference { relative: change, greatest, noise, scale, section })
}

/// How many compensation vertices of a free flight lie where something is lost.
fn vertices(run: &Run<'_>) -> Result<(Vec<(f64, f64)>, Section), Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let share = |bound: f64, placement: &'static str| -> Result<f64, Failure> {
        let seed = run.seed(format_args!("vertices/{bound}/{placement}"));
        let choice = Choice { strategy: "one_to_one", placement, ..Choice::EXACT };
        let lit = subject.with("integrator", choice.lights(PATHS, 4, bound));
        Ok(lit.measure(4, (seed, 2), &run.media)?.virtual_lights().share_inside)
    };
    let mut shares = Vec::new();
    for bound in BOUNDS {
        shares.push((bound, [share(bound, "free_flight")?, share(bound, "locally_homogeneous")?]));
        run.advance();
    }
    let text = "A vertex counts if the geometric term to it exceeds b. Beyond d it never does; with a cosine at either end it need not within d \
         either, which is what placing within the region cannot avoid.";
    let table = Table::of(
        [
            "vertices-table",
            "Compensation vertices that count",
            "d = 1/√b bounds the region; the mean free path of the smoke is about 2.",
        ],
        &shares,
        &[
            ("b", "1/length²", &|(bound, _)| Cell::Number(*bound)),
            ("d", "length", &|(bound, _)| Cell::Number(1.0 / bound.sqrt())),
            ("free flight", "1", &|(_, [free, _])| Cell::Number(*free)),
            ("locally homogeneous", "1", &|(_, [_, local])| Cell::Number(*local)),
        ],
    );
    let section =
        Section::new("vertices", "Compensation vertices that a free flight loses").with(text).with(table);
    Ok((shares.into_iter().map(|(bound, [free, _])| (bound, free)).collect(), section))
}
