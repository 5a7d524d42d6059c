//! The methods that are compared, as integrators of a scene.

use serde_json::{Value, json};

/// A method with the name that figures give it.
#[derive(Clone, Debug)]
pub(super) struct Method {
    pub(super) name: &'static str,
    pub(super) integrator: Value,
    /// A biased baseline: one ray per pixel at every budget, whose steps spend it.
    pub(super) is_baseline: bool,
}

impl Method {
    fn unbiased(name: &'static str, integrator: Value) -> Self {
        Self { name, integrator, is_baseline: false }
    }
}

/// Greatest extinction: the tightest constant majorant.
const MAJORANT: f64 = 1.0;

/// Tracking with sixteen explorers as control, four of the rays in a row sharing them (section 4.3).
fn tracked() -> Value {
    json!({ "kind": "double_particle", "sigma_samp": 0.5, "control": { "kind": "explorers", "count": 16 } })
}

/// Ratio tracking of shadow rays.
fn shadow() -> Value {
    json!({ "kind": "double_particle", "sigma_samp": 0.8 })
}

fn sampled(name: &'static str, sampling: &str, samples: u32) -> Method {
    let integrator = json!({ "kind": "single_scattering", "sampling": sampling, "samples_per_ray": samples,
                             "estimator": tracked(), "shadow": shadow(), "shared_explorers": 4 });
    Method::unbiased(name, integrator)
}

/// Flights through the majorant, as many as `splits` per ray.
fn flights(name: &'static str, splits: u32) -> Method {
    let integrator = json!({ "kind": "single_scattering", "sampling": "attenuation", "samples_per_ray": 1,
                             "estimator": { "kind": "line_integral", "majorant": MAJORANT, "splits": splits },
                             "shadow": { "kind": "woodcock", "majorant": MAJORANT } });
    Method::unbiased(name, integrator)
}

/// A Riemann sum whose `steps`, on the camera ray and on each of its shadow rays, spend `budget` look-ups.
fn marching(budget: f64) -> Method {
    // n + n² = budget, on the rays that meet the medium.
    let steps = ((budget + 0.25).sqrt() - 0.5).round().max(1.0) as u32;
    let estimator = json!({ "kind": "ray_marching", "steps": steps, "jitter": false });
    let integrator = json!({ "kind": "single_scattering", "sampling": "attenuation", "samples_per_ray": 1,
                             "estimator": estimator });
    Method { name: "ray marching (biased)", integrator, is_baseline: true }
}

/// All methods of fig. 12; the baseline for a ray that may spend `budget` look-ups.
pub(super) fn all(budget: f64) -> Vec<Method> {
    vec![
        marching(budget),
        flights("one Woodcock flight", 1),
        flights("algorithm 2, 4 flights", 4),
        sampled("attenuation", "attenuation", 1),
        sampled("attenuation, resampled", "attenuation_resampled", 1),
        sampled("attenuation, resampled, 4", "attenuation_resampled", 4),
        sampled("source", "source", 2),
        sampled("scattering", "scattering", 2),
        sampled("source and scattering", "source_and_scattering", 1),
        sampled("source and scattering, 4 + 4", "source_and_scattering", 4),
    ]
}

/// Transmittance in closed form, which no look-up buys: what remains is the sampling of distances.
pub(super) fn closed_form(name: &'static str, samples: u32) -> Method {
    let integrator = json!({ "kind": "single_scattering", "sampling": "source_and_scattering", "samples_per_ray": samples,
                             "estimator": { "kind": "regular" }, "shared_explorers": 4 });
    Method::unbiased(name, integrator)
}
