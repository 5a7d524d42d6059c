//! Fig. 7: twelve octaves of noise at 500 look-ups per pixel, whatever the sampling extinction.

use super::{REPLICAS, scenes};
use crate::Failure;
use crate::report::document::{
    Axis, Band, Cell, Chart, Gallery, GalleryRow, Mark, Picture, Pixels, Section, Table, Vertical,
};
use crate::report::replicas::{Measured, Replicas};
use crate::report::run::Run;
use crate::report::speed::curve;

/// Sampling extinctions; the greatest extinction is 1, that of the larger dense regions about 0.6.
const SAMPLING: [f64; 9] = [0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.85, 1.0];
/// Those whose images are shown.
const SHOWN: [f64; 5] = [0.3, 0.4, 0.5, 0.6, 1.0];
/// Look-ups per pixel, as in the paper.
const LOOKUPS: f64 = 500.0;

pub(super) fn steps() -> u64 {
    SAMPLING.len() as u64
}

/// One sampling extinction at the budget.
#[derive(Debug)]
pub(super) struct Point {
    pub(super) sigma_samp: f64,
    pub(super) rmse: Measured,
    image: Replicas,
}

/// What the noise came to.
#[derive(Debug)]
pub(super) struct EqualCost {
    pub(super) points: Vec<Point>,
    pub(super) section: Section,
}

impl EqualCost {
    /// The point of the least error, and the range of those that cannot be told from it.
    pub(super) fn optimum(&self) -> (&Point, [f64; 2]) {
        optimum(&self.points)
    }
}

fn optimum(points: &[Point]) -> (&Point, [f64; 2]) {
    let best = points.iter().min_by(|a, b| a.rmse.value.total_cmp(&b.rmse.value)).expect("there are points");
    let close = || points.iter().filter(|point| !best.rmse.is_below(&point.rmse));
    let low = close().map(|point| point.sigma_samp).fold(f64::INFINITY, f64::min);
    (best, [low, close().map(|point| point.sigma_samp).fold(0.0, f64::max)])
}

pub(super) fn study(run: &Run<'_>) -> Result<EqualCost, Failure> {
    // Noise is expensive to look up: the budget per pixel stays, the image is smaller.
    let resolution = run.resolution() / 2;
    let subject = scenes::noise(resolution);
    let budget = if run.options.quick { LOOKUPS / 10.0 } else { LOOKUPS };
    let mut points = Vec::new();
    for (k, &sigma_samp) in SAMPLING.iter().enumerate() {
        let subject =
            subject.with("integrator.sigma_samp", sigma_samp).with("integrator.allow_supercritical", true);
        // How many look-ups a ray takes is found out first, with variates of its own.
        let pilot = subject.render(2, run.seed(10, k as u64), &run.media)?;
        let rays = (2.0 * budget / pilot.lookups_per_pixel()).round().max(2.0) as u32;
        let image = subject.measure(rays, (run.seed(11, k as u64), REPLICAS), &run.media)?;
        // What the rounded number of rays leaves of the budget scales the error as more rays would.
        let to_budget = image.lookups_per_pixel() / budget;
        let rmse = image.squared_error().map(|error| (error * to_budget).sqrt());
        points.push(Point { sigma_samp, rmse, image });
        run.advance();
    }
    let section = section(&points, budget, resolution);
    Ok(EqualCost { points, section })
}

fn section(points: &[Point], budget: f64, resolution: u32) -> Section {
    let mut section = Section::new("noise", &format!("Fig. 7: Perlin noise at {budget} look-ups per pixel"));
    section.text = vec![format!(
        "max(0, 0.25 + 0.75 fBm) with twelve octaves in the sphere of eq. 21: the greatest extinction is 1, that of the larger dense \
         regions about 0.6 (the paper's parameters are not printed). Albedo 0.9, Rayleigh scattering, environment 1, adaptive version, \
         {resolution} x {resolution} pixels. Each image spends {budget} look-ups per pixel on average over all pixels; the number of rays \
         follows."
    )];
    let mut chart = Chart::new(
        "noise-error",
        "Error at equal cost against σ_samp",
        Axis::logarithmic("σ_samp [1/length]"),
        Axis::logarithmic("RMSE [radiance]"),
    );
    let (best, range) = optimum(points);
    chart.caption = format!(
        "The least error is at σ_samp = {}; values from {} to {} cannot be told from it.",
        best.sigma_samp, range[0], range[1]
    );
    let marks: Vec<Mark> = points
        .iter()
        .map(|point| Mark::measured(point.sigma_samp, point.rmse.value, point.rmse.interval))
        .collect();
    chart.curves = vec![curve("adaptive", marks)];
    chart.verticals = vec![
        Vertical { x: 0.6, label: "dense regions".to_owned() },
        Vertical { x: 1.0, label: "greatest σ_t".to_owned() },
    ];
    if range[0] < range[1] {
        chart.bands = vec![Band { from: range[0], to: range[1], label: "optimum".to_owned() }];
    }
    section.charts = vec![chart];
    let mut table = Table::new(
        "noise-table",
        "Rays and error at equal cost",
        "",
        &[("σ_samp", "1/length"), ("rays per pixel", "1"), ("look-ups per pixel", "1"), ("RMSE", "radiance")],
    );
    for point in points {
        table.rows.push(vec![
            Cell::Number(point.sigma_samp),
            Cell::Count(u64::from(point.image.rays_per_pixel())),
            Cell::Number(point.image.lookups_per_pixel()),
            Cell::measured(point.rmse.value, point.rmse.interval),
        ]);
    }
    section.tables = vec![table];
    let shown = points.iter().filter(|point| SHOWN.contains(&point.sigma_samp));
    section.galleries = vec![Gallery {
        id: "noise-images".to_owned(),
        title: "The images".to_owned(),
        caption: "One image of each measurement.".to_owned(),
        rows: vec![GalleryRow {
            label: String::new(),
            pictures: shown
                .map(|point| Picture {
                    id: format!("noise-{}", point.sigma_samp),
                    label: format!("σ_samp {}", point.sigma_samp),
                    lines: vec![
                        format!("RMSE {:.3}", point.rmse.value),
                        format!("{} rays", point.image.rays_per_pixel()),
                    ],
                    resolution: point.image.first().resolution(),
                    pixels: Pixels::Radiance { values: point.image.first().means().to_vec(), exposure: 1.0 },
                })
                .collect(),
        }],
    }];
    section
}
