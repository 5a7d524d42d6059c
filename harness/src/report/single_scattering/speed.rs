//! Speed against error of all methods.

use super::methods::{self, Method};
use super::{Lighting, REPLICAS, Run};
use crate::Failure;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::replicas::Measured;

/// Camera rays per pixel of the points of a curve.
const RAYS: [u32; 3] = [2, 8, 32];

fn compared() -> Vec<Method> {
    let mut compared: Vec<Method> =
        methods::all(1.0).into_iter().filter(|method| !method.is_baseline).collect();
    compared.push(methods::closed_form("closed form, 4 + 4 samples", 4));
    compared.push(methods::closed_form("closed form, 32 + 32 samples", 32));
    compared
}

pub(super) fn steps() -> u64 {
    (compared().len() * RAYS.len()) as u64
}

/// A method at its largest number of rays.
pub(super) struct Efficiency {
    pub(super) name: &'static str,
    /// 1/(MSE · CPU seconds).
    pub(super) per_second: Measured,
    pub(super) per_lookup: Measured,
}

pub(super) struct Speed {
    pub(super) section: Section,
    pub(super) methods: Vec<Efficiency>,
}

pub(super) fn study(run: &Run<'_>) -> Result<Speed, Failure> {
    let subject = Lighting::Point.subject(run.resolution());
    let (mut by_lookups, mut by_seconds, mut efficiencies) = (Vec::new(), Vec::new(), Vec::new());
    for (m, method) in compared().into_iter().enumerate() {
        let subject = subject.with("integrator", method.integrator);
        let (mut lookups, mut seconds) = (Vec::new(), Vec::new());
        for (k, &rays) in RAYS.iter().enumerate() {
            let rays = if run.options.quick { (rays / 4).max(2) } else { rays };
            let image = subject.measure(rays, (run.seed(20 + m as u64, k as u64), REPLICAS), &run.library)?;
            let error = image.squared_error();
            let rmse = error.map(f64::sqrt);
            lookups.push(Mark::measured(image.lookups_per_pixel(), rmse.value, rmse.interval));
            seconds.push(Mark::measured(image.seconds(), rmse.value, rmse.interval));
            if k + 1 == RAYS.len() {
                let (time, looked_up) = (image.seconds(), image.lookups_per_pixel());
                efficiencies.push(Efficiency {
                    name: method.name,
                    per_second: error.map(|error| 1.0 / (error * time)),
                    per_lookup: error.map(|error| 1.0 / (error * looked_up)),
                });
            }
            run.progress.advance();
        }
        let curve = |marks: Vec<Mark>| {
            let line: Vec<(f64, f64)> = marks.iter().map(|mark| (mark.x, mark.y)).collect();
            Curve::method(method.name).with_line(line).with_marks(marks)
        };
        by_lookups.push(curve(lookups));
        by_seconds.push(curve(seconds));
    }
    Ok(Speed { section: section(by_lookups, by_seconds, &efficiencies), methods: efficiencies })
}

fn section(by_lookups: Vec<Curve>, by_seconds: Vec<Curve>, efficiencies: &[Efficiency]) -> Section {
    let mut section = Section::new("speed", "Speed against error");
    section.text = vec![
        "The scene with the strong point light. The error is the sample variance of a pixel over its number of rays, averaged over all \
         pixels. Transmittance in closed form costs no look-up and has no variance; what remains is where along the ray scattering is \
         evaluated, and stratified samples of a smooth integrand settle that faster than 1/√n."
            .to_owned(),
    ];
    let chart = |id: &str, title: &str, x: &str, curves: Vec<Curve>| {
        let mut chart = Chart::new(id, title, Axis::logarithmic(x), Axis::logarithmic("RMSE [radiance]"));
        chart.curves = curves;
        chart
    };
    section.charts = vec![
        chart("speed-lookups", "Error against look-ups", "look-ups per pixel [1]", by_lookups),
        chart("speed-seconds", "Error against time", "CPU seconds of an image [s]", by_seconds),
    ];
    let mut table = Table::new(
        "speed-table",
        "Efficiency",
        "At the largest number of rays. Per CPU second: on two cores an image takes half of that time.",
        &[
            ("method", ""),
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
    section.tables = vec![table];
    section
}
