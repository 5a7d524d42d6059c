//! Specs of `harness estimate`.

use crate::refusal;
use fairflight_harness::estimator::{CellsSpec, EstimatorSpec, RayKnown};
use fairflight_harness::field::{MediumLibrary, MediumSpec, ProfileSpec, RaySpec};
use fairflight_harness::plan::Plan;
use fairflight_harness::reader::Node;
use fairflight_harness::reference::Truth;
use fairflight_harness::spec::{Experiment, Overrides, Request};
use fairflight_media::Tolerance;

/// Number of points of a sweep that are planned.
const PLANNED: usize = 3;

/// A spec is read or refused with its place; an estimator that was read is written and read back as itself; what can be planned is
/// planned, and the optical thickness of a profile that was planned is a number, or refused.
pub fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Request::parse(text, Overrides::default()) {
        Err(failure) => refusal::check(&failure),
        Ok(Request::Single(experiment)) => planned(&experiment),
        Ok(Request::Sweep(sweep)) => sweep.points.iter().take(PLANNED).for_each(|(_, point)| planned(point)),
    }
}

fn planned(experiment: &Experiment) {
    let written = experiment.estimator.written();
    let read = EstimatorSpec::read(&Node::root(&written));
    assert_eq!(read.as_ref(), Ok(&experiment.estimator), "{written}");
    if names_a_file(&experiment.profile) || preparation(&experiment.estimator) > AFFORDABLE {
        return;
    }
    match Plan::of(experiment, &MediumLibrary::default()) {
        Err(failure) => refusal::check(&failure),
        Ok(plan) => match Truth::of(&plan.profile, Tolerance::to(1e-3)) {
            Err(failure) => refusal::check(&failure),
            Ok(truth) => assert!(truth.optical_thickness.is_finite() && truth.thickness_error >= 0.0),
        },
    }
}

/// Files are not opened: the text may name any of the machine.
fn names_a_file(profile: &ProfileSpec) -> bool {
    matches!(profile, ProfileSpec::Ray(RaySpec { medium: MediumSpec::Vdb(_), .. }))
}

/// Look-ups that are little beside reading a spec.
const AFFORDABLE: f64 = 100_000.0;

/// The order of the look-ups and cells that preparing an estimator takes.
fn preparation(spec: &EstimatorSpec) -> f64 {
    let cells = match spec {
        EstimatorSpec::JitteredRatio(spec) => spec.cells.as_ref(),
        EstimatorSpec::ResidualCells(spec) => Some(&spec.cells),
        _ => None,
    };
    let cells = if let Some(CellsSpec::Count(count)) = cells { f64::from(*count) } else { 0.0 };
    let ray = RayKnown { from: 0.0, length: 1.0, upper_bound: Some(1.0), breakpoints: 0 };
    cells + spec.kind().work(ray).preparation
}
