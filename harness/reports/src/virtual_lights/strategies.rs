//! Fig. 6 and 7: the strategies of compensation at equal time, and their error over time.

use super::reference::{ROOM_PATHS, Reference};
use super::scenes::{self, BOUND, Choice, path_tracer};
use crate::measured::Measured;
use crate::replicas::Replicas;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Gallery, Section, Table};
use fairflight_harness::Failure;
use serde_json::Value;

/// Independent images per measurement.
const REPLICAS: u32 = 6;
/// Light paths of a set.
const PATHS: u32 = 100;
/// The points of a curve have so many times the sets of the one before.
const STEP: u32 = 3;
/// Points of a curve.
const POINTS: u32 = 3;

/// A way to render the room.
struct Method {
    name: &'static str,
    strategy: &'static str,
    integrator: Value,
    /// Sets of lights, or paths per pixel, of the longest image; so many that images of a strategy take alike, some seconds of CPU time but for N-to-1, whose least images have one set.
    sets: u32,
}

fn methods() -> Vec<Method> {
    let method = |name, strategy, placement, eye_samples, sets| {
        let choice = Choice { strategy, placement, ..Choice::EXACT };
        Method { name, strategy, integrator: choice.lights(PATHS, eye_samples, BOUND), sets }
    };
    let free = "free_flight";
    let local = "locally_homogeneous";
    vec![
        method("1-to-N", "one_to_many", free, 1, 9),
        method("1-to-N, locally homogeneous", "one_to_many", local, 1, 6),
        method("N-to-1", "many_to_one", free, 1, 6),
        method("N-to-1, locally homogeneous", "many_to_one", local, 1, 4),
        method("1-to-1", "one_to_one", free, 4, 90),
        method("1-to-1, locally homogeneous", "one_to_one", local, 4, 63),
        Method { name: "path tracing", strategy: "", integrator: path_tracer(), sets: 270 },
    ]
}

pub(super) fn steps() -> u64 {
    methods().len() as u64 * u64::from(POINTS)
}

/// What one method came to at its longest image.
pub(super) struct Entry {
    pub(super) name: &'static str,
    pub(super) strategy: &'static str,
    pub(super) rmse: Measured,
    /// MSE · CPU seconds \[radiance² s\]: at equal time the ratio of two is that of their mean squared errors.
    pub(super) cost: Measured,
    pub(super) seconds: f64,
    pub(super) z: f64,
    pub(super) share_inside: f64,
    images: Replicas,
}

/// All methods.
pub(super) struct Strategies {
    pub(super) entries: Vec<Entry>,
    pub(super) section: Section,
}

impl Strategies {
    /// The entry of a method.
    pub(super) fn of(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// The ratio of two methods' RMSE at equal time.
    pub(super) fn ratio(&self, of: &str, to: &str) -> Option<Measured> {
        Some(self.of(of)?.cost.over(&self.of(to)?.cost).map(f64::sqrt))
    }
}

pub(super) fn study(run: &Run<'_>, reference: &Reference) -> Result<Strategies, Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let (mut entries, mut curves) = (Vec::new(), Vec::new());
    for method in methods() {
        let subject = subject.with("integrator", method.integrator);
        let mut marks = Vec::new();
        for point in 0..POINTS {
            let part = STEP.pow(POINTS - 1 - point);
            let sets = (run.samples(method.sets) / part).max(1);
            let seed = run.seed(format_args!("strategies/{}/sets over {part}", method.name));
            let images = subject.measure(sets, (seed, REPLICAS), &run.media)?;
            let rmse = reference.rmse(&images);
            let seconds = images.seconds();
            marks.push(rmse.mark(seconds));
            run.advance();
            if point + 1 == POINTS {
                entries.push(Entry {
                    name: method.name,
                    strategy: method.strategy,
                    rmse,
                    cost: rmse.map(|rmse| rmse * rmse * seconds),
                    seconds,
                    z: reference.z_of(&images),
                    share_inside: images.virtual_lights().share_inside,
                    images,
                });
            }
        }
        curves.push(Curve::joined(method.name, marks));
    }
    let chart = Chart::new(
        "strategies-time",
        "Fig. 7: error over time",
        Axis::logarithmic("CPU seconds of an image [s]"),
        Axis::logarithmic("RMSE [radiance]"),
    )
    .with_caption("Every set of lights is new, so that all fall with the square root of time.")
    .with_curves(curves);
    let text = format!(
        "The room with smoke in gray, without its lamp in the picture, {side} x {side} pixels, sets of {PATHS} light paths, b = {BOUND}, unlimited steps, transmittance and visibility \
         exact: all of these are unbiased. 1-to-N: one compensation vertex per point, connected with all lights. N-to-1: one vertex for each \
         light, and one that sees emitters. 1-to-1: each point on the eye ray has one light and one vertex, four points per ray. Errors are against {ROOM_PATHS} paths per \
         pixel, whose own error ({:.1e}) is taken off; intervals are 95 %, from {REPLICAS} independent images with sets of their own.",
        reference.squared_error.sqrt(),
        side = scenes::side(run)
    );
    let section = Section::new("strategies", "Fig. 6 and 7: strategies of compensation at equal time")
        .with(text)
        .with(chart)
        .with(table(&entries))
        .with(gallery(&entries, reference));
    Ok(Strategies { entries, section })
}

fn table(entries: &[Entry]) -> Table {
    Table::of(
        [
            "strategies-table",
            "Strategies at equal time",
            "Relative RMSE: at the time that 1-to-N takes for its own. z: mean radiance of the images less that of the reference, in standard \
             errors of both. Inside: compensation vertices that lay where something was lost.",
        ],
        entries,
        &[
            ("method", "", &|entry| Cell::text(entry.name)),
            ("sets or paths", "1", &|entry| Cell::Count(entry.images.rays_per_pixel().into())),
            ("CPU seconds", "s", &|entry| Cell::Number(entry.seconds)),
            ("RMSE", "radiance", &|entry| entry.rmse.cell()),
            ("RMSE at equal time / 1-to-N", "1", &|entry| {
                entry.cost.over(&entries[0].cost).map(f64::sqrt).cell()
            }),
            ("inside", "1", &|entry| Cell::maybe(Some(entry.share_inside).filter(|share| share.is_finite()))),
            ("z", "1", &|entry| Cell::Number(entry.z)),
        ],
    )
}

fn gallery(entries: &[Entry], reference: &Reference) -> Gallery {
    let lines = vec!["path tracing".to_owned()];
    let exact = reference.shown.picture("strategies-reference", "reference", lines, super::EXPOSURE);
    let of_entry = |(i, entry): (usize, &Entry)| {
        let lines = vec![format!("RMSE {:.4}", entry.rmse.value), format!("{:.1} CPU s", entry.seconds)];
        entry.images.picture(format!("strategies-{i}"), entry.name, lines, super::EXPOSURE)
    };
    let pictures = [exact].into_iter().chain(entries.iter().enumerate().map(of_entry)).collect();
    let title = "Fig. 6: the images at roughly equal time";
    Gallery::of_row("strategies-images", title, pictures)
}
