//! The report on single scattering: szirmay-kalos-2017 section 4.3 with its fig. 12, measured again.

mod claims;
mod equal_cost;
mod methods;
mod speed;

use crate::report::document::{Document, Options};
use crate::report::replicas::Subject;
use crate::report::run::Run;
use crate::{Environment, Failure};
use serde_json::{Value, json};
use std::time::Instant;

/// Independent images per measurement.
const REPLICAS: u32 = 4;

/// How strong the point light is beside the environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lighting {
    /// Power 4π · 50 at the center, environment 0.02.
    Point,
    /// Power 4π at the center, environment 1.
    Environment,
}

impl Lighting {
    const ALL: [Self; 2] = [Self::Point, Self::Environment];

    fn id(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Environment => "environment",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Point => "a strong point light (power 4π · 50) in a faint environment (radiance 0.02)",
            Self::Environment => "a weak point light (power 4π) in a bright environment (radiance 1)",
        }
    }

    /// What makes the images neither black nor white.
    fn exposure(self) -> f64 {
        match self {
            Self::Point => 4.0,
            Self::Environment => 1.0,
        }
    }

    /// szirmay-kalos-2017 eq. 21, albedo 0.7, Rayleigh scattering, with the light in its center.
    fn subject(self, resolution: u32) -> Subject {
        use std::f64::consts::PI;
        let (power, radiance) = match self {
            Self::Point => (4.0 * PI * 50.0, 0.02),
            Self::Environment => (4.0 * PI, 1.0),
        };
        Subject::new(json!({
            "camera": { "origin": [0, 0, -20], "look_at": [0, 0, 10], "up": [0, 1, 0],
                        "vertical_fov_degrees": 60, "resolution": [resolution, resolution] },
            "medium": { "kind": "analytic_cosine", "albedo": 0.7, "phase": { "kind": "rayleigh" } },
            "lights": [{ "kind": "point", "position": [0, 0, 10], "power": power },
                       { "kind": "environment", "radiance": radiance }],
            "integrator": Value::Null,
        }))
    }
}

/// Measures the report, on the threads of the current pool.
pub(crate) fn document(options: &Options, environment: &Environment) -> Result<Document, Failure> {
    let clock = Instant::now();
    let steps = equal_cost::steps() + speed::steps();
    let run = Run::new(options, environment, steps);
    let mut studies = Vec::new();
    for lighting in Lighting::ALL {
        studies.push(equal_cost::study(&run, lighting)?);
    }
    let speed = speed::study(&run)?;
    run.finish();
    let claims = vec![claims::s9(&studies)];
    let mut document = Document::new(
        "single-scattering",
        "Single scattering of a point light",
        options,
        environment.provenance(options.seed),
    );
    document.summary = claims::summary(&studies, &speed);
    document.unsound = studies.iter().flat_map(|study| study.unsound.clone()).collect();
    document.claims = claims;
    document.sections = studies.into_iter().map(|study| study.section).chain([speed.section]).collect();
    document.seconds = clock.elapsed().as_secs_f64();
    Ok(document)
}
