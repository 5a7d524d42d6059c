//! Specs of `harness estimate`.

use crate::refusal;
use fairflight_harness::plan::{MediumLibrary, Plan};
use fairflight_harness::reference::Truth;
use fairflight_harness::spec::{
    BeyondSpec, CellsSpec, ControlSpec, EstimatorSpec, Experiment, MediumKind, Node, Overrides, ProfileSpec,
    Request, RouletteSpec, TeethSpec,
};
use fairflight_media::Tolerance;

/// Of a sweep, so many points are planned.
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
    matches!(profile, ProfileSpec::Ray { medium, .. } if matches!(medium.kind, MediumKind::Vdb { .. }))
}

/// Look-ups that are little beside reading a spec.
const AFFORDABLE: u64 = 100_000;

/// The order of the look-ups and cells that preparing an estimator takes.
fn preparation(spec: &EstimatorSpec) -> u64 {
    match spec {
        EstimatorSpec::DoubleParticle { control, .. } | EstimatorSpec::SingleParticle { control, .. } => {
            match control {
                ControlSpec::Explorers { count } => *count as u64,
                _ => 0,
            }
        }
        EstimatorSpec::Beyond(beyond) => match beyond {
            BeyondSpec::UnbiasedRayMarching {
                teeth, roulette: RouletteSpec::SelfTuned, segments, ..
            } => {
                let teeth = match teeth {
                    TeethSpec::Given(teeth) => u64::from(*teeth),
                    TeethSpec::Rule { .. } => 100,
                };
                100 * teeth * u64::from(*segments)
            }
            BeyondSpec::JitteredRatio {
                bounds: fairflight_harness::spec::BoundsSpec::Cells(CellsSpec::Count(count)),
                ..
            }
            | BeyondSpec::ResidualCells { cells: CellsSpec::Count(count), .. } => u64::from(*count),
            _ => 0,
        },
        _ => 0,
    }
}
