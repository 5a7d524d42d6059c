//! The beam radiance estimate (jarosz-2008), with which engelhardt-2013 fig. 12 compares: its bias and its noise by radius and photons, and
//! unbiased methods at equal time.

use super::reference::Reference;
use super::scenes;
use super::strategies::Strategies;
use crate::measured::Measured;
use crate::replicas::Replicas;
use crate::run::Run;
use fairflight_document::{
    Axis, Cell, Chart, Claim, ClaimVerdict, Curve, Gallery, Picture, Pixels, Section, Table,
};
use fairflight_harness::Failure;
use serde_json::json;

/// Independent images per measurement.
const REPLICAS: u32 = 6;
const RADII: [f64; 5] = [0.02, 0.04, 0.08, 0.16, 0.32];
/// Light of surfaces, light paths of a map, and maps of an image by radius: so many that images take alike.
const SERIES: [(&str, u32, [u32; 5]); 4] = [
    ("map", 300, [96, 96, 96, 64, 32]),
    ("map", 3_000, [24, 24, 16, 12, 4]),
    ("map", 30_000, [4, 4, 3, 2, 1]),
    ("path", 300, [48, 48, 48, 32, 24]),
];
/// Light paths of the maps whose bias is shown.
const SHOWN: u32 = 3_000;
/// Samples per pixel of the bidirectional image.
const BIDIRECTIONAL: u32 = 64;
/// CPU seconds of an image at which methods are compared.
const TIMES: [f64; 3] = [0.1, 1.0, 10.0];

pub(super) fn steps() -> u64 {
    (SERIES.len() * RADII.len() + 1) as u64
}

/// One radius and number of photons.
struct Point {
    surfaces: &'static str,
    photons: u32,
    radius: f64,
    /// CPU seconds of a map and of the image by it.
    seconds: f64,
    /// Mean over pixels of the squared bias \[radiance²\].
    bias: Measured,
    /// Variance of an image of one CPU second, likewise \[radiance²\].
    noise: Measured,
    images: Replicas,
}

impl Point {
    fn is_of(&self, surfaces: &str, photons: u32) -> bool {
        (self.surfaces, self.photons) == (surfaces, photons)
    }

    /// Its parameters.
    fn words(&self) -> String {
        let Self { surfaces, photons, radius, .. } = self;
        format!("surfaces by {surfaces}, {photons} light paths, radius {radius}")
    }

    fn of(room: &Reference, (surfaces, photons, radius): (&'static str, u32, f64), images: Replicas) -> Self {
        let seconds = images.seconds();
        let of = |function: &dyn Fn([f64; 2]) -> f64| images.bias_and_variance(&room.shown, function);
        let (bias, noise) =
            (of(&|[bias, _]| bias), of(&|[_, variance]| (variance * seconds).ln()).map(f64::exp));
        let seconds = seconds / f64::from(images.rays_per_pixel());
        Self { surfaces, photons, radius, seconds, bias, noise, images }
    }

    /// Mean squared error of an image of `time` CPU seconds: bias² + variance/time, where a square below 0 is noise and counts as 0. The ends of
    /// the interval are those of both.
    fn error(&self, time: f64) -> Measured {
        let sum = |bias: f64, noise: f64| bias.max(0.0) + noise / time;
        let (bias, noise) = (&self.bias, &self.noise);
        let interval = [0, 1].map(|end| sum(bias.interval[end], noise.interval[end]));
        Measured { value: sum(bias.value, noise.value), interval }
    }

    /// Words for the CPU seconds until an unbiased method of this MSE · CPU seconds has the lesser error; their interval is that of the bias.
    fn until(&self, cost: f64) -> String {
        let ahead = cost - self.noise.value;
        match self.bias.interval.map(|square| ahead / square) {
            _ if ahead <= 0.0 => "never ahead".to_owned(),
            [high, low] if high > 0.0 => {
                format!("ahead for {:.1} [{low:.1}, {high:.1}] s", ahead / self.bias.value)
            }
            [_, low] => format!("ahead for {low:.1} s at least"),
        }
    }
}

/// The sweep, and the unbiased methods beside it with their MSE · CPU seconds.
pub(super) struct Beams {
    points: Vec<Point>,
    rivals: Vec<(&'static str, Measured)>,
}

impl Beams {
    /// The point of the least error of those whose first map is done in this time.
    fn best(&self, time: f64) -> Option<&Point> {
        let all = self.points.iter().filter(|point| point.seconds <= time);
        all.min_by(|a, b| a.error(time).value.total_cmp(&b.error(time).value))
    }
}

pub(super) fn study(run: &Run<'_>, room: &Reference, strategies: &Strategies) -> Result<Beams, Failure> {
    let subject = scenes::smoke_room(scenes::side(run))?;
    let mut points = Vec::new();
    for (surfaces, photons, maps) in SERIES {
        for (radius, maps) in RADII.into_iter().zip(maps) {
            let beam = json!({ "kind": "beam_radiance", "photons": photons, "radius": radius, "surfaces": surfaces });
            let seed = run.seed(format_args!("beams/{surfaces}/{photons}/{radius}"));
            let images = subject.with("integrator", beam).measure(
                run.quick_or(maps.div_ceil(8), maps),
                (seed, REPLICAS),
                &run.media,
            )?;
            points.push(Point::of(room, (surfaces, photons, radius), images));
            run.advance();
        }
    }
    let both = subject.with("integrator", json!({ "kind": "bidirectional" }));
    let images =
        both.measure(run.samples(BIDIRECTIONAL), (run.seed("beams/bidirectional"), REPLICAS), &run.media)?;
    run.advance();
    let seconds = images.seconds();
    let cost = room.rmse(&images).map(|rmse| rmse * rmse * seconds);
    let of = |name| strategies.of(name).map(|entry| (entry.name, entry.cost));
    let rivals = [of("1-to-1"), Some(("bidirectional", cost)), of("path tracing")];
    let rivals = rivals.into_iter().flatten().collect();
    Ok(Beams { points, rivals })
}

/// The findings, one sentence for each time.
pub(super) fn summary(beams: &Beams) -> Vec<String> {
    let of_time = |&time: &f64| {
        let best = beams.best(time)?;
        let of_rival = |(name, cost): &(&str, Measured)| {
            let ratio = cost.map(|cost| cost / time).over(&best.error(time));
            format!("{name} {} of that ({})", ratio.words(2), best.until(cost.value))
        };
        let rivals: Vec<String> = beams.rivals.iter().map(of_rival).collect();
        Some(format!(
            "In {time} CPU s the best beam radiance estimate ({}) has a mean squared error of {:.1e} radiance²; {}.",
            best.words(),
            best.error(time).value,
            rivals.join(", ")
        ))
    };
    TIMES.iter().filter_map(of_time).collect()
}

/// E7. Criterion: at each of the [`TIMES`] 1-to-1 has more error than the best radius and number of photons, by 95 % intervals.
pub(super) fn e7(beams: &Beams) -> Claim {
    let cost = beams.rivals[0].1;
    let is_ahead = |&time: &f64| {
        let ratio = beams.best(time).map(|best| cost.map(|cost| cost / time).over(&best.error(time)));
        ratio.and_then(|ratio| ratio.exceeds(1.0)) == Some(true)
    };
    let verdict = ClaimVerdict::of_cases(TIMES.iter().map(is_ahead));
    Claim::new(
        ("E7", "engelhardt-2013 4, fig. 12"),
        "At equal time the beam radiance estimate has less error, bias included, than compensated virtual point lights",
        summary(beams).join(" "),
        (
            verdict,
            "Figure 12 prints images and times, and no errors: the claim is ours. Radius and number of photons are the best of a sweep, which whoever \
             renders does not know beforehand.",
        ),
    )
}

pub(super) fn section(run: &Run<'_>, room: &Reference, beams: &Beams) -> Section {
    let text = format!(
        "The room with smoke in gray, {side} x {side} pixels, {REPLICAS} independent images of each radius and number of light paths. Every map is new, \
         so that MSE = bias² + variance/time; both come from the scatter of images and their mean over pixels, less the noise of the images and of the \
         reference, and intervals are 95 % by the jackknife over the images of both. Light that surfaces reflect comes from the photons on them (map), \
         or from paths (path). 1-to-1 and path tracing are those of figure 6.",
        side = scenes::side(run)
    );
    let table = Table::of(
        [
            "beams-table",
            "Bias and noise by radius and light paths",
            "Negative squares of the bias are noise about 0.",
        ],
        &beams.points,
        &[
            ("surfaces", "", &|point| Cell::text(point.surfaces)),
            ("light paths", "1", &|point| Cell::Count(point.photons.into())),
            ("radius", "length", &|point| Cell::Number(point.radius)),
            ("time of a map", "s", &|point| Cell::Number(point.seconds)),
            ("bias²", "radiance²", &|point| point.bias.cell()),
            ("variance · CPU seconds", "radiance² s", &|point| point.noise.cell()),
            ("MSE in 0.1 s", "radiance²", &|point| point.error(TIMES[0]).cell()),
            ("MSE in 1 s", "radiance²", &|point| point.error(TIMES[1]).cell()),
            ("MSE in 10 s", "radiance²", &|point| point.error(TIMES[2]).cell()),
            ("ahead of 1-to-1", "", &|point| Cell::text(point.until(beams.rivals[0].1.value))),
        ],
    );
    let times: Vec<f64> = (-8..=8).map(|k| 10_f64.powf(f64::from(k) / 4.0)).collect();
    let by_radius = RADII.iter().map(|radius| {
        let points = || beams.points.iter().filter(move |point| point.radius == *radius);
        let least = |&time: &f64| {
            let done = points().filter(|point| point.seconds <= time);
            (time, done.map(|point| point.error(time).value).min_by(f64::total_cmp).map(f64::sqrt))
        };
        Curve::method(&format!("radius {radius}")).with_gaps(times.iter().map(least))
    });
    let unbiased = beams.rivals.iter().map(|(name, cost)| {
        Curve::method(name).with_line(times.iter().map(|time| (*time, (cost.value / time).sqrt())))
    });
    let (x, y) = (Axis::logarithmic("CPU seconds of an image [s]"), Axis::logarithmic("RMSE [radiance]"));
    let time = Chart::new("beams-time", "Error over time: the beam radiance estimate by its radius", x, y)
        .with_caption("The best of all numbers of light paths at each time. A bias does not fall.")
        .with_curves(unbiased.chain(by_radius).collect());
    let curve = |label: &str, of: fn(&Point) -> &Measured, (surfaces, photons)| {
        let points = beams.points.iter().filter(|point| point.is_of(surfaces, photons));
        let root = |point: &Point| of(point).map(|square| square.max(0.0).sqrt()).mark(point.radius);
        Curve::joined(label, points.map(root))
    };
    let noise = SERIES.iter().map(|&(surfaces, photons, _)| {
        let label = format!("noise of 1 s, {photons} light paths, surfaces by {surfaces}");
        curve(&label, |point| &point.noise, (surfaces, photons))
    });
    let bias = curve("bias", |point| &point.bias, ("map", SHOWN));
    let (x, y) = (Axis::logarithmic("radius [length]"), Axis::logarithmic("root mean square [radiance]"));
    let split = Chart::new("beams-split", "Bias and noise over the radius", x, y)
        .with_caption("The bias knows no number of light paths.")
        .with_curves([bias].into_iter().chain(noise).collect());
    Section::new("beams", "Fig. 12: the beam radiance estimate, biased, at equal time")
        .with(text)
        .with(time)
        .with(split)
        .with(table)
        .with(gallery(room, beams))
}

/// The difference of mean images from the reference, by radius.
fn gallery(room: &Reference, beams: &Beams) -> Gallery {
    let differences = |point: &Point| {
        let (mean, _) = point.images.mean();
        mean.iter().zip(&room.pixels).map(|(found, exact)| found - exact).collect()
    };
    let difference = |point: &Point| Picture {
        id: format!("beams-{}", point.radius),
        label: format!("radius {}", point.radius),
        lines: vec![format!("bias {:.1e}", point.bias.value.max(0.0).sqrt())],
        resolution: point.images.first().resolution(),
        pixels: Pixels::Signed { values: differences(point), scale: 0.3 * room.mean.0 },
    };
    let shown = beams.points.iter().filter(|point| point.is_of("map", SHOWN)).map(difference).collect();
    Gallery::of_row("beams-images", "The mean of all images less the reference", shown).with_caption(
        "Orange: too bright, where light of a neighbouring place is smeared to; blue: too dark. Noise is both.",
    )
}
