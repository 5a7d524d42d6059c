//! What distances look like: the density of the first collision, sampled with and without weights, and what that costs.

use crate::Failure;
use crate::report::document::{Axis, Cell, Chart, Curve, Mark, Section, Table};
use crate::report::run::Run;
use fairflight_collision::Version;
use fairflight_freeflight::{Flight, FreeFlight, Newton, Tracking, Woodcock};
use fairflight_media::{AnalyticCosine, Constant, Counted, Extinction, OpticalThickness, Ray};
use fairflight_sources::Seeded;
use glam::DVec3;
use std::time::Instant;

/// Cells of the histogram.
const CELLS: usize = 60;
/// Sampling extinctions of the weighted flights.
const SAMPLING: [f64; 3] = [0.5, 0.8, 1.5];

pub(super) fn steps() -> u64 {
    2 + SAMPLING.len() as u64
}

/// A histogram of one sampler, and its cost.
struct Histogram {
    name: String,
    /// Mean density in each cell, and its standard error.
    cells: Vec<(f64, f64)>,
    lookups: f64,
    nanoseconds: f64,
    /// E[weight²] of all flights.
    squared_weight: f64,
}

pub(super) fn study(run: &Run<'_>) -> Result<Section, Failure> {
    let bounds = AnalyticCosine::default_bounds();
    let clip = bounds.clip(DVec3::ZERO, DVec3::Z, None).map_err(Failure::refused)?;
    let clip = clip.ok_or_else(|| Failure::refused("the ray misses its medium"))?;
    let ray = Ray::new(AnalyticCosine::new(1.0).map_err(Failure::refused)?, &clip);
    let length = ray.length();
    let flights = if run.options.quick { 100_000 } else { 1_000_000 };
    let constant = |value| Constant::new(value, length).map_err(Failure::refused);

    let mut histograms = vec![
        histogram(run, "Newton's method", (&ray, &Newton), (flights, 0)),
        histogram(run, "Woodcock, majorant 1", (&ray, &Woodcock::new(constant(1.0)?)), (flights, 1)),
    ];
    for (k, &sigma_samp) in SAMPLING.iter().enumerate() {
        let sampler = Tracking::new(Version::Adaptive, constant(sigma_samp)?);
        let name = format!("adaptive, σ_samp {sigma_samp}");
        histograms.push(histogram(run, &name, (&ray, &sampler), (flights, 2 + k as u64)));
    }
    Ok(section(&ray, &histograms, flights))
}

fn histogram<'f, E: FreeFlight<&'f Ray<AnalyticCosine>> + FreeFlight<Counted<&'f Ray<AnalyticCosine>>>>(
    run: &Run<'_>,
    name: &str,
    (ray, sampler): (&'f Ray<AnalyticCosine>, &E),
    (flights, index): (u64, u64),
) -> Histogram {
    let length = ray.length();
    let seed = run.seed(2, index);
    let (mut sums, mut squares) = ([0.0; CELLS], [0.0; CELLS]);
    let mut squared_weight = 0.0;
    let clock = Instant::now();
    let mut source = Seeded::new(seed);
    for _ in 0..flights {
        let flight = sampler.sample(&ray, &mut source);
        squared_weight += flight.weight() * flight.weight();
        if let Flight::Collided { distance, weight } = flight {
            let cell = ((distance / length * CELLS as f64) as usize).min(CELLS - 1);
            sums[cell] += weight;
            squares[cell] += weight * weight;
        }
    }
    let nanoseconds = clock.elapsed().as_secs_f64() / flights as f64 * 1e9;
    // Look-ups are counted apart, so that the timed loop does not.
    let counted = Counted::new(ray);
    let mut source = Seeded::new(seed);
    let few = flights / 10;
    for _ in 0..few {
        sampler.sample(&counted, &mut source);
    }
    let n = flights as f64;
    let per_cell = CELLS as f64 / length;
    let cells = sums
        .iter()
        .zip(squares)
        .map(|(sum, square)| {
            let mean = sum / n;
            (mean * per_cell, ((square / n - mean * mean) / n).sqrt() * per_cell)
        })
        .collect();
    run.advance();
    Histogram {
        name: name.to_owned(),
        cells,
        lookups: counted.lookups() as f64 / few as f64,
        nanoseconds,
        squared_weight: squared_weight / n,
    }
}

fn section(ray: &Ray<AnalyticCosine>, histograms: &[Histogram], flights: u64) -> Section {
    let length = ray.length();
    let width = length / CELLS as f64;
    let escape = |s: f64| (-ray.optical_thickness(0.0, s)).exp();
    let middle = |cell: usize| (cell as f64 + 0.5) * width;
    let exact = (0..CELLS).map(|cell| {
        let (from, to) = (cell as f64 * width, (cell + 1) as f64 * width);
        (middle(cell), (escape(from) - escape(to)) / width)
    });
    let mut chart = Chart::new(
        "distances-density",
        "Density of the first collision",
        Axis::linear("distance [length]"),
        Axis::linear("density [1/length]"),
    );
    chart.caption = format!(
        "The ray through the center of szirmay-kalos-2017 eq. 21, {flights} flights each. The line is σ_t T in closed form, averaged over \
         cells of {width:.3}; weighted flights count with their weight."
    );
    chart.curves = histograms
        .iter()
        .map(|histogram| {
            let marks = histogram.cells.iter().enumerate().map(|(cell, &(density, error))| {
                Mark::measured(middle(cell), density, [density - 1.96 * error, density + 1.96 * error])
            });
            Curve::method(&histogram.name).with_marks(marks)
        })
        .collect();
    chart.curves.push(Curve::reference("σ_t T, exact", exact));
    let mut table = Table::new(
        "distances-cost",
        "What a flight costs",
        "The squared weight is 1 for flights without weights; what is above it is variance that every score inherits.",
        &[("sampler", ""), ("look-ups per flight", "1"), ("E[weight²]", "1"), ("time per flight", "ns")],
    );
    for histogram in histograms {
        table.rows.push(vec![
            Cell::text(&*histogram.name),
            Cell::Number(histogram.lookups),
            Cell::Number(histogram.squared_weight),
            Cell::Number(histogram.nanoseconds),
        ]);
    }
    let mut section = Section::new("distances", "Distances with and without weights");
    section.charts = vec![chart];
    section.tables = vec![table];
    section
}
