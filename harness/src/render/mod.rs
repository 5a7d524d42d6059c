//! `harness render`: a scene in, images and statistics out.

mod draw;
mod output;
mod photons;
mod pixel;
mod statistics;

use crate::cli::RenderArguments;
use crate::estimate::{named, read};
use crate::image::{Exposure, Format, Image};
use crate::plan::{IntegratorPlan, MediumLibrary, ScenePlan, Spectra};
use crate::spec::{LightSpec, SceneOverrides, SceneSpec, SurfaceSpec};
use crate::{DONE, Environment, Failure};
use draw::{Drawn, draw};
use fairflight_sources::derive_seed;
use output::{Kind, Prepared};
pub(crate) use statistics::Moments;
use std::io::{Read, Write};
use std::time::Instant;

pub(crate) fn run(
    arguments: &RenderArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let kinds = arguments.out.iter().map(|path| Kind::of(path)).collect::<Result<Vec<Kind>, _>>()?;
    let name = named(&arguments.scene);
    let in_scene = |failure: Failure| failure.within(&name);
    let text = read(&arguments.scene, stdin).map_err(in_scene)?;
    let overrides = SceneOverrides { samples_per_pixel: arguments.samples_per_pixel, seed: arguments.seed };
    let spec = SceneSpec::parse(&text, overrides).map_err(in_scene)?;
    let plan = ScenePlan::of(&spec, &MediumLibrary::default()).map_err(in_scene)?;
    let reference = reference(arguments, &plan)?;
    let mut files = arguments.out.iter().map(|path| Prepared::new(path)).collect::<Result<Vec<_>, _>>()?;

    let (moments, seconds) =
        environment.on_threads(arguments.threads, || measure(&plan, environment)).map_err(in_scene)?;
    let image = moments.image(&plan).map_err(|error| Failure::refused(error).within(&name))?;
    let warnings = warnings(&spec, &plan, &moments);
    // Nobody is left to tell if standard error is closed.
    for warning in &warnings {
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let reference = reference.as_ref().map(|(image, file)| (image, file.clone()));
    let provenance = environment.provenance(plan.seed);
    let statistics = moments.statistics(&plan, reference, seconds, warnings, provenance);
    for ((path, kind), file) in arguments.out.iter().zip(kinds).zip(&mut files) {
        let bytes = match kind {
            Kind::Image(format) => image.encode(format),
            Kind::Statistics => serde_json::to_vec_pretty(&statistics).map_err(|error| error.to_string()),
        };
        file.write(&bytes.map_err(|error| Failure::not_written(path, error))?)?;
        if kind == Kind::Image(Format::Png) {
            let _ = writeln!(stderr, "{}: {}", path.display(), Exposure::of(&image));
        }
    }
    output::put(files)?;
    Ok(DONE)
}

/// The image to compare with, as large as the one that is rendered.
fn reference(arguments: &RenderArguments, plan: &ScenePlan) -> Result<Option<(Image, String)>, Failure> {
    let Some(path) = &arguments.reference else { return Ok(None) };
    let in_reference = |failure: Failure| failure.within("--reference");
    let image = Image::read(path).map_err(in_reference)?;
    let [width, height] = plan.camera.resolution().map(|side| side as usize);
    if (image.width(), image.height()) != (width, height) {
        return Err(in_reference(Failure::refused(format!(
            "{}: must have {width} x {height} pixels as the scene, found {} x {}",
            path.display(),
            image.width(),
            image.height()
        ))));
    }
    Ok(Some((image, path.display().to_string())))
}

/// Draws the image, and says how long that took.
fn measure(plan: &ScenePlan, environment: &Environment) -> Result<(Moments, f64), Failure> {
    let [width, height] = plan.camera.resolution().map(u64::from);
    let images = if matches!(plan.spectra, Spectra::Separate(_)) { 3 } else { 1 };
    // Photons come on top of the background behind the medium.
    let passes = if matches!(plan.integrator, IntegratorPlan::PhotonTracer(_)) { 2 } else { 1 };
    let samples = width * height * u64::from(plan.samples_per_pixel) * images * passes;
    let bar = environment.progress(samples, "rendering");
    let clock = Instant::now();
    let moments = moments(plan, &|samples| bar.inc(samples))?;
    let seconds = clock.elapsed().as_secs_f64();
    bar.finish_and_clear();
    Ok((moments, seconds))
}

/// Draws the image of a plan on the threads of the current pool. `advance` is told how many samples were added.
///
/// # Errors
/// If a look-up is not lawful, or a sample not finite.
pub(crate) fn moments(plan: &ScenePlan, advance: &(dyn Fn(u64) + Sync)) -> Result<Moments, Failure> {
    Ok(match &plan.spectra {
        Spectra::Gray(radiant) => draw(plan, radiant, plan.seed, advance)?.into(),
        Spectra::Colour(radiant) => draw(plan, radiant, plan.seed, advance)?.into(),
        Spectra::Separate(channels) => {
            let channel = |k: usize| {
                // Streams of their own, so that the noise of the channels is independent.
                let seed = derive_seed(plan.seed, k as u64);
                draw(plan, &channels[k], seed, advance)
                    .map_err(|failure| failure.within(["red", "green", "blue"][k]))
            };
            Drawn::of_channels([channel(0)?, channel(1)?, channel(2)?]).into()
        }
    })
}

/// What a reader of the image should know.
fn warnings(spec: &SceneSpec, plan: &ScenePlan, moments: &Moments) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(moments.warning());
    if let Some(walk) = spec.integrator.walk()
        && moments.truncated() > 0
    {
        warnings.push(format!(
            "{} walks were cut after max_collisions = {}: what they had left is missing, a bias",
            moments.truncated(),
            walk.max_collisions
        ));
    }
    warnings.extend(spec.integrator.biased_baseline().map(|what| format!("integrator: {what}")));
    let inside = |light: &LightSpec| matches!(light, LightSpec::Point { position, .. } if plan.bounds.contains(*position));
    let photons = matches!(plan.integrator, IntegratorPlan::PhotonTracer(_));
    if photons && spec.medium.is_some() && plan.bounds.contains(plan.camera.origin()) {
        warnings.push(
            "the camera stands in the medium: the connection of photons with it has no second moment, errors are \
             underrated"
                .to_owned(),
        );
    }
    if spec.integrator.walk().is_some() && !photons && spec.medium.is_some() && spec.lights.iter().any(inside)
    {
        warnings.push(
            "a point light lies in the medium: the connection with it has no second moment, errors are underrated"
                .to_owned(),
        );
    }
    if spec.lights.is_empty() && !spec.surfaces.iter().any(SurfaceSpec::emits) {
        warnings.push("there is no light, the image is black".to_owned());
    }
    warnings
}
