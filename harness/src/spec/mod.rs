//! What is to be measured, as data: the experiment of `harness estimate`, the scene of `harness render`, and the points
//! of every report.
//!
//! A spec is what was asked for, checked in itself (types, signs, lengths of lists). Whether it fits together (a
//! majorant that is one, edges that cover the ray) is for the plan to find.

mod experiment;
mod scene;

pub use experiment::{Experiment, Overrides, Request, Sweep};
pub use scene::{
    ClampSpec, Collisions, ColourSpec, ComponentSpec, DirectionalSpec, EnvironmentMapSpec, EnvironmentSpec,
    IntegratorKind, IntegratorSpec, LightSpec, LineSplittingSpec, MaterialSpec, Particles, PathTracerSpec,
    PhaseKind, PhaseSpec, PointSpec, RectangleSpec, SamplingFieldSpec, SceneOverrides, SceneSpec, ShapeKind,
    ShapeSpec, SingleScatteringSpec, SphereSpec, Strategy, SurfaceSpec, TracerSpec, TransmittanceSpec,
    TransportSpec, VolumeSpec, VplSpec, WalkSpec,
};
