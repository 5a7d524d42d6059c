//! One image: drawn, told, put into files.

use super::output::Outputs;
use super::passes::{EarlyEnd, End, Painted, Rhythm, paint};
use super::points::Point;
use super::statistics::{ShownAt, Statistics};
use super::{Moments, Painting, pilot, warnings};
use crate::field::MediumLibrary;
use crate::image::{Exposure, Image};
use crate::input::Input;
use crate::plan::Spectra;
use crate::result::{SweepPoint, SweepResult};
use crate::{Environment, Failure};
use std::sync::OnceLock;

/// The least time between two unfinished images in files \[s\].
const FILES_EVERY: f64 = 2.0;
/// The least time between two errors in the progress bar \[s\].
const ERROR_EVERY: f64 = 0.1;

/// A scene to be rendered, with the image that it is compared with.
pub(super) struct Rendering<'a> {
    pub input: &'a Input,
    pub media: &'a MediumLibrary,
    pub point: &'a Point<'a>,
    pub reference: Option<&'a (Image, String)>,
    /// The exposure of every picture, once it was asked for, and its source.
    pub exposure: OnceLock<(Exposure, &'static str)>,
    /// Points of the sweep that are done.
    pub before: &'a [SweepPoint<Statistics>],
    pub environment: &'a Environment,
}

impl Rendering<'_> {
    /// Draws the image; unfinished ones go to `outputs`.
    fn paint(&self, early: Option<&EarlyEnd>, outputs: &mut Outputs) -> Result<Painted<'_>, Failure> {
        let plan = &self.point.plan;
        let [width, height] = plan.camera.resolution().map(u64::from);
        let images = if matches!(plan.spectra, Spectra::Separate(_)) { 3 } else { 1 };
        // Replicas come on top of what is drawn pixel by pixel.
        let layers = if plan.integrator.replicas().is_some() { 2 } else { 1 };
        let samples = width * height * u64::from(plan.samples_per_pixel) * images * layers;
        let bar = self.environment.progress(samples, "rendering");
        let (mut files, mut errors) = (Rhythm::new(FILES_EVERY), Rhythm::new(ERROR_EVERY));
        let after_pass = |painting: &Painting<'_>, seconds: f64| {
            errors.beat(seconds, || {
                bar.with_text(|| self.error(painting));
                Ok(())
            })?;
            files.beat(seconds, || {
                let (image, statistics) = self.result(&painting.moments(), seconds, None, outputs)?;
                self.put(outputs, &image, &statistics)
            })
        };
        let painted = paint(plan, early, &|samples| bar.inc(samples), after_pass);
        bar.finish();
        painted.map_err(|failure| self.in_scene(failure))
    }

    /// The error of an unfinished image in words, for the progress bar; none without an image to compare it with.
    fn error(&self, painting: &Painting<'_>) -> Option<String> {
        let (reference, _) = self.reference.as_ref()?;
        let rmse = painting.moments().squared_error(reference).sqrt();
        Some(format!("rendering, RMSE {rmse:.3e}"))
    }

    /// Draws the image: why that ended, and all that is to be put.
    pub(super) fn finished(
        &self,
        early: Option<&EarlyEnd>,
        outputs: &mut Outputs,
    ) -> Result<(End, Image, Statistics), Failure> {
        let Painted { painting, seconds, end } = self.paint(early, outputs)?;
        let result = self.result(&painting.moments(), seconds, Some(end), outputs);
        let (image, statistics) = result.map_err(|failure| self.in_scene(failure))?;
        Ok((end, image, statistics))
    }

    fn result(
        &self,
        moments: &Moments,
        seconds: f64,
        end: Option<End>,
        outputs: &Outputs,
    ) -> Result<(Image, Statistics), Failure> {
        let plan = &self.point.plan;
        let image = moments.image(plan).map_err(Failure::refused)?;
        let warnings = warnings::warnings(self.point.spec, plan, moments, end);
        let reference = self.reference.map(|(image, file)| (image, file.clone()));
        let provenance = self.input.provenance(self.environment, plan.seed)?;
        let (exposure, from) = self.exposure(outputs)?;
        let shown = outputs.tone_mapped().next().map(|_| ShownAt { stops: exposure.stops(), from });
        Ok((image, moments.statistics(plan, reference, seconds, warnings, (shown, provenance))))
    }

    /// The exposure of every picture that is put, also unfinished, and where it comes from; where none is tone-mapped it is not asked
    /// for.
    pub(super) fn exposure(&self, outputs: &Outputs) -> Result<(Exposure, &'static str), Failure> {
        if let Some(exposure) = self.exposure.get() {
            return Ok(*exposure);
        }
        let exposure = match outputs.tone_mapped().next() {
            Some(_) => {
                pilot::exposure(self.point.spec, self.media).map_err(|failure| failure.within("exposure"))?
            }
            None => Exposure::default(),
        };
        Ok(*self.exposure.get_or_init(|| (exposure, "a pilot image")))
    }

    /// Puts the files in their places; the statistics of a sweep are those of all points so far.
    pub(super) fn put(
        &self,
        outputs: &mut Outputs,
        image: &Image,
        statistics: &Statistics,
    ) -> Result<(), Failure> {
        let (exposure, _) = self.exposure(outputs)?;
        let Some(value) = self.point.value else { return outputs.put(image, exposure, statistics) };
        let before = self.before.iter().map(|point| (&point.value, &point.result));
        let points = before.chain([(value, statistics)]);
        let points = points.map(|(value, result)| SweepPoint { value: value.clone(), result }).collect();
        outputs.put(image, exposure, &SweepResult { points })
    }

    /// A refusal names the scene and the value of the swept key.
    fn in_scene(&self, failure: Failure) -> Failure {
        self.input.within(failure.at(self.point.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Host;
    use crate::plan::ScenePlan;
    use crate::spec::{SceneOverrides, SceneSpec};
    use std::path::Path;

    #[test]
    fn the_bar_tells_the_error_of_what_is_drawn() {
        let scene = include_str!("../../scenes/eq21-environment.json");
        let mut spec = SceneSpec::parse(scene, SceneOverrides::default()).unwrap();
        spec.lights.clear();
        let mut plan = ScenePlan::of(&spec, &MediumLibrary::default()).unwrap();
        plan.samples_per_pixel = 2;
        let [width, height] = plan.camera.resolution().map(|side| side as usize);
        let environment = Environment::new(&[], Host::default());
        let input = Input::read(Path::new("-"), &mut scene.as_bytes()).unwrap();
        let media = MediumLibrary::default();
        let plan_of_point = ScenePlan::of(&spec, &media).unwrap();
        let point = Point { value: None, spec: &spec, plan: plan_of_point };
        let error = |reference: Option<f32>, painting: &Painting<'_>| {
            let reference = reference.map(|value| {
                (Image::new(width, height, vec![[value; 3]; width * height]), "reference.pfm".to_owned())
            });
            let (reference, exposure) = (reference.as_ref(), OnceLock::new());
            let rendering = Rendering {
                input: &input,
                media: &media,
                point: &point,
                reference,
                exposure,
                before: &[],
                environment: &environment,
            };
            rendering.error(painting)
        };
        let mut painting = Painting::new(&plan);
        painting.add_pass(&|_| ()).unwrap();
        // It is dark, the reference is not.
        assert_eq!(error(Some(0.25), &painting).unwrap(), "rendering, RMSE 2.500e-1");
        assert_eq!(error(Some(0.0), &painting).unwrap(), "rendering, RMSE 0.000e0");
        assert_eq!(error(None, &painting), None);
    }
}
