//! The profile of an experiment: the extinction along one ray.

use super::{MediumSpec, Node};
use crate::Failure;
use glam::DVec3;

/// A profile as given.
#[derive(Clone, Debug, PartialEq)]
pub enum ProfileSpec {
    /// The same extinction everywhere.
    Constant {
        /// \[1/length\]
        sigma_t: f64,
        /// \[length\]
        length: f64,
    },
    /// One value per cell.
    PiecewiseConstant {
        /// Borders of the cells.
        edges: Vec<f64>,
        /// Their values.
        sigma_t: Vec<f64>,
    },
    /// Linear between nodes.
    PiecewiseLinear {
        /// The nodes.
        positions: Vec<f64>,
        /// Their values.
        sigma_t: Vec<f64>,
    },
    /// A formula in s.
    Expression {
        /// The formula.
        sigma_t: String,
        /// \[length\]
        length: f64,
        /// A fact about the field.
        majorant: Option<f64>,
    },
    /// A ray through a medium.
    Ray {
        /// The medium.
        medium: Box<MediumSpec>,
        /// Where the ray starts.
        origin: DVec3,
        /// Where it goes; of any length but 0.
        direction: DVec3,
        /// Where it ends; without it, at the far end of the medium's bounds.
        length: Option<f64>,
    },
}

impl ProfileSpec {
    /// Reads `profile`.
    ///
    /// # Errors
    /// If a key is missing, unknown or of the wrong kind.
    pub fn read(node: &Node<'_>) -> Result<Self, Failure> {
        let object = node.object()?;
        let kind = object.required("kind")?;
        let spec = match kind.text()? {
            "constant" => Self::Constant {
                sigma_t: object.required("sigma_t")?.number()?,
                length: object.required("length")?.non_negative()?,
            },
            "piecewise_constant" => Self::PiecewiseConstant {
                edges: object.required("edges")?.numbers()?,
                sigma_t: object.required("sigma_t")?.numbers()?,
            },
            "piecewise_linear" => Self::PiecewiseLinear {
                positions: object.required("positions")?.numbers()?,
                sigma_t: object.required("sigma_t")?.numbers()?,
            },
            "expression" => Self::Expression {
                sigma_t: object.required("sigma_t")?.text()?.to_owned(),
                length: object.required("length")?.non_negative()?,
                majorant: object.optional("majorant").map(|node| node.non_negative()).transpose()?,
            },
            "ray" => {
                let direction = object.required("direction")?;
                let vector = direction.vector()?;
                if vector == DVec3::ZERO {
                    return Err(direction.refuse("must not be zero"));
                }
                Self::Ray {
                    medium: Box::new(MediumSpec::read(&object.required("medium")?)?),
                    origin: object.required("origin")?.vector()?,
                    direction: vector,
                    length: object.optional("length").map(|node| node.non_negative()).transpose()?,
                }
            }
            _ => {
                return Err(
                    kind.refuse("must be constant, piecewise_constant, piecewise_linear, expression or ray")
                );
            }
        };
        object.finish()?;
        Ok(spec)
    }
}
