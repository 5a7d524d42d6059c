//! Whole images, as `harness render` makes them.

use crate::measured::Measured;
use crate::replicas::Subject;
use crate::run::Run;
use fairflight_document::{Cell, Table};
use fairflight_harness::Failure;

/// Scenes of the repository with their integrators, and samples per pixel.
const SCENES: [(&str, &str, u32); 6] = [
    ("eq21-environment", include_str!("../../../scenes/eq21-environment.json"), 64),
    ("eq21-point-light", include_str!("../../../scenes/eq21-point-light.json"), 8),
    ("eq21-point-light-regular", include_str!("../../../scenes/eq21-point-light-regular.json"), 2),
    ("haze-spheres", include_str!("../../../scenes/haze-spheres.json"), 4),
    ("smoke-room", include_str!("../../../scenes/smoke-room.json"), 16),
    ("door", include_str!("../../../scenes/door.json"), 16),
];
const REPLICAS: u32 = 4;

pub(super) const STEPS: u64 = SCENES.len() as u64;

struct Image {
    name: &'static str,
    integrator: String,
    samples: u32,
    seconds: Measured,
    rays_per_second: Measured,
    lookups: f64,
}

pub(super) fn study(run: &Run<'_>) -> Result<Table, Failure> {
    let side = run.quick_or(24, 96);
    let measure = |&(name, json, samples): &(&'static str, &str, u32)| {
        let subject = Subject::gray(json, [side; 2])?;
        let samples = run.samples(samples);
        let images =
            subject.measure(samples, (run.seed(format_args!("images/{name}")), REPLICAS), &run.media)?;
        run.advance();
        let seconds = images.measured_seconds();
        let rays = f64::from(side * side * samples);
        Ok(Image {
            name,
            integrator: subject.scene["integrator"]["kind"].as_str().unwrap_or_default().to_owned(),
            samples,
            seconds,
            rays_per_second: seconds.map(|seconds| 1e-6 * rays / seconds),
            lookups: images.lookups_per_pixel() / f64::from(samples),
        })
    };
    let images: Vec<Image> = SCENES.iter().map(measure).collect::<Result<_, Failure>>()?;
    let caption = format!(
        "Scenes of harness/scenes at {side} x {side}, without colours. CPU seconds over all threads, preparation and light paths included; speed against error is in the reports of each family."
    );
    Ok(Table::of(
        ["images-table", "Images", &caption],
        &images,
        &[
            ("scene", "", &|image| Cell::text(image.name)),
            ("integrator", "", &|image| Cell::text(&image.integrator)),
            ("samples per pixel", "1", &|image| Cell::Count(u64::from(image.samples))),
            ("CPU time", "s", &|image| image.seconds.cell()),
            ("samples", "10⁶/s", &|image| image.rays_per_second.cell()),
            ("look-ups per sample", "1", &|image| Cell::Number(image.lookups)),
        ],
    ))
}
