//! Fig. 6: the three versions of the single particle model over the sampling extinction, at 100 rays per pixel.

use super::{REPLICAS, scenes};
use crate::measured::{Measured, least, optimum_caption};
use crate::replicas::{Replicas, Subject};
use crate::run::Run;
use fairflight_document::{Axis, Band, Cell, Chart, Curve, Gallery, Mark, Section, Table, Vertical};
use fairflight_harness::Failure;

/// Light around the medium.
#[derive(Debug)]
pub(super) struct Lighting {
    id: &'static str,
    words: &'static str,
    subject: fn(u32) -> Subject,
    /// Exposure of the images that makes them neither black nor white.
    exposure: f64,
}

/// The same radiance from everywhere.
pub(super) const EVEN: Lighting = Lighting {
    id: "even",
    words: "an even environment of radiance 1",
    subject: scenes::evenly_lit,
    exposure: 1.0,
};

/// A sky with a sun.
pub(super) const SUN: Lighting = Lighting {
    id: "sun",
    words: "a sky with a sun (high dynamic range)",
    subject: scenes::under_the_sun,
    exposure: 0.5,
};

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
    /// Squared error · look-ups per pixel.
    cost: Measured,
    image: Replicas,
}

impl Point {
    fn merit(&self) -> Measured {
        self.cost.map(f64::recip)
    }
}

/// A version over the sampling extinction.
#[derive(Debug)]
pub(super) struct Sweep {
    pub(super) name: &'static str,
    pub(super) points: Vec<Point>,
}

impl Sweep {
    /// The point of the greatest merit (the least cost), and the range of those that cannot be told from it.
    pub(super) fn optimum(&self) -> (&Point, [f64; 2]) {
        least(&self.points, |point| &point.cost, |point| point.sigma_samp)
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
pub(super) fn study(run: &Run<'_>, lighting: &Lighting) -> Result<Versions, Failure> {
    let subject = (lighting.subject)(run.resolution());
    let mut sweeps = Vec::new();
    for &(key, name, least) in &VERSIONS {
        let mut points = Vec::new();
        for &sigma_samp in &SAMPLING {
            if sigma_samp >= least {
                let seed = run.seed(format_args!("versions/{}/{key}/{sigma_samp}", lighting.id));
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
    let cost = squared_error.map(|error| error * lookups);
    Ok(Point { sigma_samp, squared_error, lookups, cost, image })
}

fn section(run: &Run<'_>, lighting: &Lighting, sweeps: &[Sweep]) -> Section {
    let id = |what: &str| format!("{}-{what}", lighting.id);
    let text = format!(
        "szirmay-kalos-2017 eq. 21 with albedo 0.7 and Rayleigh scattering, {0} x {0} pixels, {1} rays per pixel. The mean squared error \
         is the sample variance of a pixel over its number of rays, averaged over all pixels; look-ups are those per pixel, averaged over \
         all. The figure of merit is 1/(mean squared error · look-ups). Intervals are 95 %, from {2} independent images. The terminating \
         version is defined from σ_samp = 0.85 on, where r = 2/(1 + a).",
        run.resolution(),
        run.samples(RAYS),
        REPLICAS
    );
    let chart = |what: &str, title: &str, y: Axis, value: fn(&Point) -> Mark| {
        Chart::new(&id(what), title, Axis::logarithmic("σ_samp [1/length]"), y)
            .with_curves(
                sweeps
                    .iter()
                    .map(|sweep| Curve::joined(sweep.name, sweep.points.iter().map(value)))
                    .collect(),
            )
            .with_verticals(vec![Vertical { x: 1.0, label: "greatest σ_t".to_owned() }])
    };
    let (best, range) = sweeps[0].optimum();
    let merit = chart(
        "merit",
        "Figure of merit against σ_samp",
        Axis::logarithmic("1/(MSE · look-ups) [1/radiance²]"),
        |point| point.merit().mark(point.sigma_samp),
    )
    .with_caption(optimum_caption("The adaptive version has its optimum", best.sigma_samp, range))
    .with_bands(Band::between(range, "optimum, adaptive").into_iter().collect());
    Section::new(&id("versions"), &format!("Fig. 6: three versions under {}", lighting.words))
        .with(text)
        .with(chart(
            "error",
            "Error against σ_samp",
            Axis::logarithmic("mean squared error [radiance²]"),
            |point| point.squared_error.mark(point.sigma_samp),
        ))
        .with(chart("lookups", "Look-ups against σ_samp", Axis::linear("look-ups per pixel [1]"), |point| {
            Mark::at(point.sigma_samp, point.lookups)
        }))
        .with(merit)
        .with(table(&id("table"), sweeps))
        .with(gallery(&id("images"), lighting, sweeps))
}

fn table(id: &str, sweeps: &[Sweep]) -> Table {
    let rows = sweeps.iter().flat_map(|sweep| sweep.points.iter().map(move |point| (sweep.name, point)));
    Table::of(
        [id, "Error, look-ups and figure of merit", "Per pixel, averaged over all."],
        rows,
        &[
            ("version", "", &|(version, _)| Cell::text(*version)),
            ("σ_samp", "1/length", &|(_, point)| Cell::Number(point.sigma_samp)),
            ("MSE", "radiance²", &|(_, point)| point.squared_error.cell()),
            ("look-ups per pixel", "1", &|(_, point)| Cell::Number(point.lookups)),
            ("1/(MSE · look-ups)", "1/radiance²", &|(_, point)| point.merit().cell()),
            ("CPU seconds of an image", "s", &|(_, point)| Cell::Number(point.image.seconds())),
        ],
    )
}

fn gallery(id: &str, lighting: &Lighting, sweeps: &[Sweep]) -> Gallery {
    let row = |sweep: &Sweep| {
        let picture = |point: &Point| {
            let lines = vec![
                format!("MSE {:.2e}", point.squared_error.value),
                format!("{:.0} look-ups", point.lookups),
            ];
            let sigma_samp = point.sigma_samp;
            let name = format!("{id}-{}-{sigma_samp}", sweep.name);
            point.image.picture(name, format!("σ_samp {sigma_samp}"), lines, lighting.exposure)
        };
        let shown = SHOWN.iter().filter_map(|&sigma_samp| sweep.at(sigma_samp));
        (sweep.name.to_owned(), shown.map(picture).collect())
    };
    let caption = "One image of each measurement. Below σ_samp = 1 energies grow and turn negative: bright and black specks.";
    Gallery::of_images(id, "The images", sweeps.iter().map(row).collect()).with_caption(caption)
}
