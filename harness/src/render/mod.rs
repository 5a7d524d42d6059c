//! `harness render`: a scene in, images and statistics out.
//!
//! An image is drawn in one pass, or pass by pass: under `--time-limit`, and where the integrator has a batch for each. Between
//! passes the files are put in place now and then, with statistics that say that the image is not finished: somebody may watch it, and
//! a kill leaves the last one. An interrupt ends such an image after a whole pass, and one of chains after whole replicas.

mod batch;
mod canvas;
mod draw;
mod lessons;
mod light_image;
mod metropolis;
mod output;
mod painting;
mod passes;
mod photons;
mod pilot;
mod pixel;
mod points;
mod rendering;
mod replicas;
mod statistics;
mod tile;
mod virtual_lights;
mod warnings;
mod work;

use crate::cli::RenderArguments;
use crate::field::MediumLibrary;
use crate::image::Exposure;
use crate::input::Input;
use crate::interrupt::{self, stop_gently};
use crate::result::SweepPoint;
use crate::spec::{Request, SceneOverrides};
use crate::{DONE, Environment, Failure, INTERRUPTED};
use output::Targets;
pub use painting::{Painting, moments};
use passes::{EarlyEnd, End};
use points::{points, reference, within_budget};
use rendering::Rendering;
use statistics::Statistics;
pub use statistics::{Moments, StrategyShare};
use std::io::{Read, Write};
use std::sync::OnceLock;

/// Runs `harness render`; returns the exit code.
///
/// # Errors
/// If the scene cannot be read or rendered, or an image not be written.
pub fn run(
    arguments: &RenderArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let targets = Targets::of(&arguments.out)?;
    if arguments.exposure.is_some() && !targets.has_tone_mapped() {
        return Err(Failure::refused("--exposure: is for .png files, and no --out is one"));
    }
    let input = Input::read(&arguments.scene, stdin)?;
    let overrides = SceneOverrides { samples_per_pixel: arguments.samples_per_pixel, seed: arguments.seed };
    let request = Request::scenes_in(input.text(), input.folder(), overrides);
    let request = request.map_err(|failure| input.within(failure))?;
    let media = MediumLibrary::default();
    let points = points(&request, arguments, &media, &input)?;
    let warning = environment
        .on_threads(arguments.limits.threads, || within_budget(&points, arguments, &media))
        .map_err(|failure| input.within(failure))?;
    // Nobody is left to tell if standard error is closed.
    if let Some(warning) = warning {
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let reference = arguments.reference.as_deref().map(|path| reference(path, &points)).transpose()?;

    let mut done: Vec<SweepPoint<Statistics>> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        interrupt::check()?;
        let mut outputs = match point.value {
            Some(_) => targets.outputs_of(i, points.len()),
            None => targets.outputs(),
        };
        let integrator = &point.plan.integrator;
        let in_passes =
            arguments.time_limit.is_some() || integrator.draws_in_batches() || integrator.is_of_chains();
        // Before there is a file, and until all are in place: who interrupts gets what is done.
        let early = in_passes.then(|| EarlyEnd { limit: arguments.time_limit, stop: stop_gently() });
        let exposure = arguments.exposure.map(|stops| (Exposure::of_stops(stops), "--exposure"));
        let exposure = exposure.map_or_else(OnceLock::new, OnceLock::from);
        let rendering = Rendering {
            input: &input,
            media: &media,
            point,
            reference: reference.as_ref(),
            exposure,
            before: &done,
            environment,
        };
        outputs.prepare()?;
        let (end, image, statistics) = environment
            .on_threads(arguments.limits.threads, || rendering.finished(early.as_ref(), &mut outputs))?;
        let place = point.value.map(|value| format!("sweep value {value}: ")).unwrap_or_default();
        for warning in &statistics.warnings {
            let _ = writeln!(stderr, "warning: {place}{warning}");
        }
        let exposure = rendering.exposure(&outputs)?;
        if !environment.is_quiet() {
            for path in outputs.tone_mapped() {
                let _ = writeln!(stderr, "{}: {}", path.display(), exposure.0);
            }
        }
        rendering.put(&mut outputs, &image, &statistics)?;
        if end == End::Interrupted {
            return Ok(INTERRUPTED);
        }
        done.extend(point.value.map(|value| SweepPoint { value: value.clone(), result: statistics }));
    }
    Ok(DONE)
}
