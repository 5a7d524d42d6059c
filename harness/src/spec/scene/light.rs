//! The lights of a scene.

use super::ColourSpec;
use crate::Failure;
use crate::reader::Node;
use glam::DVec3;
use std::path::PathBuf;

/// A light as given.
#[derive(Clone, Debug, PartialEq)]
pub enum LightSpec {
    /// The same radiance from everywhere.
    Environment {
        /// \[radiance\]
        radiance: ColourSpec,
    },
    /// A picture of latitude and longitude.
    EnvironmentMap {
        /// .exr or .pfm
        file: PathBuf,
    },
    /// Shines into all directions alike.
    Point {
        /// Where.
        position: DVec3,
        /// \[power\]
        power: ColourSpec,
    },
    /// Parallel light.
    Directional {
        /// The direction of travel of its light, of any length but 0.
        direction: DVec3,
        /// Power per area across that direction.
        irradiance: ColourSpec,
    },
}

impl LightSpec {
    /// Reads one of `lights`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let strength = |key| ColourSpec::read(&object.required(key)?, f64::INFINITY);
        let light = match kind.text()? {
            "environment" => Self::Environment { radiance: strength("radiance")? },
            "environment_map" => {
                Self::EnvironmentMap { file: PathBuf::from(object.required("file")?.text()?) }
            }
            "point" => {
                Self::Point { position: object.required("position")?.vector()?, power: strength("power")? }
            }
            "directional" => {
                let direction = object.required("direction")?;
                let vector = direction.vector()?;
                if vector.try_normalize().is_none() {
                    return Err(direction.refuse("must not be zero"));
                }
                Self::Directional { direction: vector, irradiance: strength("irradiance")? }
            }
            _ => return Err(kind.refuse("must be environment, environment_map, point or directional")),
        };
        object.finish()?;
        Ok(light)
    }

    /// How strong it is, but for a picture.
    #[must_use]
    pub fn strength(&self) -> Option<&ColourSpec> {
        match self {
            Self::Environment { radiance } => Some(radiance),
            Self::EnvironmentMap { .. } => None,
            Self::Point { power, .. } => Some(power),
            Self::Directional { irradiance, .. } => Some(irradiance),
        }
    }
}
