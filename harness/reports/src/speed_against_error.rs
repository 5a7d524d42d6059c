//! Speed against error of several integrators on one scene.

use super::measured::Measured;
use super::replicas::Subject;
use super::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table};
use fairflight_harness::Failure;
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

/// Result of a comparison.
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

/// Measures each of `integrators` on `subject` at each number of `rays` per pixel.
pub(super) fn compare(
    run: &Run<'_>,
    subject: &Subject,
    integrators: Vec<(&'static str, Value)>,
    rays: &[u32],
    text: &str,
) -> Result<Speed, Failure> {
    let (mut by_lookups, mut by_seconds, mut efficiencies) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (name, integrator)) in integrators.into_iter().enumerate() {
        let subject = subject.with("integrator", integrator);
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for &rays in rays {
            let seed = run.seed(format_args!("speed/{name}/{rays}"));
            let image = subject.measure(run.samples(rays), (seed, REPLICAS), &run.media)?;
            let error = image.squared_error();
            let rmse = error.map(f64::sqrt);
            let (time, looked_up) = (image.seconds(), image.lookups_per_pixel());
            lookups.push(rmse.mark(looked_up));
            seconds.push(rmse.mark(time));
            efficiencies.truncate(i);
            efficiencies.push(Efficiency {
                name,
                per_second: error.map(|error| 1.0 / (error * time)),
                per_lookup: error.map(|error| 1.0 / (error * looked_up)),
            });
            run.advance();
        }
        by_lookups.push(Curve::joined(name, lookups));
        by_seconds.push(Curve::joined(name, seconds));
    }
    let section = Section::new("speed", "Speed against error")
        .with(text)
        .with(chart("speed-lookups", "Error against look-ups", "look-ups per pixel [1]", by_lookups))
        .with(chart("speed-seconds", "Error against time", "CPU seconds of an image [s]", by_seconds))
        .with(table(&efficiencies));
    Ok(Speed { section, efficiencies })
}

fn chart(id: &str, title: &str, x: &str, curves: Vec<Curve>) -> Chart {
    let (x, y) = (Axis::logarithmic(x), Axis::logarithmic("RMSE [radiance]"));
    Chart::new(id, title, x, y).with_curves(curves)
}

fn table(efficiencies: &[Efficiency]) -> Table {
    Table::of(
        [
            "speed-table",
            "Efficiency",
            "At the largest number of rays. Per CPU second: on two cores an image takes half of that time.",
        ],
        efficiencies,
        &[
            ("integrator", "", &|row| Cell::text(row.name)),
            ("1/(MSE · CPU s)", "1/(radiance² s)", &|row| row.per_second.cell()),
            ("1/(MSE · look-ups per pixel)", "1/radiance²", &|row| row.per_lookup.cell()),
        ],
    )
}
