//! The lights of a scene.

use super::ColourSpec;
use crate::reader::Node;
use crate::reader::rule::{File, Own, Rule, Vector, vector_schema};
use crate::{Failure, kind, registry};
use glam::DVec3;
use serde_json::{Value, json};
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
        direction: DVec3 as Sight,
        /// The irradiance of a plane that it meets at a right angle.
        irradiance: ColourSpec as Own,
    }
}

/// Three numbers that can be normalised.
#[derive(Debug)]
pub(super) struct Sight;

impl Rule<DVec3> for Sight {
    fn read(node: &Node<'_>) -> Result<DVec3, Failure> {
        let vector = node.vector()?;
        if vector.try_normalize().is_none() {
            return Err(node.refuse("must not be zero"));
        }
        Ok(vector)
    }
    fn written(value: &DVec3) -> Value {
        json!(value.to_array())
    }
    fn schema() -> Value {
        vector_schema()
    }
}

impl LightSpec {
    /// Its strength; `None` where a picture says it.
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
