//! The beam radiance estimate.

use super::path_tracer::MOST_VERTICES;
use super::transport::TransportSpec;
use super::vpl::MOST_LIGHT_PATHS;
use super::{IntegratorKind, SamplerSpec};
use crate::reader::kind::Among;
use crate::reader::rule::{Positive, Whole};
use crate::{kind, words};
use fairflight_photons::SurfaceLight;

words! {
    /// The light that the first diffuse surface of a camera ray reflects.
    pub(super) SurfaceWord for SurfaceLight {
        "path" => SurfaceLight::Path,
        "map" => SurfaceLight::Map,
    }
}

kind! {
    /// Photons beside the whole camera ray (jarosz-2008), among surfaces: biased, since light is smeared out over the radius.
    BeamRadianceSpec = "beam_radiance" {
        /// Light paths that leave the photons of a map, one map for each sample of a pixel, or for each of its point sets.
        photons: u32 as Whole<1, MOST_LIGHT_PATHS>,
        /// The distance from the ray within which photons count \[length\].
        radius: f64 as Positive,
        /// The light that surfaces reflect: by paths from there on, or by the photons on them, a bias as that of the medium.
        surfaces: SurfaceLight as SurfaceWord = SurfaceLight::Path,
        /// More smooth surfaces along a ray, and longer paths from surfaces, are cut, a bias.
        max_vertices: u32 as Whole<1, MOST_VERTICES> = MOST_VERTICES as u32,
        /// The flights of photons, the transmittance between them and the camera, and the paths from surfaces.
        transport: TransportSpec as Among,
        /// Variates of the samples of a pixel.
        points: SamplerSpec as Among,
    }
    check |spec, object| spec.points.check(object)
}

impl IntegratorKind for BeamRadianceSpec {
    fn sampler(&self) -> Option<&SamplerSpec> {
        Some(&self.points)
    }
    fn transport(&self) -> Option<&TransportSpec> {
        Some(&self.transport)
    }
    fn bias(&self) -> Option<&'static str> {
        Some(if self.transport.is_biased_baseline() {
            "the beam radiance estimate is biased, and so is its transmittance, that of a biased baseline"
        } else {
            "the beam radiance estimate is biased: scattered light is smeared out over its radius"
        })
    }
}
