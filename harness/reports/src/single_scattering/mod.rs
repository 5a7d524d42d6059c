//! The report on single scattering: szirmay-kalos-2017 section 4.3 with its fig. 12, measured again.

mod claims;
mod equal_cost;
mod methods;
mod speed;

use crate::replicas::Subject;
use crate::run::Run;
use fairflight_document::Document;
use fairflight_harness::Failure;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Independent images per measurement.
const REPLICAS: u32 = 4;

/// A point light in an environment.
#[derive(Debug)]
struct Lighting {
    id: &'static str,
    words: &'static str,
    /// Exposure of the images that makes them neither black nor white.
    exposure: f64,
    /// Power of the point light in the center.
    power: f64,
    /// Radiance of the environment.
    radiance: f64,
}

const LIGHTINGS: [Lighting; 2] = [POINT, ENVIRONMENT];

const POINT: Lighting = Lighting {
    id: "point",
    words: "a strong point light (power 4π · 50) in a faint environment (radiance 0.02)",
    exposure: 4.0,
    power: 4.0 * PI * 50.0,
    radiance: 0.02,
};

const ENVIRONMENT: Lighting = Lighting {
    id: "environment",
    words: "a weak point light (power 4π) in a bright environment (radiance 1)",
    exposure: 1.0,
    power: 4.0 * PI,
    radiance: 1.0,
};

impl Lighting {
    /// szirmay-kalos-2017 eq. 21, albedo 0.7, Rayleigh scattering, with the light in its center.
    fn subject(&self, resolution: u32) -> Subject {
        Subject::new(json!({
            "camera": { "origin": [0, 0, -20], "look_at": [0, 0, 10], "up": [0, 1, 0],
                        "vertical_fov_degrees": 60, "resolution": [resolution, resolution] },
            "medium": { "kind": "analytic_cosine", "albedo": 0.7, "phase": { "kind": "rayleigh" } },
            "lights": [{ "kind": "point", "position": [0, 0, 10], "power": self.power },
                       { "kind": "environment", "radiance": self.radiance }],
            "integrator": Value::Null,
        }))
    }
}

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(run: &Run<'_>) -> Result<Document, Failure> {
    run.expect(equal_cost::steps() + speed::steps());
    let mut studies = Vec::new();
    for lighting in &LIGHTINGS {
        studies.push(equal_cost::study(run, lighting)?);
    }
    let speed = speed::study(run)?;
    Ok(Document {
        summary: claims::summary(&studies, &speed),
        claims: vec![claims::s9(&studies)],
        unsound: studies.iter().flat_map(|study| study.part.unsound.clone()).collect(),
        sections: studies.into_iter().map(|study| study.part.section).chain([speed.section]).collect(),
        hero: Some("speed-seconds".to_owned()),
        ..run.document("Single scattering of a point light")
    })
}
