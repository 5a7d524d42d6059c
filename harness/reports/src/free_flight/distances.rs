//! What distances look like: the density of the first collision, sampled with and without weights, and what that costs.

use crate::measured::Measured;
use crate::run::Run;
use cpu_time::ThreadTime;
use fairflight_collision::Version;
use fairflight_document::{Axis, Cell, Chart, Curve, Section, Table};
use fairflight_freeflight::{Flight, FreeFlight, Newton, Tracking, Woodcock};
use fairflight_harness::Failure;
use fairflight_media::{AnalyticCosine, Constant, Counted, Extinction, OpticalThickness, Ray};
use fairflight_sources::Seeded;
use fairflight_stats::Moments;
use glam::DVec3;

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
    /// Density in each cell.
    cells: Vec<Measured>,
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
    let flights = run.quick_or(100_000, 1_000_000);
    let constant = |value| Constant::new(value, length).map_err(Failure::refused);

    let mut histograms = vec![
        histogram(run, "Newton's method", (&ray, &Newton), flights),
        histogram(run, "Woodcock, majorant 1", (&ray, &Woodcock::new(constant(1.0)?)), flights),
    ];
    for &sigma_samp in &SAMPLING {
        let sampler = Tracking::new(Version::Adaptive, constant(sigma_samp)?);
        let name = format!("adaptive, σ_samp {sigma_samp}");
        histograms.push(histogram(run, &name, (&ray, &sampler), flights));
    }
    Ok(section(&ray, &histograms, flights))
}

fn histogram<'f, E: FreeFlight<&'f Ray<AnalyticCosine>> + FreeFlight<Counted<&'f Ray<AnalyticCosine>>>>(
    run: &Run<'_>,
    name: &str,
    (ray, sampler): (&'f Ray<AnalyticCosine>, &E),
    flights: u64,
) -> Histogram {
    let length = ray.length();
    let seed = run.seed(format_args!("distances/{name}"));
    let mut weights = [Moments::new(); CELLS];
    let mut squared_weight = 0.0;
    let clock = ThreadTime::now();
    let mut source = Seeded::new(seed);
    for _ in 0..flights {
        let flight = sampler.sample(&ray, &mut source);
        squared_weight += flight.weight() * flight.weight();
        if let Flight::Collided { distance, weight } = flight {
            let cell = ((distance / length * CELLS as f64) as usize).min(CELLS - 1);
            weights[cell].push(weight);
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
    let density = |weights: &Moments| {
        // All that did not end in the cell count as 0 there.
        let all = weights.with_zeros(flights - weights.count());
        let of = |value: Option<f64>| value.unwrap_or(f64::NAN) * per_cell;
        Measured::normal(of(all.mean()), of(all.standard_error()))
    };
    let cells = weights.iter().map(density).collect();
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
    let chart = Chart::new(
            "distances-density",
            "Density of the first collision",
            Axis::linear("distance [length]"),
            Axis::linear("density [1/length]"),
        ).with_caption(format!(
            "The ray through the center of szirmay-kalos-2017 eq. 21, {flights} flights each. The line is σ_t T in closed form, averaged over \
             cells of {width:.3}; weighted flights count with their weight."
        )).with_curves(histograms
            .iter()
            .map(|histogram| {
                let marks = histogram.cells.iter().enumerate();
                let marks = marks.map(|(cell, density)| density.mark(middle(cell)));
                Curve::method(&histogram.name).with_marks(marks)
            })
            .chain([Curve::reference("σ_t T, exact", exact)])
            .collect());
    let table = Table::of(
        [
            "distances-cost",
            "What a flight costs",
            "The squared weight is 1 for flights without weights; what is above it is variance that every score inherits.",
        ],
        histograms,
        &[
            ("sampler", "", &|histogram| Cell::text(&*histogram.name)),
            ("look-ups per flight", "1", &|histogram| Cell::Number(histogram.lookups)),
            ("E[weight²]", "1", &|histogram| Cell::Number(histogram.squared_weight)),
            ("time per flight", "ns", &|histogram| Cell::Number(histogram.nanoseconds)),
        ],
    );
    Section::new("distances", "Distances with and without weights").with(chart).with(table)
}
