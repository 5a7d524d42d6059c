//! Specs of `harness render`.

use crate::refusal;
use fairflight_harness::field::{MediumLibrary, MediumSpec};
use fairflight_harness::plan::ScenePlan;
use fairflight_harness::spec::{IntegratorSpec, LightSpec, SceneOverrides, SceneSpec, VolumeSpec};

/// Cells along an axis of the means that approximate compensation asks for, so that planning costs less than reading.
const MOST_CELLS: u32 = 4;

/// A scene is read or refused with its place, and planned or refused with its place.
pub fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let spec = match SceneSpec::parse(text, SceneOverrides::default()) {
        Err(failure) => return refusal::check(&failure),
        Ok(spec) => spec,
    };
    // Files are not opened: the text may name any of the machine.
    let of_a_file = |volume: &VolumeSpec| matches!(volume.medium, MediumSpec::Vdb(_));
    let picture = |light: &LightSpec| matches!(light, LightSpec::EnvironmentMap(_));
    // Means of the medium in so many cells are look-ups, not reading.
    let averages = matches!(&spec.integrator, IntegratorSpec::Vpl(vpl) if vpl.local_mean_cells > MOST_CELLS);
    if averages || spec.medium.as_ref().is_some_and(of_a_file) || spec.lights.iter().any(picture) {
        return;
    }
    if let Err(failure) = ScenePlan::of(&spec, &MediumLibrary::default()) {
        refusal::check(&failure);
    }
}
