//! `harness render`: a scene in, images and statistics out.
//!
//! An image is drawn in one pass, or pass by pass: under `--time-limit`, and where the integrator has a batch for each. Between
//! passes the files are put in place now and then, with statistics that say that the image is not finished: somebody may watch it, and
//! a kill leaves the last one. An interrupt ends such an image after a whole pass.

mod batch;
mod canvas;
mod draw;
mod output;
mod painting;
mod passes;
mod photons;
mod pilot;
mod pixel;
mod statistics;
mod tile;
mod virtual_lights;
mod warnings;
mod work;

use crate::budget::Budget;
use crate::cli::RenderArguments;
use crate::estimate::{folder_of, named, read};
use crate::field::MediumLibrary;
use crate::image::{Exposure, Image};
use crate::interrupt::stop_gently;
use crate::plan::{IntegratorPlan, ScenePlan, Spectra};
use crate::spec::{SceneOverrides, SceneSpec};
use crate::{DONE, Environment, Failure, INTERRUPTED};
use output::Outputs;
pub(crate) use painting::{Painting, moments};
use passes::{EarlyEnd, End, Painted, Rhythm, paint};
pub(crate) use statistics::Moments;
use statistics::Statistics;

use std::io::{Read, Write};
use std::sync::OnceLock;

/// The least time between two unfinished images in files \[s\].
const FILES_EVERY: f64 = 2.0;
/// The least time between two errors in the progress bar \[s\].
const ERROR_EVERY: f64 = 0.1;

pub(crate) fn run(
    arguments: &RenderArguments,
    environment: &Environment,
    stdin: &mut dyn Read,
    stderr: &mut dyn Write,
) -> Result<i32, Failure> {
    let mut outputs = Outputs::of(&arguments.out)?;
    let name = named(&arguments.scene);
    let in_scene = |failure: Failure| failure.within(&name);
    let text = read(&arguments.scene, stdin).map_err(in_scene)?;
    let overrides = SceneOverrides { samples_per_pixel: arguments.samples_per_pixel, seed: arguments.seed };
    let spec = SceneSpec::parse_in(&text, folder_of(&arguments.scene), overrides).map_err(in_scene)?;
    let media = MediumLibrary::default();
    let plan = ScenePlan::of(&spec, &media).map_err(in_scene)?;
    if arguments.time_limit.is_some() && matches!(plan.integrator, IntegratorPlan::PhotonTracer(_)) {
        return Err(Failure::refused(
            "--time-limit: photons come in replicas of the whole image, not in passes",
        ));
    }
    let length = if arguments.time_limit.is_some() { work::Length::Limited } else { work::Length::Whole };
    let bounds = (Budget::of(arguments.budget), length);
    let warning = environment
        .on_threads(arguments.threads, || work::check(&spec, &plan, &media, bounds))
        .map_err(in_scene)?;
    // Nobody is left to tell if standard error is closed.
    if let Some(warning) = warning {
        let _ = writeln!(stderr, "warning: {warning}");
    }
    let in_passes = arguments.time_limit.is_some() || plan.integrator.draws_in_batches();
    // Before there is a file, and until all are in place: who interrupts gets what is done.
    let early = in_passes.then(|| EarlyEnd { limit: arguments.time_limit, stop: stop_gently() });
    let reference = reference(arguments, &plan)?;
    let rendering = Rendering { name, spec, media, reference, plan, exposure: OnceLock::new(), environment };
    outputs.prepare()?;

    let (painted, (image, statistics), exposure) = environment.on_threads(arguments.threads, || {
        let painted = rendering.paint(early.as_ref(), &mut outputs)?;
        let finished = rendering.finished(&painted)?;
        Ok((painted, finished, rendering.exposure(&outputs)?))
    })?;
    for warning in &statistics.warnings {
        let _ = writeln!(stderr, "warning: {warning}");
    }
    for path in outputs.tone_mapped() {
        let _ = writeln!(stderr, "{}: {}", path.display(), exposure);
    }
    outputs.put(&image, exposure, &statistics)?;
    Ok(if painted.end == End::Interrupted { INTERRUPTED } else { DONE })
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

/// What is to be rendered, and compared with what.
struct Rendering<'a> {
    name: String,
    spec: SceneSpec,
    media: MediumLibrary,
    plan: ScenePlan,
    reference: Option<(Image, String)>,
    /// Of every picture, once it was asked for.
    exposure: OnceLock<Exposure>,
    environment: &'a Environment,
}

impl Rendering<'_> {
    /// Draws the image; unfinished ones go to `outputs`.
    fn paint(&self, early: Option<&EarlyEnd>, outputs: &mut Outputs) -> Result<Painted<'_>, Failure> {
        let plan = &self.plan;
        let [width, height] = plan.camera.resolution().map(u64::from);
        let images = if matches!(plan.spectra, Spectra::Separate(_)) { 3 } else { 1 };
        // Photons come on top of the background behind the medium.
        let layers = if matches!(plan.integrator, IntegratorPlan::PhotonTracer(_)) { 2 } else { 1 };
        let samples = width * height * u64::from(plan.samples_per_pixel) * images * layers;
        let bar = self.environment.progress(samples, "rendering");
        let (mut files, mut errors) = (Rhythm::new(FILES_EVERY), Rhythm::new(ERROR_EVERY));
        let after_pass = |painting: &Painting<'_>, seconds: f64| {
            errors.beat(seconds, || {
                if !bar.is_hidden()
                    && let Some(error) = self.error(painting)
                {
                    bar.set_message(error);
                }
                Ok(())
            })?;
            files.beat(seconds, || {
                let (image, statistics) = self.result(&painting.moments(), seconds, None)?;
                let exposure = self.exposure(outputs)?;
                outputs.put(&image, exposure, &statistics)
            })
        };
        let painted = paint(plan, early, &|samples| bar.inc(samples), after_pass);
        bar.finish_and_clear();
        painted.map_err(|failure| self.in_scene(failure))
    }

    /// What the progress bar says of an unfinished image, if there is something to compare it with.
    fn error(&self, painting: &Painting<'_>) -> Option<String> {
        let (reference, _) = self.reference.as_ref()?;
        let rmse = painting.moments().squared_error(reference).sqrt();
        Some(format!("rendering, RMSE {rmse:.3e}"))
    }

    fn finished(&self, painted: &Painted<'_>) -> Result<(Image, Statistics), Failure> {
        let Painted { painting, seconds, end } = painted;
        self.result(&painting.moments(), *seconds, Some(*end)).map_err(|failure| self.in_scene(failure))
    }

    fn result(
        &self,
        moments: &Moments,
        seconds: f64,
        end: Option<End>,
    ) -> Result<(Image, Statistics), Failure> {
        let image = moments.image(&self.plan).map_err(Failure::refused)?;
        let warnings = warnings::warnings(&self.spec, &self.plan, moments, end);
        let reference = self.reference.as_ref().map(|(image, file)| (image, file.clone()));
        let provenance = self.environment.provenance(self.plan.seed);
        Ok((image, moments.statistics(&self.plan, reference, seconds, warnings, provenance)))
    }

    /// The exposure of every picture that is put, also unfinished; where none is tone-mapped it is not asked for.
    fn exposure(&self, outputs: &Outputs) -> Result<Exposure, Failure> {
        if let Some(exposure) = self.exposure.get() {
            return Ok(*exposure);
        }
        let exposure = match outputs.tone_mapped().next() {
            Some(_) => pilot::exposure(&self.spec, &self.media)
                .map_err(|failure| self.in_scene(failure.within("exposure")))?,
            None => Exposure::default(),
        };
        Ok(*self.exposure.get_or_init(|| exposure))
    }

    /// A refusal names the scene; a file that cannot be written names itself.
    fn in_scene(&self, failure: Failure) -> Failure {
        match failure {
            Failure::Refused(_) => failure.within(&self.name),
            Failure::NotWritten(_) | Failure::Interrupted => failure,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Host;

    #[test]
    fn the_bar_tells_the_error_of_what_is_drawn() {
        let scene = include_str!("../../scenes/eq21-environment.json");
        let mut spec = SceneSpec::parse(scene, SceneOverrides::default()).unwrap();
        spec.lights.clear();
        let mut plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
        plan.samples_per_pixel = 2;
        let [width, height] = plan.camera.resolution().map(|side| side as usize);
        let environment = Environment::new(&[], Host::default());
        let rendering = |value: f32| {
            let reference = Image::new(width, height, vec![[value; 3]; width * height]);
            let plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
            let reference = Some((reference, "reference.pfm".to_owned()));
            let (spec, media, exposure) = (spec.clone(), MediumLibrary::default(), OnceLock::new());
            Rendering {
                name: String::new(),
                spec,
                media,
                plan,
                reference,
                exposure,
                environment: &environment,
            }
        };
        let mut painting = Painting::new(&plan);
        painting.add_pass(&|_| ()).unwrap();
        // It is dark, the reference is not.
        assert_eq!(rendering(0.25).error(&painting).unwrap(), "rendering, RMSE 2.500e-1");
        assert_eq!(rendering(0.0).error(&painting).unwrap(), "rendering, RMSE 0.000e0");
        assert_eq!(Rendering { reference: None, ..rendering(0.0) }.error(&painting), None);
    }
}
