//! Warnings that a reader of an image should know.

use super::passes::End;
use super::statistics::Moments;
use crate::plan::{IntegratorPlan, ScenePlan};
use crate::spec::{
    BeamRadianceSpec, BidirectionalSpec, ClampSpec, IntegratorSpec, LightSpec, MaterialSpec, PathTracerSpec,
    SceneSpec, SurfaceSpec,
};
use fairflight_photons::SurfaceLight;

/// The warnings; without an `end`, those of an image that is still being drawn.
pub(super) fn warnings(
    spec: &SceneSpec,
    plan: &ScenePlan,
    moments: &Moments,
    end: Option<End>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let (drawn, asked) = (moments.samples(), spec.samples_per_pixel);
    warnings.extend(match end {
        Some(end) => end.warning(drawn, asked),
        None => Some(format!("the image is not finished: {drawn} of {asked} samples per pixel so far")),
    });
    warnings.extend(moments.warning());
    if let Some(walk) = spec.integrator.walk()
        && moments.truncated() > 0
    {
        let limit = match &spec.integrator {
            IntegratorSpec::PathTracer(PathTracerSpec { max_vertices, .. })
            | IntegratorSpec::Bidirectional(BidirectionalSpec { max_vertices, .. })
            | IntegratorSpec::BeamRadiance(BeamRadianceSpec { max_vertices, .. }) => {
                format!("max_vertices = {max_vertices} or ")
            }
            IntegratorSpec::Vpl(_) => "too many vertices or ".to_owned(),
            _ => String::new(),
        };
        warnings.push(format!(
            "{} walks were cut by {limit}max_collisions = {}: what they had left is missing, a bias",
            moments.truncated(),
            walk.max_collisions
        ));
    }
    warnings.extend(spec.integrator.kind().bias().map(|what| format!("integrator: {what}")));
    let inside =
        |light: &LightSpec| matches!(light, LightSpec::Point(point) if plan.bounds.contains(point.position));
    let photons = matches!(plan.integrator, IntegratorPlan::PhotonTracer(_));
    if photons && spec.medium.is_some() && plan.bounds.contains(plan.camera.origin()) {
        warnings.push(
            "the camera stands in the medium: the connection of photons with it has no second moment, errors are \
             underrated"
                .to_owned(),
        );
    }
    // Weighted against the light image a connection is bounded.
    let bounded = match &spec.integrator {
        IntegratorSpec::Bidirectional(integrator) => integrator.light_image,
        // Only paths from surfaces are connected.
        IntegratorSpec::BeamRadiance(beam) => spec.surfaces.is_empty() || beam.surfaces == SurfaceLight::Map,
        _ => false,
    };
    let connected = spec.integrator.walk().is_some() && !photons && !bounded && spec.medium.is_some();
    if connected && spec.lights.iter().any(inside) {
        warnings.push(
            "a point light lies in the medium: the connection with it has no second moment, errors are underrated"
                .to_owned(),
        );
    }
    let caustics = matches!(&spec.integrator, IntegratorSpec::Bidirectional(spec) if spec.point_caustics);
    let is_smooth = |surface: &SurfaceSpec| !matches!(surface.material, MaterialSpec::Diffuse(_));
    let no_extent = |light: &LightSpec| matches!(light, LightSpec::Point(_) | LightSpec::Directional(_));
    let passed_on = spec.surfaces.iter().any(is_smooth) && spec.lights.iter().any(no_extent);
    if passed_on && spec.integrator.kind().transport().is_some() {
        let missing = if caustics {
            "light of points and directions is missing where smooth surfaces show what smooth surfaces pass on: no strategy connects \
             such a path"
        } else {
            "light of points and directions that smooth surfaces pass on is missing: no path from the camera meets it by chance, \
             and virtual point lights leave it out alike"
        };
        warnings.push(missing.to_owned());
    }
    let unbounded = matches!(&spec.integrator, IntegratorSpec::Vpl(vpl) if vpl.clamp == ClampSpec::Unclamped);
    if unbounded && spec.medium.is_some() {
        warnings.push(
            "unbounded connections in a medium have no second moment: errors are underrated".to_owned(),
        );
    }
    if spec.lights.is_empty() && !spec.surfaces.iter().any(SurfaceSpec::emits) {
        warnings.push("there is no light, the image is black".to_owned());
    }
    warnings
}
