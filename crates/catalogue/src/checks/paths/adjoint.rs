//! Importons and photons.

use super::{Check, LAWFUL};
use crate::checks::Law;
use crate::paths::adjoint::check;
use fairflight_collision::Version;
use fairflight_laws::CheckResult;
use fairflight_media::phase::HenyeyGreenstein;
use fairflight_media::{AnalyticCosine, Bounds};
use fairflight_paths::{Uniform, Walk};
use fairflight_scene::{Background, Camera, EnvironmentMap, Lights, Scene, Source, Volume};
use glam::{DVec3, dvec3};

/// One check per kind of light: N, and photons per sample; few of a point's own photons meet the medium.
pub(super) fn checks() -> Vec<Check> {
    let dark = || Lights { background: Background::dark(), sources: Vec::new() };
    let directional = Source::directional(dvec3(0.6, -0.5, -0.6), 3.0).expect(LAWFUL);
    let point = Source::point(dvec3(-1.5, 1.2, 12.4), 100.0).expect(LAWFUL);
    // Twice as bright at +x as at −x, and more so towards +y.
    let gradient = EnvironmentMap::new(4, 2, vec![3.0, 4.0, 3.0, 2.0, 1.5, 2.0, 1.5, 1.0]).expect(LAWFUL);
    let background = |constant, maps| Background { constant, maps };
    vec![
        adjoint("directional", (190_000, 8), Lights { sources: vec![directional], ..dark() }),
        adjoint("point_outside", (150_000, 40), Lights { sources: vec![point], ..dark() }),
        adjoint("constant", (240_000, 8), Lights { background: background(1.0, vec![]), ..dark() }),
        adjoint("map", (100_000, 8), Lights { background: background(0.0, vec![gradient]), ..dark() }),
    ]
}

fn adjoint(name: &str, (samples, photons): (u64, u32), lights: Lights<f64>) -> Check {
    let scene = Scene {
        camera: Camera::new(dvec3(2.0, 1.0, -10.0), dvec3(0.0, 0.0, 10.0), DVec3::Y, 12.0, [2, 2])
            .expect(LAWFUL),
        volume: Volume {
            medium: AnalyticCosine::new(2.0).expect(LAWFUL),
            bounds: Bounds::sphere(dvec3(0.0, 0.0, 10.0), 2.0).expect(LAWFUL),
            albedo: 0.7,
            phase: HenyeyGreenstein::new(0.5).expect(LAWFUL),
        },
        lights,
    };
    let walk = Walk::new(Version::NonTerminating, Uniform::new(1.6).expect(LAWFUL));
    let id = format!("paths/adjoint/{name}");
    Check::new(id, Law::Adjoint, "photons and importons", "eq21", samples, move |run| {
        check(&scene, &walk, photons, run)
            .unwrap_or_else(|error| CheckResult::exact(false, format!("refused: {error}")))
    })
    .about(["particle_tracer", "transmittance"])
}
