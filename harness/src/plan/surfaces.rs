//! The surfaces of a scene, and whether lights and integrator fit them.

use crate::Failure;
use crate::spec::{
    ExtensionSpec, IntegratorSpec, LightSpec, MaterialSpec, PathTracerSpec, PointSpec, SceneSpec, SurfaceSpec,
};
use fairflight_scene::{Material, SceneError, Spectrum, Surface, Surfaces};
use glam::DVec3;

/// The surfaces of a spec, in the channels that `of` takes of red, green and blue.
pub(super) fn build<C: Spectrum>(
    specs: &[SurfaceSpec],
    of: impl Fn([f64; 3]) -> C,
) -> Result<Surfaces<C>, Failure> {
    let one = |spec: &SurfaceSpec| -> Result<Surface<C>, SceneError> {
        let material = match &spec.material {
            MaterialSpec::Diffuse(material) => {
                Material::Diffuse { reflectance: of(material.reflectance.rgb()) }
            }
            MaterialSpec::Mirror(_) => Material::Mirror,
            MaterialSpec::Dielectric(material) => Material::Dielectric { ior: material.ior },
        };
        Surface::new(spec.shape.kind().build()?, material, of(spec.emission.rgb()))
    };
    let all = specs
        .iter()
        .enumerate()
        .map(|(i, spec)| one(spec).map_err(|error| Failure::refused(format!("surfaces.{i}: {error}"))));
    Ok(Surfaces::new(all.collect::<Result<_, _>>()?))
}

/// Checks that the parts of a scene fit its surfaces.
///
/// # Errors
/// If the integrator is blind to them, or nothing of a light can be seen because of them.
pub(super) fn check(spec: &SceneSpec) -> Result<(), Failure> {
    let camera = spec.camera.origin();
    for (i, light) in spec.lights.iter().enumerate() {
        let LightSpec::Point(PointSpec { position, .. }) = light else { continue };
        let position = *position;
        if let Some(j) = solid_around(&spec.surfaces, camera, |solid| solid.shape.encloses(position)) {
            return Err(shut_in(&format!("lights.{i}.position"), j));
        }
        let glass = |surface: &SurfaceSpec| is_dielectric(surface) && surface.shape.encloses(position);
        if let Some(j) = spec.surfaces.iter().position(glass) {
            return Err(Failure::refused(format!(
                "lights.{i}.position: lies inside the dielectric surfaces.{j}: no connection passes a smooth interface, \
                 and nothing meets a point"
            )));
        }
    }
    for (i, emitter) in spec.surfaces.iter().enumerate().filter(|(_, surface)| surface.emits()) {
        let around = |solid: &SurfaceSpec| solid.shape.encloses_all_of(&emitter.shape);
        if let Some(j) = solid_around(&spec.surfaces, camera, around) {
            return Err(shut_in(&format!("surfaces.{i}"), j));
        }
    }
    let guided = |spec: &PathTracerSpec| matches!(spec.extension, Some(ExtensionSpec::Guided(_)));
    let shines = |light: &LightSpec| light.strength().is_none_or(|strength| strength.rgb() != [0.0; 3]);
    if matches!(&spec.integrator, IntegratorSpec::PathTracer(spec) if guided(spec))
        && !spec.lights.iter().any(shines)
        && !spec.surfaces.iter().any(SurfaceSpec::emits)
    {
        return Err(Failure::refused("integrator.extension: guided needs a light that emits photons"));
    }
    if spec.integrator.kind().transport().is_none() && !spec.surfaces.is_empty() {
        let name = spec.integrator.name();
        return Err(Failure::refused(format!(
            "integrator.kind: {name} knows no surfaces; allowed with surfaces are path_tracer, vpl, bidirectional and \
             beam_radiance"
        )));
    }
    Ok(())
}

fn is_dielectric(surface: &SurfaceSpec) -> bool {
    matches!(surface.material, MaterialSpec::Dielectric(_))
}

/// A sphere that light cannot leave, with the light inside and the camera outside: from inside, one sees.
fn solid_around(
    surfaces: &[SurfaceSpec],
    camera: DVec3,
    encloses: impl Fn(&SurfaceSpec) -> bool,
) -> Option<usize> {
    surfaces
        .iter()
        .position(|surface| !is_dielectric(surface) && encloses(surface) && !surface.shape.encloses(camera))
}

fn shut_in(what: &str, solid: usize) -> Failure {
    Failure::refused(format!("{what}: lies inside the solid surfaces.{solid}, nothing of its light gets out"))
}
