//! Specs of measurements, as data: the experiment of `harness estimate`, the scene of `harness render`, and the points
//! of every report.
//!
//! A spec is what was asked for, checked in itself (types, signs, lengths of lists). Whether it fits together (a
//! majorant that is one, edges that cover the ray) is for the plan to find.

mod experiment;
mod scene;
mod sweep;

use crate::Failure;
use crate::reader::Object;
pub use experiment::{Experiment, Overrides};
pub use scene::{
    Adaptation, BeamRadianceSpec, BidirectionalSpec, ClampSpec, Collisions, ColourSpec, ComponentSpec,
    DirectionalSpec, EnergyRedistributionSpec, EnvironmentMapSpec, EnvironmentSpec, ExtensionSpec,
    GuidedSpec, IntegratorKind, IntegratorSpec, LightSpec, LineSplittingSpec, MaterialSpec, MetropolisSpec,
    MutationKind, Over, Particles, PathTracerSpec, PhaseKind, PhaseSpec, PointSpec, RectangleSpec,
    ResampledSpec, ReuseSpec, Sampler, SamplerSpec, SamplingFieldSpec, SceneOverrides, SceneSpec, ShapeKind,
    ShapeSpec, SingleScatteringSpec, SphereSpec, StagesSpec, StepsSpec, Strategy, SurfaceSpec, ThicknessSpec,
    TracerSpec, TransmittanceSpec, TransportSpec, VolumeSpec, VplSpec, WalkSpec,
};
pub use sweep::{Request, Sweep};

/// Files that are something else, by a key that only they have.
const FILES: [(&str, &str); 4] = [
    ("camera", "a scene, no {}: `harness render` takes it"),
    ("profile", "an experiment, no {}: `harness estimate` takes it"),
    ("provenance", "a result, no {}: what it was made from stands in its provenance"),
    ("kind", "a part such as a medium, no {}: `harness advise` takes a medium"),
];

/// Refuses a file that is something else than its command takes.
///
/// # Errors
/// If it lacks `key`, and has one that tells what it is.
pub(crate) fn refuse_other(key: &str, wanted: &str, root: &Object<'_>) -> Result<(), Failure> {
    let other = FILES.iter().find(|(other, _)| root.has(other)).filter(|_| !root.has(key));
    match other {
        Some((_, told)) => Err(Failure::refused(format!("this is {}", told.replace("{}", wanted)))),
        None => Ok(()),
    }
}
