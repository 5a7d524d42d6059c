//! What the number of lights in a set does to the strategies.

use super::scenes::{self, BOUND, Choice};
use crate::measured::Measured;
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table};
use fairflight_harness::Failure;

/// Independent images per measurement.
const REPLICAS: u32 = 4;
/// Light paths of a set.
const PATHS: [u32; 3] = [25, 100, 400];

/// A strategy with its points per eye ray, and how many sets of each size make an image.
struct Method {
    name: &'static str,
    choice: Choice,
    eye_samples: u32,
    sets: [u32; 3],
}

fn methods() -> [Method; 3] {
    let one_to_one = Choice { strategy: "one_to_one", ..Choice::EXACT };
    let local = Choice { placement: "locally_homogeneous", ..one_to_one };
    [
        Method { name: "1-to-N", choice: Choice::EXACT, eye_samples: 1, sets: [40, 10, 3] },
        Method { name: "1-to-1", choice: one_to_one, eye_samples: 4, sets: [80; 3] },
        Method { name: "1-to-1, locally homogeneous", choice: local, eye_samples: 4, sets: [60; 3] },
    ]
}

pub(super) fn steps() -> u64 {
    (methods().len() * PATHS.len()) as u64
}

/// All methods over the size of a set.
pub(super) struct Sizes {
    /// RMSE at equal time over that of 1-to-N, by light paths, of both 1-to-1.
    pub(super) ratios: Vec<(u32, [Measured; 2])>,
    pub(super) section: Section,
}

pub(super) fn study(run: &Run<'_>) -> Result<Sizes, Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let mut costs: Vec<[Measured; 3]> = Vec::new();
    for (k, paths) in PATHS.into_iter().enumerate() {
        let mut row = Vec::new();
        for method in methods() {
            let seed = run.seed(format_args!("sizes/{}/{paths}", method.name));
            let subject = subject.with("integrator", method.choice.lights(paths, method.eye_samples, BOUND));
            // Two sets at least, so that the scatter of a pixel is known.
            let sets = run.samples(method.sets[k]).max(2);
            let images = subject.measure(sets, (seed, REPLICAS), &run.media)?;
            let seconds = images.seconds();
            row.push(images.squared_error().map(|error| (error * seconds).sqrt()));
            run.advance();
        }
        costs.push([row[0], row[1], row[2]]);
    }
    let curve = |(m, method): (usize, Method)| {
        Curve::joined(method.name, PATHS.iter().zip(&costs).map(|(&paths, row)| row[m].mark(paths.into())))
    };
    let chart = Chart::new(
        "sizes-error",
        "Error at equal time over the size of a set",
        Axis::logarithmic("light paths of a set [1]"),
        Axis::logarithmic("RMSE · √(CPU seconds) [radiance √s]"),
    )
    .with_curves(methods().into_iter().enumerate().map(curve).collect());
    let ratio = |[many, one, local]: &[Measured; 3]| [one.over(many), local.over(many)];
    let table = Table::of(
        [
            "sizes-table",
            "RMSE · √(CPU seconds) by the size of a set",
            "What one image of a second of CPU time would have for an error.",
        ],
        PATHS.into_iter().zip(&costs),
        &[
            ("light paths", "1", &|(paths, _)| Cell::Count((*paths).into())),
            ("1-to-N", "radiance √s", &|(_, [many, ..])| many.cell()),
            ("1-to-1", "radiance √s", &|(_, [_, one, _])| one.cell()),
            ("1-to-1, locally homogeneous", "radiance √s", &|(_, [.., local])| local.cell()),
            ("1-to-1 / 1-to-N", "1", &|(_, row)| ratio(row)[0].cell()),
            ("1-to-1, locally homogeneous / 1-to-N", "1", &|(_, row)| ratio(row)[1].cell()),
        ],
    );
    let text = format!(
        "The same room and bound (b = {BOUND}). The time of 1-to-N grows with the lights of a set, whose number does little for the noise of a \
         compensation vertex; that of 1-to-1 does not. Errors from the scatter of a pixel over its sets, {REPLICAS} independent images."
    );
    let section = Section::new("sizes", "The size of a set").with(text).with(chart).with(table);
    Ok(Sizes { ratios: PATHS.into_iter().zip(costs.iter().map(ratio)).collect(), section })
}
