//! The lights of a scene.

use super::ColourSpec;
use crate::reader::rule::{Direction, File, Own, Vector};
use crate::{kind, registry};
use glam::DVec3;
use std::path::PathBuf;

registry! {
    /// A light that is no surface.
    LightSpec {
        Environment(EnvironmentSpec),
        EnvironmentMap(EnvironmentMapSpec),
        Point(PointSpec),
        Directional(DirectionalSpec),
    }
}

kind! {
    /// The same radiance from everywhere.
    EnvironmentSpec = "environment" {
        /// The radiance.
        radiance: ColourSpec as Own,
    }
}

kind! {
    /// Radiance from a picture, latitude and longitude.
    EnvironmentMapSpec = "environment_map" {
        /// The picture, .exr or .pfm, relative to the file in which it is named.
        file: PathBuf as File,
    }
}

kind! {
    /// The same intensity into all directions, from a point.
    PointSpec = "point" {
        /// The point.
        position: DVec3 as Vector,
        /// The power.
        power: ColourSpec as Own,
    }
}

kind! {
    /// Parallel light from infinitely far away.
    DirectionalSpec = "directional" {
        /// The direction in which it travels.
        direction: DVec3 as Direction,
        /// The irradiance of a plane that it meets at a right angle.
        irradiance: ColourSpec as Own,
    }
}

impl LightSpec {
    /// Strength of the light; `None` where a picture says it.
    #[must_use]
    pub fn strength(&self) -> Option<&ColourSpec> {
        match self {
            Self::Environment(light) => Some(&light.radiance),
            Self::EnvironmentMap(_) => None,
            Self::Point(light) => Some(&light.power),
            Self::Directional(light) => Some(&light.irradiance),
        }
    }
}
