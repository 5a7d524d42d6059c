//! Fig. 2: splitting along the primary ray by algorithm 2, from equidistant and from independent starts, from a homogeneous to a
//! highly inhomogeneous hazy medium, beside ray marching at as many look-ups.

use crate::measured::Measured;
use crate::replicas::{Replicas, Subject};
use crate::run::Run;
use fairflight_document::{Axis, Cell, Chart, Curve, Gallery, Section, Table};
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// Powers of the wave: the higher, the less homogeneous.
const POWERS: [u32; 5] = [0, 1, 2, 6, 20];
/// Those whose images are shown.
const SHOWN: [u32; 2] = [0, 20];
/// Flights per camera ray.
const FLIGHTS: u32 = 8;
/// Camera rays per pixel of the images: a low sampling rate, as in the paper.
const RAYS: u32 = 2;
/// Camera rays per pixel of what is measured.
const MEASURED_RAYS: u32 = 16;
/// Field of view of the images, and of the window in their middle in which the noise of one camera ray is measured: so narrow that
/// the rays of a pixel are the same to the medium, and that what is measured is not the edge of the ball within a pixel \[°\].
const VIEWS: [f64; 2] = [45.0, 4.0];
/// Mean extinction of all media \[1/length\].
const MEAN: f64 = 0.12;
/// Independent images per measurement.
const REPLICAS: u32 = 4;

pub(super) fn steps() -> u64 {
    POWERS.len() as u64 * 3
}

/// One medium.
pub(super) struct Point {
    power: u32,
    /// Majorant over mean extinction.
    pub(super) inhomogeneity: f64,
    pub(super) equidistant: Measured,
    pub(super) independent: Measured,
    pub(super) marching: Measured,
    /// Mean radiance by ray marching over that by flights, less 1.
    bias: f64,
    methods: [(&'static str, Method); 3],
}

/// What one method came to.
struct Method {
    window: Replicas,
    /// Of the whole ball, where it is shown.
    image: Option<Replicas>,
}

pub(super) struct Splitting {
    pub(super) points: Vec<Point>,
    pub(super) section: Section,
}

/// E\[((1 + cos φ)/2)^p\] = C(2p, p)/4^p.
fn mean_of_wave(power: u32) -> f64 {
    (1..=power).map(|k| f64::from(2 * k - 1) / f64::from(2 * k)).product()
}

/// A ball of haze with `MEAN` extinction, its waves to the power `power`, lit by sixteen lights around it.
fn scene(resolution: u32, view: f64, power: u32) -> Subject {
    let majorant = MEAN / mean_of_wave(power);
    let wave = format!("{majorant}*(0.5*cos(1.5*(x+y+z)) + 0.5)^{power}");
    let lights: Vec<Value> = (0..16)
        .map(|k| {
            let turn = f64::from(k) * 2.399_963_229_728_653;
            let height = (f64::from(k) + 0.5) / 8.0 - 1.0;
            let (sin, cos) = turn.sin_cos();
            let across = 13.0 * (1.0 - height * height).sqrt();
            json!({ "kind": "point", "position": [across * cos, 13.0 * height, 10.0 + across * sin], "power": 400.0 })
        })
        .collect();
    Subject::new(json!({
        "camera": { "origin": [0, 0, -20], "look_at": [0, 0, 10], "up": [0, 1, 0],
                    "vertical_fov_degrees": view, "resolution": [resolution, resolution] },
        "medium": { "kind": "expression", "sigma_t": wave, "majorant": majorant * (1.0 + 1e-12),
                    "bounds": { "sphere": { "center": [0, 0, 10], "radius": 10 } },
                    "albedo": 0.9, "phase": { "kind": "hazy_mie" } },
        "lights": lights,
        "integrator": Value::Null,
    }))
}

fn flights(power: u32, starts: &str) -> Value {
    let majorant = MEAN / mean_of_wave(power) * (1.0 + 1e-12);
    json!({ "kind": "single_scattering", "sampling": "attenuation", "samples_per_ray": 1,
            "estimator": { "kind": "line_integral", "majorant": majorant, "splits": FLIGHTS }, "starts": starts,
            "shadow": { "kind": "ray_marching", "steps": 24, "jitter": false } })
}

/// Both methods share the shadow rays' quadrature, so that what differs is the camera ray.
fn marching(steps: u32) -> Value {
    json!({ "kind": "single_scattering", "sampling": "attenuation", "samples_per_ray": 1,
            "estimator": { "kind": "ray_marching", "steps": steps, "jitter": true },
            "shadow": { "kind": "ray_marching", "steps": 24, "jitter": false } })
}

pub(super) fn study(run: &Run<'_>) -> Result<Splitting, Failure> {
    let resolution = run.quick_or(24, 64);
    let [whole, narrow] = VIEWS;
    let mut points = Vec::new();
    for &power in &POWERS {
        let (window, ball) = (scene(resolution / 2, narrow, power), scene(resolution, whole, power));
        let method = |integrator: Value, name: &str| {
            let seed = |what: &str| run.seed(format_args!("splitting/{power}/{name}/{what}"));
            let rays = run.quick_or(MEASURED_RAYS / 4, MEASURED_RAYS);
            let narrow = window.with("integrator", integrator.clone());
            let measured = narrow.measure(rays, (seed("window"), REPLICAS), &run.media)?;
            let shown = SHOWN
                .contains(&power)
                .then(|| ball.with("integrator", integrator).measure(RAYS, (seed("image"), 2), &run.media));
            run.advance();
            Ok::<_, Failure>(Method { window: measured, image: shown.transpose()? })
        };
        let equidistant = method(flights(power, "equidistant"), "equidistant")?;
        let independent = method(flights(power, "independent"), "independent")?;
        // As many steps as flights: in a homogeneous medium both look up as often.
        let marched = method(marching(FLIGHTS), "marching")?;
        let noise = |method: &Method| method.window.squared_error().map(f64::sqrt);
        let mean = |method: &Method| {
            let (pixels, _) = method.window.mean();
            pixels.iter().sum::<f64>() / pixels.len() as f64
        };
        points.push(Point {
            power,
            inhomogeneity: 1.0 / mean_of_wave(power),
            equidistant: noise(&equidistant),
            independent: noise(&independent),
            marching: noise(&marched),
            bias: mean(&marched) / mean(&equidistant) - 1.0,
            methods: [
                ("algorithm 2, equidistant starts", equidistant),
                ("independent starts", independent),
                ("ray marching, jittered (biased)", marched),
            ],
        });
    }
    let section = section(&points);
    Ok(Splitting { points, section })
}

fn section(points: &[Point]) -> Section {
    let text = format!(
        "A ball of haze (hazy Mie, albedo 0.9) of mean extinction {MEAN}, lit by sixteen point lights around it: single scattering, \
         {FLIGHTS} flights per camera ray. The extinction is a plane wave ((1 + cos)/2)^p: homogeneous for p = 0, thin sheets for p = 20. The \
         majorant over the mean extinction measures how inhomogeneous it is. Ray marching takes {FLIGHTS} jittered steps; all share the same \
         quadrature on shadow rays, so that what differs is the camera ray. Noise is the standard deviation of a pixel of {MEASURED_RAYS} \
         camera rays, in a window of {}° in the middle of the ball; of ray marching it leaves out the bias, which the table shows.",
        VIEWS[1]
    );
    let curve = |label: &str, value: fn(&Point) -> Measured| {
        Curve::joined(label, points.iter().map(|point| value(point).mark(point.inhomogeneity)))
    };
    let chart = Chart::new(
        "splitting-error",
        "Noise from homogeneous to inhomogeneous",
        Axis::logarithmic("majorant / mean extinction [1]"),
        Axis::logarithmic("standard deviation of a pixel [radiance]"),
    )
    .with_curves(vec![
        curve("equidistant starts", |point| point.equidistant),
        curve("independent starts", |point| point.independent),
        curve("ray marching, jittered (biased)", |point| point.marching),
    ]);
    let per_ray = |point: &Point, m: usize| {
        let window = &point.methods[m].1.window;
        Cell::Number(window.lookups_per_pixel() / f64::from(window.rays_per_pixel()))
    };
    let table = Table::of(
        ["splitting-table", "Noise of a pixel", ""],
        points,
        &[
            ("p", "1", &|point| Cell::Count(point.power.into())),
            ("majorant / mean", "1", &|point| Cell::Number(point.inhomogeneity)),
            ("equidistant", "radiance", &|point| point.equidistant.cell()),
            ("independent", "radiance", &|point| point.independent.cell()),
            ("ray marching", "radiance", &|point| point.marching.cell()),
            ("bias of ray marching", "1", &|point| Cell::Number(point.bias)),
            ("look-ups per ray, flights", "1", &|point| per_ray(point, 0)),
            ("look-ups per ray, marching", "1", &|point| per_ray(point, 2)),
        ],
    );
    let pictures = |point: &Point| {
        let images = point.methods.iter().enumerate();
        let images = images.filter_map(|(m, (label, method))| Some((m, label, method.image.as_ref()?)));
        let picture = |(m, label, image): (usize, &&str, &Replicas)| {
            let lines = vec![format!("{} camera rays", image.rays_per_pixel())];
            image.picture(format!("splitting-{}-{m}", point.power), *label, lines, 3.0)
        };
        (format!("p = {}", point.power), images.map(picture).collect())
    };
    let shown = points.iter().filter(|point| SHOWN.contains(&point.power)).map(pictures);
    Section::new("splitting", "raab-2008 fig. 2: splitting along the primary ray")
        .with(text)
        .with(chart)
        .with(table)
        .with(Gallery::of_images("splitting-images", "Homogeneous and highly inhomogeneous", shown.collect()))
}
