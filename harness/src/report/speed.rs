//! Speed against error of several integrators on one scene.

use super::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use super::replicas::{Measured, Subject};
use super::run::Run;
use crate::Failure;
use serde_json::Value;

/// Independent images per measurement.
const REPLICAS: u32 = 4;

/// An integrator at the largest number of rays.
pub(super) struct Efficiency {
    pub(super) name: &'static str,
    /// 1/(MSE · CPU seconds).
    pub(super) per_second: Measured,
    /// 1/(MSE · look-ups per pixel).
    pub(super) per_lookup: Measured,
}

/// What a comparison came to.
pub(super) struct Speed {
    pub(super) section: Section,
    pub(super) efficiencies: Vec<Efficiency>,
}

impl Speed {
    /// The integrator with the greatest efficiency per second.
    pub(super) fn fastest(&self) -> &Efficiency {
        let order = |a: &&Efficiency, b: &&Efficiency| a.per_second.value.total_cmp(&b.per_second.value);
        self.efficiencies.iter().max_by(order).expect("something is compared")
    }
}

/// Measures each of `integrators` on `subject` at each number of `rays` per pixel; seeds are those of `part` and the ones after it.
pub(super) fn compare(
    run: &Run<'_>,
    (subject, part): (&Subject, u64),
    integrators: Vec<(&'static str, Value)>,
    rays: &[u32],
    text: &str,
) -> Result<Speed, Failure> {
    let (mut by_lookups, mut by_seconds, mut efficiencies) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (name, integrator)) in (0..).zip(integrators) {
        let subject = subject.with("integrator", integrator);
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for (k, &rays) in (0..).zip(rays) {
            let seed = run.seed(part + i, k);
            let image = subject.measure(run.samples(rays), (seed, REPLICAS), &run.media)?;
            let error = image.squared_error();
            let rmse = error.map(f64::sqrt);
            let (time, looked_up) = (image.seconds(), image.lookups_per_pixel());
            lookups.push(Mark::measured(looked_up, rmse.value, rmse.interval));
            seconds.push(Mark::measured(time, rmse.value, rmse.interval));
            efficiencies.truncate(i as usize);
            efficiencies.push(Efficiency {
                name,
                per_second: error.map(|error| 1.0 / (error * time)),
                per_lookup: error.map(|error| 1.0 / (error * looked_up)),
            });
            run.advance();
        }
        by_lookups.push(curve(name, lookups));
        by_seconds.push(curve(name, seconds));
    }
    let mut section = Section::new("speed", "Speed against error");
    section.text = vec![text.to_owned()];
    section.charts = vec![
        chart("speed-lookups", "Error against look-ups", "look-ups per pixel [1]", by_lookups),
        chart("speed-seconds", "Error against time", "CPU seconds of an image [s]", by_seconds),
    ];
    section.tables = vec![table(&efficiencies)];
    Ok(Speed { section, efficiencies })
}

/// Marks joined by a line.
pub(super) fn curve(name: &str, marks: Vec<Mark>) -> Curve {
    let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
    Curve::method(name).with_line(line).with_marks(marks)
}

fn chart(id: &str, title: &str, x: &str, curves: Vec<Curve>) -> Chart {
    let mut chart = Chart::new(id, title, Axis::logarithmic(x), Axis::logarithmic("RMSE [radiance]"));
    chart.curves = curves;
    chart
}

fn table(efficiencies: &[Efficiency]) -> Table {
    let mut table = Table::new(
        "speed-table",
        "Efficiency",
        "At the largest number of rays. Per CPU second: on two cores an image takes half of that time.",
        &[
            ("integrator", ""),
            ("1/(MSE · CPU s)", "1/(radiance² s)"),
            ("1/(MSE · look-ups per pixel)", "1/radiance²"),
        ],
    );
    for row in efficiencies {
        table.rows.push(vec![
            Cell::text(row.name),
            Cell::measured(row.per_second.value, row.per_second.interval),
            Cell::measured(row.per_lookup.value, row.per_lookup.interval),
        ]);
    }
    table
}
