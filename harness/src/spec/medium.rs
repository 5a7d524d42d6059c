//! The medium of a ray.

use super::Node;
use super::node::Object;
use crate::Failure;
use fairflight_media::{Bounds, PerlinParameters};
use std::path::PathBuf;

/// A medium with its bounds, as given.
#[derive(Clone, Debug, PartialEq)]
pub struct MediumSpec {
    /// What fills the bounds.
    pub kind: MediumKind,
    /// Where the medium is; without it, the kind's own.
    pub bounds: Option<Bounds>,
}

/// What fills the bounds.
#[derive(Clone, Debug, PartialEq)]
pub enum MediumKind {
    /// The same extinction everywhere.
    Homogeneous {
        /// \[1/length\]
        sigma_t: f64,
    },
    /// szirmay-kalos-2017 eq. 21.
    AnalyticCosine {
        /// A factor in front of it.
        scale: f64,
    },
    /// Perlin noise of several octaves.
    Perlin(PerlinParameters),
    /// A formula in x, y, z.
    Expression {
        /// The formula.
        sigma_t: String,
        /// A fact about the field.
        majorant: Option<f64>,
    },
    /// An OpenVDB fog volume.
    Vdb {
        /// The file.
        file: PathBuf,
        /// The grid; without it `density`, or else the only float grid.
        grid: Option<String>,
        /// A factor in front of the voxel values.
        scale: f64,
        /// Voxels below 0.
        negative: NegativeVoxels,
    },
}

/// What is done with voxels below 0: densities have none, and of what is none a grid without a class gives no
/// other sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NegativeVoxels {
    /// The volume is refused.
    #[default]
    Refused,
    /// They are negative extinctions, as `allow_negative` says.
    Allowed,
}

impl MediumSpec {
    /// Reads `medium`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let medium = Self::take_from(&object)?;
        object.finish()?;
        Ok(medium)
    }

    /// Takes the keys of a medium from an object that may have more: those of a scene's medium.
    ///
    /// # Errors
    /// If a key is missing or of the wrong kind.
    pub fn take_from(object: &Object<'_>) -> Result<Self, Failure> {
        let kind = MediumKind::read(object)?;
        let bounds = object.optional("bounds").map(|node| read_bounds(&node)).transpose()?;
        let has_own = matches!(kind, MediumKind::AnalyticCosine { .. } | MediumKind::Vdb { .. });
        if bounds.is_none() && !has_own {
            // Names the missing key.
            object.required("bounds")?;
        }
        Ok(Self { kind, bounds })
    }
}

impl MediumKind {
    fn read(object: &Object<'_>) -> Result<Self, Failure> {
        let kind = object.required("kind")?;
        Ok(match kind.text()? {
            "homogeneous" => Self::Homogeneous { sigma_t: object.required("sigma_t")?.number()? },
            "analytic_cosine" => Self::AnalyticCosine { scale: number_or(object, "scale", 1.0)? },
            "perlin" => Self::Perlin(read_perlin(object)?),
            "expression" => Self::Expression {
                sigma_t: object.required("sigma_t")?.text()?.to_owned(),
                majorant: object.optional("majorant").map(|node| node.non_negative()).transpose()?,
            },
            "vdb" => Self::Vdb {
                file: PathBuf::from(object.required("file")?.text()?),
                grid: object.optional("grid").map(|node| node.text().map(str::to_owned)).transpose()?,
                scale: number_or(object, "scale", 1.0)?,
                negative: match object.optional("allow_negative").map(|node| node.boolean()).transpose()? {
                    Some(true) => NegativeVoxels::Allowed,
                    _ => NegativeVoxels::Refused,
                },
            },
            _ => {
                return Err(kind.refuse("must be homogeneous, analytic_cosine, perlin, expression or vdb"));
            }
        })
    }
}

fn number_or(object: &Object<'_>, key: &'static str, default: f64) -> Result<f64, Failure> {
    object.optional(key).map_or(Ok(default), |node| node.number())
}

fn read_perlin(object: &Object<'_>) -> Result<PerlinParameters, Failure> {
    let default = PerlinParameters::default();
    let integer = |key, least, most, otherwise: u32| {
        object.optional(key).map_or(Ok(otherwise), |node| node.integer(least, most).map(|n| n as u32))
    };
    Ok(PerlinParameters {
        octaves: integer("octaves", 1, 32, default.octaves)?,
        frequency: number_or(object, "frequency", default.frequency)?,
        lacunarity: number_or(object, "lacunarity", default.lacunarity)?,
        gain: number_or(object, "gain", default.gain)?,
        seed: integer("seed", 0, u64::from(u32::MAX), default.seed)?,
        scale: number_or(object, "scale", default.scale)?,
        offset: number_or(object, "offset", default.offset)?,
    })
}

fn read_bounds(node: &Node<'_>) -> Result<Bounds, Failure> {
    let object = node.object()?;
    let bounds = match (object.optional("sphere"), object.optional("box")) {
        (Some(sphere), None) => {
            let object = sphere.object()?;
            let center = object.required("center")?.vector()?;
            let radius = object.required("radius")?.non_negative()?;
            object.finish()?;
            Bounds::sphere(center, radius).map_err(|error| sphere.reject(error))?
        }
        (None, Some(cuboid)) => {
            let object = cuboid.object()?;
            let (min, max) = (object.required("min")?, object.required("max")?);
            let (low, high) = (min.vector()?, max.vector()?);
            if !low.cmple(high).all() {
                return Err(max.refuse("must not be below min in any coordinate"));
            }
            object.finish()?;
            Bounds::aligned_box(low, high).map_err(|error| cuboid.reject(error))?
        }
        _ => return Err(node.refuse("must hold either sphere or box")),
    };
    object.finish()?;
    Ok(bounds)
}
