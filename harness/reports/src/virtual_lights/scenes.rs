//! The scenes of the report: those of the repository, in gray, with other integrators.

use crate::replicas::Subject;
use crate::run::Run;
use fairflight_harness::Failure;
use serde_json::{Value, json};

/// A room of rectangles with a lamp, full of noisy smoke.
const SMOKE_ROOM: &str = include_str!("../../../scenes/smoke-room.json");
/// Spheres on a floor in even haze: diffuse, glass, mirror.
const HAZE_SPHERES: &str = include_str!("../../../scenes/haze-spheres.json");
/// A cloud lit by a lamp beside it.
const LIT_CLOUD: &str = include_str!("../../../scenes/lit-cloud.json");

/// Pixels along each side of what is measured.
pub(super) fn side(run: &Run<'_>) -> u32 {
    run.quick_or(16, 48)
}

/// The bound that all figures use where nothing else is said \[1/length²\].
pub(super) const BOUND: f64 = 20.0;

/// The room with smoke, square. The camera looks a little down, so that the lamp is not in the picture: where its edges fall within a
/// pixel they would be most of the error of a method with few camera rays.
pub(super) fn smoke_room(resolution: u32) -> Result<Subject, Failure> {
    let room = Subject::gray(SMOKE_ROOM, [resolution; 2])?;
    Ok(room.with("camera.vertical_fov_degrees", 34.0).with("camera.look_at", json!([0, -0.3, 0])))
}

/// One line of pixels through the middle of the room.
pub(super) fn scanline(columns: u32) -> Result<Subject, Failure> {
    let subject = Subject::gray(SMOKE_ROOM, [columns, 1])?;
    let height = subject.scene["camera"]["vertical_fov_degrees"].as_f64().unwrap_or(50.0);
    // As wide as the square image; a row is one part of so many of its height.
    let half = (0.5 * height).to_radians().tan() / f64::from(columns);
    Ok(subject.with("camera.vertical_fov_degrees", 2.0 * half.atan().to_degrees()))
}

/// Spheres in haze, square, with this mean cosine of the phase function.
pub(super) fn haze(resolution: u32, g: f64) -> Result<Subject, Failure> {
    Ok(Subject::gray(HAZE_SPHERES, [resolution; 2])?.with("medium.phase.g", g))
}

/// The cloud, square.
pub(super) fn cloud(resolution: u32) -> Result<Subject, Failure> {
    Subject::gray(LIT_CLOUD, [resolution; 2])
}

/// A screen of no thickness in even smoke, with the lamp on one side of it: light that passes it shows on the other side.
pub(super) fn screen(resolution: u32) -> Result<Subject, Failure> {
    let mut subject = smoke_room(resolution)?;
    subject.scene["medium"] = json!({
        "kind": "homogeneous", "sigma_t": 0.6, "albedo": 0.95, "phase": { "kind": "isotropic" },
        "bounds": { "box": { "min": [-1, -1, -1], "max": [1, 1, 1] } }
    });
    let black = json!({ "kind": "diffuse", "reflectance": 0.2 });
    if let Some(surfaces) = subject.scene["surfaces"].as_array_mut() {
        surfaces.push(json!({ "kind": "rectangle", "corner": [-0.6, 0.3, -0.6], "edge_u": [1.2, 0, 0], "edge_v": [0, 0, 1.2],
                              "material": black }));
    }
    Ok(subject)
}

/// The reference of everything.
pub(super) fn path_tracer() -> Value {
    json!({ "kind": "path_tracer" })
}

/// Virtual point lights without compensation; `clamp` null is unbounded.
pub(super) fn lights(light_paths: u32, eye_samples: u32, clamp: &Value) -> Value {
    json!({ "kind": "vpl", "light_paths": light_paths, "eye_samples": eye_samples, "clamp": clamp })
}

/// A compensation by its keys.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    pub(super) strategy: &'static str,
    pub(super) placement: &'static str,
    pub(super) transmittance: &'static str,
    pub(super) steps: Option<u32>,
    pub(super) visibility: &'static str,
}

impl Choice {
    /// raab-2008 section 4.2.
    pub(super) const EXACT: Self = Self {
        strategy: "one_to_many",
        placement: "free_flight",
        transmittance: "exact",
        steps: None,
        visibility: "full",
    };

    /// engelhardt-2013 in full: 1-to-1, locally homogeneous with approximated transmittance, two steps.
    pub(super) const PAPER: Self = Self {
        strategy: "one_to_one",
        placement: "locally_homogeneous",
        transmittance: "approximate",
        steps: Some(2),
        visibility: "full",
    };

    /// Bounded and compensated lights.
    pub(super) fn lights(self, light_paths: u32, eye_samples: u32, bound: f64) -> Value {
        let mut integrator = lights(light_paths, eye_samples, &json!(bound));
        integrator["compensation"] = json!({
            "strategy": self.strategy, "placement": self.placement, "transmittance": self.transmittance,
            "steps": self.steps, "visibility": self.visibility
        });
        integrator
    }
}
