//! Fig. 6: the three versions of the single particle model over the sampling extinction, at 100 rays per pixel.

use super::{REPLICAS, scenes};
use crate::Failure;
use crate::report::document::{
    Axis, Band, Cell, Chart, Gallery, GalleryRow, Mark, Picture, Pixels, Section, Table, Vertical,
};
use crate::report::replicas::{Measured, Replicas, Subject};
use crate::report::run::Run;
use crate::report::speed::curve as joined;

/// What lights the medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lighting {
    /// The same radiance from everywhere.
    Even,
    /// A sky with a sun.
    Sun,
}

impl Lighting {
    fn id(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Sun => "sun",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Even => "an even environment of radiance 1",
            Self::Sun => "a sky with a sun (high dynamic range)",
        }
    }
}

/// A version by its key in a scene, its name, and the least σ_samp at which it is defined on eq. 21.
const VERSIONS: [(&str, &str, f64); 3] = [
    ("adaptive", "adaptive", 0.0),
    ("non_terminating", "non-terminating", 0.0),
    // r = 1/σ_samp reaches 2/(1 + a) at 0.85.
    ("terminating", "terminating", 0.86),
];

/// Sampling extinctions; the greatest extinction is 1.
const SAMPLING: [f64; 11] = [0.6, 0.65, 0.7, 0.75, 0.8, 0.86, 0.93, 1.0, 1.2, 1.5, 2.0];
/// Those whose images are shown.
const SHOWN: [f64; 5] = [0.6, 0.8, 1.0, 1.2, 2.0];
/// Rays per pixel, as in the paper.
const RAYS: u32 = 100;

/// Measurements of one lighting.
pub(super) fn steps() -> u64 {
    (VERSIONS.len() * SAMPLING.len()) as u64
}

/// One version at one sampling extinction.
#[derive(Debug)]
pub(super) struct Point {
    pub(super) sigma_samp: f64,
    pub(super) squared_error: Measured,
    pub(super) lookups: f64,
    /// 1/(squared error · look-ups per pixel).
    pub(super) merit: Measured,
    image: Replicas,
}

/// A version over the sampling extinction.
#[derive(Debug)]
pub(super) struct Sweep {
    pub(super) name: &'static str,
    pub(super) points: Vec<Point>,
}

impl Sweep {
    /// The point of the greatest merit, and the range of those that cannot be told from it.
    pub(super) fn optimum(&self) -> (&Point, [f64; 2]) {
        let best = self
            .points
            .iter()
            .max_by(|a, b| a.merit.value.total_cmp(&b.merit.value))
            .expect("every version is defined somewhere");
        let close = || self.points.iter().filter(|point| !point.merit.is_below(&best.merit));
        let low = close().map(|point| point.sigma_samp).fold(f64::INFINITY, f64::min);
        let high = close().map(|point| point.sigma_samp).fold(0.0, f64::max);
        (best, [low, high])
    }

    /// The point at this sampling extinction.
    pub(super) fn at(&self, sigma_samp: f64) -> Option<&Point> {
        self.points.iter().find(|point| point.sigma_samp == sigma_samp)
    }
}

/// What one lighting came to.
#[derive(Debug)]
pub(super) struct Versions {
    pub(super) sweeps: Vec<Sweep>,
    pub(super) section: Section,
}

/// Measures all versions under one lighting.
pub(super) fn study(run: &Run<'_>, lighting: Lighting) -> Result<Versions, Failure> {
    let subject = match lighting {
        Lighting::Even => scenes::evenly_lit(run.resolution()),
        Lighting::Sun => scenes::under_the_sun(run.resolution()),
    };
    let mut sweeps = Vec::new();
    for (v, &(key, name, least)) in VERSIONS.iter().enumerate() {
        let mut points = Vec::new();
        for (k, &sigma_samp) in SAMPLING.iter().enumerate() {
            if sigma_samp >= least {
                let seed = run.seed(lighting as u64, (v * SAMPLING.len() + k) as u64);
                points.push(point(run, &subject, (key, sigma_samp), seed)?);
            }
            run.advance();
        }
        sweeps.push(Sweep { name, points });
    }
    let section = section(run, lighting, &sweeps);
    Ok(Versions { sweeps, section })
}

fn point(
    run: &Run<'_>,
    subject: &Subject,
    (version, sigma_samp): (&str, f64),
    seed: u64,
) -> Result<Point, Failure> {
    let subject = subject.with("integrator.version", version).with("integrator.sigma_samp", sigma_samp);
    let image = subject
        // Below 0.7 of the maximum the growth is measured in a section of its own.
        .with("integrator.allow_supercritical", true)
        .measure(run.samples(RAYS), (seed, REPLICAS), &run.media)?;
    let (squared_error, lookups) = (image.squared_error(), image.lookups_per_pixel());
    let merit = squared_error.map(|error| 1.0 / (error * lookups));
    Ok(Point { sigma_samp, squared_error, lookups, merit, image })
}

fn section(run: &Run<'_>, lighting: Lighting, sweeps: &[Sweep]) -> Section {
    let id = |what: &str| format!("{}-{what}", lighting.id());
    let mut section =
        Section::new(&id("versions"), &format!("Fig. 6: three versions under {}", lighting.words()));
    section.text = vec![format!(
        "szirmay-kalos-2017 eq. 21 with albedo 0.7 and Rayleigh scattering, {0} x {0} pixels, {1} rays per pixel. The mean squared error \
         is the sample variance of a pixel over its number of rays, averaged over all pixels; look-ups are those per pixel, averaged over \
         all. The figure of merit is 1/(mean squared error · look-ups). Intervals are 95 %, from {2} independent images. The terminating \
         version is defined from σ_samp = 0.85 on, where r = 2/(1 + a).",
        run.resolution(),
        run.samples(RAYS),
        REPLICAS
    )];
    let x = || Axis::logarithmic("σ_samp [1/length]");
    let curve = |sweep: &Sweep, value: fn(&Point) -> Mark| {
        joined(sweep.name, sweep.points.iter().map(value).collect())
    };
    let error = |point: &Point| {
        Mark::measured(point.sigma_samp, point.squared_error.value, point.squared_error.interval)
    };
    let lookups = |point: &Point| Mark::at(point.sigma_samp, point.lookups);
    let merit = |point: &Point| Mark::measured(point.sigma_samp, point.merit.value, point.merit.interval);
    let mut chart = |what: &str, title: &str, y: Axis, caption: String, value: fn(&Point) -> Mark| {
        let mut chart = Chart::new(&id(what), title, x(), y);
        chart.caption = caption;
        chart.curves = sweeps.iter().map(|sweep| curve(sweep, value)).collect();
        chart.verticals = vec![Vertical { x: 1.0, label: "greatest σ_t".to_owned() }];
        section.charts.push(chart);
    };
    chart(
        "error",
        "Error against σ_samp",
        Axis::logarithmic("mean squared error [radiance²]"),
        String::new(),
        error,
    );
    chart(
        "lookups",
        "Look-ups against σ_samp",
        Axis::linear("look-ups per pixel [1]"),
        String::new(),
        lookups,
    );
    let (best, range) = sweeps[0].optimum();
    let caption = format!(
        "The adaptive version has its optimum at σ_samp = {}; values from {} to {} cannot be told from it.",
        best.sigma_samp, range[0], range[1]
    );
    chart(
        "merit",
        "Figure of merit against σ_samp",
        Axis::logarithmic("1/(MSE · look-ups) [1/radiance²]"),
        caption,
        merit,
    );
    if let Some(chart) = section.charts.last_mut()
        && range[0] < range[1]
    {
        chart.bands = vec![Band { from: range[0], to: range[1], label: "optimum, adaptive".to_owned() }];
    }
    section.tables = vec![table(&id("table"), sweeps)];
    section.galleries = vec![gallery(&id("images"), lighting, sweeps)];
    section
}

fn table(id: &str, sweeps: &[Sweep]) -> Table {
    let mut table = Table::new(
        id,
        "Error, look-ups and figure of merit",
        "Per pixel, averaged over all.",
        &[
            ("version", ""),
            ("σ_samp", "1/length"),
            ("MSE", "radiance²"),
            ("look-ups per pixel", "1"),
            ("1/(MSE · look-ups)", "1/radiance²"),
            ("CPU seconds of an image", "s"),
        ],
    );
    for sweep in sweeps {
        for point in &sweep.points {
            table.rows.push(vec![
                Cell::text(sweep.name),
                Cell::Number(point.sigma_samp),
                Cell::measured(point.squared_error.value, point.squared_error.interval),
                Cell::Number(point.lookups),
                Cell::measured(point.merit.value, point.merit.interval),
                Cell::Number(point.image.seconds()),
            ]);
        }
    }
    table
}

fn gallery(id: &str, lighting: Lighting, sweeps: &[Sweep]) -> Gallery {
    let rows = sweeps
        .iter()
        .map(|sweep| GalleryRow {
            label: sweep.name.to_owned(),
            pictures: SHOWN
                .iter()
                .filter_map(|&sigma_samp| sweep.at(sigma_samp))
                .map(|point| Picture {
                    id: format!("{id}-{}-{}", sweep.name, point.sigma_samp),
                    label: format!("σ_samp {}", point.sigma_samp),
                    lines: vec![
                        format!("MSE {:.2e}", point.squared_error.value),
                        format!("{:.0} look-ups", point.lookups),
                    ],
                    resolution: point.image.first().resolution(),
                    pixels: Pixels::Radiance {
                        values: point.image.first().means().to_vec(),
                        exposure: if lighting == Lighting::Even { 1.0 } else { 0.5 },
                    },
                })
                .collect(),
        })
        .collect();
    Gallery {
        id: id.to_owned(),
        title: "The images".to_owned(),
        caption: "One image of each measurement. Below σ_samp = 1 energies grow and turn negative: bright and black specks.".to_owned(),
        rows,
    }
}
