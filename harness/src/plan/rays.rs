//! Some of a scene's own rays: those on which an estimator that learns is prepared.

use crate::spec::{DirectionalSpec, IntegratorSpec, LightSpec, PointSpec, SceneSpec};
use fairflight_media::phase::Isotropic;
use fairflight_media::{Bounds, Clip, Line, PhaseFunction};
use fairflight_sources::{Seeded, UniformSource};
use glam::DVec3;

/// Rays that are looked for: as many as a hybrid remembers.
const RAYS: usize = 16;
/// Camera rays that are tried for each.
const TRIES: usize = 64;
/// The stream of the rays, "rays" in ASCII, whatever the seed of the image.
const SEED: u64 = 0x7261_7973;

/// Rays of the kind that the integrator estimates, as far as they are in the bounds of the medium: those of the camera, or from points on them
/// to the lights. Surfaces that stand in the way are not asked.
pub(super) fn rays_of(spec: &SceneSpec, bounds: &Bounds) -> Vec<Clip> {
    let mut source = Seeded::new(SEED);
    let mut rays = Vec::with_capacity(RAYS);
    let Ok(camera) = spec.camera.with_resolution([1; 2]) else { return rays };
    let tries = if spec.medium.is_some() { RAYS * TRIES } else { 0 };
    for _ in 0..tries {
        let line = camera.ray([0; 2], [source.next_uniform(), source.next_uniform()]);
        let clip = bounds.clip(line.origin, line.direction, None).ok().flatten();
        let Some(seen) = clip.filter(|clip| clip.length > 0.0) else { continue };
        rays.push(match spec.integrator {
            IntegratorSpec::Transmittance(_) => seen,
            _ => connection(&spec.lights, &seen, bounds, &mut source),
        });
        if rays.len() == RAYS {
            break;
        }
    }
    rays
}

/// Draws a connection from a point that is seen to one of the lights, in any direction where that has no place.
fn connection(lights: &[LightSpec], seen: &Clip, bounds: &Bounds, source: &mut Seeded) -> Clip {
    let point = seen.line.at(source.next_uniform() * seen.length);
    let light = lights.get((source.next_uniform() * lights.len() as f64) as usize);
    let [u, v] = [source.next_uniform(), source.next_uniform()];
    let (direction, distance) = match light {
        Some(LightSpec::Point(PointSpec { position, .. })) if *position != point => {
            ((position - point).normalize(), position.distance(point))
        }
        Some(LightSpec::Directional(DirectionalSpec { direction, .. })) => (-*direction, f64::INFINITY),
        _ => (Isotropic.sample(DVec3::Z, u, v).direction, f64::INFINITY),
    };
    let clip = bounds.clip_inside(Line { origin: point, direction });
    Clip { length: clip.length.min(distance), ..clip }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::SceneOverrides;
    use serde_json::{Value, json};

    fn rays(change: impl FnOnce(&mut Value)) -> Vec<Clip> {
        let mut scene: Value =
            serde_json::from_str(include_str!("../../scenes/eq21-environment.json")).unwrap();
        change(&mut scene);
        let spec = SceneSpec::parse(&scene.to_string(), SceneOverrides::default()).unwrap();
        rays_of(&spec, &Bounds::sphere(DVec3::new(0.0, 0.0, 10.0), 10.0).unwrap())
    }

    #[test]
    fn they_are_those_of_the_integrator_whatever_seed_and_resolution() {
        let estimator = json!({ "kind": "regular" });
        let transmittance = json!({ "kind": "transmittance", "estimator": estimator });
        let seen = rays(|scene| scene["integrator"] = transmittance.clone());
        assert_eq!(seen.len(), RAYS);
        assert!(seen.iter().all(|clip| clip.entry_distance > 0.0 && clip.length > 0.0));
        let again = rays(|scene| {
            scene["integrator"] = transmittance.clone();
            scene["seed"] = json!(99);
            scene["samples_per_pixel"] = json!(1);
        });
        assert_eq!(again, seen);
        // Towards a point in the medium, and no further.
        let towards = rays(|scene| {
            scene["integrator"] = json!({ "kind": "path_tracer" });
            scene["lights"] = json!([{ "kind": "point", "position": [0, 0, 10], "power": 1 }]);
        });
        let reaches = |clip: &Clip| (clip.line.at(clip.length) - DVec3::new(0.0, 0.0, 10.0)).length() < 1e-9;
        assert!(towards.len() == RAYS && towards.iter().all(reaches));
    }

    #[test]
    fn a_camera_that_looks_away_and_a_scene_without_medium_have_none() {
        assert_eq!(rays(|scene| scene["camera"]["look_at"] = json!([0, 0, -100])), []);
        let empty = rays(|scene| {
            scene.as_object_mut().unwrap().remove("medium");
            scene["integrator"] = json!({ "kind": "path_tracer" });
        });
        assert_eq!(empty, []);
    }
}
