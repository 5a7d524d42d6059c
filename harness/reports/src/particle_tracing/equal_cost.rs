//! Fig. 7: twelve octaves of noise at 500 look-ups per pixel, whatever the sampling extinction.

use super::{REPLICAS, scenes};
use crate::measured::{Measured, least, optimum_caption};
use crate::replicas::Replicas;
use crate::run::Run;
use fairflight_document::{Axis, Band, Cell, Chart, Curve, Gallery, Section, Table, Vertical};
use fairflight_harness::Failure;

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
    least(points, |point| &point.rmse, |point| point.sigma_samp)
}

pub(super) fn study(run: &Run<'_>) -> Result<EqualCost, Failure> {
    // Noise is expensive to look up: the budget per pixel stays, the image is smaller.
    let resolution = run.resolution() / 2;
    let subject = scenes::noise(resolution);
    let budget = run.quick_or(LOOKUPS / 10.0, LOOKUPS);
    let mut points = Vec::new();
    for &sigma_samp in &SAMPLING {
        let subject =
            subject.with("integrator.sigma_samp", sigma_samp).with("integrator.allow_supercritical", true);
        let seed = |what: &str| run.seed(format_args!("noise/{sigma_samp}/{what}"));
        // How many look-ups a ray takes is found out first, with variates of its own.
        let pilot = subject.render(2, seed("pilot"), &run.media)?;
        let rays = (2.0 * budget / pilot.lookups_per_pixel()).round().max(2.0) as u32;
        let image = subject.measure(rays, (seed("images"), REPLICAS), &run.media)?;
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
    let text = format!(
        "max(0, 0.25 + 0.75 fBm) with twelve octaves in the sphere of eq. 21: the greatest extinction is 1, that of the larger dense \
         regions about 0.6 (the paper's parameters are not printed). Albedo 0.9, Rayleigh scattering, environment 1, adaptive version, \
         {resolution} x {resolution} pixels. Each image spends {budget} look-ups per pixel on average over all pixels; the number of rays \
         follows."
    );
    let (best, range) = optimum(points);
    let chart = Chart::new(
        "noise-error",
        "Error at equal cost against σ_samp",
        Axis::logarithmic("σ_samp [1/length]"),
        Axis::logarithmic("RMSE [radiance]"),
    )
    .with_caption(optimum_caption("The least error is", best.sigma_samp, range))
    .with_curves(vec![Curve::joined(
        "adaptive",
        points.iter().map(|point| point.rmse.mark(point.sigma_samp)),
    )])
    .with_verticals(vec![
        Vertical { x: 0.6, label: "dense regions".to_owned() },
        Vertical { x: 1.0, label: "greatest σ_t".to_owned() },
    ])
    .with_bands(Band::between(range, "optimum").into_iter().collect());
    let table = Table::of(
        ["noise-table", "Rays and error at equal cost", ""],
        points,
        &[
            ("σ_samp", "1/length", &|point| Cell::Number(point.sigma_samp)),
            ("rays per pixel", "1", &|point| Cell::Count(point.image.rays_per_pixel().into())),
            ("look-ups per pixel", "1", &|point| Cell::Number(point.image.lookups_per_pixel())),
            ("RMSE", "radiance", &|point| point.rmse.cell()),
        ],
    );
    let picture = |point: &Point| {
        let lines =
            vec![format!("RMSE {:.3}", point.rmse.value), format!("{} rays", point.image.rays_per_pixel())];
        let sigma_samp = point.sigma_samp;
        point.image.picture(format!("noise-{sigma_samp}"), format!("σ_samp {sigma_samp}"), lines, 1.0)
    };
    let shown = points.iter().filter(|point| SHOWN.contains(&point.sigma_samp)).map(picture);
    Section::new("noise", &format!("Fig. 7: Perlin noise at {budget} look-ups per pixel"))
        .with(text)
        .with(chart)
        .with(table)
        .with(Gallery::of_row("noise-images", "The images", shown.collect()))
}
