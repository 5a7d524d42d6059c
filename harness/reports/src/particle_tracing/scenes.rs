//! The scenes of the report, as `harness render` takes them.

use crate::replicas::Subject;
use fairflight_scene::EnvironmentMap;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// σ_t of the densest regions of the noise: 0.25 + 0.75 fBm, whose quantiles in the sphere are 0.25 (50 %), 0.54 (99 %), 0.63
/// (99.9 %).
const NOISE: (f64, f64) = (0.25, 0.75);

fn scene(resolution: u32, medium: &Value, lights: &Value) -> Value {
    json!({
        "camera": { "origin": [0, 0, -20], "look_at": [0, 0, 10], "up": [0, 1, 0],
                    "vertical_fov_degrees": 60, "resolution": [resolution, resolution] },
        "medium": medium,
        "lights": lights,
        "integrator": { "kind": "particle_tracer", "version": "adaptive", "sigma_samp": 1.0 },
    })
}

/// szirmay-kalos-2017 eq. 21 with the paper's albedo and phase function.
fn analytic() -> Value {
    json!({ "kind": "analytic_cosine", "albedo": 0.7, "phase": { "kind": "rayleigh" } })
}

/// Eq. 21 in a radiance of 1 from everywhere.
pub(super) fn evenly_lit(resolution: u32) -> Subject {
    Subject::new(scene(resolution, &analytic(), &json!([{ "kind": "environment", "radiance": 1.0 }])))
}

/// Eq. 21 under a sky with a sun: the high dynamic range that the paper's fig. 6 is lit by is not printed.
pub(super) fn under_the_sun(resolution: u32) -> Subject {
    Subject { scene: scene(resolution, &analytic(), &json!([])), map: Some(sky()) }
}

/// Twelve octaves of Perlin noise with the paper's albedo.
pub(super) fn noise(resolution: u32) -> Subject {
    let (offset, scale) = NOISE;
    let medium = json!({ "kind": "perlin", "octaves": 12, "offset": offset, "scale": scale,
                         "bounds": { "sphere": { "center": [0, 0, 10], "radius": 10 } },
                         "albedo": 0.9, "phase": { "kind": "rayleigh" } });
    Subject::new(self::scene(resolution, &medium, &json!([{ "kind": "environment", "radiance": 1.0 }])))
}

/// Columns and rows of the sky.
const SKY: (usize, usize) = (64, 32);
/// Radiance of the sun's pixels.
const SUN: f64 = 300.0;

/// A sky that fades from 1 at the zenith to 0.2 at the horizon, a ground of 0.1, and a sun of 2 x 2 pixels 45° high whose light is
/// about as much as that of all the rest.
fn sky() -> EnvironmentMap<f64> {
    let (width, height) = SKY;
    let pixel = |i: usize| {
        let (row, column) = (i / width, i % width);
        let elevation = (PI * (row as f64 + 0.5) / height as f64).cos();
        let is_sun = (7..9).contains(&row) && (20..22).contains(&column);
        if is_sun {
            SUN
        } else if elevation > 0.0 {
            0.2 + 0.8 * elevation
        } else {
            0.1
        }
    };
    EnvironmentMap::new(width, height, (0..width * height).map(pixel).collect())
        .expect("all pixels are positive")
}
