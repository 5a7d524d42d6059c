//! The scenes that one command renders: one, or one for each value of a swept key.

use super::work;
use crate::Failure;
use crate::budget::{Budget, patience};
use crate::cli::RenderArguments;
use crate::field::MediumLibrary;
use crate::image::Image;
use crate::input::Input;
use crate::plan::{IntegratorPlan, ScenePlan};
use crate::spec::{Request, SceneSpec};
use serde_json::Value;
use std::path::Path;

/// A scene that is to be rendered, and the value of the swept key, if there is one.
pub(super) struct Point<'a> {
    pub value: Option<&'a Value>,
    pub spec: &'a SceneSpec,
    pub plan: ScenePlan,
}

/// Plans of the scenes of a request, none of which is drawn before all are known to fit together.
pub(super) fn points<'r>(
    request: &'r Request<SceneSpec>,
    arguments: &RenderArguments,
    media: &MediumLibrary,
    input: &Input,
) -> Result<Vec<Point<'r>>, Failure> {
    let point = |(value, spec): (Option<&'r Value>, &'r SceneSpec)| {
        work::before_planning(spec, Budget::of(arguments.limits.budget))
            .map_err(|failure| input.within(failure.at(value)))?;
        let plan = ScenePlan::of(spec, media).map_err(|failure| input.within(failure.at(value)))?;
        if arguments.time_limit.is_some() && matches!(plan.integrator, IntegratorPlan::PhotonTracer(_)) {
            return Err(Failure::refused(
                "--time-limit: photons come in replicas of the whole image, not in passes",
            ));
        }
        Ok(Point { value, spec, plan })
    };
    request.points().into_iter().map(point).collect()
}

/// Checks that the scenes together are within the budget; returns a warning if they take more than an hour.
pub(super) fn within_budget(
    points: &[Point<'_>],
    arguments: &RenderArguments,
    media: &MediumLibrary,
) -> Result<Option<String>, Failure> {
    let is_whole = arguments.time_limit.is_none();
    let length = if is_whole { work::Length::Whole } else { work::Length::Limited };
    let budget = Budget::of(arguments.limits.budget);
    let (mut lookups, mut seconds) = (0.0, 0.0_f64);
    for Point { value, spec, plan } in points {
        let work = work::check(spec, plan, media, (budget, length)).map_err(|failure| failure.at(*value))?;
        lookups += work.lookups;
        seconds = seconds.max(work.seconds);
    }
    if points.iter().any(|point| point.value.is_some()) {
        budget.check("sweep.values", lookups, &format!("the sum over {} points", points.len()))?;
    }
    Ok(if is_whole { patience(lookups, seconds) } else { None })
}

/// The image to compare with, as large as those that are rendered.
pub(super) fn reference(path: &Path, points: &[Point<'_>]) -> Result<(Image, String), Failure> {
    let in_reference = |failure: Failure| failure.within("--reference");
    let image = Image::read(path).map_err(in_reference)?;
    for point in points {
        let [width, height] = point.plan.camera.resolution().map(|side| side as usize);
        if (image.width(), image.height()) != (width, height) {
            return Err(in_reference(Failure::refused(format!(
                "{}: must have {width} x {height} pixels as the scene, found {} x {}",
                path.display(),
                image.width(),
                image.height()
            ))));
        }
    }
    Ok((image, path.display().to_string()))
}
